"""Boundary between labelled regions of an image, as chains of unit pixel edges (§4.2).

Nodes are pixel corners (row, col) of the array handed in: node (r, c) is the top-left corner of
cell (r, c).  Everything is directed so that the larger of the two labels lies to the left.  Inside,
nodes are numbered row by row, one more to a row than cells, and an edge is the number of its start
node times four, plus its heading: 0 to the right, 1 up, 2 to the left, 3 down.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import flags, kept_flags, kept_ints, longs, longs_out

Cells = NDArray[np.int64]
Nodes = NDArray[np.int64]

EMPTY = -1
"""Label of nothing; labels that bound something are >= 0."""

# Of a node: the lower four bits are the headings that edges leave it with, the upper four say that
# another edge goes over into that one.  A node where two labels cross has no edges.
LEAVING = cython.declare(cython.int, 0x0F)
CROSSING = cython.declare(cython.int, 0x80)

NOTHING = cython.declare(cython.longlong, EMPTY)


@dataclass(frozen=True, eq=False)
class Boundary:
    """Where the regions of an array of cells touch."""

    # (n, 2) the two labels of each chain of pixel edges; the first is the larger and lies to
    # the left
    labels: NDArray[np.int64]
    # (n + 1,) where the nodes of each chain begin; in the end the number of all nodes
    begins: NDArray[np.int64]
    nodes: Nodes  # (m, 2) row and col of the nodes of all chains, one chain after the other
    # (k, 4) where two labels touch only diagonally, across two empty cells: label above,
    # label below, row and col of the node; from the top down
    corners: NDArray[np.int64]


def boundary_of(cells: Cells, fresh: Mask | None = None) -> Boundary:
    """Find where regions touch: chains of pixel edges and crossing corners.

    `cells` (h, w) are int64 labels, EMPTY where nothing is.  Of two cells that touch at least one
    must be `fresh` (h, w); of a label all cells are, or none.

    Where four edges of one pair meet (the pixels cross like a chequerboard) a chain turns left,
    around its own pixel of the higher label.  A closed chain starts at the lowest of its leftmost
    corners.  Chains are sorted by labels, then by start: from the bottom up and from left to right.
    """
    w: BoundaryWork = BoundaryWork()
    w.room = []
    w.height, w.width = cells.shape
    w.stride = w.width + 1
    w.cells = longs(cells)
    w.all_fresh = fresh is None
    if fresh is not None:
        w.fresh = flags(fresh)
    w.nodes = kept_flags(w.room, (w.height + 1) * w.stride)
    w.around, w.steps = kept_ints(w.room, 4), kept_ints(w.room, 4)
    w.around[0], w.around[1], w.around[2] = -w.width, -w.width - 1, -1
    w.steps[0], w.steps[1], w.steps[2], w.steps[3] = 1, -w.stride, -1, w.stride
    w.edge_count = w.corner_count = w.chain_count = w.path_count = 0
    with cython.nogil:
        mark_nodes(w)
    w.edges, w.corners = kept_ints(w.room, w.edge_count), kept_ints(w.room, w.corner_count)
    # A chain has one node more than edges; closed ones have at least four edges.
    w.path = kept_ints(w.room, 2 * w.edge_count)
    list_edges(w)
    starts: cython.int = put_starts_first(w)
    rows = np.empty((starts + w.edge_count // 4, 6), np.int64)
    w.chains = longs_out(rows)
    with cython.nogil:
        for k in range(starts):
            follow_chain(w, w.edges[k])
        for k in range(starts, w.edge_count):
            if is_followed(w, w.edges[k]):  # and no chain came here yet: a closed one
                follow_chain(w, lowest_of_leftmost(w, w.edges[k]))
    return told(w, rows[: w.chain_count])


@cython.cclass
class BoundaryWork:
    """Cells, marks of their nodes, and what is found; of chains labels, -row, col, begin, end."""


def told(w, rows):
    """Write what was found into arrays, with the rows of chains in order."""
    rows = rows[np.lexsort(rows.T[::-1])]
    w.chains = longs(rows)
    labels, begins = rows[:, :2].copy(), np.zeros(w.chain_count + 1, np.int64)
    nodes, corners = np.empty((w.path_count, 2), np.int64), np.empty((w.corner_count, 4), np.int64)
    begin: cython.p_longlong = longs_out(begins)
    places: cython.p_longlong = longs_out(nodes)
    crossings: cython.p_longlong = longs_out(corners)
    at: cython.int = 0
    with cython.nogil:
        for k in range(w.chain_count):
            for n in range(w.chains[6 * k + 4], w.chains[6 * k + 5]):
                places[2 * at] = w.path[n] // w.stride
                places[2 * at + 1] = w.path[n] % w.stride
                at += 1
            begin[k + 1] = at
        for k in range(w.corner_count):
            cell: cython.Py_ssize_t = w.corners[k] - w.corners[k] // w.stride
            right: cython.bint = w.cells[cell - w.width] != NOTHING
            crossings[4 * k] = w.cells[cell - w.width - (0 if right else 1)]
            crossings[4 * k + 1] = w.cells[cell - (1 if right else 0)]
            crossings[4 * k + 2] = w.corners[k] // w.stride
            crossings[4 * k + 3] = w.corners[k] % w.stride
    return Boundary(labels, begins, nodes, corners)


def mark_nodes(w):
    """Mark where edges leave nodes, and where labels cross; count both."""
    cells: cython.p_longlong = w.cells
    nodes: cython.p_uchar = w.nodes
    width: cython.Py_ssize_t = w.width
    for row in range(w.height):
        for col in range(width):
            at: cython.Py_ssize_t = row * width + col
            here = cells[at]
            above = cells[at - width] if row else here
            before = cells[at - 1] if col else here
            if above == here and before == here:
                continue
            node = at + row
            full: cython.bint = here != NOTHING
            if full and above not in (here, NOTHING) and is_fresh(w, at, at - width):
                w.edge_count += 1
                if above > here:
                    nodes[node] |= 1
                else:
                    nodes[node + 1] |= 4
            if full and before not in (here, NOTHING) and is_fresh(w, at, at - 1):
                w.edge_count += 1
                if before > here:
                    nodes[node + width + 1] |= 2
                else:
                    nodes[node] |= 8
            if not (row and col):
                continue
            corner = cells[at - width - 1]
            if above == NOTHING and before == NOTHING:
                if full and corner not in (NOTHING, here):
                    if is_fresh(w, at, at - width - 1):
                        w.corner_count += 1
                        nodes[node] = CROSSING
            elif corner == NOTHING and not full:
                if above != NOTHING and before not in (NOTHING, above):
                    if is_fresh(w, at - width, at - 1):
                        w.corner_count += 1
                        nodes[node] = CROSSING


def is_fresh(w, one, other):
    """Say whether one of two cells is fresh."""
    return w.all_fresh or w.fresh[one] or w.fresh[other]


def list_edges(w):
    """List all edges, and the nodes where labels cross, row by row."""
    edges: cython.int = 0
    corners: cython.int = 0
    for node in range((w.height + 1) * w.stride):
        mark = w.nodes[node]
        if mark == 0:
            continue
        if mark == CROSSING:
            w.corners[corners] = node
            corners += 1
            continue
        for heading in range(4):
            if mark >> heading & 1:
                w.edges[edges] = 4 * node + heading
                edges += 1


def put_starts_first(w):
    """Mark the edges that another one goes over into; list the others first, return how many."""
    starts: cython.int = 0
    for k in range(w.edge_count):
        edge = following(w, w.edges[k])
        if edge >= 0:
            w.nodes[edge >> 2] |= 16 << (edge & 3)
    for k in range(w.edge_count):
        edge = w.edges[k]
        if not is_followed(w, edge):
            w.edges[k], w.edges[starts] = w.edges[starts], edge
            starts += 1
    return starts


def is_followed(w, edge):
    """Say whether another edge goes over into one, and no chain was written there yet."""
    return (w.nodes[edge >> 2] >> 4 >> (edge & 3) & 1) != 0


def following(w, edge):
    """Return which edge of the same two labels goes on where an edge ends, -1 for none."""
    start: cython.int = edge >> 2
    node: cython.int = start + w.steps[edge & 3]
    mark = w.nodes[node]
    if mark & LEAVING == 0:
        return -1
    # The cells below and to the right of nodes, and from there those beside an edge.
    at: cython.Py_ssize_t = start - start // w.stride
    high, low = w.cells[at + w.around[edge & 3]], w.cells[at + w.around[(edge + 3) & 3]]
    at = node - node // w.stride
    for turn in range(5, 2, -1):  # to the left before straight on, and that before to the right
        heading = (edge + turn) & 3
        if mark >> heading & 1 and w.cells[at + w.around[heading]] == high:
            if w.cells[at + w.around[(heading + 3) & 3]] == low:
                return 4 * node + heading
    return -1


def lowest_of_leftmost(w, start):
    """Return the edge of a closed chain at the lowest of its leftmost nodes."""
    edge: cython.int = start
    best: cython.int = start
    best_row, best_col = (start >> 2) // w.stride, (start >> 2) % w.stride
    while True:
        edge = following(w, edge)
        if edge == start:
            return best
        row, col = (edge >> 2) // w.stride, (edge >> 2) % w.stride
        if col < best_col or (col == best_col and row > best_row):
            best, best_row, best_col = edge, row, col


def follow_chain(w, start):
    """Write the nodes of a chain from its first edge on."""
    k: cython.Py_ssize_t = 6 * w.chain_count
    node: cython.int = start >> 2
    edge: cython.int = start
    last: cython.int = start
    at: cython.Py_ssize_t = node - node // w.stride
    w.chains[k] = w.cells[at + w.around[start & 3]]
    w.chains[k + 1] = w.cells[at + w.around[(start + 3) & 3]]
    w.chains[k + 2], w.chains[k + 3] = -(node // w.stride), node % w.stride
    w.chains[k + 4] = w.path_count
    while True:
        w.nodes[edge >> 2] &= ~(16 << (edge & 3))
        w.path[w.path_count] = edge >> 2
        w.path_count += 1
        last = edge
        edge = following(w, edge)
        if edge < 0 or edge == start:
            break
    w.path[w.path_count] = (last >> 2) + w.steps[last & 3]
    w.path_count += 1
    w.chains[k + 5] = w.path_count
    w.chain_count += 1
