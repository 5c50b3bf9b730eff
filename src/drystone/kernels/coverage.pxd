from drystone.kernels.memory cimport doubles, doubles_out, flags_out
from libc.math cimport ceil, floor, isfinite

cdef void cut_at_rows(
    double foot_x, double foot_y, double head_x, double head_y, double sign, double *out,
    Py_ssize_t width, Py_ssize_t height
) noexcept nogil
cdef void cut_at_columns(
    double low, double high, double drop, double *sums, Py_ssize_t row, Py_ssize_t width
) noexcept nogil
cdef void add_up(double *shares, Py_ssize_t width, Py_ssize_t height) noexcept nogil
