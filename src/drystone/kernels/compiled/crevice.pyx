# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.crevice`."""

from libc.math cimport INFINITY, fabs, sqrt
from libc.stdint cimport int32_t
from libc.stdlib cimport free, malloc, qsort

import numpy as np

cdef double SAME = 1e-9


cdef struct Segment:
    double x0
    double y0
    double x1
    double y1


cdef struct Corner:
    double x
    double y


cdef struct Chain:
    Corner *corners
    Py_ssize_t count


def crevice(
    const double[:, ::1] stone,
    const double[:, ::1] corners,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
    double clearance,
):
    """Return lid and floor as `crevice_numpy` does."""
    cdef Chain lid, floor
    cdef double left = stone[0, 0], right = stone[0, 0]
    cdef Py_ssize_t i
    cdef bint lost
    lid.corners = floor.corners = NULL
    lid.count = floor.count = 0
    for i in range(1, stone.shape[0]):
        left, right = min(left, stone[i, 0]), max(right, stone[i, 0])
    with nogil:
        lost = boundaries(stone, corners, first, boxes, 4.0 * clearance, &lid, &floor)
        if not lost:
            flip(&lid)
            lost = raised(&lid, clearance, left, right) or raised(&floor, clearance, left, right)
            flip(&lid)
    found = (as_array(&lid), as_array(&floor))
    free(lid.corners)
    free(floor.corners)
    if lost:
        raise MemoryError
    return found


cdef as_array(const Chain *chain):
    points = np.empty((chain.count, 2))
    cdef double[:, ::1] view = points
    cdef Py_ssize_t i
    for i in range(chain.count):
        view[i, 0], view[i, 1] = chain.corners[i].x, chain.corners[i].y
    return points


cdef void flip(Chain *chain) noexcept nogil:
    cdef Py_ssize_t i
    for i in range(chain.count):
        chain.corners[i].y = -chain.corners[i].y


cdef bint boundaries(
    const double[:, ::1] stone,
    const double[:, ::1] corners,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
    double reach,
    Chain *lid,
    Chain *floor,
) noexcept nogil:
    """Find lid and floor as they are; say whether there was no memory."""
    cdef Py_ssize_t room = corners.shape[0] + 1, most = stone.shape[0] + 2
    cdef Py_ssize_t i, lids, edges, slabs
    cdef double left, right, top
    cdef Segment *lid_at = <Segment *>malloc(most * sizeof(Segment))
    cdef Segment *turned = <Segment *>malloc(most * sizeof(Segment))
    cdef Segment *edge_at = <Segment *>malloc(room * sizeof(Segment))
    cdef bint *bottom = <bint *>malloc(room * sizeof(bint))
    cdef Py_ssize_t places = 2 * (room + most) + 2
    cdef double *at = <double *>malloc(3 * places * sizeof(double))
    cdef Py_ssize_t *which = <Py_ssize_t *>malloc(2 * places * sizeof(Py_ssize_t))
    cdef Segment *picked = <Segment *>malloc(2 * places * sizeof(Segment))
    cdef double *middle = at + places
    cdef double *ceiling = at + 2 * places
    cdef Py_ssize_t *below = which + places
    cdef bint lost = (
        lid_at == NULL or turned == NULL or edge_at == NULL or bottom == NULL or at == NULL
        or which == NULL or picked == NULL
    )
    if not lost:
        lids = lid_edges(stone, reach, lid_at, &left, &right, &top)
        edges = edges_below(corners, first, boxes, left, right, top, edge_at, bottom)
        for i in range(lids):
            at[2 * i], at[2 * i + 1] = lid_at[i].x0, lid_at[i].x1
            turned[i] = lid_at[i]
            turned[i].y0, turned[i].y1 = -lid_at[i].y0, -lid_at[i].y1
        for i in range(edges):
            at[2 * (lids + i)], at[2 * (lids + i) + 1] = edge_at[i].x0, edge_at[i].x1
        slabs = distinct(at, 2 * (lids + edges), left, right) - 1
        for i in range(slabs):
            middle[i] = (at[i] + at[i + 1]) / 2.0
            ceiling[i] = INFINITY
        lost = highest(turned, lids, middle, slabs, ceiling, which)
        for i in range(slabs):
            picked[i] = lid_at[which[i] if which[i] >= 0 else lids - 1]
            ceiling[i] = line(&picked[i], middle[i])
        lost = highest(edge_at, edges, middle, slabs, ceiling, below) or lost
        lost = chained(picked, which, at, slabs, lid) or lost
        for i in range(slabs):
            # Nothing below, or a bottom from inside: the stone stands in something.
            if below[i] < 0 or bottom[below[i]]:
                below[i] = edges + which[i]
            else:
                picked[i] = edge_at[below[i]]
        lost = chained(picked, below, at, slabs, floor) or lost
    free(lid_at)
    free(turned)
    free(edge_at)
    free(bottom)
    free(at)
    free(which)
    free(picked)
    return lost


