from drystone.kernels.gaps cimport MovingStone, find_gaps, heap_of, stone_of
from drystone.kernels.memory cimport doubles, more_doubles, new_doubles, release
from drystone.kernels.seidel cimport solve2, solve3
from libc.math cimport sqrt


cdef class LpRows:
    cdef double *rows
    cdef double *scratch
    cdef Py_ssize_t room


cdef int enough_rows(LpRows work, Py_ssize_t count) except -1 nogil
cdef double arm_of(const double *corners, Py_ssize_t count, double x, double y) noexcept nogil
cdef double firmness(
    MovingStone stone, double x, double y, double arm, double mu, double tolerance,
    double steep, LpRows work
) except -2.0 nogil
