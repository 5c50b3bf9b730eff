"""Boundary between labelled regions of an image, as chains of unit pixel edges (§4.2).

Nodes are pixel corners (row, col) of the array handed in: node (r, c) is the top-left corner of
cell (r, c).  Everything is directed so that the larger of the two labels lies to the left.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.raster import Mask

Cells = NDArray[np.int64]
Nodes = NDArray[np.int64]

EMPTY = -1
"""Label of nothing; labels that bound something are >= 0."""

_fast = compiled("boundary")


@dataclass(frozen=True, eq=False)
class Boundary:
    """Where the regions of an array of cells touch.

    Parameters
    ----------
    labels : (n, 2) int64 array
        The two labels of each chain of pixel edges; the first is the larger and lies to the left.
    begins : (n + 1,) int64 array
        Where the nodes of each chain begin; in the end the number of all nodes.
    nodes : (m, 2) int64 array
        Row and col of the nodes of all chains, one chain after the other.
    corners : (k, 4) int64 array
        From :func:`crossing_corners`.
    """

    labels: NDArray[np.int64]
    begins: NDArray[np.int64]
    nodes: Nodes
    corners: NDArray[np.int64]


def boundary_of(cells: Cells, fresh: Mask | None = None) -> Boundary:
    """Find where the regions of an array of cells touch: chains and crossing corners.

    Parameters
    ----------
    cells : (h, w) int64 array
        Labels; EMPTY where nothing is.  C-contiguous.
    fresh : (h, w) bool array, optional
        At least one side must be in here.  Of a label all cells are, or none.

    Examples
    --------
    >>> boundary = boundary_of(np.array([[5, 5], [3, 3]]))
    >>> boundary.labels.tolist(), boundary.nodes.tolist()
    ([[5, 3]], [[1, 0], [1, 1], [1, 2]])
    """
    if _fast is None:
        return boundary_numpy(cells, fresh)
    return Boundary(*_fast.boundary(cells, fresh))


def boundary_numpy(cells: Cells, fresh: Mask | None = None) -> Boundary:
    """Find chains and crossing corners without compiled code."""
    chains = trace_chains(touching_edges(cells, fresh))
    counts = [0, *(len(chain.rows) for chain in chains)]
    rows = [row for chain in chains for row in chain.rows]
    cols = [col for chain in chains for col in chain.cols]
    return Boundary(
        np.array([(chain.high, chain.low) for chain in chains], np.int64).reshape(-1, 2),
        np.cumsum(counts, dtype=np.int64),
        np.array([rows, cols], np.int64).T.copy(),
        crossing_corners(cells, fresh),
    )


@dataclass(frozen=True, eq=False)
class Chain:
    """A connected chain of pixel edges between two regions.

    Parameters
    ----------
    high, low : int
        The two labels; `high` is the larger and lies to the left of the chain.
    rows, cols : list of int
        Pixel corners along the chain; first and last are equal in a closed one.
    """

    high: int
    low: int
    rows: list[int]
    cols: list[int]

    @property
    def nodes(self) -> Nodes:
        """Pixel corners (row, col), one a row."""
        return np.column_stack((self.rows, self.cols))


def touching_edges(cells: Cells, fresh: Mask | None = None) -> NDArray[np.int64]:
    """Find the pixel edges between two labels of which one is fresh.

    Parameters
    ----------
    cells : (h, w) int array
        Labels; EMPTY where nothing is.
    fresh : (h, w) bool array, optional
        Only edges with at least one of their two cells in here are returned; all without it.

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
    # Horizontal edges lie between a cell and the one below: they run to the right along the top
    # of the lower cell when that has the lower label.  Vertical ones lie beside each other.
    a, b, row, col = _unlike(cells, fresh, np.s_[:-1], np.s_[1:])
    back = a < b
    across = np.maximum(a, b), np.minimum(a, b), row + 1, col + back, 2 * back
    a, b, row, col = _unlike(cells, fresh, np.s_[:, :-1], np.s_[:, 1:])
    up = a > b
    upright = np.maximum(a, b), np.minimum(a, b), row + up, col + 1, 3 - 2 * up
    return np.concatenate([np.column_stack(across), np.column_stack(upright)])


