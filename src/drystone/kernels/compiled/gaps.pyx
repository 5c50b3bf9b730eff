# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.gaps`."""

from libc.math cimport sqrt
from libc.stdint cimport int32_t
from libc.stdlib cimport free, realloc

import numpy as np

GROUND, END = -1, -2

cdef double SAME = 1e-9
cdef double INTO = 0.03


def gaps_around(
    const double[:, ::1] corners,
    const double[:, ::1] edges,
    const double[:, ::1] around,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
    const double[:, ::1] around_edges,
    double width,
    double reach,
    double corner,
):
    """Return what `gaps_python` returns, as an array of rows."""
    cdef Body body
    cdef Heap heap = heap_of(around, first, boxes, around_edges, width)
    cdef Gaps found
    cdef Py_ssize_t i
    body.count = corners.shape[0]
    body.corners, body.edges = &corners[0, 0], &edges[0, 0]
    measure(&body)
    init_gaps(&found)
    with nogil:
        find_gaps(&body, &heap, reach, corner, &found)
    if found.lost:
        free_gaps(&found)
        raise MemoryError
    rows = np.empty((found.count, 7))
    cdef double[:, ::1] view = rows
    for i in range(found.count):
        view[i, 0], view[i, 1] = found.items[i].gap, found.items[i].normal[0]
        view[i, 2], view[i, 3] = found.items[i].normal[1], found.items[i].point[0]
        view[i, 4], view[i, 5] = found.items[i].point[1], found.items[i].away
        view[i, 6] = found.items[i].other
    free_gaps(&found)
    return rows


def crosses_any(
    const double[:, ::1] corners,
    const double[:, ::1] around,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
):
    """Return what `crosses_any_python` returns."""
    cdef Body body
    cdef Heap heap
    cdef Gaps scratch
    cdef bint hit
    body.count, body.corners, body.edges = corners.shape[0], &corners[0, 0], NULL
    measure(&body)
    heap.count = boxes.shape[0]
    if not heap.count:
        return False
    heap.corners, heap.first, heap.boxes, heap.edges = &around[0, 0], &first[0], &boxes[0, 0], NULL
    init_gaps(&scratch)
    with nogil:
        hit = crosses(&body, &heap, &scratch)
    if scratch.lost:
        free_gaps(&scratch)
        raise MemoryError
    free_gaps(&scratch)
    return hit


cdef Heap heap_of(
    const double[:, ::1] corners,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
    const double[:, ::1] edges,
    double width,
):
    """Return the polygons of some arrays, which have to outlive it."""
    cdef Heap heap
    heap.count, heap.first, heap.width, heap.beyond = boxes.shape[0], &first[0], width, 0.0
    heap.corners = heap.boxes = heap.edges = NULL
    if heap.count:
        heap.corners, heap.boxes, heap.edges = &corners[0, 0], &boxes[0, 0], &edges[0, 0]
    return heap


cdef void measure(Body *body) noexcept nogil:
    """Fill in the box of a body."""
    cdef Py_ssize_t i
    cdef double x, y
    body.box[0] = body.box[2] = body.corners[0]
    body.box[1] = body.box[3] = body.corners[1]
    for i in range(1, body.count):
        x, y = body.corners[2 * i], body.corners[2 * i + 1]
        if x < body.box[0]:
            body.box[0] = x
        if x > body.box[2]:
            body.box[2] = x
        if y < body.box[1]:
            body.box[1] = y
        if y > body.box[3]:
            body.box[3] = y


cdef void init_gaps(Gaps *gaps) noexcept nogil:
    gaps.items, gaps.count, gaps.room = NULL, 0, 0
    gaps.near, gaps.near_room, gaps.lost = NULL, 0, False


cdef void free_gaps(Gaps *gaps) noexcept nogil:
    free(gaps.items)
    free(gaps.near)


cdef Body body_of(const Heap *heap, Py_ssize_t index) noexcept nogil:
    """Return one polygon of a heap."""
    cdef Body body
    cdef Py_ssize_t first = heap.first[index], k
    body.count = heap.first[index + 1] - first
    body.corners = heap.corners + 2 * first
    body.edges = heap.edges + 3 * first if heap.edges != NULL else NULL
    for k in range(4):
        body.box[k] = heap.boxes[4 * index + k]
    return body


