# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :func:`drystone.kernels.contacts.contacts_numpy`, and of ``kernels.straight``."""

from libc.math cimport fabs, sqrt
from libc.stdint cimport int64_t, uint8_t
from libc.stdlib cimport free, malloc
from libc.string cimport memset

import numpy as np


cdef struct Run:
    Py_ssize_t chain, first, last


cdef struct Work:
    const int64_t* nodes
    Run* runs
    Py_ssize_t* pieces
    uint8_t* is_cut
    Py_ssize_t count


def contacts(
    const int64_t[:, ::1] cells,
    const int64_t[:, ::1] labels,
    const int64_t[::1] begins,
    const int64_t[:, ::1] nodes,
    const int64_t[:, ::1] corners,
    origin,
    lengths,
):
    """Return high, low, ends and normals of runs and corners, and the number of runs."""
    cdef int64_t tolerance = lengths[0]
    cdef Py_ssize_t hook = lengths[1]
    cdef Work work
    memset(&work, 0, sizeof(Work))
    if nodes.shape[0]:
        work.nodes = &nodes[0, 0]
    # A chain has fewer runs than nodes, and fewer pieces wait than it has nodes.
    work.runs = <Run*>malloc((nodes.shape[0] + 1) * sizeof(Run))
    work.pieces = <Py_ssize_t*>malloc(2 * (nodes.shape[0] + 1) * sizeof(Py_ssize_t))
    work.is_cut = <uint8_t*>malloc(nodes.shape[0] + 1)
    cdef Py_ssize_t k
    try:
        if not (work.runs and work.pieces and work.is_cut):
            raise MemoryError
        with nogil:
            for k in range(labels.shape[0]):
                split_chain(&work, k, begins[k], begins[k + 1], tolerance, hook)
        return told(&work, cells, labels, corners, origin, lengths[2])
    finally:
        free(work.runs)
        free(work.pieces)
        free(work.is_cut)


cdef tuple told(
    Work* work,
    const int64_t[:, ::1] cells,
    const int64_t[:, ::1] labels,
    const int64_t[:, ::1] corners,
    origin,
    Py_ssize_t reach,
):
    """Write what was found into arrays, in the wall frame."""
    cdef int64_t x0 = origin[0], y0 = origin[1]
    cdef Py_ssize_t count = work.count + corners.shape[0], k, c
    high, low = np.empty(count, np.int64), np.empty(count, np.int64)
    ends, normals = np.empty((count, 2, 2)), np.empty((count, 2))
    cdef int64_t[::1] highs = high, lows = low
    cdef double[:, :, ::1] points = ends
    cdef double[:, ::1] vectors = normals
    cdef Run run
    with nogil:
        for k in range(work.count):
            run = work.runs[k]
            highs[k], lows[k] = labels[run.chain, 0], labels[run.chain, 1]
            points[k, 0, 0] = <double>(x0 + work.nodes[2 * run.first + 1])
            points[k, 0, 1] = <double>(y0 - work.nodes[2 * run.first])
            points[k, 1, 0] = <double>(x0 + work.nodes[2 * run.last + 1])
            points[k, 1, 1] = <double>(y0 - work.nodes[2 * run.last])
            write_normal(work.nodes + 2 * run.first, run.last - run.first, &vectors[k, 0])
        for c in range(corners.shape[0]):
            k = work.count + c
            highs[k], lows[k] = max(corners[c, 0], corners[c, 1]), min(corners[c, 0], corners[c, 1])
            points[k, 0, 0] = points[k, 1, 0] = <double>(x0 + corners[c, 3])
            points[k, 0, 1] = points[k, 1, 1] = <double>(y0 - corners[c, 2])
            write_normal_at_point(cells, &corners[c, 0], reach, &vectors[k, 0])
    return high, low, ends, normals, work.count


cdef void split_chain(
    Work* work,
    Py_ssize_t chain,
    Py_ssize_t begin,
    Py_ssize_t end,
    int64_t tolerance,
    Py_ssize_t hook,
) noexcept nogil:
    """Cut a chain at its corners (Douglas and Peucker 1973), and leave hooks out."""
    cdef Py_ssize_t waiting = 1, first, last, middle, cut, before = begin
    memset(work.is_cut + begin, 0, end - begin)
    work.is_cut[end - 1] = 1
    work.pieces[0], work.pieces[1] = begin, end - 1
    while waiting:
        waiting -= 1
        first, last = work.pieces[2 * waiting], work.pieces[2 * waiting + 1]
        middle = corner_between(work.nodes, first, last, tolerance)
        if middle < 0:
            continue
        work.is_cut[middle] = 1
        work.pieces[2 * waiting], work.pieces[2 * waiting + 1] = first, middle
        work.pieces[2 * waiting + 2], work.pieces[2 * waiting + 3] = middle, last
        waiting += 2
    for cut in range(begin + 1, end):
        if not work.is_cut[cut]:
            continue
        first, last = before, cut
        before = cut
        if last - first > hook and is_hook(work.nodes, last, -1, hook):
            last -= 1
        if last - first > hook and is_hook(work.nodes, first, 1, hook):
            first += 1
        work.runs[work.count].chain = chain
        work.runs[work.count].first, work.runs[work.count].last = first, last
        work.count += 1


