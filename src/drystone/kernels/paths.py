"""Shortest ways through the open pixels of an image, from one end of a row to its other end.

Steps go to any of the 8 neighbours and are 1 or sqrt 2 long.  Lengths are whole numbers here:
:data:`STRAIGHT` and :data:`DIAGONAL` a step, whose ratio is a convergent of sqrt 2.  That is exact.
Let a way have m straight steps more than another and n diagonal ones less: which of them is the
longer one depends on whether m / n is above sqrt 2 or below.  No fraction with a denominator below
STRAIGHT lies between sqrt 2 and DIAGONAL / STRAIGHT, or is equal to either, so whole numbers order
ways of less than 38 million diagonal steps as the true lengths do, and ways of one length have
equal numbers of steps of both kinds.

Cells wait in buckets and are looked at from the lowest bucket on, in any order within one.  A
bucket is narrower than any detour but 0, so few cells are looked at twice, which is not wrong: a
cell is put in again whenever its key becomes smaller.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import longs, longs_out, more_longs, new_longs, release

STRAIGHT, DIAGONAL = 38_613_965, 54_608_393
"""Length of a step along a row or column, and of one across a corner."""

_STEPS = ((0, 1), (-1, 1), (1, 1), (-1, 0), (1, 0), (-1, -1), (1, -1), (0, -1))
"""Down and right.  Ways are followed back by the first step of this order that fits."""

_COSTS = tuple(DIAGONAL if down and right else STRAIGHT for down, right in _STEPS)
_ASIDE = DIAGONAL - STRAIGHT
_INVERSE = pow(DIAGONAL, -1, STRAIGHT)
_CLOSED, _FAR = -1, 2**62

STEPS = cython.declare(cython.int, 8)
WIDTH_BITS = cython.declare(cython.int, 24)

# More than the greatest detour is wide, and a power of two.
BUCKETS = cython.declare(cython.int, 8)

_DETOURS = np.array(
    [
        [
            cost - STRAIGHT * right + _ASIDE * (abs(side + down) - abs(side))
            for cost, (down, right) in zip(_COSTS, _STEPS, strict=True)
        ]
        for side in (-1, 0, 1)
    ],
    np.int64,
)
"""What each step adds to the keys of :func:`_searched` above the row, on it and below it."""


def row_lengths(open_px: Mask, rows: NDArray[np.intp]) -> NDArray[np.int64]:
    """Return the length of the shortest way from the first pixel of each row to its last.

    In units of which a straight step has :data:`STRAIGHT`; -1 where there is no way.  Rows are less
    than 2^62 over 109 million times the open pixels: some two hundred in the largest images that
    are read.
    """
    return _searched(open_px, rows)[0]


def row_ways(open_px: Mask, rows: NDArray[np.intp]) -> list[NDArray[np.intp] | None]:
    """Return the pixels (k, 2) of the shortest way along each row; None where there is no way.

    Of ways of one length, followed back from the end, it is the one that goes left while it can,
    rather down and left than up and left, then down, up, right.
    """
    return [_followed_back(_searched_lengths(open_px, row), row) for row in rows.tolist()]


def step_counts(length: int) -> tuple[int, int]:
    """Return how many straight and how many diagonal steps make a length."""
    diagonal = length * _INVERSE % STRAIGHT
    return (length - diagonal * DIAGONAL) // STRAIGHT, diagonal


def _searched(open_px: Mask, rows: NDArray[np.intp]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Search along rows, one after the other, in one array of keys; return lengths and keys.

    The key of a cell is by how much, as far as known, the shortest way through it is longer than
    the row at least: what is left to go takes a straight step for every column, and for every row
    on the way back what a diagonal step is longer.  Nothing is reset between rows: each row's keys
    begin so much lower than those of the row before that older keys are as good as none.  The last
    row's begin at 0; they are final on shortest ways.
    """
    height, width = open_px.shape
    cells = np.full((height + 2, width + 2), _CLOSED, np.int64)
    cells[1:-1, 1:-1][open_px] = _FAR
    # No way steps on a pixel twice.
    span = int(_DETOURS.max()) * (np.count_nonzero(open_px) + 1)
    firsts = span * np.arange(len(rows) - 1, -1, -1, dtype=np.int64)
    steps = np.array([down * cells.shape[1] + right for down, right in _STEPS], np.int64)
    found = np.empty(len(rows), np.int64)
    _search_rows(cells, np.asarray(rows, np.int64), firsts, steps, found)
    ways = (found >= firsts) & (found < firsts + span)
    lengths = np.where(ways, found - firsts + STRAIGHT * (width - 1), _CLOSED)
    return lengths, cells[1:-1, 1:-1]


