# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.rays`."""

from libc.stdint cimport int32_t, int64_t, uint64_t

import numpy as np

from drystone.kernels.compiled.words cimport highest_bit, pack

cdef enum:
    BLOCK = 16  # rows

cdef unsigned char[128] BITS
for _number in range(128):
    BITS[_number] = _number.bit_count()


cdef class Swept:
    """The pattern of the rays of a mask."""

    def __cinit__(self, mask):
        self.left, self.runs, self.area = mask.rays.left, mask.rays.runs, mask.rays.area
        self.height, self.width = mask.height, mask.width


cdef class RaySums:
    """A landscape as words of bits from row `first` on, with what is counted before each byte.

    `below` has the pixels left of each column in every BLOCK-th row and all rows under it; other
    rows are counted one by one.
    """

    def __init__(self, const unsigned char[:, ::1] occupied, Py_ssize_t first):
        cdef Py_ssize_t row, rows
        self.height, self.width, self.first = occupied.shape[0], occupied.shape[1], first
        rows = self.height - first
        self.words = np.zeros((rows, self.width // 64 + 1), np.uint64)
        self.counts = np.empty((rows, self.width // 8 + 1), np.int32)
        self.below = np.zeros(((rows + BLOCK - 1) // BLOCK + 1, self.width + 1), np.int32)
        cdef unsigned char[::1] sums = np.empty(self.width, np.uint8)
        with nogil:
            for row in range(rows):
                pack(
                    &occupied[first + row, 0],
                    self.width,
                    &self.words[row, 0],
                    &self.counts[row, 0],
                )
            for row in range(self.below.shape[0] - 2, -1, -1):
                add_block(occupied, first + row * BLOCK, sums, self.below[row + 1], self.below[row])

    def filled_share(self, mask, const int64_t[:, :] positions):
        """Return the filled share of the swept pixels for many positions of one mask (Eq. 4)."""
        cdef Swept swept = Swept(mask)
        cdef Py_ssize_t at
        self.check(swept, positions)
        shares = np.empty(positions.shape[0])
        cdef double[::1] out = shares
        for at in range(positions.shape[0]):
            out[at] = self.share(swept, positions[at, 0], positions[at, 1])
        return shares

    def filled_share_at(self, mask, Py_ssize_t row, Py_ssize_t col):
        """Return the same for one position."""
        cdef Swept swept = Swept(mask)
        if not self.holds(swept, row, col):
            raise IndexError("the mask leaves the landscape")
        return self.share(swept, row, col)

    def empty_beside(self, mask, const int64_t[:, :] positions):
        """Return the pixels between a mask and the next ones to its left, for many positions."""
        cdef Swept swept = Swept(mask)
        cdef Py_ssize_t at
        self.check(swept, positions)
        pixels = np.empty(positions.shape[0], np.int64)
        cdef int64_t[::1] out = pixels
        for at in range(positions.shape[0]):
            out[at] = self.beside(swept, positions[at, 0], positions[at, 1])
        return pixels

    cdef bint holds(self, Swept mask, Py_ssize_t row, Py_ssize_t col) noexcept nogil:
        """Say whether a position is inside the image."""
        return 0 <= row <= self.height - mask.height and 0 <= col <= self.width - mask.width

    cdef int check(self, Swept mask, const int64_t[:, :] positions) except -1:
        """Refuse positions outside the image."""
        cdef Py_ssize_t at
        for at in range(positions.shape[0]):
            if not self.holds(mask, positions[at, 0], positions[at, 1]):
                raise IndexError("the mask leaves the landscape")
        return 0

    cdef int64_t along(self, Py_ssize_t row, Py_ssize_t col) noexcept nogil:
        """Return the pixels left of a column in a row, counted from the first."""
        cdef uint64_t byte = self.words[row, col >> 6] >> (col & 56)
        return self.counts[row, col >> 3] + BITS[byte & ((1 << (col & 7)) - 1)]

    cdef int64_t end(self, Py_ssize_t row, Py_ssize_t col) noexcept nogil:
        """Return the column after the last pixel left of a column, 0 when there is none."""
        cdef Py_ssize_t word = col >> 6
        cdef uint64_t bits = self.words[row, word] & (((<uint64_t> 1) << (col & 63)) - 1)
        if bits == 0 and self.counts[row, col >> 3] == 0:
            return 0
        while bits == 0:
            word -= 1
            bits = self.words[row, word]
        return 64 * word + highest_bit(bits) + 1

    cdef double share(self, Swept mask, Py_ssize_t row, Py_ssize_t col) noexcept nogil:
        """Return the filled share of what is swept."""
        cdef int64_t filled = 0
        cdef int64_t swept = (
            mask.height * col + mask.width * (self.height - row - mask.height) + mask.area
        )
        cdef Py_ssize_t top = row - self.first, at, n
        if swept <= 0:
            return 1.0
        for at in range(max(0, -top), mask.height):
            filled += self.along(top + at, col + mask.left[at])
        for n in range(mask.runs.shape[0]):
            at = top + mask.runs[n, 0]
            if at >= 0:
                filled += self.along(at, col + mask.runs[n, 2])
                filled -= self.along(at, col + mask.runs[n, 1])
        at = max(0, top + mask.height)
        while at < self.words.shape[0] and at % BLOCK != 0:
            filled += self.along(at, col + mask.width) - self.along(at, col)
            at += 1
        at = (at + BLOCK - 1) // BLOCK
        filled += self.below[at, col + mask.width] - self.below[at, col]
        return <double> filled / <double> swept

    cdef int64_t beside(self, Swept mask, Py_ssize_t row, Py_ssize_t col) noexcept nogil:
        """Return the pixels between a mask and the next ones to its left."""
        cdef Py_ssize_t top = row - self.first, at
        cdef int64_t empty = 0
        for at in range(mask.height):
            empty += col + mask.left[at]
            if top + at >= 0:
                empty -= self.end(top + at, col + mask.left[at])
        return empty


cdef void add_block(
    const unsigned char[:, ::1] occupied,
    Py_ssize_t start,
    unsigned char[::1] sums,
    const int32_t[::1] under,
    int32_t[::1] out,
) noexcept nogil:
    """Fill in the pixels left of each column in a block of rows and what is under it."""
    cdef Py_ssize_t row, col, width = sums.shape[0]
    cdef int32_t left = 0
    cdef const unsigned char *pixels
    for col in range(width):
        sums[col] = 0
    for row in range(start, min(start + BLOCK, occupied.shape[0])):
        pixels = &occupied[row, 0]
        for col in range(width):
            sums[col] += pixels[col]
    for col in range(width):
        left += sums[col]
        out[col + 1] = under[col + 1] + left
