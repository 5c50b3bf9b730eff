"""Gaps between a polygon and those around it, as constraints of its small motions (DESIGN 4.9).

A gap belongs to a corner of one polygon and an edge, or a corner, of another.  It has a normal
that points towards the moving polygon, and a motion that takes the corner along the normal by
minus the gap makes the two touch.  Where two corners are near each other the face that parts
them best gives the normal, so that bricks meet with their faces.
"""

from __future__ import annotations

from typing import NamedTuple

from drystone.kernels.polygons import Points, Polygons

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from math import sqrt

    from drystone.kernels.lists import (
        doubles,
        ints,
        more_doubles,
        more_longs,
        new_doubles,
        new_longs,
        release,
    )

GROUND, END = -1, -2
GROUND_BELOW = cython.declare(cython.double, GROUND)
WALL_END = cython.declare(cython.double, END)

# A little more than 1, for what rounding makes of distances.
FARTHER = cython.declare(cython.double, 1.0 + 1e-9)

SAME = cython.declare(cython.double, 1e-9)
INTO = cython.declare(cython.double, 0.03)


class Gap(NamedTuple):
    """One gap."""

    gap: float  # along the normal; below 0 where the corner lies inside
    normal_x: float  # unit vector towards the moving polygon
    normal_y: float
    x: float  # the corner; of two corners, that of the moving polygon
    y: float
    away: float  # distance; more than the gap only where two corners meet with a face
    other: int  # number of the other polygon, or `GROUND`, or `END` for an end of the wall


def gaps_around(
    corners: Points,
    edges: Points,
    around: Polygons,
    width: float,
    reach: float,
    corner: float,
    beyond: float = 0.0,
) -> list[Gap]:
    """List the gaps, at most as wide or deep as the reach, to others, the ground, the wall's ends.

    Edges are (unit vector x, y, length); those without length are left out.  Two corners nearer
    than `corner` meet with a face.  The polygon may stand out over the ends by `beyond`.
    """
    stone: MovingStone = stone_of(corners, edges)
    heap: Heap = heap_of(around, width)
    heap.beyond = beyond
    find_gaps(stone, heap, reach, corner)
    found = [stone.gaps[i] for i in range(7 * stone.found)]
    rows = zip(*[iter(found)] * 7, strict=True)
    return [Gap(d, nx, ny, x, y, away, int(k)) for d, nx, ny, x, y, away, k in rows]


def crosses_any(corners: Points, around: Polygons) -> bool:
    """Say whether edges of a polygon cross those of others, or one lies in another.

    Quick, for outlines that keep a clearance: no overlap is missed, and outlines that only touch
    may count.  Where they may touch, ask :mod:`drystone.model.overlap`.
    """
    stone: MovingStone = stone_of(corners, corners)
    return bool(crosses(stone, heap_of(around, 0.0)))


@cython.cclass
class Body:
    """A polygon: so many corners from the first one on, their edges, and the box around them."""


@cython.cclass
class Heap(Body):
    """Polygons, one of which at a time is the body, and the wall that they stand in."""


@cython.cclass
class MovingStone(Body):
    """A polygon with its centroid that moves, and the gaps around it, seven numbers each.

    It has room for numbers of edges that are near, and for the linear programs of its motions.
    Each gap has two rows in these at most.
    """

    def __init__(self) -> None:
        self.room = self.near_room = 64
        self.gaps, self.near = new_doubles(7 * self.room), new_longs(self.near_room)
        self.spans = new_doubles(2 * self.near_room)
        self.rows, self.scratch = new_doubles(8 * self.room), new_doubles(6 * self.room + 6)

    def __dealloc__(self) -> None:
        release(self.gaps)
        release(self.near)
        release(self.spans)
        release(self.rows)
        release(self.scratch)


def heap_of(around, width):
    """Return polygons, whose arrays it keeps."""
    heap: Heap = Heap()
    heap.kept = list(around)
    heap.corners, heap.edges = doubles(around.corners), doubles(around.edges)
    heap.size, heap.starts, heap.boxes = len(around), ints(around.first), doubles(around.boxes)
    heap.width, heap.beyond = width, 0.0
    return heap


def stone_of(corners, edges):
    """Return a polygon without gaps, whose arrays it keeps."""
    stone: MovingStone = MovingStone()
    stone.kept = [corners, edges]
    stone.corners, stone.edges = doubles(corners), doubles(edges)
    stone.first, stone.count, stone.found = 0, len(corners), 0
    measure(stone)
    return stone


