"""Boundary between labelled regions of an image, as chains of unit pixel edges (§4.2).

Nodes are pixel corners (row, col) of the array handed in: node (r, c) is the top-left corner of
cell (r, c).  Everything is directed so that the larger of the two labels lies to the left.
"""

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask

Cells = NDArray[np.int64]
Nodes = NDArray[np.int64]

EMPTY = -1
"""Label of nothing; labels that bound something are >= 0."""

_STEP = np.array([[0, 1], [-1, 0], [0, -1], [1, 0]])
"""(row, col) of a step to the right, up, to the left, down."""


@dataclass(frozen=True, eq=False)
class Chain:
    """A connected chain of pixel edges between two regions.

    Parameters
    ----------
    high, low : int
        The two labels; `high` is the larger and lies to the left of the chain.
    nodes : (n + 1, 2) int array
        Pixel corners (row, col) along the chain; first and last are equal in a closed one.
    """

    high: int
    low: int
    nodes: Nodes


def touching_edges(cells: Cells, fresh: Mask) -> NDArray[np.int64]:
    """Find the pixel edges between two labels of which one is fresh.

    Parameters
    ----------
    cells : (h, w) int array
        Labels; EMPTY where nothing is.
    fresh : (h, w) bool array
        Only edges with at least one of their two cells in here are returned.

    Returns
    -------
    (n, 5) int array
        high, low, row and col of the start node, heading: 0 to the right, 1 up, 2 to the left,
        3 down.

    Examples
    --------
    >>> cells = np.array([[5], [3]])
    >>> touching_edges(cells, cells > 0).tolist()
    [[5, 3, 1, 0, 0]]
    """
    parts = []
    # Horizontal edges lie between a cell and the one below, vertical ones beside each other.
    for first, second, new, horizontal in (
        (cells[:-1], cells[1:], fresh[:-1] | fresh[1:], True),
        (cells[:, :-1], cells[:, 1:], fresh[:, :-1] | fresh[:, 1:], False),
    ):
        row, col = np.nonzero(new & (first != second) & (np.minimum(first, second) > EMPTY))
        a, b = first[row, col], second[row, col]
        forward = a > b
        if horizontal:  # to the right along the top of `second` when it is the lower label
            start_row, start_col = row + 1, np.where(forward, col, col + 1)
            heading = np.where(forward, 0, 2)
        else:
            start_row, start_col = np.where(forward, row + 1, row), col + 1
            heading = np.where(forward, 1, 3)
        parts.append((np.maximum(a, b), np.minimum(a, b), start_row, start_col, heading))
    return np.concatenate([np.column_stack(part) for part in parts])


def trace_chains(edges: NDArray[np.int64]) -> list[Chain]:
    """Join pixel edges of the same two labels into chains.

    Where four edges of one pair meet (the pixels cross like a chequerboard) a chain turns left,
    around its own pixel of the higher label.  A closed chain starts at the lowest of its
    leftmost corners.  The order of the result does not depend on the order of the edges.

    Parameters
    ----------
    edges : (n, 5) int array
        From :func:`touching_edges`.

    Returns
    -------
    list of Chain
        Sorted by labels, then by start: from the bottom up and from left to right.
    """
    starts: dict[tuple[int, int, int, int], dict[int, int]] = defaultdict(dict)
    rows: list[list[int]] = edges.tolist()
    for index, (high, low, row, col, heading) in enumerate(rows):
        starts[high, low, row, col][heading] = index
    following: list[int] = []
    ends = (edges[:, 2:4] + _STEP[edges[:, 4]]).tolist() if len(edges) else []
    for (high, low, _, _, heading), (row, col) in zip(rows, ends, strict=True):
        leaving = starts.get((high, low, row, col), {})
        left = leaving.get((heading + 1) % 4)
        following.append(next(iter(leaving.values()), -1) if left is None else left)
    chains = []
    for sequence in _sequences(following):
        members = sequence
        if following[sequence[-1]] == sequence[0]:
            # A closed chain may begin anywhere: leftmost, then lowest.
            place = [(rows[i][3], -rows[i][2]) for i in sequence]
            first = place.index(min(place))
            members = sequence[first:] + sequence[:first]
        high, low = rows[members[0]][:2]
        nodes = [*(rows[i][2:4] for i in members), ends[members[-1]]]
        chains.append(Chain(high, low, np.array(nodes)))
    chains.sort(key=lambda chain: (chain.high, chain.low, -chain.nodes[0, 0], chain.nodes[0, 1]))
    return chains


