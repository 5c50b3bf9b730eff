"""Rows of pixels as bits of 64-bit words, the first pixel in the lowest bit of the first word."""

from libc.stdint cimport int32_t, uint64_t

cdef extern from *:
    """
    #if defined(_MSC_VER)
    #include <intrin.h>
    static int lowest_bit(unsigned long long x) {
        unsigned long at; _BitScanForward64(&at, x); return (int) at;
    }
    static int highest_bit(unsigned long long x) {
        unsigned long at; _BitScanReverse64(&at, x); return (int) at;
    }
    #elif defined(__GNUC__)
    static int lowest_bit(unsigned long long x) { return __builtin_ctzll(x); }
    static int highest_bit(unsigned long long x) { return 63 - __builtin_clzll(x); }
    #else
    static int lowest_bit(unsigned long long x) {
        int at = 0; while (!(x >> at & 1)) at++; return at;
    }
    static int highest_bit(unsigned long long x) {
        int at = 63; while (!(x >> at & 1)) at--; return at;
    }
    #endif
    """
    int lowest_bit(uint64_t x) nogil  # x is not 0
    int highest_bit(uint64_t x) nogil


cdef inline void pack(
    const unsigned char *pixels, Py_ssize_t width, uint64_t *words, int32_t *counts
) noexcept nogil:
    """Fill in a row: bit c of the words for pixel c, and how many are set before each 8 pixels.

    Words are 0 before; there is one count more than whole bytes, or no room for counts at all.
    """
    cdef Py_ssize_t col = 0, at
    cdef int32_t count = 0
    cdef uint64_t eight
    for col in range(0, width - 7, 8):
        eight = 0
        for at in range(8):
            eight |= <uint64_t> pixels[col + at] << (8 * at)
        # Byte i, 0 or 1, comes to bit 56 + i; then all come to bit 56.
        words[col >> 6] |= (eight * <uint64_t> 0x0102040810204080) >> 56 << (col & 63)
        if counts != NULL:
            counts[col >> 3] = count
            count += <int32_t> ((eight * <uint64_t> 0x0101010101010101) >> 56)
    if counts != NULL:
        counts[width >> 3] = count
    for col in range(width & ~<Py_ssize_t> 7, width):
        words[col >> 6] |= <uint64_t> pixels[col] << (col & 63)
