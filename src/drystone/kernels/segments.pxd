from drystone.kernels.memory cimport doubles, p_double
from libc.math cimport sqrt


cdef class Chain:
    cdef object kept
    cdef p_double nodes, middle, sums
    cdef Py_ssize_t count
    cdef double x, y, along_x, along_y


cdef double fit(Chain chain, Py_ssize_t first, Py_ssize_t last) noexcept
cdef bint fits(Chain chain, Py_ssize_t first, Py_ssize_t last, double tolerance) noexcept
cdef Py_ssize_t furthest(Chain chain, Py_ssize_t first, double tolerance) noexcept
cdef Py_ssize_t best_cut(
    Chain chain, Py_ssize_t first, Py_ssize_t cut, Py_ssize_t last, double tolerance
) noexcept
