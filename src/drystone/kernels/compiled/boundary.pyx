# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :func:`drystone.kernels.boundary.boundary_numpy`.

Nodes are pixel corners, numbered row by row, one more to a row than cells.  An edge is the number
of its start node times four, plus its heading: 0 to the right, 1 up, 2 to the left, 3 down.
"""

from libc.stdint cimport int64_t, uint8_t
from libc.stdlib cimport calloc, free, malloc, qsort
from libc.string cimport memset

import numpy as np

cdef int64_t EMPTY = -1

# Of a node: the lower four bits are the headings that edges leave it with, the upper four say that
# another edge goes over into that one.  A node where two labels cross has no edges.
cdef enum:
    LEAVING = 0x0F
    CROSSING = 0x80


cdef struct Chain:
    int64_t high, low
    int64_t row, col
    Py_ssize_t begin, count


cdef struct Work:
    const int64_t* cells
    const uint8_t* fresh
    Py_ssize_t height, width
    uint8_t* nodes
    Py_ssize_t* edges
    Py_ssize_t* corners
    Py_ssize_t* path
    Chain* chains
    Py_ssize_t edge_count, corner_count, chain_count, path_count


def boundary(const int64_t[:, ::1] cells, const uint8_t[:, ::1] fresh):
    """Return labels and begins of chains, the nodes of all chains, and corners."""
    cdef Work work
    cdef bint done
    memset(&work, 0, sizeof(Work))
    work.height, work.width = cells.shape[0], cells.shape[1]
    if work.height and work.width:
        work.cells = &cells[0, 0]
        work.fresh = &fresh[0, 0] if fresh is not None else NULL
    try:
        with nogil:
            done = find_chains(&work)
        if not done:
            raise MemoryError
        return told(&work)
    finally:
        free(work.nodes)
        free(work.edges)
        free(work.corners)
        free(work.path)
        free(work.chains)


cdef tuple told(Work* work):
    """Write what was found into arrays."""
    labels_of = np.empty((work.chain_count, 2), np.int64)
    begins_of = np.zeros(work.chain_count + 1, np.int64)
    nodes_of = np.empty((work.path_count, 2), np.int64)
    corners_of = np.empty((work.corner_count, 4), np.int64)
    cdef int64_t[:, ::1] labels = labels_of, nodes = nodes_of, corners = corners_of
    cdef int64_t[::1] begins = begins_of
    cdef Py_ssize_t k, n, at = 0, row, col, stride = work.width + 1
    cdef bint to_right
    with nogil:
        for k in range(work.chain_count):
            labels[k, 0], labels[k, 1] = work.chains[k].high, work.chains[k].low
            for n in range(work.chains[k].begin, work.chains[k].begin + work.chains[k].count):
                nodes[at, 0], nodes[at, 1] = work.path[n] // stride, work.path[n] % stride
                at += 1
            begins[k + 1] = at
        for k in range(work.corner_count):
            row, col = work.corners[k] // stride, work.corners[k] % stride
            to_right = work.cells[(row - 1) * work.width + col] != EMPTY
            corners[k, 0] = work.cells[(row - 1) * work.width + col - (0 if to_right else 1)]
            corners[k, 1] = work.cells[row * work.width + col - (1 if to_right else 0)]
            corners[k, 2], corners[k, 3] = row, col
    return labels_of, begins_of, nodes_of, corners_of


cdef bint find_chains(Work* work) noexcept nogil:
    """Join all pixel edges to chains, sorted by labels and place; False when memory is short."""
    cdef Py_ssize_t k, starts
    work.nodes = <uint8_t*>calloc((work.height + 1) * (work.width + 1), 1)
    if work.nodes == NULL:
        return False
    mark_nodes(work)
    work.edges = <Py_ssize_t*>malloc((work.edge_count + 1) * sizeof(Py_ssize_t))
    work.corners = <Py_ssize_t*>malloc((work.corner_count + 1) * sizeof(Py_ssize_t))
    # A chain has one node more than edges.
    work.path = <Py_ssize_t*>malloc((2 * work.edge_count + 1) * sizeof(Py_ssize_t))
    if not (work.edges and work.corners and work.path):
        return False
    list_edges(work)
    starts = put_starts_first(work)
    # Closed chains have at least four edges.
    work.chains = <Chain*>malloc((starts + work.edge_count // 4 + 1) * sizeof(Chain))
    if work.chains == NULL:
        return False
    for k in range(starts):
        follow_chain(work, work.edges[k])
    for k in range(starts, work.edge_count):
        if is_followed(work, work.edges[k]):  # and no chain came here yet: a closed one
            follow_chain(work, lowest_of_leftmost(work, work.edges[k]))
    qsort(work.chains, work.chain_count, sizeof(Chain), compare_chains)
    return True


cdef void mark_nodes(Work* work) noexcept nogil:
    """Mark where edges leave nodes, and where labels cross; count both."""
    cdef Py_ssize_t width = work.width, row, col, at, node
    cdef const int64_t* cells = work.cells
    cdef int64_t here, above, before, corner
    cdef bint full
    for row in range(work.height):
        for col in range(width):
            at = row * width + col
            node = at + row
            here = cells[at]
            above = cells[at - width] if row else here
            before = cells[at - 1] if col else here
            if above == here and before == here:
                continue
            full = here != EMPTY
            if full and above != here and above != EMPTY and is_fresh(work, at, at - width):
                work.edge_count += 1
                if above > here:
                    work.nodes[node] |= 1 << 0
                else:
                    work.nodes[node + 1] |= 1 << 2
            if full and before != here and before != EMPTY and is_fresh(work, at, at - 1):
                work.edge_count += 1
                if before > here:
                    work.nodes[node + width + 1] |= 1 << 1
                else:
                    work.nodes[node] |= 1 << 3
            if not (row and col):
                continue
            corner = cells[at - width - 1]
            if above == EMPTY and before == EMPTY:
                if full and corner != EMPTY and corner != here:
                    if is_fresh(work, at, at - width - 1):
                        work.corner_count += 1
                        work.nodes[node] = CROSSING
            elif corner == EMPTY and not full:
                if above != EMPTY and before != EMPTY and above != before:
                    if is_fresh(work, at - width, at - 1):
                        work.corner_count += 1
                        work.nodes[node] = CROSSING


cdef inline bint is_fresh(Work* work, Py_ssize_t one, Py_ssize_t other) noexcept nogil:
    """Say whether one of two cells is fresh."""
    return work.fresh == NULL or work.fresh[one] or work.fresh[other]


cdef void list_edges(Work* work) noexcept nogil:
    """List all edges, and the nodes where labels cross, row by row."""
    cdef Py_ssize_t node, edges = 0, corners = 0
    cdef int heading
    for node in range((work.height + 1) * (work.width + 1)):
        if work.nodes[node] == 0:
            continue
        if work.nodes[node] == CROSSING:
            work.corners[corners] = node
            corners += 1
            continue
        for heading in range(4):
            if work.nodes[node] >> heading & 1:
                work.edges[edges] = 4 * node + heading
                edges += 1


cdef Py_ssize_t put_starts_first(Work* work) noexcept nogil:
    """Mark the edges that another one goes over into; list the others first, return how many."""
    cdef Py_ssize_t k, edge, starts = 0
    for k in range(work.edge_count):
        edge = following(work, work.edges[k])
        if edge >= 0:
            work.nodes[edge >> 2] |= <uint8_t>(16 << (edge & 3))
    for k in range(work.edge_count):
        edge = work.edges[k]
        if not is_followed(work, edge):
            work.edges[k], work.edges[starts] = work.edges[starts], edge
            starts += 1
    return starts


cdef inline bint is_followed(Work* work, Py_ssize_t edge) noexcept nogil:
    """Say whether another edge goes over into one, and no chain was written there yet."""
    return work.nodes[edge >> 2] >> 4 >> (edge & 3) & 1


cdef inline Py_ssize_t end_of(Work* work, Py_ssize_t edge) noexcept nogil:
    """Return the node where an edge ends."""
    cdef int heading = edge & 3
    if heading == 0:
        return (edge >> 2) + 1
    if heading == 1:
        return (edge >> 2) - work.width - 1
    if heading == 2:
        return (edge >> 2) - 1
    return (edge >> 2) + work.width + 1


cdef inline void read_labels(
    Work* work, Py_ssize_t edge, int64_t* high, int64_t* low
) noexcept nogil:
    """Read the labels to the left and to the right of an edge."""
    cdef Py_ssize_t node = edge >> 2, width = work.width
    cdef Py_ssize_t at = node - node // (width + 1)  # the cell below and to the right
    cdef int heading = edge & 3
    if heading == 0:
        high[0], low[0] = work.cells[at - width], work.cells[at]
    elif heading == 1:
        high[0], low[0] = work.cells[at - width - 1], work.cells[at - width]
    elif heading == 2:
        high[0], low[0] = work.cells[at - 1], work.cells[at - width - 1]
    else:
        high[0], low[0] = work.cells[at], work.cells[at - 1]


cdef Py_ssize_t following(Work* work, Py_ssize_t edge) noexcept nogil:
    """Return which edge of the same two labels goes on where an edge ends, -1 for none."""
    cdef int64_t high, low, other_high, other_low
    cdef Py_ssize_t node = end_of(work, edge), other
    cdef int turn, heading
    if work.nodes[node] & LEAVING == 0:
        return -1
    read_labels(work, edge, &high, &low)
    for turn in range(1, -2, -1):  # to the left before straight on, and that before to the right
        heading = (edge + turn) & 3
        if work.nodes[node] >> heading & 1:
            other = 4 * node + heading
            read_labels(work, other, &other_high, &other_low)
            if other_high == high and other_low == low:
                return other
    return -1


cdef Py_ssize_t lowest_of_leftmost(Work* work, Py_ssize_t start) noexcept nogil:
    """Return the edge of a closed chain at the lowest of its leftmost nodes."""
    cdef Py_ssize_t stride = work.width + 1, edge = start, best = start, row, col
    cdef Py_ssize_t best_row = (start >> 2) // stride, best_col = (start >> 2) % stride
    while True:
        edge = following(work, edge)
        if edge == start:
            return best
        row, col = (edge >> 2) // stride, (edge >> 2) % stride
        if col < best_col or (col == best_col and row > best_row):
            best, best_row, best_col = edge, row, col


cdef void follow_chain(Work* work, Py_ssize_t start) noexcept nogil:
    """Write the nodes of a chain from its first edge on."""
    cdef Chain* chain = &work.chains[work.chain_count]
    cdef Py_ssize_t stride = work.width + 1, edge = start, last = start
    chain.begin = work.path_count
    while True:
        work.nodes[edge >> 2] &= <uint8_t>~(16 << (edge & 3))
        work.path[work.path_count] = edge >> 2
        work.path_count += 1
        last = edge
        edge = following(work, edge)
        if edge < 0 or edge == start:
            break
    work.path[work.path_count] = end_of(work, last)
    work.path_count += 1
    read_labels(work, start, &chain.high, &chain.low)
    chain.row, chain.col = (start >> 2) // stride, (start >> 2) % stride
    chain.count = work.path_count - chain.begin
    work.chain_count += 1


cdef int compare_chains(const void* first, const void* second) noexcept nogil:
    """Compare by labels, then by start: from the bottom up and from left to right."""
    cdef const Chain* a = <const Chain*>first
    cdef const Chain* b = <const Chain*>second
    if a.high != b.high:
        return -1 if a.high < b.high else 1
    if a.low != b.low:
        return -1 if a.low < b.low else 1
    if a.row != b.row:
        return -1 if a.row > b.row else 1
    return -1 if a.col < b.col else <int>(a.col > b.col)