cdef Py_ssize_t corner_between(
    const int64_t* nodes, Py_ssize_t first, Py_ssize_t last, int64_t tolerance
) noexcept nogil:
    """Return the node furthest from the chord, the first of several; -1 if that is near."""
    cdef int64_t row = nodes[2 * first], col = nodes[2 * first + 1]
    cdef int64_t rows = nodes[2 * last] - row, cols = nodes[2 * last + 1] - col, r, c
    cdef int64_t away, furthest = 0
    cdef Py_ssize_t k, middle = -1
    if last - first < 2:
        return -1
    if rows or cols:  # times the length of the chord
        furthest = integer_root(tolerance * (rows * rows + cols * cols))
    for k in range(first + 1, last):
        r, c = nodes[2 * k] - row, nodes[2 * k + 1] - col
        if rows or cols:
            away = cols * r - rows * c
            if away < 0:
                away = -away
        else:  # a closed piece has no chord; it is bent however small it is
            away = r * r + c * c
        if away > furthest:
            furthest, middle = away, k
    return middle


cdef int64_t integer_root(int64_t square) noexcept nogil:
    """Return the largest integer whose square is no larger."""
    cdef int64_t root = <int64_t>sqrt(<double>square)
    while root * root > square:
        root -= 1
    while (root + 1) * (root + 1) <= square:
        root += 1
    return root


cdef bint is_hook(
    const int64_t* nodes, Py_ssize_t end, Py_ssize_t inwards, Py_ssize_t needs
) noexcept nogil:
    """Say whether the edge at the end of a run turns off from a straight piece."""
    cdef const int64_t* last = nodes + 2 * end
    cdef const int64_t* bend = nodes + 2 * (end + inwards)
    cdef const int64_t* far = nodes + 2 * (end + inwards + needs * inwards)
    cdef int64_t rows = bend[0] - far[0], cols = bend[1] - far[1]
    if max(rows if rows > 0 else -rows, cols if cols > 0 else -cols) != needs:
        return False
    return rows * (last[0] - bend[0]) + cols * (last[1] - bend[1]) == 0


cdef void write_normal(const int64_t* nodes, Py_ssize_t count, double* normal) noexcept nogil:
    """Write the unit normal to the left of a run of so many edges."""
    cdef int64_t sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0, sum_yy = 0, x, y
    cdef double n = <double>count, sx, sy, xx, xy, yy, difference, mixed, size
    cdef double along_x, along_y, length
    cdef double chord_x = <double>(nodes[2 * count + 1] - nodes[1])
    cdef double chord_y = <double>(nodes[0] - nodes[2 * count])
    cdef Py_ssize_t k
    for k in range(count):
        x = nodes[2 * k + 1] + nodes[2 * k + 3] - 2 * nodes[1]
        y = 2 * nodes[0] - nodes[2 * k] - nodes[2 * k + 2]
        sum_x += x
        sum_y += y
        sum_xx += x * x
        sum_xy += x * y
        sum_yy += y * y
    sx, sy = <double>sum_x, <double>sum_y
    xx = n * <double>sum_xx - sx * sx
    xy = n * <double>sum_xy - sx * sy
    yy = n * <double>sum_yy - sy * sy
    difference, mixed = xx - yy, 2.0 * xy
    if mixed == 0.0:
        if difference == 0.0:  # one edge, or no direction better than another
            along_x, along_y = chord_x, chord_y
        else:
            along_x = 1.0 if difference > 0.0 else 0.0
            along_y = 1.0 - along_x
    else:
        size = sqrt(difference * difference + mixed * mixed)
        if difference >= 0.0:  # of two expressions the one that does not cancel
            along_x, along_y = size + difference, mixed
        else:
            along_x = fabs(mixed)
            along_y = size - difference if mixed > 0.0 else difference - size
    length = sqrt(along_x * along_x + along_y * along_y)
    if along_x * chord_x + along_y * chord_y < 0.0:
        length = -length
    normal[0] = -along_y / length + 0.0
    normal[1] = along_x / length + 0.0


cdef void write_normal_at_point(
    const int64_t[:, ::1] cells, const int64_t* corner, Py_ssize_t reach, double* normal
) noexcept nogil:
    """Write the normal of two labels that touch at a node across two empty cells."""
    cdef Py_ssize_t row = corner[2], col = corner[3], r, c
    cdef bint on_right = cells[row - 1, col] == corner[0]
    cdef int64_t sign, up, right, outside, moment_x, moment_y, normal_x = 0, normal_y = 0
    cdef double length
    for sign in range(1, -2, -2):  # the region above, then the one below
        outside = moment_x = moment_y = 0
        for r in range(max(row - reach, 0), min(row + reach, cells.shape[0])):
            up = 2 * (row - r) - 1
            for c in range(max(col - reach, 0), min(col + reach, cells.shape[1])):
                if cells[r, c] != (corner[0] if sign > 0 else corner[1]):
                    continue
                right = 2 * (c - col) + 1
                moment_x += right
                moment_y += up
                outside += sign * up < 0 or sign * (right if on_right else -right) < 0
        normal_x += sign * outside * moment_x
        normal_y += sign * outside * moment_y
    if normal_x == 0 and normal_y == 0:
        normal_y = 1
    length = sqrt(<double>(normal_x * normal_x + normal_y * normal_y))
    if corner[0] < corner[1]:
        length = -length
    normal[0] = <double>normal_x / length + 0.0
    normal[1] = <double>normal_y / length + 0.0
