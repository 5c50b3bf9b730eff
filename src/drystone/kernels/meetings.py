"""Where one placed polygon meets others and the ground: straight pieces and points (§4.1).

Two edges that face each other, parallel or nearly so, meet along the piece on which the gap
between them is small: at its two ends.  Any other contact is that of a corner on an edge, or of a
corner on a corner.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.polygons import Points, Polygons

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from math import sqrt

    from drystone.kernels.lists import (
        doubles,
        doubles_out,
        ints,
        ints_out,
        kept_doubles,
        kept_ints,
        more_doubles,
        new_doubles,
        release,
    )

# Edges that face each other may lean by so much (tangent) and still touch along a piece.
LEAN = cython.declare(cython.double, 0.05)

# Cosine above which normals of contacts at one place are those of one contact.
SAME = cython.declare(cython.double, 0.995)

# Nothing that is further away than so many tolerances has to do with a contact.
BESIDE = cython.declare(cython.double, 1.5)

# Faces separate corners equally when they do to this share of the tolerance.
EQUAL = cython.declare(cython.double, 0.01)

# How much more level, by the cosine, a face must be to be preferred.
LEVEL = cython.declare(cython.double, 1e-6)

# A face ends where the outline has turned away from it by more than 30 degrees (tangent).
SHARP = cython.declare(cython.double, 0.577)

# The numbers of a contact: edge, how far along it, number of points, x and y of both points,
# normal into the polygon, edge and index of the other polygon.
EDGE = cython.declare(cython.Py_ssize_t, 0)
START = cython.declare(cython.Py_ssize_t, 1)
COUNT = cython.declare(cython.Py_ssize_t, 2)
X0 = cython.declare(cython.Py_ssize_t, 3)
Y0 = cython.declare(cython.Py_ssize_t, 4)
X1 = cython.declare(cython.Py_ssize_t, 5)
Y1 = cython.declare(cython.Py_ssize_t, 6)
NORMAL_X = cython.declare(cython.Py_ssize_t, 7)
NORMAL_Y = cython.declare(cython.Py_ssize_t, 8)
FACING = cython.declare(cython.Py_ssize_t, 9)
OTHER = cython.declare(cython.Py_ssize_t, 10)
NUMBERS = cython.declare(cython.Py_ssize_t, 11)

# What :func:`common` finds.
LOW = cython.declare(cython.Py_ssize_t, 0)
HIGH = cython.declare(cython.Py_ssize_t, 1)
FIRST = cython.declare(cython.Py_ssize_t, 2)
LAST = cython.declare(cython.Py_ssize_t, 3)
INSIDE = cython.declare(cython.Py_ssize_t, 4)
SLOPE = cython.declare(cython.Py_ssize_t, 5)


class Meetings(NamedTuple):
    """Contacts of one polygon, ordered by the other one, then along the polygon."""

    # (k,) index of the other polygon of each contact; -1 for the ground, which comes first
    others: NDArray[np.int32]
    counts: NDArray[np.int32]  # (k,) number of points, 1 or 2
    # (k, 2, 2) (x, y) of both, on the boundary of the polygon; twice the same for a contact
    # at a point
    points: Points
    normals: Points  # (k, 2) unit vectors into the polygon


def meetings(corners: Points, around: Polygons, tolerance: float, setback: float = 0.0) -> Meetings:
    """Find all contacts of one placed polygon with others and with the ground, y = 0.

    It is simple, counter-clockwise, without a corner twice in a row.  Up to the tolerance a gap or
    an overlap is a contact; edges are longer as a rule.

    Edges that face each other at an angle of less than 2.9 degrees (a tangent of .05) touch on the
    part where the gap is within reach, as long as both run beside each other for more than the
    tolerance.  Reach is the tolerance for parallel edges and less the more they lean, nothing at
    2.9 degrees: from one stone to the next the part shrinks to the corner that is nearest, without
    a jump.  At larger angles only this corner touches.

    A corner of one that is beside an edge of the other touches where both sides of the corner lead
    away from the edge.  Corners beside each other touch on the face that separates them most, of
    the two at each corner; where none keeps them apart they do not.  Where faces separate them
    equally, which is common where four joints meet, it is the most level one.

    The normal is that of the edge that a corner stands on; for a piece, at the end with the smaller
    gap.

    Edges of stones are rounded, break and crush.  So with a set-back, a share of the root of the
    area of the smaller polygon and the tolerance at least, a piece stays away from the ends of both
    faces, and a point counts only where one of them goes on to both sides of it: a corner on a
    corner, or a lap of less than twice the set-back, carries nothing.
    """
    corners = np.ascontiguousarray(corners, np.float64)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3:
        raise ValueError("a polygon has three corners (x, y) or more")
    if not tolerance > 0.0:
        raise ValueError("the tolerance must be above 0")
    if not setback >= 0.0:
        raise ValueError("the set-back must not be below 0")
    return find_meetings(
        doubles(corners), len(corners), doubles(around.corners), ints(around.first),
        doubles(around.boxes), len(around), tolerance, setback,
    )  # fmt: skip


def find_meetings(at, corners, others, first, boxes, count, near, back):
    """Find the contacts of a polygon with the ground and with the first so many others."""
    found: MeetingRows = MeetingRows(4 * corners + 16)
    most: cython.Py_ssize_t = 4
    for k in range(count):
        most = max(most, first[k + 1] - first[k])
    mine: Sides = Sides(corners)
    theirs: Sides = Sides(most)
    reach: cython.double = BESIDE * near
    beyond: cython.double = 1.0 + 4.0 * near
    ground: cython.double[8] = [0.0, -beyond, 0.0, -beyond, 0.0, 0.0, 0.0, 0.0]
    mine.count = corners
    with cython.nogil:
        set_sides(mine, at, 0)
        if mine.low - reach <= 0.0:
            # The piece of ground below, a box that reaches further on all sides.
            ground[0] = ground[6] = mine.first - beyond
            ground[2] = ground[4] = mine.last + beyond
            theirs.count = 4
            set_sides(theirs, ground, 0)
            meet(mine, theirs, -1, near, set_back_by(area(mine), near, back), found)
        for k in range(count):
            if not (boxes[4 * k] <= mine.last + reach and boxes[4 * k + 2] >= mine.first - reach):
                continue
            if not (boxes[4 * k + 1] <= mine.high + reach and boxes[4 * k + 3] >= mine.low - reach):
                continue
            theirs.count = first[k + 1] - first[k]
            set_sides(theirs, others, 2 * first[k])
            size: cython.double = min(area(mine), area(theirs)) if back != 0.0 else 0.0
            meet(mine, theirs, k, near, set_back_by(size, near, back), found)
    return _told(found)


def _told(found):
    """Write what was found into arrays."""
    count: cython.Py_ssize_t = found.count
    others, counts = np.empty(count, np.int32), np.empty(count, np.int32)
    points, normals = np.empty((count, 2, 2)), np.empty((count, 2))
    other: cython.p_int = ints_out(others)
    number: cython.p_int = ints_out(counts)
    point: cython.p_double = doubles_out(points)
    normal: cython.p_double = doubles_out(normals)
    at: cython.p_double = found.at
    for i in range(count):
        k = NUMBERS * i
        other[i] = cython.cast(cython.int, at[k + OTHER])
        number[i] = cython.cast(cython.int, at[k + COUNT])
        point[4 * i], point[4 * i + 1] = at[k + X0], at[k + Y0]
        point[4 * i + 2], point[4 * i + 3] = at[k + X1], at[k + Y1]
        # No zero has a sign.
        normal[2 * i], normal[2 * i + 1] = at[k + NORMAL_X] + 0.0, at[k + NORMAL_Y] + 0.0
    return Meetings(others, counts, points, normals)


@cython.cclass
class Sides:
    """The edges of a polygon and the corners at their starts: unit vectors, lengths, boxes.

    `first`, `last`, `low` and `high` are the box of all.
    """

    def __init__(self, room: int) -> None:
        self.count, self.room = 0, []
        self.x, self.y = kept_doubles(self.room, room), kept_doubles(self.room, room)
        self.along_x, self.along_y = kept_doubles(self.room, room), kept_doubles(self.room, room)
        self.left, self.bottom = kept_doubles(self.room, room), kept_doubles(self.room, room)
        self.right, self.top = kept_doubles(self.room, room), kept_doubles(self.room, room)
        self.length, self.convex = kept_doubles(self.room, room), kept_ints(self.room, room)


@cython.cclass
class MeetingRows:
    """Contacts one after the other, :data:`NUMBERS` numbers each."""

    def __init__(self, room: int) -> None:
        self.count, self.room = 0, room
        self.at = new_doubles(NUMBERS * room)

    def __dealloc__(self) -> None:
        release(self.at)


def set_sides(sides, corners, first):
    """Prepare the sides of a polygon."""
    n: cython.Py_ssize_t = sides.count
    before: cython.Py_ssize_t = n - 1
    for k in range(n):
        at = first + 2 * k
        sides.x[k], sides.y[k] = corners[at], corners[at + 1]
        at = at + 2 if k + 1 < n else first
        x, y = corners[at], corners[at + 1]
        step_x, step_y = x - sides.x[k], y - sides.y[k]
        length = sqrt(step_x * step_x + step_y * step_y)
        sides.length[k] = length
        sides.along_x[k], sides.along_y[k] = step_x / length, step_y / length
        sides.left[k], sides.right[k] = min(sides.x[k], x), max(sides.x[k], x)
        sides.bottom[k], sides.top[k] = min(sides.y[k], y), max(sides.y[k], y)
    sides.first = sides.last = sides.x[0]
    sides.low = sides.high = sides.y[0]
    for k in range(1, n):
        sides.first, sides.last = min(sides.first, sides.x[k]), max(sides.last, sides.x[k])
        sides.low, sides.high = min(sides.low, sides.y[k]), max(sides.high, sides.y[k])
    for k in range(n):
        x = sides.along_x[before] * sides.along_y[k] - sides.along_y[before] * sides.along_x[k]
        sides.convex[k] = x > 0.0
        before = k


def meet(p, q, other, tolerance, by, found):
    """Add the contacts of two polygons, in order along the first."""
    reach: cython.double = BESIDE * tolerance
    begin: cython.Py_ssize_t = found.count
    for i in range(p.count):
        left, bottom = p.left[i] - reach, p.bottom[i] - reach
        right, top = p.right[i] + reach, p.top[i] + reach
        if q.first > right or q.last < left or q.low > top or q.high < bottom:
            continue
        for j in range(q.count):
            if q.left[j] > right or q.right[j] < left or q.bottom[j] > top or q.top[j] < bottom:
                continue
            # What an edge and the corner at its start have to do with an edge and the corner at
            # its start.
            facing_edges(p, i, q, j, tolerance, found)
            corner_on_edge(p, i, q, j, tolerance, found)
            edge_on_corner(p, i, q, j, tolerance, found)
            corner_on_corner(p, i, q, j, tolerance, found)
    without_repeats(found, begin, tolerance)
    if by > 0.0:
        j = begin
        for i in range(begin, found.count):
            if set_back(p, q, found.at, NUMBERS * i, by, tolerance):
                copy(found.at, i, j)
                j += 1
        found.count = j
    for i in range(begin, found.count):
        found.at[NUMBERS * i + OTHER] = other
    return 0


def copy(at, one, to):
    """Copy a contact to another place."""
    for k in range(NUMBERS):
        at[NUMBERS * to + k] = at[NUMBERS * one + k]


def add(found, p, edge, facing, start, end, normal_x, normal_y):
    """Add a contact along an edge, or at a point of it; there is always room for one more."""
    k: cython.Py_ssize_t = NUMBERS * found.count
    at: cython.p_double = found.at
    at[k + EDGE], at[k + FACING], at[k + START] = edge, facing, start
    at[k + COUNT] = 1.0 if start == end else 2.0
    at[k + X0], at[k + Y0] = (
        p.x[edge] + start * p.along_x[edge],
        p.y[edge] + start * p.along_y[edge],
    )
    at[k + X1], at[k + Y1] = p.x[edge] + end * p.along_x[edge], p.y[edge] + end * p.along_y[edge]
    at[k + NORMAL_X], at[k + NORMAL_Y] = normal_x, normal_y
    found.count += 1
    if found.count + 1 >= found.room:
        found.room *= 2
        found.at = more_doubles(found.at, NUMBERS * found.room)
    return 0


def facing_edges(p, i, q, j, tolerance, found):
    """Add the contact along edges that face each other; one point where it is short."""
    c: cython.double[6] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    part: cython.double[2] = [0.0, 0.0]
    low_first: cython.bint
    if not common(p, i, q, j, tolerance, c):
        return 0
    at_low = c[INSIDE] + c[SLOPE] * (c[LOW] - c[FIRST])
    at_high = c[INSIDE] + c[SLOPE] * (c[HIGH] - c[FIRST])
    low_first = abs(at_low) <= abs(at_high)
    reach = tolerance * (1.0 - abs(c[SLOPE]) / LEAN)
    if not within(c[LOW], c[HIGH], at_low, at_high, reach, part):
        if min(abs(at_low), abs(at_high)) > tolerance:
            return 0
        part[0] = part[1] = c[LOW] if low_first else c[HIGH]
    over = c[LAST] if low_first else p.length[i] - c[FIRST]
    share = min(max(0.5 + over / (2.0 * tolerance), 0.0), 1.0)
    nx = share * -p.along_y[i] + (1.0 - share) * q.along_y[j]
    ny = share * p.along_x[i] + (1.0 - share) * -q.along_x[j]
    length = sqrt(nx * nx + ny * ny)
    if not part[1] - part[0] > tolerance:
        part[0] = part[1] = (part[0] + part[1]) / 2.0
    return add(found, p, i, j, part[0], part[1], nx / length, ny / length)


def corner_on_edge(p, i, q, j, tolerance, found):
    """Add the contact of corner `i` on edge `j`, away from its ends."""
    c: cython.double[6] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    if stands_on(p, i, q, j, tolerance) < 0.0:
        return 0
    if common(p, before(p, i), q, j, tolerance, c) or common(p, i, q, j, tolerance, c):
        return 0
    return add(found, p, i, j, 0.0, 0.0, q.along_y[j], -q.along_x[j])


def edge_on_corner(p, i, q, j, tolerance, found):
    """Add the contact of edge `i`, away from its ends, on corner `j`."""
    c: cython.double[6] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    start: cython.double = stands_on(q, j, p, i, tolerance)
    if start < 0.0:
        return 0
    if common(p, i, q, before(q, j), tolerance, c) or common(p, i, q, j, tolerance, c):
        return 0
    return add(found, p, i, j, start, start, -p.along_y[i], p.along_x[i])


def corner_on_corner(p, i, q, j, tolerance, found):
    """Add the contact of two convex corners beside each other, where a face separates them."""
    c: cython.double[6] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    apart: cython.double[4] = [0.0, 0.0, 0.0, 0.0]
    level: cython.double[4] = [0.0, 0.0, 0.0, 0.0]
    separates: cython.bint[4] = [False, False, False, False]
    edge: cython.Py_ssize_t = i
    start: cython.double = 0.0
    if not (p.convex[i] and q.convex[j] and are_beside(p, i, q, j, tolerance)):
        return 0
    i_before, j_before = before(p, i), before(q, j)
    if common(p, i_before, q, j_before, tolerance, c) or common(p, i_before, q, j, tolerance, c):
        return 0
    if common(p, i, q, j_before, tolerance, c) or common(p, i, q, j, tolerance, c):
        return 0
    x, y = p.x[i] - q.x[j], p.y[i] - q.y[j]
    for place in range(4):
        if place < 2:
            face = j if place else j_before
            separates[place] = clears(p, i, q.along_y[face], -q.along_x[face])
            apart[place] = x * q.along_y[face] + y * -q.along_x[face]
            level[place] = abs(q.along_x[face])
        else:
            face = i_before if place == 2 else i
            separates[place] = clears(q, j, p.along_y[face], -p.along_x[face])
            apart[place] = -x * p.along_y[face] + -y * -p.along_x[face]
            level[place] = abs(p.along_x[face])
    place = best(separates, apart, level, EQUAL * tolerance)
    if place < 0 or abs(apart[place]) > tolerance:
        return 0
    if place < 2:
        face = j if place else j_before
        along = x * q.along_x[face] + y * q.along_y[face]
    else:
        face = i_before if place == 2 else i
        along = -x * p.along_x[face] + -y * p.along_y[face]
    if place in (0, 2):
        along = -along
    if not (along >= 0.0 or x * x + y * y <= tolerance * tolerance):
        return 0
    if place < 2:
        return add(found, p, i, face, 0.0, 0.0, q.along_y[face], -q.along_x[face])
    if along > 0.0 and place == 3:
        start = along
    elif along > 0.0:
        edge, start = i_before, p.length[i_before] - along
    return add(found, p, edge, j, start, start, -p.along_y[face], p.along_x[face])


def set_back_by(size, tolerance, setback):
    """Return by how much contacts are set back, by the area of the smaller polygon."""
    return max(tolerance, setback * sqrt(size)) if setback != 0.0 else 0.0


def area(s):
    """Return the area of a polygon."""
    doubled: cython.double = 0.0
    for k in range(1, s.count - 1):
        x, y = s.x[k] - s.x[0], s.y[k] - s.y[0]
        doubled += x * (s.y[k + 1] - s.y[0]) - y * (s.x[k + 1] - s.x[0])
    return doubled / 2.0 if doubled > 0.0 else 0.0


def set_back(p, q, at, k, by, tolerance):
    """Set a contact back from the ends of faces; return whether anything is left of it."""
    edge: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, at[k + EDGE])
    facing: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, at[k + FACING])
    ux: cython.double = p.along_x[edge]
    uy: cython.double = p.along_y[edge]
    start: cython.double = at[k + START]
    if at[k + COUNT] == 2.0:
        end = start + (at[k + X1] - at[k + X0]) * ux + (at[k + Y1] - at[k + Y0]) * uy
        across = projected(q, facing, at[k + X0], at[k + Y0])
        start = start + by - min(runs_on(p, edge, start, by, -1), runs_on(q, facing, across, by, 1))
        across = projected(q, facing, at[k + X1], at[k + Y1])
        end = end - by + min(runs_on(p, edge, end, by, 1), runs_on(q, facing, across, by, -1))
        if end - start > tolerance:
            at[k + START] = start
            at[k + X0], at[k + Y0] = p.x[edge] + start * ux, p.y[edge] + start * uy
            at[k + X1], at[k + Y1] = p.x[edge] + end * ux, p.y[edge] + end * uy
            return True
        at[k + START] = start = min(max((start + end) / 2.0, 0.0), p.length[edge])
        at[k + X0], at[k + Y0] = p.x[edge] + start * ux, p.y[edge] + start * uy
    at[k + COUNT], at[k + X1], at[k + Y1] = 1.0, at[k + X0], at[k + Y0]
    if min(runs_on(p, edge, start, by, -1), runs_on(p, edge, start, by, 1)) >= by:
        return True
    across = projected(q, facing, at[k + X0], at[k + Y0])
    return min(runs_on(q, facing, across, by, -1), runs_on(q, facing, across, by, 1)) >= by


def projected(s, i, x, y):
    """Return how far along an edge a point is beside it; its ends for what is beyond them."""
    along: cython.double = (x - s.x[i]) * s.along_x[i] + (y - s.y[i]) * s.along_y[i]
    return min(max(along, 0.0), s.length[i])


def runs_on(s, i, along, enough, sense):
    """Return how far a face goes on from a point of edge `i`, at most `enough`."""
    run: cython.double = s.length[i] - along if sense > 0 else along
    edge: cython.Py_ssize_t = i
    for k in range(s.count - 1):  # noqa: B007 - typed
        if run >= enough:
            return enough
        if sense > 0:
            edge = edge + 1 if edge + 1 < s.count else 0
        else:
            edge = before(s, edge)
        dot = s.along_x[i] * s.along_x[edge] + s.along_y[i] * s.along_y[edge]
        away = sense * (s.along_x[i] * s.along_y[edge] - s.along_y[i] * s.along_x[edge])
        if abs(away) > SHARP * dot:
            return run if away >= 0.0 else enough
        run += s.length[edge]
    return run if run < enough else enough


def without_repeats(found, begin, tolerance):
    """Leave out points that are told already, and sort the others, from a place on."""
    kept: cython.Py_ssize_t = begin
    at: cython.p_double = found.at
    spare: cython.Py_ssize_t = found.count
    # Marked first: also what is left out makes others repeats.
    for k in range(begin, found.count):
        at[NUMBERS * k + OTHER] = 0.0
        if at[NUMBERS * k + COUNT] == 2.0:
            continue
        for other in range(begin, found.count):
            if (at[NUMBERS * other + COUNT] == 2.0 or other < k) and is_same(
                at, NUMBERS * k, NUMBERS * other, tolerance
            ):
                at[NUMBERS * k + OTHER] = 1.0
                break
    for k in range(begin, found.count):
        if at[NUMBERS * k + OTHER] != 0.0:
            continue
        copy(at, k, spare)
        other = kept
        while other > begin and comes_before(at, NUMBERS * spare, NUMBERS * (other - 1)):
            copy(at, other - 1, other)
            other -= 1
        copy(at, spare, other)
        kept += 1
    found.count = kept


def comes_before(at, one, other):
    """Tell whether a contact comes before another one, along the polygon."""
    if at[one + EDGE] != at[other + EDGE]:
        return at[one + EDGE] < at[other + EDGE]
    return at[one + START] < at[other + START]


def before(s, i):
    """Return the edge that ends where edge `i` starts."""
    return i - 1 if i else s.count - 1


def common(p, i, q, j, tolerance, c):
    """Find where two edges face each other; return whether they do.

    Along edge `i`: from where to where they are beside each other, and both ends of edge `j`; how
    far the start of that is inside, and how much it leans.
    """
    dot: cython.double = p.along_x[i] * q.along_x[j] + p.along_y[i] * q.along_y[j]
    cross: cython.double = p.along_x[i] * q.along_y[j] - p.along_y[i] * q.along_x[j]
    if dot >= 0.0 or abs(cross) > LEAN * -dot:
        return False
    end = j + 1 if j + 1 < q.count else 0
    x, y = q.x[j] - p.x[i], q.y[j] - p.y[i]
    c[FIRST] = x * p.along_x[i] + y * p.along_y[i]
    c[INSIDE] = p.along_x[i] * y - p.along_y[i] * x
    c[LAST] = (q.x[end] - p.x[i]) * p.along_x[i] + (q.y[end] - p.y[i]) * p.along_y[i]
    c[LOW] = c[LAST] if c[LAST] > 0.0 else 0.0
    c[HIGH] = c[FIRST] if c[FIRST] < p.length[i] else p.length[i]
    c[SLOPE] = cross / dot
    return c[HIGH] - c[LOW] > tolerance


def within(low, high, at_low, at_high, reach, part):
    """Find the part from low to high on which a value is at most `reach` from 0."""
    if min(at_low, at_high) > reach or max(at_low, at_high) < -reach:
        return False
    part[0], part[1] = low, high
    if abs(at_low) > reach:
        limit = reach if at_low > 0.0 else -reach
        part[0] = low + (high - low) * ((limit - at_low) / (at_high - at_low))
    if abs(at_high) > reach:
        limit = reach if at_high > 0.0 else -reach
        part[1] = low + (high - low) * ((limit - at_low) / (at_high - at_low))
    return True


def stands_on(s, i, t, j, tolerance):
    """Return how far along edge `j` corner `i` stands on it; -1 when it does not."""
    x: cython.double = s.x[i] - t.x[j]
    y: cython.double = s.y[i] - t.y[j]
    outside: cython.double = x * t.along_y[j] - y * t.along_x[j]
    along: cython.double = x * t.along_x[j] + y * t.along_y[j]
    end: cython.Py_ssize_t = j + 1 if j + 1 < t.count else 0
    if not (along >= 0.0 and along <= t.length[j] and s.convex[i]):
        return -1.0
    if abs(outside) > tolerance or not clears(s, i, t.along_y[j], -t.along_x[j]):
        return -1.0
    if t.convex[j] and are_beside(s, i, t, j, tolerance):
        return -1.0
    return -1.0 if t.convex[end] and are_beside(s, i, t, end, tolerance) else along


def are_beside(s, i, t, j, tolerance):
    """Tell whether two corners are so near that neither stands on an edge away from its ends."""
    x: cython.double = s.x[i] - t.x[j]
    y: cython.double = s.y[i] - t.y[j]
    return x * x + y * y <= 2.0 * tolerance * tolerance


def clears(s, i, out_x, out_y):
    """Tell whether both edges at a corner lead outwards, or hardly inwards."""
    coming: cython.Py_ssize_t = before(s, i)
    if s.along_x[coming] * out_x + s.along_y[coming] * out_y > LEAN:
        return False
    return s.along_x[i] * out_x + s.along_y[i] * out_y >= -LEAN


def best(separates, apart, level, equal):
    """Return which of four faces separates most, the most level of equals; -1 when none does."""
    chosen: cython.int = -1
    most: cython.double = 0.0
    for place in range(4):
        if separates[place] and (chosen < 0 or apart[place] > most):
            most, chosen = apart[place], place
    chosen = -1
    for place in range(4):
        if separates[place] and apart[place] >= most - equal:
            if chosen < 0 or level[place] > level[chosen] + LEVEL:
                chosen = place
    return chosen


def is_same(at, one, other, tolerance):
    """Tell whether a contact at a point has the place and the normal of another contact."""
    limit: cython.double = 4.0 * tolerance * tolerance
    x: cython.double = at[one + NORMAL_X] * at[other + NORMAL_X]
    y: cython.double = at[one + NORMAL_Y] * at[other + NORMAL_Y]
    if x + y < SAME:
        return False
    x, y = at[one + X0] - at[other + X0], at[one + Y0] - at[other + Y0]
    if x * x + y * y <= limit:
        return True
    x, y = at[one + X0] - at[other + X1], at[one + Y0] - at[other + Y1]
    return x * x + y * y <= limit
