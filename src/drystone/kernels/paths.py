"""Shortest ways through the open pixels of an image, from one end of a row to its other end.

Steps go to any of the 8 neighbours and are 1 or sqrt 2 long.  Lengths are whole numbers here:
:data:`STRAIGHT` and :data:`DIAGONAL` a step, whose ratio is a convergent of sqrt 2.  That is exact.
Let a way have m straight steps more than another and n diagonal ones less: which of them is the
longer one depends on whether m / n is above sqrt 2 or below.  No fraction with a denominator below
STRAIGHT lies between sqrt 2 and DIAGONAL / STRAIGHT, or is equal to either, so whole numbers order
ways of less than 38 million diagonal steps as the true lengths do, and ways of one length have
equal numbers of steps of both kinds.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from drystone.kernels.backend import compiled
from drystone.kernels.raster import Mask

STRAIGHT, DIAGONAL = 38_613_965, 54_608_393
"""Length of a step along a row or column, and of one across a corner."""

_STEPS = ((0, 1), (-1, 1), (1, 1), (-1, 0), (1, 0), (-1, -1), (1, -1), (0, -1))
"""Down and right.  Ways are followed back by the first step of this order that fits."""

_COSTS = tuple(DIAGONAL if down and right else STRAIGHT for down, right in _STEPS)
_ASIDE = DIAGONAL - STRAIGHT
_INVERSE = pow(DIAGONAL, -1, STRAIGHT)
_CLOSED, _FAR = -1, 2**62
_NO_NODE = -1

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
"""What each step adds to :func:`_least` from cells above the row, on it and below it."""

_fast = compiled("paths")


def row_lengths(open_px: Mask, rows: NDArray[np.intp]) -> NDArray[np.int64]:
    """Return the length of the shortest way along each of some rows.

    Parameters
    ----------
    open_px : (h, w) bool array
        Pixels that ways may use.
    rows : (n,) int array
        Ways lead from the first pixel of a row to its last.  Less than 2^62 over 109 million times
        the open pixels: some two hundred in the largest images that are read.

    Returns
    -------
    lengths : (n,) int array
        In units of which a straight step has :data:`STRAIGHT`; -1 where there is no way.

    Examples
    --------
    >>> lengths = row_lengths(np.array([[1, 1, 1], [1, 0, 1]], bool), np.array([0, 1]))
    >>> [step_counts(length) for length in lengths.tolist()]
    [(2, 0), (0, 2)]
    """
    if _fast is None:
        return row_lengths_numpy(open_px, rows)
    return _searched(open_px, rows)[0]


def row_lengths_numpy(open_px: Mask, rows: NDArray[np.intp]) -> NDArray[np.int64]:
    """Twin of :func:`row_lengths`."""
    graph = _Graph(open_px)
    return np.array([graph.lengths(row)[row, -1] for row in rows.tolist()], np.int64)


def row_ways(open_px: Mask, rows: NDArray[np.intp]) -> list[NDArray[np.intp] | None]:
    """Return the pixels of the shortest way along each of some rows.

    Parameters
    ----------
    open_px : (h, w) bool array
        Pixels that ways may use.
    rows : (n,) int array
        Ways lead from the first pixel of a row to its last.

    Returns
    -------
    ways : list of (k, 2) int arrays or None
        Row and column of their pixels; None where there is no way.  Of ways of one length,
        followed back from the end, the one that goes left while it can, rather down and left than
        up and left, then down, up, right.

    Examples
    --------
    >>> [way.tolist() for way in row_ways(np.array([[1, 1, 1], [1, 0, 1]], bool), np.array([1]))]
    [[[1, 0], [0, 1], [1, 2]]]
    """
    if _fast is None:
        return row_ways_numpy(open_px, rows)
    return [_followed_back(_searched_lengths(open_px, row), row) for row in rows.tolist()]


def row_ways_numpy(open_px: Mask, rows: NDArray[np.intp]) -> list[NDArray[np.intp] | None]:
    """Twin of :func:`row_ways`."""
    graph = _Graph(open_px)
    return [_followed_back(graph.lengths(row), row) for row in rows.tolist()]


def step_counts(length: int) -> tuple[int, int]:
    """Return how many straight and how many diagonal steps make a length.

    Examples
    --------
    >>> step_counts(3 * STRAIGHT + 5 * DIAGONAL)
    (3, 5)
    """
    diagonal = length * _INVERSE % STRAIGHT
    return (length - diagonal * DIAGONAL) // STRAIGHT, diagonal


def _searched(open_px: Mask, rows: NDArray[np.intp]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Search along rows, one after the other, in one array of keys.

    The key of a cell is how much longer than :func:`_least` the shortest way through it is, as far
    as known.  Nothing is reset between rows: each row's keys begin so much lower than those of the
    row before that older keys are as good as none.

    Returns
    -------
    lengths : (n,) int array
        As of :func:`row_lengths`.
    keys : (h, w) int array
        Of the cells that the last row's search has met, beginning at 0; final on shortest ways.
    """
    height, width = open_px.shape
    cells = np.full((height + 2, width + 2), _CLOSED, np.int64)
    cells[1:-1, 1:-1][open_px] = _FAR
    # No way steps on a pixel twice.
    span = int(_DETOURS.max()) * (np.count_nonzero(open_px) + 1)
    firsts = span * np.arange(len(rows) - 1, -1, -1, dtype=np.int64)
    steps = np.array([down * cells.shape[1] + right for down, right in _STEPS], np.int64)
    found = np.empty(len(rows), np.int64)
    assert _fast is not None  # noqa: S101 - the callers look
    _fast.search_rows(cells, np.asarray(rows, np.int64), firsts, steps, _DETOURS, found)
    ways = (found >= firsts) & (found < firsts + span)
    lengths = np.where(ways, found - firsts + STRAIGHT * (width - 1), _CLOSED)
    return lengths, cells[1:-1, 1:-1]