cdef Py_ssize_t lid_edges(
    const double[:, ::1] stone,
    double reach,
    Segment *out,
    double *left,
    double *right,
    double *top,
) noexcept nogil:
    """List the edges below which the stone ends, and level ones beyond it."""
    cdef Py_ssize_t i, j, count = 0, size = stone.shape[0]
    cdef double low_left = INFINITY, low_right = INFINITY
    cdef double first = stone[0, 0], last = stone[0, 0]
    cdef Segment edge
    top[0] = stone[0, 1]
    for i in range(size):
        first, last = min(first, stone[i, 0]), max(last, stone[i, 0])
        top[0] = max(top[0], stone[i, 1])
    for i in range(size):
        if stone[i, 0] == first:
            low_left = min(low_left, stone[i, 1])
        if stone[i, 0] == last:
            low_right = min(low_right, stone[i, 1])
        j = i + 1 if i + 1 < size else 0
        edge.x0, edge.y0, edge.x1, edge.y1 = stone[i, 0], stone[i, 1], stone[j, 0], stone[j, 1]
        if edge.x1 - edge.x0 > SAME:
            out[count] = edge
            count += 1
    left[0], right[0] = first - reach, last + reach
    edge.x0, edge.y0, edge.x1, edge.y1 = first - reach, low_left, first, low_left
    if edge.x1 - edge.x0 > SAME:
        out[count] = edge
        count += 1
    edge.x0, edge.y0, edge.x1, edge.y1 = last, low_right, last + reach, low_right
    if edge.x1 - edge.x0 > SAME:
        out[count] = edge
        count += 1
    return count


cdef Py_ssize_t edges_below(
    const double[:, ::1] corners,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
    double left,
    double right,
    double top,
    Segment *out,
    bint *bottom,
) noexcept nogil:
    """List the edges of the polygons that are near, and the ground; say which are bottoms."""
    cdef Py_ssize_t k, i, j, one, two, count = 0
    cdef double run
    for k in range(boxes.shape[0]):
        if not (boxes[k, 0] < right and boxes[k, 2] > left and boxes[k, 1] < top):
            continue
        for i in range(first[k], first[k + 1]):
            j = i + 1 if i + 1 < first[k + 1] else first[k]
            run = corners[j, 0] - corners[i, 0]
            if fabs(run) <= SAME:
                continue
            bottom[count] = run > 0.0
            one, two = (i, j) if run > 0.0 else (j, i)
            out[count].x0, out[count].y0 = corners[one, 0], corners[one, 1]
            out[count].x1, out[count].y1 = corners[two, 0], corners[two, 1]
            count += 1
    bottom[count] = False
    out[count].x0, out[count].y0, out[count].x1, out[count].y1 = left, 0.0, right, 0.0
    return count + 1


