# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.bits`.

Where nothing stands above a mask, it rests on what it comes to when it is lowered from above: the
least of some differences for every column.  The runs of the mask are tried only further down, in
words of 64 positions; there nearly all positions meet something, most of them at the first runs.
"""

from libc.stdint cimport uint64_t
from libc.string cimport memcpy, memset

from drystone.kernels.memory cimport (
    ints, kept, kept_ints, kept_longs, longs, longs_out, more_longs, release
)

import numpy as np

cdef extern from *:
    """
    #if defined(_MSC_VER)
    #include <intrin.h>
    static int lowest_bit(unsigned long long x) {
        unsigned long at; _BitScanForward64(&at, x); return (int) at;
    }
    #elif defined(__GNUC__)
    static int lowest_bit(unsigned long long x) { return __builtin_ctzll(x); }
    #else
    static int lowest_bit(unsigned long long x) {
        int at = 0; while (!(x >> at & 1)) at++; return at;
    }
    #endif
    """
    int lowest_bit(uint64_t x) nogil  # x is not 0

cdef uint64_t ALL = ~<uint64_t> 0

cdef enum:
    LEVELS = 7  # of dilations: by 1, 2 ... 64 pixels
    PIECE = 128  # the longest run that is two of the last


cdef class Columns:
    """Columns chained by a row of each: the first one of a row, and the next one of the same."""

    cdef int *rows
    cdef int *following
    cdef int *heads
    cdef Py_ssize_t cols, count

    def __cinit__(self, list room, Py_ssize_t cols, Py_ssize_t count):
        self.cols, self.count = cols, count
        self.rows, self.following = kept_ints(room, cols), kept_ints(room, cols)
        self.heads = kept_ints(room, count)

    cdef void drop(self, const int *top, const int *bottom, Py_ssize_t width) noexcept nogil:
        """Fill in the row at which a mask comes to rest; negative above the image."""
        cdef Py_ssize_t col, at
        cdef int under, row
        for col in range(self.cols):
            self.rows[col] = top[col] - bottom[0] - 1
        for at in range(1, width):
            under = bottom[at] + 1
            for col in range(self.cols):
                row = top[at + col] - under
                self.rows[col] = row if row < self.rows[col] else self.rows[col]

    cdef Py_ssize_t cover(self) noexcept nogil:
        """Chain the columns by the row from which on something stands above the mask.

        A mask that is lowered comes to rest two rows before; in between it meets something.  The
        row that is returned is the first at which something can happen.
        """
        cdef Py_ssize_t col, row, start = self.count
        memset(self.heads, 255, self.count * sizeof(int))
        for col in range(self.cols - 1, -1, -1):
            row = max(0, self.rows[col] + 2)
            start = min(start, row)
            if row < self.count:
                self.following[col] = self.heads[row]
                self.heads[row] = <int> col
        return max(0, start - 2)

    cdef void mark(self, uint64_t *line, Py_ssize_t row) noexcept nogil:
        """Set the bits of the columns that are chained to a row."""
        cdef Py_ssize_t col = self.heads[row]
        while col >= 0:
            line[col >> 6] |= <uint64_t> 1 << (col & 63)
            col = self.following[col]


cdef class Found:
    """Rows and columns of the positions found so far."""

    cdef long long *at
    cdef Py_ssize_t count, room

    def __dealloc__(self):
        release(self.at)

    cdef int add(self, Py_ssize_t row, Py_ssize_t col) except -1 nogil:
        if self.count == self.room:
            self.at = more_longs(self.at, 2 * (2 * self.room + 512))
            self.room = 2 * self.room + 512
        self.at[2 * self.count], self.at[2 * self.count + 1] = row, col
        self.count += 1
        return 0


cdef struct Run:
    # Some pixels in a row, twice the same power of 2: `near` and `far` are where their dilations
    # begin for the position in the first row and column that are stored.
    const uint64_t *near
    const uint64_t *far
    int near_bit
    int far_bit
    int row


cdef class Lines:
    """Rows of positions, a bit each, while a mask is tried row by row."""

    cdef Run *runs
    cdef uint64_t *covered  # something stands above
    cdef uint64_t *landing  # lowered from above, it comes to rest
    cdef uint64_t *above  # the row above: something is met, or nothing stands above
    cdef uint64_t *now  # the same of this row
    cdef Py_ssize_t words, count, longest, longest_row

    def __cinit__(self, list room, Py_ssize_t cols, Py_ssize_t runs):
        self.words = (cols + 63) // 64
        self.covered = <uint64_t *> kept_longs(room, 4 * self.words)
        self.landing = self.covered + self.words
        self.above = self.landing + self.words
        self.now = self.above + self.words
        self.runs = <Run *> kept(room, runs * sizeof(Run))

    cdef int take(self, Py_ssize_t row, bint full, bint full_below, Found found) except -1 nogil:
        """Add positions of the row above: the mask lands, or meets nothing but would below."""
        cdef Py_ssize_t word
        cdef uint64_t bits
        for word in range(self.words):
            bits = self.landing[word]
            if not full:
                bits |= ~self.above[word] & (ALL if full_below else self.now[word])
            while bits:
                found.add(row, 64 * word + lowest_bit(bits))
                bits &= bits - 1
        return 0


cdef class BitLandscape:
    """A landscape packed into words, with its dilations.

    The rows from `first` on are stored, each with an empty word at its end; the n-th table has a
    bit set where any of the 2**n pixels from there to the right is occupied.
    """

    cdef Py_ssize_t first, height, width, words, rows
    cdef const int *top
    cdef const int *gaps  # the longest run of free pixels of each row
    cdef const uint64_t *tables
    cdef tuple kept

    def __init__(self, occupied, top):
        self.height, self.width = occupied.shape
        self.first = top.min()
        self.words, self.rows = (self.width + 63) // 64 + 1, self.height - self.first
        built, columns = occupied[self.first :], np.arange(1, self.width + 1, dtype=np.int32)
        gaps = (columns - np.maximum.accumulate(built * columns, axis=1)).max(axis=1)
        packed = np.packbits(built, axis=1, bitorder="little")
        octets = np.zeros((self.rows, 8 * self.words), np.uint8)
        octets[:, : packed.shape[1]] = packed
        tables = np.zeros((LEVELS, max(1, self.rows), self.words), np.uint64)
        tables[0, : self.rows] = octets.view("<u8")
        for level in range(1, LEVELS):
            step, last = 1 << (level - 1), tables[level - 1]
            tables[level] = last | last >> step
            tables[level, :, :-1] |= last[:, 1:] << (64 - step)
        signed = tables.view(np.int64)
        self.kept = (top, gaps, signed)
        self.top, self.gaps, self.tables = ints(top), ints(gaps), <uint64_t *> longs(signed)

    def resting(self, mask):
        """Return all positions of a mask where it rests, by row, then column."""
        cdef Py_ssize_t width = mask.width, count = len(mask.runs), start
        cdef Py_ssize_t cols = self.width - width + 1
        cdef Py_ssize_t rows = self.height - <Py_ssize_t> mask.height + 1
        if cols <= 0 or rows <= 0:
            return np.empty((0, 2), np.int64)
        cdef const int *bottom = ints(mask.bottom)
        cdef const int *runs = ints(mask.runs)
        cdef list room = []
        cdef Columns columns = Columns(room, cols, rows + 2)
        cdef Lines lines = Lines(room, cols, count * ((width + PIECE - 1) // PIECE))
        cdef Found found = Found()
        with nogil:
            self.prepare(runs, count, lines)
            columns.drop(self.top, bottom, width)
            start = columns.cover()
            self.scan(start, rows, columns, lines, found)
        positions = np.empty((found.count, 2), np.int64)
        memcpy(longs_out(positions), found.at, found.count * 2 * sizeof(long long))
        return positions

    cdef void prepare(self, const int *runs, Py_ssize_t count, Lines lines) noexcept nogil:
        """Cut the runs into pieces, and look up where the dilations of each begin."""
        cdef Py_ssize_t n, row, start, length, piece
        for n in range(0, 3 * count, 3):
            row, start, length = runs[n], runs[n + 1], runs[n + 2]
            if length > lines.longest:
                lines.longest, lines.longest_row = length, row
            while length > 0:
                piece = min(length, PIECE)
                self.add_piece(lines, row, start, piece)
                start += piece
                length -= piece

    cdef void add_piece(
        self, Lines lines, Py_ssize_t row, Py_ssize_t start, Py_ssize_t length
    ) noexcept nogil:
        cdef Py_ssize_t level = 0, far
        cdef Run *run = &lines.runs[lines.count]
        cdef const uint64_t *table
        while 2 << level <= length and level + 1 < LEVELS:
            level += 1
        table = self.tables + (level * self.rows + row) * self.words
        far = start + length - ((<Py_ssize_t> 1) << level)
        run.row = <int> row
        run.near, run.near_bit = table + (start >> 6), start & 63
        run.far, run.far_bit = table + (far >> 6), far & 63
        lines.count += 1

    cdef int scan(
        self, Py_ssize_t start, Py_ssize_t rows, Columns columns, Lines lines, Found found
    ) except -1 nogil:
        """Find the positions, row by row from the first at which something can happen."""
        cdef Py_ssize_t row
        cdef bint full, full_above = True
        for row in range(start, rows + 1):
            full = True
            if row < rows:
                columns.mark(lines.covered, row)
                if self.has_room(lines, row + lines.longest_row):
                    full = self.meets_everywhere(lines, row)
            if row > start and not (full_above and columns.heads[row + 1] < 0):
                memset(lines.landing, 0, lines.words * sizeof(uint64_t))
                columns.mark(lines.landing, row + 1)
                lines.take(row - 1, full_above, full, found)
            lines.above, lines.now = lines.now, lines.above
            full_above = full
        return 0

    cdef bint has_room(self, Lines lines, Py_ssize_t row) noexcept nogil:
        """Say whether the longest run of the mask fits into a row somewhere."""
        return row < self.first or self.gaps[row - self.first] >= lines.longest

    cdef bint meets_everywhere(self, Lines lines, Py_ssize_t row) noexcept nogil:
        """Fill in where in a row something is met, or nothing stands above; say if everywhere."""
        cdef Py_ssize_t word, n, at
        cdef uint64_t bits, left = 0
        cdef const Run *run
        for word in range(lines.words):
            bits = ~lines.covered[word]
            at = (row - self.first) * self.words + word
            for n in range(lines.count):
                run = &lines.runs[n]
                # Runs come from the lowest row up: the others are above all that is there.
                if bits == ALL or row + run.row < self.first:
                    break
                bits |= run.near[at] >> run.near_bit
                bits |= run.near[at + 1] << 1 << (63 - run.near_bit)
                bits |= run.far[at] >> run.far_bit
                bits |= run.far[at + 1] << 1 << (63 - run.far_bit)
            lines.now[word] = bits
            left |= ~bits
        return left == 0