def _searched_lengths(open_px: Mask, row: int) -> NDArray[np.int64]:
    """Return how far from the first pixel of a row others are; -1: not known, or no way."""
    _, keys = _searched(open_px, np.array([row]))
    ahead = _least(open_px.shape[0], open_px.shape[1], row)
    reached = (keys != _CLOSED) & (keys < _FAR)
    return np.where(reached, keys - ahead + ahead[row, 0], _CLOSED)


def _least(height: int, width: int, row: int) -> NDArray[np.int64]:
    """Return what is left to go from each cell to the end of a row, if not more.

    A straight step for every column, and for every row on the way back to the row what a diagonal
    step is longer.
    """
    columns = STRAIGHT * np.arange(width - 1, -1, -1, dtype=np.int64)
    aside = _ASIDE * np.abs(np.arange(height, dtype=np.int64) - row)
    return np.asarray(aside[:, None] + columns)


def _followed_back(lengths: NDArray[np.int64], row: int) -> NDArray[np.intp] | None:
    """Return the way along a row, given how far from its first pixel others are (-1: unknown).

    A cell whose length is right is on a shortest way to the next one; all such cells are known.
    """
    height, width = lengths.shape
    if lengths[row, -1] == _CLOSED:
        return None
    way = [(row, width - 1)]
    while way[-1] != (row, 0):
        here = way[-1]
        before = (
            ((here[0] - down, here[1] - right), lengths[here] - cost)
            for cost, (down, right) in zip(_COSTS, _STEPS, strict=True)
            if 0 <= here[0] - down < height and 0 <= here[1] - right < width
        )
        way.append(next(cell for cell, length in before if lengths[cell] == length))
    return np.array(way[::-1], np.intp)


class _Graph:
    """Open pixels and the steps between them, for SciPy; sums of steps are exact in floats."""

    def __init__(self, open_px: Mask) -> None:
        height, width = open_px.shape
        count = int(np.count_nonzero(open_px))
        self._node = np.full(open_px.shape, _NO_NODE, np.int32)
        self._node[open_px] = np.arange(count)
        starts, ends, costs = [], [], []
        for cost, (down, right) in zip(_COSTS, _STEPS, strict=True):
            here = self._node[max(0, -down) : height - max(0, down), max(0, -right) :]
            there = self._node[max(0, down) : height - max(0, -down), max(0, right) :]
            here, there = here[:, : width - abs(right)], there[:, : width - abs(right)]
            both = (here != _NO_NODE) & (there != _NO_NODE)
            starts.append(here[both])
            ends.append(there[both])
            costs.append(np.full(np.count_nonzero(both), float(cost)))
        steps = (np.concatenate(starts), np.concatenate(ends))
        self._steps = csr_array((np.concatenate(costs), steps), shape=(count, count))

    def lengths(self, row: int) -> NDArray[np.int64]:
        """Return how far from the first pixel of a row all pixels are; -1 where no way leads."""
        found = np.full(self._node.shape, _CLOSED, np.int64)
        start = self._node[row, 0]
        if start != _NO_NODE:
            reached = dijkstra(self._steps, indices=start)
            reached[np.isinf(reached)] = _CLOSED
            found[self._node != _NO_NODE] = reached
        return found
