# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.bits`.

Where nothing stands above a mask, it rests on what it comes to when it is lowered from above: the
least of some differences for every column.  The runs of the mask are tried only further down, in
words of 64 positions; there nearly all positions meet something, most of them at the first runs.
"""

from libc.stdint cimport int32_t, uint64_t
from libc.stdlib cimport free, malloc
from libc.string cimport memset

import numpy as np

from drystone.kernels.compiled.lowering cimport Columns, Found, drop
from drystone.kernels.compiled.words cimport lowest_bit, pack

cdef uint64_t ALL = ~<uint64_t> 0

cdef enum:
    LEVELS = 7  # of dilations: by 1, 2 ... 64 pixels
    PIECE = 128  # the longest run that is two of the last


cdef void spread(
    const uint64_t *row, Py_ssize_t words, Py_ssize_t step, uint64_t *out
) noexcept nogil:
    """Set each bit that is set in a row of words, or `step` bits further on."""
    cdef Py_ssize_t at, far = step >> 6
    cdef int bit = step & 63
    for at in range(words - far - 1):
        out[at] = row[at] | row[at + far] >> bit | row[at + far + 1] << 1 << (63 - bit)
    for at in range(max(0, words - far - 1), words):
        out[at] = row[at] | (row[at + far] >> bit if at + far < words else 0)


cdef int32_t longest_gap(const uint64_t *row, Py_ssize_t width) noexcept nogil:
    """Return how many bits there are in the longest run of zeros."""
    cdef Py_ssize_t word, at, size, run = 0, longest = 0
    cdef uint64_t bits
    for word in range((width + 63) >> 6):
        bits, at, size = row[word], 0, min(64, width - 64 * word)
        while bits:
            run += lowest_bit(bits)
            longest = max(longest, run)
            at += lowest_bit(bits)
            bits >>= lowest_bit(bits)
            run = 0
            if bits == ALL:
                at = 64
                break
            at += lowest_bit(~bits)
            bits >>= lowest_bit(~bits)
        run += max(0, size - at)
        longest = max(longest, run)
    return <int32_t> longest


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

    def __cinit__(self, Py_ssize_t cols, Py_ssize_t room):
        self.words = (cols + 63) // 64
        self.covered = <uint64_t *> malloc(
            4 * self.words * sizeof(uint64_t) + room * sizeof(Run)
        )
        if self.covered == NULL:
            raise MemoryError
        self.landing = self.covered + self.words
        self.above = self.landing + self.words
        self.now = self.above + self.words
        self.runs = <Run *> (self.now + self.words)
        memset(self.covered, 0, self.words * sizeof(uint64_t))

    def __dealloc__(self):
        free(self.covered)

    cdef void take(self, Py_ssize_t row, bint full, bint full_below, Found found) noexcept nogil:
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


cdef void mark(uint64_t *line, Columns columns, Py_ssize_t row) noexcept nogil:
    """Set the bits of the columns that are chained to a row."""
    cdef Py_ssize_t col = columns.heads[row]
    while col >= 0:
        line[col >> 6] |= <uint64_t> 1 << (col & 63)
        col = columns.following[col]


cdef class BitLandscape:
    """A landscape packed into words, with its dilations.

    The rows from `first` on are stored, each with an empty word at its end; the n-th table has a
    bit set where any of the 2**n pixels from there to the right is occupied.
    """

    cdef Py_ssize_t first, height, width, words
    cdef const int32_t[::1] top
    cdef uint64_t[:, :, ::1] tables
    cdef int32_t[::1] gaps

    def __init__(self, const unsigned char[:, ::1] occupied, const int32_t[::1] top):
        cdef Py_ssize_t row, level, rows
        self.height, self.width, self.top = occupied.shape[0], occupied.shape[1], top
        self.first = self.height
        for row in range(self.width):
            self.first = min(self.first, top[row])
        self.words = (self.width + 63) // 64 + 1
        rows = self.height - self.first
        self.tables = np.zeros((LEVELS, max(1, rows), self.words), np.uint64)
        self.gaps = np.empty(rows, np.int32)
        with nogil:
            for row in range(rows):
                pack(&occupied[self.first + row, 0], self.width, &self.tables[0, row, 0], NULL)
                self.gaps[row] = longest_gap(&self.tables[0, row, 0], self.width)
                for level in range(1, LEVELS):
                    spread(
                        &self.tables[level - 1, row, 0],
                        self.words,
                        (<Py_ssize_t> 1) << (level - 1),
                        &self.tables[level, row, 0],
                    )

    def resting(self, mask):
        """Return all positions of a mask where it rests, by row, then column."""
        cdef const int32_t[:, ::1] runs = mask.runs
        cdef const int32_t[::1] bottom = mask.bottom
        cdef Py_ssize_t cols = self.width - bottom.shape[0] + 1
        cdef Py_ssize_t rows = self.height - <Py_ssize_t> mask.height + 1, start
        if cols <= 0 or rows <= 0:
            return np.empty((0, 2), np.int64)
        cdef Columns columns = Columns(cols, rows + 2)
        cdef Lines lines = Lines(cols, runs.shape[0] * ((bottom.shape[0] + PIECE - 1) // PIECE))
        cdef Found found = Found()
        with nogil:
            self.prepare(runs, lines)
            drop(&self.top[0], &bottom[0], cols, bottom.shape[0], columns.rows)
            start = cover(columns)
            self.scan(start, rows, columns, lines, found)
        return found.positions()

    cdef void prepare(self, const int32_t[:, ::1] runs, Lines lines) noexcept nogil:
        """Cut the runs into pieces, and look up where the dilations of each begin."""
        cdef Py_ssize_t n, start, length, piece
        for n in range(runs.shape[0]):
            start, length = runs[n, 1], runs[n, 2]
            if length > lines.longest:
                lines.longest, lines.longest_row = length, runs[n, 0]
            while length > 0:
                piece = min(length, PIECE)
                self.add_piece(lines, runs[n, 0], start, piece)
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
        table = &self.tables[level, 0, 0] + row * self.words
        far = start + length - ((<Py_ssize_t> 1) << level)
        run.row = <int> row
        run.near, run.near_bit = table + (start >> 6), start & 63
        run.far, run.far_bit = table + (far >> 6), far & 63
        lines.count += 1

    cdef void scan(
        self, Py_ssize_t start, Py_ssize_t rows, Columns columns, Lines lines, Found found
    ) noexcept nogil:
        """Find the positions, row by row from the first at which something can happen."""
        cdef Py_ssize_t row
        cdef bint full, full_above = True
        for row in range(start, rows + 1):
            full = True
            if row < rows:
                mark(lines.covered, columns, row)
                if self.has_room(lines, row + lines.longest_row):
                    full = self.meets_everywhere(lines, row)
            if row > start and not (full_above and columns.heads[row + 1] < 0):
                memset(lines.landing, 0, lines.words * sizeof(uint64_t))
                mark(lines.landing, columns, row + 1)
                lines.take(row - 1, full_above, full, found)
            lines.above, lines.now = lines.now, lines.above
            full_above = full

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


cdef Py_ssize_t cover(Columns columns) noexcept nogil:
    """Chain the columns by the row from which on something stands above the mask.

    A mask that is lowered comes to rest two rows before; in between it meets something.  The row
    that is returned is the first at which something can happen.
    """
    cdef Py_ssize_t col, start = columns.count
    for col in range(columns.cols):
        columns.rows[col] = max(0, columns.rows[col] + 2)
        start = min(start, columns.rows[col])
    columns.chain()
    return max(0, start - 2)