def _sequences(following: list[int]) -> list[list[int]]:
    """Order a successor list (-1 ends a sequence) into open sequences, then closed ones."""
    has_predecessor = set(following)
    open_starts = [i for i in range(len(following)) if i not in has_predecessor]
    seen = [False] * len(following)
    sequences = []
    for start in (*open_starts, *range(len(following))):
        if seen[start]:
            continue
        sequence = []
        at = start
        while at >= 0 and not seen[at]:
            seen[at] = True
            sequence.append(at)
            at = following[at]
        sequences.append(sequence)
    return sequences


def split_at_corners(points: NDArray[np.float64], tolerance: float) -> list[int]:
    """Cut a polyline at its corners (Douglas and Peucker 1973).

    Parameters
    ----------
    points : (n, 2) float array
        At least two points; a closed line repeats the first one at the end.
    tolerance : float
        A piece is straight when no point is further from its chord, same unit as `points`.

    Returns
    -------
    list of int
        Indices of the points where pieces meet, with 0 and n - 1.

    Examples
    --------
    >>> split_at_corners(np.array([[0.0, 0], [0, 1], [0, 5], [4, 5]]), 1.5)
    [0, 2, 3]
    """
    cuts = {0, len(points) - 1}
    pieces = [(0, len(points) - 1)]
    while pieces:
        first, last = pieces.pop()
        if last - first < 2:
            continue
        chord = points[last] - points[first]
        inner = points[first + 1 : last] - points[first]
        length = float(np.hypot(chord[0], chord[1]))
        if length > 0:
            distance = np.abs(chord[0] * inner[:, 1] - chord[1] * inner[:, 0]) / length
        else:  # a closed piece has no chord; it is bent however small it is
            distance = np.hypot(inner[:, 0], inner[:, 1]) + tolerance
        furthest = int(distance.argmax())
        if distance[furthest] > tolerance:
            middle = first + 1 + furthest
            cuts.add(middle)
            pieces += [(first, middle), (middle, last)]
    return sorted(cuts)


def crossing_corners(cells: Cells, fresh: Mask) -> NDArray[np.int64]:
    """Find where two labels touch only diagonally, across two empty cells.

    Parameters
    ----------
    cells : (h, w) int array
        Labels; EMPTY where nothing is.
    fresh : (h, w) bool array
        At least one of the two must be in here.

    Returns
    -------
    (n, 4) int array
        Label above, label below, row and col of the node; from the top down.
    """
    empty = cells == EMPTY
    found = []
    for above, below, beside, beneath in (
        (np.s_[:-1, :-1], np.s_[1:, 1:], np.s_[:-1, 1:], np.s_[1:, :-1]),
        (np.s_[:-1, 1:], np.s_[1:, :-1], np.s_[:-1, :-1], np.s_[1:, 1:]),
    ):
        across = empty[beside] & empty[beneath] & ~empty[above] & ~empty[below]
        across &= (fresh[above] | fresh[below]) & (cells[above] != cells[below])
        row, col = np.nonzero(across)
        ids = cells[above][row, col], cells[below][row, col]
        found.append(np.column_stack((*ids, row + 1, col + 1)))
    corners = np.concatenate(found)
    return corners[np.lexsort((corners[:, 3], corners[:, 2]))]