cdef void find_gaps(
    const Body *body, const Heap *heap, double reach, double corner, Gaps *out
) noexcept nogil:
    """List the gaps of a body to a heap, the ground and the ends of the wall."""
    cdef Py_ssize_t i
    cdef const double *box
    cdef Body other
    cdef double x, y, room
    out.count = 0
    for i in range(heap.count):
        box = heap.boxes + 4 * i
        if body.box[0] > box[2] + reach or body.box[2] < box[0] - reach:
            continue
        if body.box[1] > box[3] + reach or body.box[3] < box[1] - reach:
            continue
        other = body_of(heap, i)
        one_way(body, &other, reach, corner, 1.0, <int32_t>i, out)
        one_way(&other, body, reach, corner, -1.0, <int32_t>i, out)
    if body.box[1] < reach:
        for i in range(body.count):
            x, y = body.corners[2 * i], body.corners[2 * i + 1]
            if y < reach:
                keep(out, y, 0.0, 1.0, x, y, y, -1)
    if body.box[0] + heap.beyond < reach:
        for i in range(body.count):
            x, y = body.corners[2 * i], body.corners[2 * i + 1]
            room = x + heap.beyond
            if room < reach:
                keep(out, room, 1.0, 0.0, x, y, room, -2)
    if heap.width - body.box[2] + heap.beyond < reach:
        for i in range(body.count):
            x, y = body.corners[2 * i], body.corners[2 * i + 1]
            room = heap.width - x + heap.beyond
            if room < reach:
                keep(out, room, -1.0, 0.0, x, y, room, -2)


cdef bint room_for(Gaps *out, Py_ssize_t count) noexcept nogil:
    """Make room for the numbers of edges that are near."""
    cdef void *more
    if count <= out.near_room:
        return True
    more = realloc(out.near, 2 * count * sizeof(int32_t))
    if more == NULL:
        out.lost = True
        return False
    out.near, out.near_room = <int32_t *>more, 2 * count
    return True


cdef void keep(
    Gaps *out, double gap, double nx, double ny, double x, double y, double away, int32_t other
) noexcept nogil:
    """Add a gap to the list."""
    cdef void *more
    cdef Py_ssize_t room
    if out.count == out.room:
        room = 2 * out.room + 64
        more = realloc(out.items, room * sizeof(Gap))
        if more == NULL:
            out.lost = True
            return
        out.items, out.room = <Gap *>more, room
    cdef Gap *item = out.items + out.count
    item.gap, item.other = gap, other
    item.normal[0], item.normal[1] = nx, ny
    item.point[0], item.point[1] = x, y
    item.away = away
    out.count += 1


cdef void one_way(
    const Body *a, const Body *b, double reach, double corner, double sign, int32_t other, Gaps *out
) noexcept nogil:
    """List the gaps of the corners of one polygon to the edges and corners of another."""
    cdef double left = (b.box[0] if b.box[0] > a.box[0] else a.box[0]) - reach
    cdef double low = (b.box[1] if b.box[1] > a.box[1] else a.box[1]) - reach
    cdef double right = (b.box[2] if b.box[2] < a.box[2] else a.box[2]) + reach
    cdef double high = (b.box[3] if b.box[3] < a.box[3] else a.box[3]) + reach
    cdef Py_ssize_t i, j, e, f, near = 0, nearest = 0
    cdef double vx, vy, dx, dy, s, t, deep
    cdef int inside
    if left > right or low > high or not room_for(out, b.count):
        return
    for e in range(b.count):
        f = e + 1 if e + 1 < b.count else 0
        if max(b.corners[2 * e], b.corners[2 * f]) < left:
            continue
        if min(b.corners[2 * e], b.corners[2 * f]) > right:
            continue
        if max(b.corners[2 * e + 1], b.corners[2 * f + 1]) < low:
            continue
        if min(b.corners[2 * e + 1], b.corners[2 * f + 1]) > high:
            continue
        out.near[near] = <int32_t>e
        near += 1
    if not near:
        return
    for i in range(a.count):
        vx, vy = a.corners[2 * i], a.corners[2 * i + 1]
        if vx < left or vx > right or vy < low or vy > high:
            continue
        inside, deep = -1, 0.0
        for j in range(near):
            e = out.near[j]
            dx, dy = vx - b.corners[2 * e], vy - b.corners[2 * e + 1]
            # The outward normal of an edge along u is (u_y, -u_x); edges without length have none.
            s = dx * b.edges[3 * e + 1] - dy * b.edges[3 * e]
            if not (-reach <= s <= reach):
                continue
            t = dx * b.edges[3 * e] + dy * b.edges[3 * e + 1]
            if t > b.edges[3 * e + 2]:
                continue
            if t < 0.0:
                if at_corner(a, b, i, e, reach, corner, sign, other, out):
                    inside = 3
                continue
            if s >= -SAME:
                keep(out, s, sign * b.edges[3 * e + 1], -sign * b.edges[3 * e], vx, vy, s, other)
                if s <= SAME:
                    inside = 3
                continue
            # Inside (1), or only behind (0)?  Of the edges it is inside of, the nearest counts (2),
            # unless it lies on one (3), where rounding says whether it is inside.
            if inside < 0:
                inside = contains(b, vx, vy)
            if inside == 1 or (inside == 2 and s > deep):
                deep, nearest, inside = s, e, 2
        if inside == 2:
            dx, dy = sign * b.edges[3 * nearest + 1], -sign * b.edges[3 * nearest]
            keep(out, deep, dx, dy, vx, vy, deep, other)


