from drystone.kernels.memory cimport doubles

cdef bint solve3(
    double *rows, Py_ssize_t count, const double *gain, const double *most, double *scratch,
    double *x,
) noexcept nogil
cdef bint solve2(
    const double *rows, Py_ssize_t count, const double *gain, const double *most, double *x
) noexcept nogil