def measure(body):
    """Fill in the box of a body."""
    body.left = body.right = body.corners[2 * body.first]
    body.low = body.high = body.corners[2 * body.first + 1]
    for i in range(body.first + 1, body.first + body.count):
        x, y = body.corners[2 * i], body.corners[2 * i + 1]
        body.left = min(body.left, x)
        body.right = max(body.right, x)
        body.low = min(body.low, y)
        body.high = max(body.high, y)


def select(heap, i):
    """Make one polygon of a heap its body."""
    heap.first = heap.starts[i]
    heap.count = heap.starts[i + 1] - heap.first
    heap.left, heap.low = heap.boxes[4 * i], heap.boxes[4 * i + 1]
    heap.right, heap.high = heap.boxes[4 * i + 2], heap.boxes[4 * i + 3]


def find_gaps(stone, heap, reach, corner):
    """List the gaps of a stone to a heap, the ground and the ends of the wall."""
    stone.found = 0
    for i in range(heap.size):
        if stone.left > heap.boxes[4 * i + 2] + reach or stone.right < heap.boxes[4 * i] - reach:
            continue
        if stone.low > heap.boxes[4 * i + 3] + reach or stone.high < heap.boxes[4 * i + 1] - reach:
            continue
        select(heap, i)
        one_way(stone, heap, stone, reach, corner, 1.0, i)
        one_way(heap, stone, stone, reach, corner, -1.0, i)
    if stone.low < reach:
        to_line(stone, 0.0, 0.0, 1.0, 0.0, reach, GROUND_BELOW)
    if stone.left + heap.beyond < reach:
        to_line(stone, 0.0, 1.0, 0.0, heap.beyond, reach, WALL_END)
    if heap.width - stone.right + heap.beyond < reach:
        to_line(stone, heap.width, -1.0, 0.0, heap.beyond, reach, WALL_END)
    return 0


def to_line(stone, start, nx, ny, beyond, reach, other):
    """List the gaps of a stone's corners to the ground, or to an end of the wall."""
    for i in range(stone.count):
        x, y = stone.corners[2 * i], stone.corners[2 * i + 1]
        room = start + (nx * x + ny * y) + beyond
        if room < reach:
            keep(stone, room, nx, ny, x, y, room, other)
    return 0


def keep(stone, gap, nx, ny, x, y, away, other):
    """Add a gap to the list."""
    k: cython.Py_ssize_t = 7 * stone.found
    if stone.found == stone.room:
        stone.room *= 2
        stone.gaps = more_doubles(stone.gaps, 7 * stone.room)
        stone.rows = more_doubles(stone.rows, 8 * stone.room)
        stone.scratch = more_doubles(stone.scratch, 6 * stone.room + 6)
    stone.gaps[k], stone.gaps[k + 1], stone.gaps[k + 2] = gap, nx, ny
    stone.gaps[k + 3], stone.gaps[k + 4] = x, y
    stone.gaps[k + 5], stone.gaps[k + 6] = away, other
    stone.found += 1
    return 0


def room_for(stone, count):
    """Make room for the numbers of edges that are near, and from where to where they reach."""
    if count > stone.near_room:
        stone.near = more_longs(stone.near, 2 * count)
        stone.spans = more_doubles(stone.spans, 4 * count)
        stone.near_room = 2 * count
    return 0