cdef bint at_corner(
    const Body *a,
    const Body *b,
    Py_ssize_t i,
    Py_ssize_t e,
    double reach,
    double corner,
    double sign,
    int32_t other,
    Gaps *out,
) noexcept nogil:
    """List the gap of a corner before an edge's start to that start, if it lies in its region.

    Returns whether it is the same point.
    """
    cdef double vx = a.corners[2 * i], vy = a.corners[2 * i + 1], ex, ey, s, sp, d, nx, ny
    cdef double dx = vx - b.corners[2 * e], dy = vy - b.corners[2 * e + 1]
    cdef Py_ssize_t p = edge_before(b, e)
    # Is it beyond the end of the edge before as well?
    ex, ey = vx - b.corners[2 * p], vy - b.corners[2 * p + 1]
    if not ex * b.edges[3 * p] + ey * b.edges[3 * p + 1] > b.edges[3 * p + 2]:
        return False
    s = dx * b.edges[3 * e + 1] - dy * b.edges[3 * e]
    sp = ex * b.edges[3 * p + 1] - ey * b.edges[3 * p]
    d = sqrt(dx * dx + dy * dy)
    if d > reach or (s < 0.0 and sp < 0.0):
        return False
    if sign < 0.0:
        # Either way the force acts on the moving polygon's corner.
        vx, vy = b.corners[2 * e], b.corners[2 * e + 1]
    if d < corner and face_between(a, b, i, e, &nx, &ny):
        keep(out, dx * nx + dy * ny, sign * nx, sign * ny, vx, vy, d, other)
    elif d > SAME:
        keep(out, d, sign * (dx / d), sign * (dy / d), vx, vy, d, other)
    else:
        nx = b.edges[3 * e + 1] + b.edges[3 * p + 1]
        ny = -b.edges[3 * e] - b.edges[3 * p]
        s = sqrt(nx * nx + ny * ny)
        if s > SAME:
            keep(out, 0.0, sign * (nx / s), sign * (ny / s), vx, vy, 0.0, other)
    return d <= SAME


cdef Py_ssize_t edge_before(const Body *b, Py_ssize_t e) noexcept nogil:
    """Return the edge before one, past those without length."""
    cdef Py_ssize_t i, p = e
    for i in range(b.count):
        p = p - 1 if p else b.count - 1
        if b.edges[3 * p + 2] > 0.0:
            break
    return p


