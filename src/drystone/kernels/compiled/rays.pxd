"""See `rays.pyx`."""

from libc.stdint cimport int32_t, int64_t, uint64_t


cdef class Swept:
    cdef const int32_t[::1] left
    cdef const int32_t[:, ::1] runs
    cdef Py_ssize_t height, width, area


cdef class RaySums:
    cdef readonly Py_ssize_t height, width
    cdef Py_ssize_t first
    cdef uint64_t[:, ::1] words
    cdef int32_t[:, ::1] counts, below

    cdef bint holds(self, Swept mask, Py_ssize_t row, Py_ssize_t col) noexcept nogil
    cdef int check(self, Swept mask, const int64_t[:, :] positions) except -1
    cdef int64_t along(self, Py_ssize_t row, Py_ssize_t col) noexcept nogil
    cdef int64_t end(self, Py_ssize_t row, Py_ssize_t col) noexcept nogil
    cdef double share(self, Swept mask, Py_ssize_t row, Py_ssize_t col) noexcept nogil
    cdef int64_t beside(self, Swept mask, Py_ssize_t row, Py_ssize_t col) noexcept nogil
