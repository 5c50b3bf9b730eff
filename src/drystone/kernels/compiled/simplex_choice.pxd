"""See `simplex_choice.pyx`."""

from libc.stdint cimport int32_t, uint64_t

cdef enum:
    PLACE_SEED = 0x10000000
    START_SEED = 0x20000000

cdef double LARGE_PIVOT
cdef double SMALL_PIVOT

cdef void scattered(uint64_t seed, Py_ssize_t count, double *out) noexcept nogil
cdef Py_ssize_t leaving(
    const double *levels, const double *steps, const char *fixed, Py_ssize_t size,
    Py_ssize_t alpha_place
) noexcept nogil
cdef Py_ssize_t entering(
    const double *slopes, double flip, const double *rates, const double *ties, Py_ssize_t count,
    double pivot, int32_t *listed
) noexcept nogil
cdef Py_ssize_t blocking(
    const double *column, const double *levels, const double *ties, const char *fixed,
    Py_ssize_t size, Py_ssize_t alpha_place, double pivot, int32_t *listed
) noexcept nogil
