from drystone.kernels.memory cimport doubles, doubles_out
from libc.math cimport ceil, floor

cdef void sweep_all(
    double *at, Py_ssize_t size, double left, double cell, double *bottoms, double *tops,
    Py_ssize_t columns
) noexcept nogil
cdef void sweep(
    double start_x, double start_y, double end_x, double end_y, double cell, double *bottoms,
    double *tops, Py_ssize_t columns
) noexcept nogil