def one_way(a, b, out, reach, corner, sign, other):
    """List the gaps of the corners of one polygon to the edges and corners of another."""
    left: cython.double = max(a.left, b.left) - reach
    low: cython.double = max(a.low, b.low) - reach
    right: cython.double = min(a.right, b.right) + reach
    high: cython.double = min(a.high, b.high) + reach
    near: cython.Py_ssize_t = 0
    inside: cython.int
    nearest: cython.Py_ssize_t = 0
    ca: cython.p_double = a.corners
    cb: cython.p_double = b.corners
    edges: cython.p_double = b.edges
    spans: cython.p_double
    beside: cython.double = FARTHER * reach
    # Edges are far from most corners along the longer side of where both polygons are.
    axis: cython.Py_ssize_t = 0 if right - left > high - low else 1
    if left > right or low > high:
        return 0
    room_for(out, b.count)
    spans = out.spans
    for i in range(b.count):
        if meets(b, i, left, low, right, high):
            start = cb[2 * (b.first + i) + axis]
            end = cb[2 * (b.first + i + 1 if i + 1 < b.count else b.first) + axis]
            spans[2 * near] = min(start, end) - beside
            spans[2 * near + 1] = max(start, end) + beside
            out.near[near] = b.first + i
            near += 1
    if not near:
        return 0
    for i in range(a.first, a.first + a.count):
        vx, vy = ca[2 * i], ca[2 * i + 1]
        if vx < left or vx > right or vy < low or vy > high:
            continue
        inside, deep = -1, 0.0
        place = vy if axis else vx
        for j in range(near):
            if spans[2 * j] > place or spans[2 * j + 1] < place:
                continue
            e = out.near[j]
            dx, dy = vx - cb[2 * e], vy - cb[2 * e + 1]
            # The outward normal of an edge along u is (u_y, -u_x); edges without length have none.
            s = dx * edges[3 * e + 1] - dy * edges[3 * e]
            if not (-reach <= s <= reach):
                continue
            t = dx * edges[3 * e] + dy * edges[3 * e + 1]
            if t > edges[3 * e + 2]:
                continue
            if t < 0.0:
                # A corner farther before an edge than `reach` has no gap to the edge's start.
                if t >= -beside and at_corner(a, b, i, e, reach, corner, sign, other, out):
                    inside = 3
                continue
            if s >= -SAME:
                keep(out, s, sign * edges[3 * e + 1], -sign * edges[3 * e], vx, vy, s, other)
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
            dx, dy = sign * edges[3 * nearest + 1], -sign * edges[3 * nearest]
            keep(out, deep, dx, dy, vx, vy, deep, other)
    return 0


def at_corner(a, b, i, e, reach, corner, sign, other, out):
    """List the gap of a corner before an edge's start to that start, if it lies in its region.

    Returns whether it is the same point.
    """
    vx: cython.double = a.corners[2 * i]
    vy: cython.double = a.corners[2 * i + 1]
    dx: cython.double = vx - b.corners[2 * e]
    dy: cython.double = vy - b.corners[2 * e + 1]
    p: cython.Py_ssize_t = edge_before(b, e)
    edges: cython.p_double = b.edges
    face: cython.double[2] = [0.0, 0.0]
    # Is it beyond the end of the edge before as well?
    ex: cython.double = vx - b.corners[2 * p]
    ey: cython.double = vy - b.corners[2 * p + 1]
    if not ex * edges[3 * p] + ey * edges[3 * p + 1] > edges[3 * p + 2]:
        return False
    s = dx * edges[3 * e + 1] - dy * edges[3 * e]
    sp = ex * edges[3 * p + 1] - ey * edges[3 * p]
    d = sqrt(dx * dx + dy * dy)
    if d > reach or (s < 0.0 and sp < 0.0):
        return False
    if sign < 0.0:
        # Either way the force acts on the moving polygon's corner.
        vx, vy = b.corners[2 * e], b.corners[2 * e + 1]
    if d < corner and face_between(a, b, i, e, face):
        nx, ny = face[0], face[1]
        keep(out, dx * nx + dy * ny, sign * nx, sign * ny, vx, vy, d, other)
    elif d > SAME:
        keep(out, d, sign * (dx / d), sign * (dy / d), vx, vy, d, other)
    else:
        nx = edges[3 * e + 1] + edges[3 * p + 1]
        ny = -edges[3 * e] - edges[3 * p]
        s = sqrt(nx * nx + ny * ny)
        if s > SAME:
            keep(out, 0.0, sign * (nx / s), sign * (ny / s), vx, vy, 0.0, other)
    return d <= SAME


def edge_before(b, e):
    """Return the edge before one, past those without length."""
    p: cython.Py_ssize_t = e
    for i in range(b.count):  # noqa: B007 - typed
        p = p - 1 if p > b.first else b.first + b.count - 1
        if b.edges[3 * p + 2] > 0.0:
            break
    return p