Part = slice | tuple[slice, slice]


def _unlike(
    cells: Cells, fresh: Mask | None, one: Part, other: Part
) -> tuple[Cells, Cells, NDArray[np.intp], NDArray[np.intp]]:
    """Return the labels of neighbours that differ, neither of them empty, and where they are."""
    first, second = cells[one], cells[other]
    unlike = first != second
    unlike &= (first | second) > EMPTY  # all bits of EMPTY are set
    if fresh is not None:
        unlike &= fresh[one] | fresh[other]
    row, col = np.nonzero(unlike)
    return first[row, col], second[row, col], row, col


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
    if not len(edges):
        return []
    # Nodes are numbered row by row, with one more than the last column of an edge's end.
    stride = int(edges[:, 3].max()) + 2
    start = edges[:, 2] * stride + edges[:, 3]
    end = start + np.array([1, -stride, -1, stride])[edges[:, 4]]
    high, low, rows, cols, _ = edges.T.tolist()
    following = _following(high, low, start, end, edges[:, 4])
    chains = []
    for sequence in _sequences(following):
        members = sequence
        last = end[sequence[-1]]
        if following[sequence[-1]] == sequence[0]:
            # A closed chain may begin anywhere: leftmost, then lowest.
            first = min(range(len(sequence)), key=lambda k: (cols[sequence[k]], -rows[sequence[k]]))
            members = sequence[first:] + sequence[:first]
            last = start[members[0]]
        row, col = divmod(int(last), stride)
        first = members[0]
        chains.append(
            Chain(
                high[first],
                low[first],
                [*(rows[i] for i in members), row],
                [*(cols[i] for i in members), col],
            )
        )
    chains.sort(key=lambda chain: (chain.high, chain.low, -chain.rows[0], chain.cols[0]))
    return chains


def _following(
    high: list[int],
    low: list[int],
    start: NDArray[np.int64],
    end: NDArray[np.int64],
    heading: NDArray[np.int64],
) -> list[int]:
    """Return which edge of the same two labels goes on where each edge ends, -1 for none."""
    leaving = {code: edge for edge, code in enumerate((4 * start + heading).tolist())}
    # To the left before straight on, and that before to the right.
    turns = (4 * end[:, None] + (heading[:, None] + np.array([1, 0, 3])) % 4).tolist()
    following = []
    for a, b, codes in zip(high, low, turns, strict=True):
        for code in codes:
            edge = leaving.get(code, -1)
            if edge >= 0 and high[edge] == a and low[edge] == b:
                following.append(edge)
                break
        else:
            following.append(-1)
    return following


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


def crossing_corners(cells: Cells, fresh: Mask | None = None) -> NDArray[np.int64]:
    """Find where two labels touch only diagonally, across two empty cells.

    Parameters
    ----------
    cells : (h, w) int array
        Labels; EMPTY where nothing is.
    fresh : (h, w) bool array, optional
        At least one of the two must be in here.

    Returns
    -------
    (n, 4) int array
        Label above, label below, row and col of the node; from the top down.

    Examples
    --------
    >>> crossing_corners(np.array([[EMPTY, 7], [4, EMPTY]])).tolist()
    [[7, 4, 1, 1]]
    """
    full = cells != EMPTY
    one = full[:-1, :-1]
    across = (one == full[1:, 1:]) & (full[:-1, 1:] == full[1:, :-1]) & (one != full[:-1, 1:])
    row, col = np.nonzero(across)
    to_right = (~full[row, col]).astype(np.int64)  # whether the upper label is on the right
    above, below = (row, col + to_right), (row + 1, col + 1 - to_right)
    found = cells[above] != cells[below]
    if fresh is not None:
        found &= fresh[above] | fresh[below]
    return np.asarray(np.column_stack((cells[above], cells[below], row + 1, col + 1))[found])