def _searched_lengths(open_px: Mask, row: int) -> NDArray[np.int64]:
    """Return how far from the first pixel of a row others are; -1: not known, or no way."""
    _, keys = _searched(open_px, np.array([row]))
    height, width = open_px.shape
    aside = _ASIDE * np.abs(np.arange(height, dtype=np.int64) - row)[:, None]
    reached = (keys != _CLOSED) & (keys < _FAR)
    return np.where(reached, keys + STRAIGHT * np.arange(width) - aside, _CLOSED)


def _followed_back(lengths: NDArray[np.int64], row: int) -> NDArray[np.intp] | None:
    """Return the way along a row, given how far from its first pixel others are (-1: unknown).

    A cell whose length is right is on a shortest way to the next one; all such cells are known.
    """
    height, width = lengths.shape
    here = row, width - 1
    if lengths[here] == _CLOSED:
        return None
    way = [here]
    while here != (row, 0):
        before = (
            ((here[0] - down, here[1] - right), lengths[here] - cost)
            for cost, (down, right) in zip(_COSTS, _STEPS, strict=True)
            if 0 <= here[0] - down < height and 0 <= here[1] - right < width
        )
        here = next(cell for cell, length in before if lengths[cell] == length)
        way.append(here)
    return np.array(way[::-1], np.intp)


@cython.cclass
class Queue:
    """Cells that wait, three numbers each: cell, key and which is next in its bucket."""

    def __init__(self) -> None:
        self.room = 1024
        self.entries = new_longs(3 * self.room)
        self.heads = new_longs(BUCKETS)

    def __dealloc__(self) -> None:
        release(self.entries)
        release(self.heads)


def _search_rows(cells, rows, firsts, steps, found):
    """Search along rows; the keys of their last cells go into `found`.

    Cells (h + 2, w + 2) are keys: -1 for closed cells, among them a rim of one, else above all that
    will be written.  Rows are counted without the rim, and begin with the keys `firsts`, which fall
    from row to row.  `steps` (8,) is what each step adds to the place of a cell.
    """
    queue: Queue = Queue()
    keys: cython.p_longlong = longs_out(cells)
    row: cython.p_longlong = longs(rows)
    first: cython.p_longlong = longs(firsts)
    ways: cython.p_longlong = longs(steps)
    detours: cython.p_longlong = longs(_DETOURS)
    last: cython.p_longlong = longs_out(found)
    count: cython.Py_ssize_t = len(rows)
    stride: cython.Py_ssize_t = cells.shape[1]
    with cython.nogil:
        for k in range(count):
            start: cython.Py_ssize_t = (row[k] + 1) * stride + 1
            end: cython.Py_ssize_t = start + stride - 3
            _search_row(queue, keys, start, end, first[k], ways, detours)
            last[k] = keys[end]
    return 0


def _search_row(queue, cells, row_start, row_end, first, steps, detours):
    """Make the keys of all cells final whose key is not above the end's."""
    number: cython.longlong = first >> WIDTH_BITS
    empty: cython.int = 0
    if cells[row_start] < 0 or cells[row_end] < 0:
        return 0
    for i in range(BUCKETS):
        queue.heads[i] = -1
    queue.used, queue.free = 0, -1
    cells[row_start] = first
    _put(queue, row_start, first)
    while empty < BUCKETS and number <= cells[row_end] >> WIDTH_BITS:
        bucket = number & (BUCKETS - 1)
        empty = empty + 1 if queue.heads[bucket] < 0 else 0
        while queue.heads[bucket] >= 0:
            at: cython.Py_ssize_t = queue.heads[bucket]
            here: cython.Py_ssize_t = queue.entries[at]
            key = queue.entries[at + 1]
            queue.heads[bucket] = queue.entries[at + 2]
            queue.entries[at + 2], queue.free = queue.free, at
            if cells[here] != key:
                continue  # its key has become smaller since
            side = 0
            if here >= row_start:
                side = 2 * STEPS if here > row_end else STEPS
            for i in range(STEPS):
                there: cython.Py_ssize_t = here + steps[i]
                new = key + detours[side + i]
                if new < cells[there]:
                    cells[there] = new
                    _put(queue, there, new)
        number += 1
    return 0


def _put(queue, cell, key):
    """Put a cell into the bucket of its key."""
    at: cython.Py_ssize_t = queue.free
    bucket = (key >> WIDTH_BITS) & (BUCKETS - 1)
    if at >= 0:
        queue.free = queue.entries[at + 2]
    else:
        at = 3 * queue.used
        queue.used += 1
        if queue.used > queue.room:
            queue.room *= 2
            queue.entries = more_longs(queue.entries, 3 * queue.room)
    queue.entries[at], queue.entries[at + 1] = cell, key
    queue.entries[at + 2], queue.heads[bucket] = queue.heads[bucket], at
    return 0
