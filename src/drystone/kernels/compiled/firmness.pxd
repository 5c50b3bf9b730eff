"""The rest test, for other compiled kernels."""

from drystone.kernels.compiled.gaps cimport Gaps
from drystone.kernels.compiled.seidel cimport Row2, Row3

ctypedef struct Work:
    Row3 *rows
    Row2 *scratch
    Py_ssize_t room
    bint lost

cdef void init_work(Work *work) noexcept nogil
cdef void free_work(Work *work) noexcept nogil
cdef bint enough_rows(Work *work, Py_ssize_t count) noexcept nogil
cdef double arm_of(const double *corners, Py_ssize_t count, double x, double y) noexcept nogil
cdef double firmness(
    const Gaps *gaps, double x, double y, double arm, double mu, double tolerance,
    double steep, Work *work
) noexcept nogil
