"""Small linear programs for other compiled kernels."""

ctypedef struct Row3:
    double a[3]
    double b

ctypedef struct Row2:
    double a[2]
    double b

cdef bint solve3(
    Row3 *rows, Py_ssize_t count, const double *gain, const double *most, Row2 *scratch, double *x
) noexcept nogil

cdef bint solve2(
    const Row2 *rows, Py_ssize_t count, const double *gain, const double *most, double *x
) noexcept nogil
