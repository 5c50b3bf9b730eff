"""See `simplex_small.pyx`."""

from libc.stdint cimport int32_t

cdef enum:
    FOUND = 0
    NO_FORCES = 1
    NO_BOUND = 2
    SMALL_LOST = 3

cdef Py_ssize_t tableau_size(Py_ssize_t rows, Py_ssize_t count) noexcept nogil
cdef int solve_small(
    double *tableau, Py_ssize_t rows, Py_ssize_t count, int32_t *heads, double *fall, double *lift
) noexcept nogil