cdef bint face_between(
    const Body *a, const Body *b, Py_ssize_t i, Py_ssize_t e, double *nx, double *ny
) noexcept nogil:
    """Find the face that parts two corners best: its normal, out of b; False when none does."""
    cdef Py_ssize_t before_a = edge_before(a, i), before_b = edge_before(b, e)
    cdef double dx = a.corners[2 * i] - b.corners[2 * e]
    cdef double dy = a.corners[2 * i + 1] - b.corners[2 * e + 1]
    cdef const double *edge
    cdef double mx, my, s, best = -SAME
    cdef int k
    nx[0] = ny[0] = 0.0
    for k in range(4):
        if k < 2:
            edge = b.edges + 3 * (before_b if k == 0 else e)
            mx, my = edge[1], -edge[0]
        else:
            edge = a.edges + 3 * (before_a if k == 2 else i)
            mx, my = -edge[1], edge[0]
        # The two edges at either corner must not run through the face.
        if not (-along(a, before_a, mx, my) >= -INTO and along(a, i, mx, my) >= -INTO):
            continue
        if not (-along(b, before_b, mx, my) <= INTO and along(b, e, mx, my) <= INTO):
            continue
        s = dx * mx + dy * my
        if s > best:
            best, nx[0], ny[0] = s, mx, my
    return best > -SAME


cdef double along(const Body *a, Py_ssize_t e, double mx, double my) noexcept nogil:
    """Return the share of an edge's direction that runs along a normal."""
    return a.edges[3 * e] * mx + a.edges[3 * e + 1] * my


cdef bint contains(const Body *body, double x, double y) noexcept nogil:
    """Say whether a point lies in a polygon (even-odd rule)."""
    cdef Py_ssize_t i, j = body.count - 1
    cdef double ax, ay, bx, by
    cdef bint inside = False
    for i in range(body.count):
        ax, ay = body.corners[2 * i], body.corners[2 * i + 1]
        bx, by = body.corners[2 * j], body.corners[2 * j + 1]
        if (ay > y) != (by > y) and x < (bx - ax) * (y - ay) / (by - ay) + ax:
            inside = not inside
        j = i
    return inside


cdef bint crosses(const Body *body, const Heap *heap, Gaps *scratch) noexcept nogil:
    """Say whether a body lies over any polygon of a heap."""
    cdef Py_ssize_t i
    cdef Body other
    for i in range(heap.count):
        other = body_of(heap, i)
        if over(body, &other, scratch):
            return True
    return False


cdef bint over(const Body *a, const Body *b, Gaps *scratch) noexcept nogil:
    """Say whether edges of two polygons cross, or one lies in the other."""
    cdef double left, low, right, high
    cdef Py_ssize_t i, j, k, e, f, near = 0
    if a.box[0] > b.box[2] or a.box[2] < b.box[0] or a.box[1] > b.box[3] or a.box[3] < b.box[1]:
        return False
    left, low = max(a.box[0], b.box[0]), max(a.box[1], b.box[1])
    right, high = min(a.box[2], b.box[2]), min(a.box[3], b.box[3])
    if not room_for(scratch, b.count):
        return True
    for e in range(b.count):
        if meets(b, e, left, low, right, high):
            scratch.near[near] = <int32_t>e
            near += 1
    for i in range(a.count):
        if not meets(a, i, left, low, right, high):
            continue
        j = i + 1 if i + 1 < a.count else 0
        for k in range(near):
            e = scratch.near[k]
            f = e + 1 if e + 1 < b.count else 0
            if cut(a.corners + 2 * i, a.corners + 2 * j, b.corners + 2 * e, b.corners + 2 * f):
                return True
    return contains(b, a.corners[0], a.corners[1]) or contains(a, b.corners[0], b.corners[1])


cdef bint meets(
    const Body *body, Py_ssize_t e, double left, double low, double right, double high
) noexcept nogil:
    """Say whether the box of an edge meets another box."""
    cdef Py_ssize_t f = e + 1 if e + 1 < body.count else 0
    cdef double ax = body.corners[2 * e], ay = body.corners[2 * e + 1]
    cdef double bx = body.corners[2 * f], by = body.corners[2 * f + 1]
    if max(ax, bx) < left or min(ax, bx) > right:
        return False
    return not (max(ay, by) < low or min(ay, by) > high)


cdef bint cut(const double *a, const double *b, const double *c, const double *d) noexcept nogil:
    """Say whether two segments cross."""
    if (side(a, b, c) > 0.0) == (side(a, b, d) > 0.0):
        return False
    return (side(c, d, a) > 0.0) != (side(c, d, b) > 0.0)


cdef double side(const double *a, const double *b, const double *c) noexcept nogil:
    """Return twice the area of a triangle, positive when it is counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
