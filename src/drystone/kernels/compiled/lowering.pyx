# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.lowering`."""

from libc.stdint cimport int32_t, int64_t, uint64_t
from libc.stdlib cimport free, malloc, realloc
from libc.string cimport memcpy, memset

import numpy as np

ctypedef const unsigned char[:, ::1] Pixels


def skyline(Pixels occupied):
    """Return the row of the highest occupied pixel of each column."""
    cdef Py_ssize_t height = occupied.shape[0], width = occupied.shape[1]
    cdef Py_ssize_t row, col, stop, missing = width
    cdef uint64_t eight, eight_seen
    cdef unsigned char[::1] seen = np.zeros(width, np.uint8)
    tops = np.full(width, height, np.int32)
    cdef int32_t[::1] top = tops
    with nogil:
        for row in range(height):
            if missing == 0:
                break
            for col in range(0, width, 8):
                stop = min(width, col + 8)
                if stop == col + 8:
                    memcpy(&eight, &occupied[row, col], 8)
                    memcpy(&eight_seen, &seen[col], 8)
                    if eight & ~eight_seen == 0:
                        continue
                missing -= see(&occupied[row, 0], col, stop, <int32_t> row, &seen[0], &top[0])
    return tops


cdef Py_ssize_t see(
    const unsigned char *pixels,
    Py_ssize_t col,
    Py_ssize_t stop,
    int32_t row,
    unsigned char *seen,
    int32_t *top,
) noexcept nogil:
    """Note the pixels of a row that are the first of their columns; return how many they are."""
    cdef Py_ssize_t count = 0
    for col in range(col, stop):
        if pixels[col] and not seen[col]:
            seen[col] = 1
            top[col] = row
            count += 1
    return count


cdef void drop(
    const int32_t *top,
    const int32_t *bottom,
    Py_ssize_t cols,
    Py_ssize_t width,
    int32_t *rows,
) noexcept nogil:
    """Fill in the row at which a mask comes to rest for every column; negative above the image."""
    cdef Py_ssize_t col, at
    cdef int32_t under, row
    cdef const int32_t *tops
    for col in range(cols):
        rows[col] = top[col] - bottom[0] - 1
    for at in range(1, width):
        tops, under = top + at, bottom[at] + 1
        for col in range(cols):
            row = tops[col] - under
            rows[col] = row if row < rows[col] else rows[col]


cdef void narrow(
    const int32_t *top, Py_ssize_t width, int32_t height, Py_ssize_t clearance, int32_t *tops
) noexcept nogil:
    """Fill in the highest of the tops up to `clearance` columns away."""
    cdef Py_ssize_t col, at
    for col in range(width):
        tops[col] = height
        for at in range(max(0, col - clearance), min(width, col + clearance + 1)):
            tops[col] = min(tops[col], top[at])


cdef class Columns:
    """Columns chained by a row of each: the first one of a row, and the next one of the same."""

    def __cinit__(self, Py_ssize_t cols, Py_ssize_t count):
        self.cols, self.count = cols, count
        self.rows = <int32_t *> malloc((2 * cols + count) * sizeof(int32_t))
        if self.rows == NULL:
            raise MemoryError
        self.following = self.rows + cols
        self.heads = self.following + cols

    def __dealloc__(self):
        free(self.rows)

    cdef void chain(self) noexcept nogil:
        """Chain the columns, in order, of the rows that there are."""
        cdef Py_ssize_t col, row
        memset(self.heads, 255, self.count * sizeof(int32_t))
        for col in range(self.cols - 1, -1, -1):
            row = self.rows[col]
            if 0 <= row < self.count:
                self.following[col] = self.heads[row]
                self.heads[row] = <int32_t> col


cdef class Found:
    """Positions found so far."""

    def __dealloc__(self):
        free(self.at)

    cdef void add(self, Py_ssize_t row, Py_ssize_t col) noexcept nogil:
        cdef int64_t *at
        if self.count == self.room:
            at = <int64_t *> realloc(self.at, (2 * self.room + 512) * 2 * sizeof(int64_t))
            if at == NULL:
                self.lost = True
                return
            self.at, self.room = at, 2 * self.room + 512
        self.at[2 * self.count] = row
        self.at[2 * self.count + 1] = col
        self.count += 1

    cdef object positions(self):
        """Return an (n, 2) array of rows and columns."""
        if self.lost:
            raise MemoryError
        found = np.empty((self.count, 2), np.int64)
        cdef int64_t[:, ::1] out
        if self.count:
            out = found
            memcpy(&out[0, 0], self.at, self.count * 2 * sizeof(int64_t))
        return found


def lowered_positions(
    const int32_t[::1] top,
    const int32_t[::1] bottom,
    Py_ssize_t mask_height,
    Py_ssize_t height,
    Py_ssize_t clearance,
):
    """Return where a mask comes to rest that is lowered from above, by row, then column."""
    cdef Py_ssize_t width = top.shape[0], cols = width - bottom.shape[0] + 1
    cdef Py_ssize_t count = height - mask_height + 1, row, col
    if cols <= 0 or count <= 0:
        return np.empty((0, 2), np.int64)
    cdef Columns columns = Columns(cols, count), wider = Columns(width, 0)
    cdef Found found = Found()
    with nogil:
        drop(&top[0], &bottom[0], cols, bottom.shape[0], columns.rows)
        if clearance:
            narrow(&top[0], width, <int32_t> height, clearance, wider.following)
            drop(wider.following, &bottom[0], cols, bottom.shape[0], wider.rows)
            for col in range(cols):
                if wider.rows[col] < columns.rows[col] - mask_height:
                    columns.rows[col] = -1
        columns.chain()
        for row in range(count):
            col = columns.heads[row]
            while col >= 0:
                found.add(row, col)
                col = columns.following[col]
    return found.positions()
