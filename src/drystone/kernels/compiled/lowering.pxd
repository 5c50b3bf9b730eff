# cython: language_level=3
from libc.stdint cimport int32_t, int64_t


cdef void drop(
    const int32_t *top,
    const int32_t *bottom,
    Py_ssize_t cols,
    Py_ssize_t width,
    int32_t *rows,
) noexcept nogil


cdef class Columns:
    cdef int32_t *rows
    cdef int32_t *following
    cdef int32_t *heads
    cdef Py_ssize_t cols, count

    cdef void chain(self) noexcept nogil


cdef class Found:
    cdef int64_t *at
    cdef Py_ssize_t count, room
    cdef bint lost

    cdef void add(self, Py_ssize_t row, Py_ssize_t col) noexcept nogil
    cdef object positions(self)