def face_between(a, b, i, e, face):
    """Find the face that parts two corners best: its normal, out of b; False when none does."""
    before_a: cython.Py_ssize_t = edge_before(a, i)
    before_b: cython.Py_ssize_t = edge_before(b, e)
    dx: cython.double = a.corners[2 * i] - b.corners[2 * e]
    dy: cython.double = a.corners[2 * i + 1] - b.corners[2 * e + 1]
    best: cython.double = -SAME
    for k in range(4):
        if k < 2:
            p = before_b if k == 0 else e
            mx, my = b.edges[3 * p + 1], -b.edges[3 * p]
        else:
            p = before_a if k == 2 else i
            mx, my = -a.edges[3 * p + 1], a.edges[3 * p]
        # The two edges at either corner must not run through the face.
        if not (-along(a, before_a, mx, my) >= -INTO and along(a, i, mx, my) >= -INTO):
            continue
        if not (-along(b, before_b, mx, my) <= INTO and along(b, e, mx, my) <= INTO):
            continue
        s = dx * mx + dy * my
        if s > best:
            best, face[0], face[1] = s, mx, my
    return best > -SAME


def along(a, e, mx, my):
    """Return the share of an edge's direction that runs along a normal."""
    return a.edges[3 * e] * mx + a.edges[3 * e + 1] * my


def contains(body, x, y):
    """Say whether a point lies in a polygon (even-odd rule)."""
    j: cython.Py_ssize_t = body.first + body.count - 1
    inside: cython.bint = False
    for i in range(body.first, body.first + body.count):
        ax, ay = body.corners[2 * i], body.corners[2 * i + 1]
        bx, by = body.corners[2 * j], body.corners[2 * j + 1]
        if (ay > y) != (by > y) and x < (bx - ax) * (y - ay) / (by - ay) + ax:
            inside = not inside
        j = i
    return inside


def crosses(stone, heap):
    """Say whether a stone lies over any polygon of a heap."""
    for i in range(heap.size):
        select(heap, i)
        if over(stone, heap):
            return True
    return False


def over(a, b):
    """Say whether edges of two polygons cross, or one lies in the other."""
    near: cython.Py_ssize_t = 0
    last: cython.Py_ssize_t = b.first + b.count - 1
    if a.left > b.right or a.right < b.left or a.low > b.high or a.high < b.low:
        return False
    left: cython.double = max(a.left, b.left)
    low: cython.double = max(a.low, b.low)
    right: cython.double = min(a.right, b.right)
    high: cython.double = min(a.high, b.high)
    room_for(a, b.count)
    for i in range(b.count):
        if meets(b, i, left, low, right, high):
            a.near[near] = b.first + i
            near += 1
    for i in range(a.count):
        if not meets(a, i, left, low, right, high):
            continue
        j = i + 1 if i + 1 < a.count else 0
        for k in range(near):
            e = a.near[k]
            f = e + 1 if e < last else b.first
            if cut(a.corners, i, j, b.corners, e, f):
                return True
    if contains(b, a.corners[0], a.corners[1]):
        return True
    return contains(a, b.corners[2 * b.first], b.corners[2 * b.first + 1])


@cython.cfunc
@cython.nogil
@cython.inline
@cython.exceptval(check=False)
def meets(
    body: Body,
    i: cython.Py_ssize_t,
    left: cython.double,
    low: cython.double,
    right: cython.double,
    high: cython.double,
) -> cython.bint:
    """Say whether the box of an edge meets another box."""
    e: cython.Py_ssize_t = 2 * (body.first + i)
    f: cython.Py_ssize_t = e + 2 if i + 1 < body.count else 2 * body.first
    corners: cython.p_double = body.corners
    if max(corners[e], corners[f]) < left or min(corners[e], corners[f]) > right:
        return False
    e, f = e + 1, f + 1
    return not (max(corners[e], corners[f]) < low or min(corners[e], corners[f]) > high)


def cut(one, a, b, two, c, d):
    """Say whether two segments cross: from a to b of one polygon, from c to d of another."""
    if (side(one, a, b, two, c) > 0.0) == (side(one, a, b, two, d) > 0.0):
        return False
    return (side(two, c, d, one, a) > 0.0) != (side(two, c, d, one, b) > 0.0)


@cython.cfunc
@cython.nogil
@cython.inline
@cython.exceptval(check=False)
def side(
    one: cython.p_double,
    a: cython.Py_ssize_t,
    b: cython.Py_ssize_t,
    two: cython.p_double,
    c: cython.Py_ssize_t,
) -> cython.double:
    """Return twice the area of a triangle, positive when it is counter-clockwise."""
    x: cython.double = one[2 * a]
    y: cython.double = one[2 * a + 1]
    return (one[2 * b] - x) * (two[2 * c + 1] - y) - (one[2 * b + 1] - y) * (two[2 * c] - x)