cdef bint raised(Chain *chain, double clearance, double left, double right) noexcept nogil:
    """Move a chain up and cut it off; say whether there was no memory."""
    cdef Py_ssize_t most = 2 * chain.count, i, j, count = 0, points, slabs, places
    cdef double low, high, before, after
    cdef bint lost = True
    cdef double *at = NULL
    cdef Py_ssize_t *which = NULL
    cdef Segment *picked = NULL
    cdef Segment *edges = <Segment *>malloc(most * sizeof(Segment))
    if edges == NULL:
        return True
    if clearance != 0.0:
        lost = moved(chain, clearance, edges, &count)
    else:
        lost = False
        for i in range(chain.count - 1):
            edges[i].x0, edges[i].y0 = chain.corners[i].x, chain.corners[i].y
            edges[i].x1, edges[i].y1 = chain.corners[i + 1].x, chain.corners[i + 1].y
        count = chain.count - 1
    j = 0
    for i in range(count):
        if edges[i].x1 - edges[i].x0 > SAME:
            edges[j] = edges[i]
            j += 1
    count = j
    if not lost:
        # Two ends each, and at most one crossing of each pair.
        places = 2 * count + count * (count - 1) // 2 + 2
        at = <double *>malloc(3 * places * sizeof(double))
        which = <Py_ssize_t *>malloc(places * sizeof(Py_ssize_t))
        picked = <Segment *>malloc(places * sizeof(Segment))
        lost = at == NULL or which == NULL or picked == NULL
    if not lost:
        points = 0
        for i in range(count):
            at[points], at[points + 1] = edges[i].x0, edges[i].x1
            points += 2
        for i in range(count):
            for j in range(i + 1, count):
                if not (edges[i].x0 < edges[j].x1 and edges[j].x0 < edges[i].x1):
                    continue
                low = edges[i].x0 if edges[i].x0 > edges[j].x0 else edges[j].x0
                high = edges[i].x1 if edges[i].x1 < edges[j].x1 else edges[j].x1
                before = line(&edges[i], low) - line(&edges[j], low)
                after = line(&edges[i], high) - line(&edges[j], high)
                if before * after < 0.0:
                    at[points] = low + (high - low) * (before / (before - after))
                    points += 1
        slabs = distinct(at, points, left, right) - 1
        for i in range(slabs):
            at[places + i] = (at[i] + at[i + 1]) / 2.0
            at[2 * places + i] = INFINITY
        lost = highest(edges, count, at + places, slabs, at + 2 * places, which)
        for i in range(slabs):
            picked[i] = edges[which[i] if which[i] >= 0 else count - 1]
        lost = chained(picked, which, at, slabs, chain) or lost
    free(edges)
    free(at)
    free(which)
    free(picked)
    return lost


cdef bint moved(
    const Chain *chain, double clearance, Segment *out, Py_ssize_t *count
) noexcept nogil:
    """List the edges of a chain moved up and made longer, and those that join them."""
    cdef Py_ssize_t edges = chain.count - 1, i, sharp = 0
    cdef double x, y, sine, cosine, next_x, next_y, before, after
    cdef Segment *joints = <Segment *>malloc(chain.count * sizeof(Segment))
    cdef bint joint = False
    if joints == NULL:
        return True
    before = 0.0
    x = y = 0.0
    for i in range(edges):
        if i == 0:
            direction(chain, 0, &x, &y)
        after = 0.0
        next_x = next_y = 0.0
        joint = False
        if i + 1 < edges:
            direction(chain, i + 1, &next_x, &next_y)
            sine = x * next_y - y * next_x
            cosine = x * next_x + y * next_y
            if sine < 0.0:
                joint = cosine < 0.0
                # The tangent of half the turn.
                after = 1.0 if joint else -sine / (1.0 + cosine)
        out[i].x0 = chain.corners[i].x + clearance * (-y - before * x)
        out[i].y0 = chain.corners[i].y + clearance * (x - before * y)
        out[i].x1 = chain.corners[i + 1].x + clearance * (-y + after * x)
        out[i].y1 = chain.corners[i + 1].y + clearance * (x + after * y)
        if joint:
            joints[sharp].x0, joints[sharp].y0 = out[i].x1, out[i].y1
            joints[sharp].x1 = chain.corners[i + 1].x + clearance * (-next_y - after * next_x)
            joints[sharp].y1 = chain.corners[i + 1].y + clearance * (next_x - after * next_y)
            sharp += 1
        before, x, y = after, next_x, next_y
    for i in range(sharp):
        out[edges + i] = joints[i]
    count[0] = edges + sharp
    free(joints)
    return False


