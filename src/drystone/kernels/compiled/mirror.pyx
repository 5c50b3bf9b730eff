# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.mirror`."""

from libc.stdint cimport uint64_t
from libc.string cimport memcpy


def mirror(const unsigned char[:, ::1] pixels, unsigned char[:, ::1] out):
    """Fill in the mirror image, eight pixels at a time."""
    cdef Py_ssize_t width = pixels.shape[1], row, col
    cdef uint64_t eight
    with nogil:
        for row in range(pixels.shape[0]):
            for col in range(0, width - 7, 8):
                memcpy(&eight, &pixels[row, col], 8)
                eight = reverse(eight)
                memcpy(&out[row, width - 8 - col], &eight, 8)
            for col in range(width & ~<Py_ssize_t> 7, width):
                out[row, width - 1 - col] = pixels[row, col]


cdef inline uint64_t reverse(uint64_t x) noexcept nogil:
    """Return the bytes of a word in the other order."""
    x = (x & <uint64_t> 0x00FF00FF00FF00FF) << 8 | (x >> 8 & <uint64_t> 0x00FF00FF00FF00FF)
    x = (x & <uint64_t> 0x0000FFFF0000FFFF) << 16 | (x >> 16 & <uint64_t> 0x0000FFFF0000FFFF)
    return x << 32 | x >> 32
