from drystone.kernels.memory cimport doubles, p_double
from libc.math cimport sqrt


cdef class EdgeChain:
    cdef object kept
    cdef p_double nodes, middle, sums
    cdef Py_ssize_t count
    cdef double x, y, along_x, along_y


cdef double fit(EdgeChain chain, Py_ssize_t first, Py_ssize_t last) noexcept
cdef bint fits(EdgeChain chain, Py_ssize_t first, Py_ssize_t last, double tolerance) noexcept
cdef Py_ssize_t furthest(EdgeChain chain, Py_ssize_t first, double tolerance) noexcept
cdef Py_ssize_t best_cut(
    EdgeChain chain, Py_ssize_t first, Py_ssize_t cut, Py_ssize_t last, double tolerance
) noexcept