cdef void direction(const Chain *chain, Py_ssize_t i, double *x, double *y) noexcept nogil:
    """Give the unit vector of an edge of a chain."""
    cdef double dx = chain.corners[i + 1].x - chain.corners[i].x
    cdef double dy = chain.corners[i + 1].y - chain.corners[i].y
    cdef double length = sqrt(dx * dx + dy * dy)
    x[0], y[0] = dx / length, dy / length


cdef bint highest(
    const Segment *edges,
    Py_ssize_t count,
    const double *middle,
    Py_ssize_t slabs,
    const double *ceiling,
    Py_ssize_t *found,
) noexcept nogil:
    """Find the highest segment of each slab, not above the ceiling; -1: none."""
    cdef Py_ssize_t i, k
    cdef double y
    cdef double *best = <double *>malloc((slabs + 1) * sizeof(double))
    if best == NULL:
        return True
    for k in range(slabs):
        best[k], found[k] = -INFINITY, -1
    for i in range(count):
        k = from_left(middle, slabs, edges[i].x0)
        while k < slabs and middle[k] < edges[i].x1:
            y = line(&edges[i], middle[k])
            if y <= ceiling[k] and y > best[k]:
                best[k], found[k] = y, i
            k += 1
    free(best)
    return False


cdef Py_ssize_t from_left(const double *sorted_x, Py_ssize_t count, double x) noexcept nogil:
    """Return the first place that is not below a value."""
    cdef Py_ssize_t low = 0, high = count, half
    while low < high:
        half = (low + high) // 2
        if sorted_x[half] < x:
            low = half + 1
        else:
            high = half
    return low


cdef bint chained(
    const Segment *picked, const Py_ssize_t *which, const double *at, Py_ssize_t slabs, Chain *out
) noexcept nogil:
    """Put together the chain of segments that are given for each slab; free what was there."""
    cdef Py_ssize_t i = 0, stop, count = 0
    cdef Corner corner, last
    cdef Corner *corners = <Corner *>malloc(2 * slabs * sizeof(Corner))
    if corners == NULL:
        return True
    while i < slabs:
        stop = i + 1
        while stop < slabs and which[stop] == which[i]:
            stop += 1
        corner.x, corner.y = at[i], line(&picked[i], at[i])
        if i == 0 or fabs(corner.x - last.x) > SAME or fabs(corner.y - last.y) > SAME:
            corners[count] = corner
            count += 1
        last = corner
        corner.x, corner.y = at[stop], line(&picked[i], at[stop])
        if fabs(corner.x - last.x) > SAME or fabs(corner.y - last.y) > SAME:
            corners[count] = corner
            count += 1
        last = corner
        i = stop
    free(out.corners)
    out.corners, out.count = corners, count
    return False


cdef Py_ssize_t distinct(double *x, Py_ssize_t count, double left, double right) noexcept nogil:
    """Put numbers in order between two limits, without those that are the same.

    There is room for two more than are given.
    """
    cdef Py_ssize_t i, inside = 0, kept = 0
    cdef double last = 0.0, value
    for i in range(count):
        if x[i] > left + SAME and x[i] < right - SAME:
            x[inside] = x[i]
            inside += 1
    qsort(x, inside, sizeof(double), in_order)
    for i in range(inside):
        value = x[i]
        if i == 0 or value - last > SAME:
            x[kept] = value
            kept += 1
        last = value
    for i in range(kept, 0, -1):
        x[i] = x[i - 1]
    x[0], x[kept + 1] = left, right
    return kept + 2


cdef int in_order(const void *one, const void *two) noexcept nogil:
    cdef double a = (<const double *>one)[0], b = (<const double *>two)[0]
    return (a > b) - (a < b)


cdef double line(const Segment *edge, double x) noexcept nogil:
    """Return y of a segment at an x."""
    cdef double share = (x - edge.x0) / (edge.x1 - edge.x0)
    return edge.y0 + (edge.y1 - edge.y0) * share
