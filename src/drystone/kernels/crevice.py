"""The free space under a placed polygon, with all its corners: no columns, no pixels (§3.7).

What lies above and below it are *chains*: corners from left to right, two corners of one x are a
step.  The lid is the stone's lower boundary as seen from below, the floor the first that is met on
the way down from there.  Both are moved into the free space by a clearance.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from drystone.kernels.polygons import Points, Polygons

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from math import sqrt

    from drystone.kernels.lists import doubles, doubles_out, ints, kept_doubles, kept_ints

Chain = Points

SAME = 1e-9
"""Corners nearer than this are one, and edges that cover less of the x axis are upright."""

NEAR = cython.declare(cython.double, SAME)
INFINITY = cython.declare(cython.double, np.inf)


class Crevice(NamedTuple):
    """The free space under a polygon, from its left end to its right end.

    Chains (n, 2), the clearance already taken off.  There is no space where the lid is not above
    the floor.
    """

    lid: Chain
    floor: Chain


def crevice(stone: Points, around: Polygons, clearance: float) -> Crevice:
    """Return the free space between a polygon (n, 2) and what is below, above the ground y = 0.

    The chains keep a clearance from both: nowhere less, at corners up to 1.42 times as much.  With
    a clearance of 0 they are the boundaries themselves.
    """
    stone = np.ascontiguousarray(stone, np.float64)
    corners: cython.p_double = doubles(stone)
    left: cython.double = corners[0]
    right: cython.double = corners[0]
    for i in range(2, 2 * len(stone), 2):
        left, right = min(left, corners[i]), max(right, corners[i])
    lid: Rows
    floor: Rows
    lid, floor = boundaries(stone, around, left, right, 4.0 * clearance)
    flip(lid.at, 2 * lid.count)
    lid = raised(lid, clearance, left, right)
    flip(lid.at, 2 * lid.count)
    return Crevice(as_array(lid), as_array(raised(floor, clearance, left, right)))


def between(space: Crevice, x_left: float, x_right: float) -> Points | None:
    """Cut the piece between two upright lines out of a crevice; None when it closes there.

    It is simple and counter-clockwise.  The lines are in order, and inside.
    """
    x, low, high = slabs(space, x_left, x_right)
    # Both sides of a step count together: halves that meet in a point are not one simple polygon.
    over = np.minimum(high[:-1, 1], high[1:, 0]) - np.maximum(low[:-1, 1], low[1:, 0])
    if (high <= low).any() or (over <= 0.0).any():
        return None
    inside = (x[0] + SAME, x[-1] - SAME)
    ends = np.array([[x[0], low[0, 0], high[0, 0]], [x[-1], low[-1, 1], high[-1, 1]]])
    return np.concatenate(
        [
            ends[:1, :2],
            _within(space.floor, *inside),
            ends[1:, :2],
            ends[1:, ::2],
            _within(space.lid, *inside)[::-1],
            ends[:1, ::2],
        ]
    )


def slabs(space: Crevice, x_left: float, x_right: float) -> tuple[Points, Points, Points]:
    """Cut a crevice at all its corners into slabs with a straight floor and lid.

    Returns x (n + 1,) where slabs begin, and the end of the last; y of the floor, then of the lid,
    (n, 2), at the left and at the right of each.
    """
    x = np.concatenate([space.lid[:, 0], space.floor[:, 0]])
    x = np.sort(x[(x > x_left + SAME) & (x < x_right - SAME)])
    new = np.append(True, x[1:] - x[:-1] > SAME)[: len(x)]
    x = np.concatenate([[x_left], x[new], [x_right]])
    return x, _heights(space.floor, x), _heights(space.lid, x)


def _heights(chain: Chain, x: Points) -> Points:
    """Return y of a chain at the left and at the right end of each slab."""
    stop = np.searchsorted(chain[:, 0], (x[:-1] + x[1:]) / 2.0)
    edges = np.column_stack([chain[stop - 1], chain[stop]])
    return np.column_stack([_line(edges, x[:-1]), _line(edges, x[1:])])


def _within(chain: Chain, x_left: float, x_right: float) -> Chain:
    """Return the corners of a chain between two lines."""
    return chain[(chain[:, 0] > x_left) & (chain[:, 0] < x_right)]


def _line(edges: Points, x: Points) -> Points:
    """Return y of segments at one x each."""
    share = (x - edges[:, 0]) / (edges[:, 2] - edges[:, 0])
    return np.asarray(edges[:, 1] + (edges[:, 3] - edges[:, 1]) * share)


@cython.cclass
class Rows:
    """Segments from left to right, x0, y0, x1, y1, or corners of a chain, one after the other."""

    def __init__(self, numbers: int) -> None:
        self.room, self.count = [], 0
        self.at = kept_doubles(self.room, numbers)


@cython.cclass
class Slabs:
    """Strips between upright lines, and which segment is taken in each: -1 for none."""

    def __init__(self, room: int) -> None:
        self.room, self.count, self.begins = [], 0, np.empty(room)
        self.x, self.middle = doubles_out(self.begins), kept_doubles(self.room, room)
        self.ceiling, self.best = kept_doubles(self.room, room), kept_doubles(self.room, room)
        self.which = kept_ints(self.room, room)


def as_array(chain):
    """Return the corners of a chain."""
    points = np.empty((chain.count, 2))
    into: cython.p_double = doubles_out(points)
    for i in range(2 * chain.count):
        into[i] = chain.at[i]
    return points


def flip(at, end):
    """Turn points upside down."""
    for i in range(1, end, 2):
        at[i] = -at[i]


def add(out, x0, y0, x1, y1):
    """Add a segment, unless it is upright or goes to the left."""
    if x1 - x0 > NEAR:
        put(out, x0, y0, x1, y1)


def line(at, k, x):
    """Return y of a segment at an x."""
    share: cython.double = (x - at[k]) / (at[k + 2] - at[k])
    return at[k + 1] + (at[k + 3] - at[k + 1]) * share


def boundaries(stone, around, left, right, reach):
    """Return lid and floor as they are, from `reach` left of the stone to so far right of it."""
    corners: cython.p_double = doubles(stone)
    others: cython.p_double = doubles(around.corners)
    first: cython.p_int = ints(around.first)
    boxes: cython.p_double = doubles(around.boxes)
    size: cython.Py_ssize_t = len(stone)
    room: cython.Py_ssize_t = len(around.corners) + 1
    lids: Rows = Rows(4 * (size + 2))
    edges: Rows = Rows(4 * room)
    bottom: cython.p_int = kept_ints(edges.room, room)
    top: cython.double = corners[1]
    low_left: cython.double = INFINITY
    low_right: cython.double = INFINITY
    for i in range(size):
        top = max(top, corners[2 * i + 1])
        if corners[2 * i] == left:
            low_left = min(low_left, corners[2 * i + 1])
        if corners[2 * i] == right:
            low_right = min(low_right, corners[2 * i + 1])
        j = i + 1 if i + 1 < size else 0
        add(lids, corners[2 * i], corners[2 * i + 1], corners[2 * j], corners[2 * j + 1])
    # In thought the lid goes on beyond both ends, so that what stands close beside the lines is
    # seen as well.
    add(lids, left - reach, low_left, left, low_left)
    add(lids, right, low_right, right + reach, low_right)
    left, right = left - reach, right + reach
    for k in range(len(around)):
        if not (boxes[4 * k] < right and boxes[4 * k + 2] > left and boxes[4 * k + 1] < top):
            continue
        for i in range(first[k], first[k + 1]):
            j = 2 * (i + 1 if i + 1 < first[k + 1] else first[k])
            run = others[j] - others[2 * i]
            if abs(run) <= NEAR:
                continue
            bottom[edges.count] = run > 0.0
            if run > 0.0:
                put(edges, others[2 * i], others[2 * i + 1], others[j], others[j + 1])
            else:
                put(edges, others[j], others[j + 1], others[2 * i], others[2 * i + 1])
    bottom[edges.count] = False
    put(edges, left, 0.0, right, 0.0)

    cuts: Slabs = Slabs(2 * (lids.count + edges.count) + 2)
    for i in range(lids.count):
        cuts.x[2 * i], cuts.x[2 * i + 1] = lids.at[4 * i], lids.at[4 * i + 2]
    for i in range(edges.count):
        j = 2 * (lids.count + i)
        cuts.x[j], cuts.x[j + 1] = edges.at[4 * i], edges.at[4 * i + 2]
    slice_up(cuts, 2 * (lids.count + edges.count), left, right)
    flip(lids.at, 4 * lids.count)
    highest(lids, cuts)
    flip(lids.at, 4 * lids.count)
    picked: Rows = Rows(4 * cuts.count)
    for i in range(cuts.count):
        pick(picked, lids, cuts.which[i] if cuts.which[i] >= 0 else lids.count - 1)
        cuts.ceiling[i] = line(picked.at, 4 * i, cuts.middle[i])
    lid = chained(picked, cuts)
    was: cython.p_int = kept_ints(cuts.room, cuts.count)
    for i in range(cuts.count):
        was[i] = cuts.which[i]
    highest(edges, cuts)
    for i in range(cuts.count):
        # Nothing below, or a bottom from inside: the stone stands in something.
        if cuts.which[i] < 0 or bottom[cuts.which[i]]:
            cuts.which[i] = edges.count + was[i]
        else:
            picked.count = i
            pick(picked, edges, cuts.which[i])
    return lid, chained(picked, cuts)


def put(out, x0, y0, x1, y1):
    """Add a segment as it is."""
    k: cython.Py_ssize_t = 4 * out.count
    out.at[k], out.at[k + 1], out.at[k + 2], out.at[k + 3] = x0, y0, x1, y1
    out.count += 1


def pick(out, one, i):
    """Add one of some segments."""
    k: cython.Py_ssize_t = 4 * i
    put(out, one.at[k], one.at[k + 1], one.at[k + 2], one.at[k + 3])


def raised(chain, clearance, left, right):
    """Move a chain up by a clearance, along its normals, and cut it off at two places.

    The highest of its moved edges counts everywhere.  At corners that stand out they are made
    longer until they meet; where the chain turns by more than 90 degrees, by the clearance, and
    joined straight.
    """
    edges: Rows = Rows(8 * chain.count)
    points: cython.Py_ssize_t = 0
    if clearance != 0.0:
        moved(chain, clearance, edges)
    else:
        for i in range(0, 2 * chain.count - 2, 2):
            add(edges, chain.at[i], chain.at[i + 1], chain.at[i + 2], chain.at[i + 3])
    at: cython.p_double = edges.at
    # Two ends each, and at most one crossing of each pair.
    cuts: Slabs = Slabs(2 * edges.count + edges.count * (edges.count - 1) // 2 + 2)
    for i in range(edges.count):
        cuts.x[points], cuts.x[points + 1] = at[4 * i], at[4 * i + 2]
        points += 2
    for i in range(0, 4 * edges.count, 4):
        for j in range(i + 4, 4 * edges.count, 4):
            if not (at[i] < at[j + 2] and at[j] < at[i + 2]):
                continue
            low = at[i] if at[i] > at[j] else at[j]
            high = at[i + 2] if at[i + 2] < at[j + 2] else at[j + 2]
            before = line(at, i, low) - line(at, j, low)
            after = line(at, i, high) - line(at, j, high)
            if before * after < 0.0:
                cuts.x[points] = low + (high - low) * (before / (before - after))
                points += 1
    slice_up(cuts, points, left, right)
    highest(edges, cuts)
    picked: Rows = Rows(4 * cuts.count)
    for i in range(cuts.count):
        pick(picked, edges, cuts.which[i] if cuts.which[i] >= 0 else edges.count - 1)
    return chained(picked, cuts)


def moved(chain, clearance, out):
    """List the edges of a chain moved up and made longer, then those that join them."""
    edges: cython.Py_ssize_t = chain.count - 1
    joints: Rows = Rows(4 * chain.count)
    at: cython.p_double = chain.at
    one: cython.double[2] = [0.0, 0.0]
    two: cython.double[2] = [0.0, 0.0]
    joint: cython.bint
    before: cython.double = 0.0
    direction(at, 0, one)
    for i in range(edges):
        k = 2 * i
        x, y = one[0], one[1]
        after, joint = 0.0, False
        if i + 1 < edges:
            direction(at, k + 2, two)
            sine = x * two[1] - y * two[0]
            cosine = x * two[0] + y * two[1]
            if sine < 0.0:
                joint = cosine < 0.0
                # The tangent of half the turn.
                after = 1.0 if joint else -sine / (1.0 + cosine)
        end_x = at[k + 2] + clearance * (-y + after * x)
        end_y = at[k + 3] + clearance * (x + after * y)
        add(
            out, at[k] + clearance * (-y - before * x), at[k + 1] + clearance * (x - before * y),
            end_x, end_y,
        )  # fmt: skip
        if joint:
            add(
                joints, end_x, end_y, at[k + 2] + clearance * (-two[1] - after * two[0]),
                at[k + 3] + clearance * (two[0] - after * two[1]),
            )  # fmt: skip
        before, one[0], one[1] = after, two[0], two[1]
    for i in range(joints.count):
        pick(out, joints, i)


def direction(at, k, out):
    """Give the unit vector of an edge of a chain."""
    x: cython.double = at[k + 2] - at[k]
    y: cython.double = at[k + 3] - at[k + 1]
    length: cython.double = sqrt(x * x + y * y)
    out[0], out[1] = x / length, y / length


def highest(edges, cuts):
    """Find the highest segment of each slab, not above its ceiling."""
    at: cython.p_double = edges.at
    for k in range(cuts.count):
        cuts.best[k], cuts.which[k] = -INFINITY, -1
    for i in range(edges.count):
        # The first slab whose middle is not left of the segment.
        low, k = 0, cuts.count
        while low < k:
            half = (low + k) // 2
            if cuts.middle[half] < at[4 * i]:
                low = half + 1
            else:
                k = half
        while k < cuts.count and cuts.middle[k] < at[4 * i + 2]:
            y = line(at, 4 * i, cuts.middle[k])
            if y <= cuts.ceiling[k] and y > cuts.best[k]:
                cuts.best[k], cuts.which[k] = y, i
            k += 1


def chained(picked, cuts):
    """Return the chain of segments that are given for each slab."""
    out: Rows = Rows(4 * cuts.count)
    i: cython.Py_ssize_t = 0
    last_x: cython.double = 0.0
    last_y: cython.double = 0.0
    while i < cuts.count:
        stop = i + 1
        while stop < cuts.count and cuts.which[stop] == cuts.which[i]:
            stop += 1
        for end in range(2):
            x = cuts.x[stop if end else i]
            y = line(picked.at, 4 * i, x)
            if (i == 0 and end == 0) or abs(x - last_x) > NEAR or abs(y - last_y) > NEAR:
                k = 2 * out.count
                out.at[k], out.at[k + 1] = x, y
                out.count += 1
            last_x, last_y = x, y
        i = stop
    return out


def slice_up(cuts, count, left, right):
    """Make slabs between the first numbers, without those that are the same, and two limits."""
    x: cython.p_double = cuts.x
    inside: cython.Py_ssize_t = 0
    kept: cython.Py_ssize_t = 0
    last: cython.double = 0.0
    for i in range(count):
        if x[i] > left + NEAR and x[i] < right - NEAR:
            x[inside] = x[i]
            inside += 1
    cuts.begins[:inside].sort()
    for i in range(inside):
        value = x[i]
        if i == 0 or value - last > NEAR:
            x[kept] = value
            kept += 1
        last = value
    for i in range(kept, 0, -1):
        x[i] = x[i - 1]
    x[0], x[kept + 1] = left, right
    cuts.count = kept + 1
    for i in range(cuts.count):
        cuts.middle[i], cuts.ceiling[i] = (x[i] + x[i + 1]) / 2.0, INFINITY
