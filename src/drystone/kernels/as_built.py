"""A wall as it is built, with errors (DESIGN 4.10).

A block comes to rest on others that do not move (:mod:`drystone.kernels.putting`).  Then its weight
goes down through the wall: from each block by the lever to the two points it bears on left and
right of where its load acts.  Reactions lean no more than friction asks for: a block between slopes
pushes others aside, and one that leans on an upright face pushes its seat.  A block whose load acts
beside all that it bears on is let go again under that load, unless it is held, and what lies on it
is put down again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from drystone.kernels.polygons import Points, place_on_grid, polygon_edges, turn
from drystone.kernels.raster import Pair, wrap_deg
from drystone.kernels.settling import SettlingRules

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.gaps import Heap, measure
    from drystone.kernels.lists import (
        doubles,
        kept_doubles,
        kept_flags,
        kept_ints,
        move_doubles,
        move_ints,
    )
    from drystone.kernels.meetings import find_meetings
    from drystone.kernels.putting import Press, press_of, put_down
    from drystone.kernels.settling import Way, let_go, way_of

RESTS = cython.declare(cython.int, 0)
OVERLAPS = cython.declare(cython.int, 2)

# A block bears on what it touches where the normal of the contact goes up by at least so much.
UPWARD = cython.declare(cython.double, 0.3)

# What moves by no more than so much of the way to a fall has stayed.
HALF = cython.declare(cython.double, 0.5)

# A block is tipped by at least so much of the way to a fall, to see where its load acts by then.
TIPS = (0.05, 0.5)

# The numbers of a row of a bed: a point, the number of the block below (-1 for the ground), and by
# how much the normal goes up and aside there.
X = cython.declare(cython.Py_ssize_t, 0)
Y = cython.declare(cython.Py_ssize_t, 1)
BELOW = cython.declare(cython.Py_ssize_t, 2)
UP = cython.declare(cython.Py_ssize_t, 3)
ASIDE = cython.declare(cython.Py_ssize_t, 4)
ROW = cython.declare(cython.Py_ssize_t, 5)

# The numbers of what acts on a block: its weight with all that lies on it, the moments of that
# about x = 0 and y = 0, and the push to the right; the first moment has that of the push.
LOAD = cython.declare(cython.Py_ssize_t, 4)

# A reaction leans no further, aside over up.
FURTHEST = cython.declare(cython.double, 4.0)


class WayDown(NamedTuple):
    """How a block of a size is put down."""

    rules: SettlingRules
    lifts: list[float]  # so much higher it is let go where it overlaps others
    last_lifts: list[float]  # where it rests with none of these
    most: float  # so far it is moved aside or pushed at most
    gap: float  # what it is moved away from keeps this gap


@dataclass(frozen=True, eq=False)
class Built:
    """A block somewhere in a wall."""

    outline: Points  # (n, 2): as planned, not turned further, about its centroid
    x: float  # of the centroid, wall frame
    y: float
    angle_deg: float  # by which it is turned from the plan
    size: float  # root of its area, as it was seen

    @cached_property
    def corners(self) -> Points:
        """Corners in the wall frame, (n, 2)."""
        return np.asarray(turn(self.outline, self.angle_deg) + (self.x, self.y))  # noqa: RUF005


@cython.cclass
class Bed:
    """Where a block touches others, from left to right: what it bears on.

    Upright faces are among it where its own weight acts beside all that it bears on, or it bears on
    nothing and hangs between them.  What is held bears on nothing, and stays whatever comes onto
    it.
    """


@cython.cclass
class BuiltWall(Heap):
    """Blocks as they lie, each after all that it bears on; what changes it makes a new one.

    `how` tells of the size of a block how it is put down.  Every block that was ever laid has a
    number, and a place while it lies in the wall.  A bed is None where it is not known.
    """

    def __init__(self, mu: float, how: Callable[[float], WayDown]) -> None:
        self.mu, self.how, self.width, self.beyond = mu, how, 0.0, math.inf
        self.numbers, self.ids, self.built, self.beds = {}, [], [], []
        make_room(self, 0, 0)
        self.size = self.starts[0] = 0

    @property
    def laid(self) -> dict[int, Built]:
        """Return the blocks by their ids, in the order in which they were laid."""
        return {
            self.ids[self.order[place]]: self.built[self.order[place]] for place in range(self.size)
        }

    @property
    def held_bytes(self) -> int:
        """About how much memory it takes."""
        return 80 * self.starts[self.size] + 400 * self.size

    def get(self, block: int) -> Built | None:
        """Return a block as it lies; None where it does not."""
        number = self.numbers.get(block)
        return None if number is None or self.places[number] < 0 else self.built[number]

    def changed(self, before: BuiltWall) -> list[tuple[int, Built, Built | None]]:
        """List what lies elsewhere than in the wall this was made of: then and now, or None."""
        told = []
        was: BuiltWall = before
        for place in range(was.size):
            number = was.order[place]
            now = self.built[number] if self.places[number] >= 0 else None
            if now is not was.built[number]:
                told.append((was.ids[number], was.built[number], now))
        return told

    def put(self, pieces: Iterable[tuple[int, Built]]) -> BuiltWall:
        """Put blocks down on what does not move; those that rest nowhere are left out.

        What is there stays as it is: a wedge whose stone has fallen waits for it.
        """
        return laid_too(self, list(pieces))

    def held(self, blocks: Mapping[int, Built]) -> BuiltWall:
        """Hold blocks where they are, whatever they bear on."""
        wall: BuiltWall = copied(self, blocks.items())
        for block, built in blocks.items():
            number: cython.Py_ssize_t = number_of(wall, block)
            if wall.places[number] < 0:
                add(wall, number, built)
            wall.beds[number] = bed_of([], True)
        return wall

    def with_burden(self, blocks: Iterable[int]) -> set[int]:
        """Return blocks and all that lies on them."""
        some = set(blocks)
        return some.union(set(self.laid).difference(self.without(some).laid))

    def without(self, blocks: Iterable[int]) -> BuiltWall:
        """Take up blocks, and all that lies on them."""
        wall: BuiltWall = copied(self, ())
        find_beds(wall)
        kept: list = []
        marks: cython.p_uchar = kept_flags(kept, len(wall.ids))
        for block in blocks:
            if block in wall.numbers:
                marks[number_of(wall, block)] = 1
        mark_burden(wall, marks)
        take_up(wall, marks)
        return wall

    def loaded(self, block: int) -> BuiltWall:
        """Let what carries a block move under it, each at most once.

        What was pushed on the way to it, and what lies on that, may move too.
        """
        wall: BuiltWall = copied(self, ())
        kept: list = []
        count: cython.Py_ssize_t = len(wall.ids)
        laid: cython.Py_ssize_t = wall.numbers.get(block, -1)
        beneath: cython.p_uchar = kept_flags(kept, count)
        for place in range(wall.size):
            number = wall.order[place]
            beneath[number] = number == laid or wall.beds[number] is None
        find_beds(wall)
        asked = []
        for place in range(wall.size - 1, -1, -1):
            number = wall.order[place]
            if not beneath[number]:
                continue
            if number != laid:
                asked.append(number)
            bed: Bed = wall.beds[number]
            for k in range(0, ROW * bed.count, ROW):
                if is_on(bed, k):
                    beneath[cython.cast(cython.Py_ssize_t, bed.rows[k + BELOW])] = 1
        loads: cython.p_double = loads_of(wall, beneath, -1, kept)
        for i in range(len(asked) - 1, -1, -1):
            one: cython.Py_ssize_t = asked[i]
            if wall.places[one] < 0 or stays(wall, one, loads, False):
                continue  # it may have fallen with another
            # Upright faces may carry a part of what lies on it.
            alone: cython.p_uchar = kept_flags(kept, count)
            alone[one] = 1
            if stays(wall, one, loads_of(wall, alone, one, kept), True):
                continue
            after: BuiltWall = rolled(wall, one, loads)
            if after is not wall:
                wall = after
                loads = loads_of(wall, beneath, -1, kept)
        return wall


def make_room(wall, count, corners):
    """Make room for so many blocks with so many corners."""
    wall.kept = []
    wall.places, wall.order = kept_ints(wall.kept, count), kept_ints(wall.kept, count)
    wall.starts, wall.boxes = kept_ints(wall.kept, count + 1), kept_doubles(wall.kept, 4 * count)
    wall.corners = kept_doubles(wall.kept, 2 * corners)
    wall.edges = kept_doubles(wall.kept, 3 * corners)
    return 0


def copied(wall, pieces):
    """Return a wall that is as another one, with room for more blocks."""
    new: BuiltWall = BuiltWall(wall.mu, wall.how)
    count: cython.Py_ssize_t = len(wall.ids)
    corners: cython.Py_ssize_t = wall.starts[wall.size]
    room: cython.Py_ssize_t = corners
    for _, built in pieces:
        room += len(built.outline)
    make_room(new, count + len(pieces), room)
    new.numbers, new.ids = dict(wall.numbers), list(wall.ids)
    new.built, new.beds, new.size = list(wall.built), list(wall.beds), wall.size
    move_ints(new.places, 0, wall.places, 0, count)
    move_ints(new.order, 0, wall.order, 0, wall.size)
    move_ints(new.starts, 0, wall.starts, 0, wall.size + 1)
    move_doubles(new.boxes, 0, wall.boxes, 0, 4 * wall.size)
    move_doubles(new.corners, 0, wall.corners, 0, 2 * corners)
    move_doubles(new.edges, 0, wall.edges, 0, 3 * corners)
    return new


def number_of(wall, block):
    """Return the number of a block, which may be new."""
    found = wall.numbers.get(block)
    if found is not None:
        return found
    number: cython.Py_ssize_t = len(wall.ids)
    wall.numbers[block], wall.places[number] = number, -1
    wall.ids.append(block)
    wall.built.append(None)
    wall.beds.append(None)
    return number


def add(wall, number, built):
    """Let a block lie in the wall."""
    corners = built.corners
    edges = polygon_edges(corners)
    place: cython.Py_ssize_t = wall.size
    first: cython.Py_ssize_t = wall.starts[place]
    count: cython.Py_ssize_t = len(corners)
    move_doubles(wall.corners, 2 * first, doubles(corners), 0, 2 * count)
    move_doubles(wall.edges, 3 * first, doubles(edges), 0, 3 * count)
    wall.first, wall.count = first, count
    measure(wall)
    wall.boxes[4 * place], wall.boxes[4 * place + 1] = wall.left, wall.low
    wall.boxes[4 * place + 2], wall.boxes[4 * place + 3] = wall.right, wall.high
    wall.starts[place + 1] = first + count
    wall.order[place], wall.places[number], wall.built[number] = number, place, built
    wall.size += 1
    return 0


def take_up(wall, marks):
    """Take marked blocks out of the wall."""
    to: cython.Py_ssize_t = 0
    to_corner: cython.Py_ssize_t = 0
    for place in range(wall.size):
        number = wall.order[place]
        first, count = wall.starts[place], wall.starts[place + 1] - wall.starts[place]
        if marks[number]:
            wall.places[number], wall.beds[number] = -1, None
            continue
        move_doubles(wall.corners, 2 * to_corner, wall.corners, 2 * first, 2 * count)
        move_doubles(wall.edges, 3 * to_corner, wall.edges, 3 * first, 3 * count)
        move_doubles(wall.boxes, 4 * to, wall.boxes, 4 * place, 4)
        wall.starts[to], wall.order[to], wall.places[number] = to_corner, number, to
        to, to_corner = to + 1, to_corner + count
    wall.starts[to], wall.size = to_corner, to
    return 0


def laid_too(before, pieces):
    """Return a wall with blocks put down that did not lie in it; without those that do not rest."""
    wall: BuiltWall = copied(before, pieces)
    for block, built in pieces:
        number: cython.Py_ssize_t = number_of(wall, block)
        if wall.places[number] < 0:
            lay(wall, number, built)
    return wall


def lay(wall, number, built):
    """Put a block down, and return whether it rests, falls, or has no room.

    Beds of what was pushed, and of what lies on that, are not known any more.
    """
    rules, lifts, last, most, gap = wall.how(built.size)
    outline = turn(built.outline, built.angle_deg)
    edges = polygon_edges(outline)
    way: Way = way_of(outline, edges, rules)
    press: Press = press_of(way, wall, most, gap)
    status: cython.int = put_down(press, built.x, built.y, lifts, last)
    if status != RESTS:
        return status
    kept: list = []
    marks: cython.p_uchar = kept_flags(kept, len(wall.ids))
    for place, shift in press.pushed.items():
        pushed: cython.Py_ssize_t = wall.order[place]
        marks[pushed] = 1
        wall.built[pushed] = replace(wall.built[pushed], x=wall.built[pushed].x + shift)
    if press.pushed:
        for k in range(wall.size):
            one = wall.order[k]
            bed: Bed = wall.beds[one]
            if bed is not None and not bed.held and (marks[one] or rests_on(bed, marks)):
                wall.beds[one] = None
    x, y = place_on_grid(way.here.x, way.here.y)
    angle_deg = wrap_deg(built.angle_deg + math.degrees(way.here.turn))
    add(wall, number, replace(built, x=x, y=y, angle_deg=angle_deg))
    return status


def find_beds(wall):
    """Look for what blocks bear on where it is not known."""
    for place in range(wall.size):
        number = wall.order[place]
        if wall.beds[number] is not None:
            continue
        built = wall.built[number]
        corners = built.corners
        tolerance: cython.double = wall.how(built.size).rules.tolerance
        found = find_meetings(
            doubles(corners), len(corners), wall.corners, wall.starts, wall.boxes, place,
            tolerance, 0.0,
        )  # fmt: skip
        touched: list = []
        for other, count, points, (aside, up) in zip(
            *[part.tolist() for part in found], strict=True
        ):
            below = wall.ids[wall.order[other]] if other >= 0 else -1
            touched += [(x, y, below, up, aside) for x, y in points[:count]]
        touched.sort()
        bears_on: list = [row for row in touched if row[3] >= UPWARD]
        if bears_on and bears_on[0][0] <= built.x <= bears_on[len(bears_on) - 1][0]:
            # Else friction on the others holds it, as it came to rest there.
            touched = bears_on
        rows = [
            (x, y, -1 if below < 0 else wall.numbers[below], up, aside)
            for x, y, below, up, aside in touched
        ]
        wall.beds[number] = bed_of(rows, False)
    return 0


def bed_of(rows, held):
    """Return a bed of rows."""
    bed: Bed = Bed()
    bed.kept, bed.count, bed.held, bed.hangs = [], len(rows), held, True
    bed.rows = kept_doubles(bed.kept, ROW * bed.count)
    bed.level = 0.0
    bearing: cython.Py_ssize_t = 0
    for i in range(bed.count):
        for j in range(ROW):
            bed.rows[ROW * i + j] = rows[i][j]
        if bears(bed, ROW * i, False):
            bed.hangs = False
            bed.level += bed.rows[ROW * i + Y]
            bearing += 1
    if bearing:
        bed.level /= bearing
    return bed


def bears(bed, k, faced):
    """Say whether a block bears on a row, also where the face is upright."""
    return bed.rows[k + UP] >= UPWARD or (faced and bed.rows[k + UP] > -UPWARD)


def is_on(bed, k):
    """Say whether a block lies on the one below in a row; what bears on nothing hangs on all."""
    return bed.rows[k + BELOW] >= 0.0 and (bed.hangs or bears(bed, k, False))


def rests_on(bed, marks):
    """Say whether a block lies on a marked one."""
    for k in range(0, ROW * bed.count, ROW):
        if is_on(bed, k) and marks[cython.cast(cython.Py_ssize_t, bed.rows[k + BELOW])]:
            return True
    return False


def mark_burden(wall, marks):
    """Mark all that lies on what is marked."""
    for place in range(wall.size):
        number = wall.order[place]
        if not marks[number]:
            marks[number] = rests_on(wall.beds[number], marks)
    return 0


def loads_of(wall, marks, unfaced, kept):
    """Return the loads of marked blocks, and of all that lies on them: weights, x and y.

    A load is the weight of a block with what lies on it, and where that acts; x is that on the
    level of its bed, where a push has moved it.  With a block that is `unfaced`, all others bear on
    upright faces, too.
    """
    two: cython.Py_ssize_t[2] = [0, 0]
    count: cython.Py_ssize_t = len(wall.ids)
    burden: cython.p_uchar = kept_flags(kept, count)
    sums: cython.p_double = kept_doubles(kept, LOAD * count)
    loads: cython.p_double = kept_doubles(kept, 3 * count + 1)
    for number in range(count):
        burden[number] = marks[number] if wall.places[number] >= 0 else 0
    mark_burden(wall, burden)
    for place in range(wall.size):
        number = wall.order[place]
        if burden[number]:
            built = wall.built[number]
            at = LOAD * number
            weight: cython.double = built.size**2
            sums[at], sums[at + 3] = weight, 0.0
            sums[at + 1], sums[at + 2] = weight * built.x, weight * built.y
    for place in range(wall.size - 1, -1, -1):
        number = wall.order[place]
        if not burden[number]:
            continue
        at = LOAD * number
        weight = loads[3 * number] = sums[at]
        push: cython.double = sums[at + 3]
        bed: Bed = wall.beds[number]
        x: cython.double = (sums[at + 1] - push * bed.level) / weight
        loads[3 * number + 1] = x
        loads[3 * number + 2] = sums[at + 2] / weight
        faced: cython.bint = unfaced >= 0 and number != unfaced
        find_carrying(bed, faced, x, two)
        a: cython.Py_ssize_t = two[0]
        b: cython.Py_ssize_t = two[1]
        if a < 0:
            continue
        left, right = bed.rows[a + X], bed.rows[b + X]
        if a != b:
            share = (x - left) / (right - left) if right > left else 0.0
            first: cython.double = weight * (1.0 - share)
            second: cython.double = weight - first
            # Reactions lean alike, but no further than friction lets each of them.
            aside: cython.double = -push * (1.0 - share)
            least: cython.double = first * leaning(bed, a, wall.mu, -1.0)
            least = max(least, -push - second * leaning(bed, b, wall.mu, 1.0))
            most: cython.double = first * leaning(bed, a, wall.mu, 1.0)
            most = min(most, -push - second * leaning(bed, b, wall.mu, -1.0))
            aside = min(max(aside, least), most) if least <= most else 0.5 * (least + most)
            pass_on(bed, a, first, aside, burden, sums)
            pass_on(bed, b, second, -push - aside, burden, sums)
            continue
        if not faced:
            # It leans on the upright face that holds it with the least force.
            lean: cython.Py_ssize_t = -1
            longest: cython.double = 0.0
            for k in range(0, ROW * bed.count, ROW):
                if abs(bed.rows[k + UP]) < UPWARD and (x - left) * bed.rows[k + ASIDE] < 0.0:
                    arm = lever(bed, k, a, wall.mu)
                    if (x - left) * arm > longest:
                        lean, longest = k, (x - left) * arm
            if lean >= 0:
                force = weight * (x - left) / lever(bed, lean, a, wall.mu)
                up = force * reaction(bed, lean, wall.mu, 1)
                if up > weight:
                    # The face bears all of it: more would lift the block off its seat.
                    force, up = force * weight / up, weight
                aside = force * reaction(bed, lean, wall.mu, 0)
                pass_on(bed, lean, up, aside, burden, sums)
                weight, push = weight - up, push + aside
        pass_on(bed, a, weight, -push, burden, sums)
    return loads


def pass_on(bed, k, up, aside, burden, sums):
    """Pass a reaction on to what is below a row."""
    below = cython.cast(cython.Py_ssize_t, bed.rows[k + BELOW])
    if below >= 0 and burden[below]:
        at = LOAD * below
        sums[at] += up
        sums[at + 1] += up * bed.rows[k + X] - aside * bed.rows[k + Y]
        sums[at + 2] += up * bed.rows[k + Y]
        sums[at + 3] -= aside


def leaning(bed, k, mu, sign):
    """Return how far a reaction leans to a side at most, aside over up; a face may also pull."""
    up = bed.rows[k + UP]
    upright = up - sign * mu * bed.rows[k + ASIDE]
    if up < UPWARD or upright <= 0.0:
        return sign * FURTHEST
    return min(max((bed.rows[k + ASIDE] + sign * mu * up) / upright, -FURTHEST), FURTHEST)


def reaction(bed, k, mu, upward):
    """Return the part, aside or upward, of a reaction that goes up as far as friction lets it."""
    rises = mu if bed.rows[k + ASIDE] < 0.0 else -mu
    if upward:
        return bed.rows[k + UP] - rises * bed.rows[k + ASIDE]
    return bed.rows[k + ASIDE] + rises * bed.rows[k + UP]


def lever(bed, k, a, mu):
    """Return the arm of such a reaction about the point of a row."""
    away, rise = bed.rows[k + X] - bed.rows[a + X], bed.rows[k + Y] - bed.rows[a + Y]
    return away * reaction(bed, k, mu, 1) - rise * reaction(bed, k, mu, 0)


def find_carrying(bed, faced, x, two):
    """Find the rows left and right of a load; one beside all hangs on the last, twice.

    -1 where the block bears on nothing.
    """
    two[0] = two[1] = -1
    for k in range(0, ROW * bed.count, ROW):
        if bears(bed, k, faced):
            if two[0] < 0 or bed.rows[k + X] < x:
                two[0] = k
            two[1] = k
            if bed.rows[k + X] >= x:
                break


def stays(wall, number, loads, faced):
    """Say whether a block bears its load.

    A stone on it that another block bears too comes to bear further in, and with less, once the
    block begins to roll.  Friction with that stone holds it back, as far as the other one holds it.
    """
    two: cython.Py_ssize_t[2] = [0, 0]
    on: Bed = wall.beds[number]
    x: cython.double = loads[3 * number + 1]
    first: cython.Py_ssize_t = -1
    last: cython.Py_ssize_t = -1
    for k in range(0, ROW * on.count, ROW):
        if bears(on, k, False):
            first = k if first < 0 else first
            last = k
    if on.held or first < 0:
        return on.held
    near: cython.double = wall.how(wall.built[number].size).rules.tolerance
    left: cython.bint = x < on.rows[first + X]
    edge: cython.Py_ssize_t = first if left else last
    edge_x: cython.double = on.rows[edge + X]
    edge_y: cython.double = on.rows[edge + Y]
    beside: cython.double = edge_x - x if left else x - edge_x
    if beside <= near:
        return True
    # About the edge, that rolls it.
    moment: cython.double = loads[3 * number] * beside
    for place in range(wall.size):
        other = wall.order[place]
        bed: Bed = wall.beds[other]
        on_it = False
        for k in range(0, ROW * bed.count, ROW):
            on_it = on_it or (bed.rows[k + BELOW] == number and is_on(bed, k))
        if not on_it:
            continue
        part, at = loads[3 * other], loads[3 * other + 1]
        find_carrying(bed, faced, at, two)
        outer, held = two[0], two[1]
        if outer < 0:
            continue
        if bed.rows[outer + BELOW] != number:
            outer, held = held, outer
        from_x, outer_x = bed.rows[held + X], bed.rows[outer + X]
        if bed.rows[outer + BELOW] != number or bed.rows[held + BELOW] == number:
            continue
        if outer_x == from_x:
            continue
        # Of all points of both the last one on the way to the middle of the block.
        inner, furthest = outer, 0.0
        for k in range(0, ROW * bed.count, ROW):
            away = bed.rows[k + X] - from_x
            if bed.rows[k + BELOW] == number and bears(bed, k, faced):
                if away * (outer_x - from_x) > 0.0 and abs(away) > furthest:
                    inner, furthest = k, abs(away)
        if (from_x < outer_x) != left:
            inner = outer
        inner_x = bed.rows[inner + X]
        was = part * (at - from_x) / (outer_x - from_x)
        share = part * (at - from_x) / (inner_x - from_x)
        sign = 1.0 if left else -1.0
        moment += sign * (share * (edge_x - inner_x) - was * (edge_x - outer_x))
        hold = min(
            -sign * share * leaning(bed, inner, wall.mu, -sign),
            sign * (part - share) * leaning(bed, held, wall.mu, sign),
        )
        moment -= max(hold, 0.0) * (bed.rows[inner + Y] - edge_y)
    return moment <= near * loads[3 * number]


def comes_back(below, number, tipped, again):
    """Say whether a load acts over the edge again once a block has tipped about it.

    What lies on the block is put down again, and does not fall.
    """
    kept: list = []
    wall: BuiltWall = copied(below, [(below.ids[number], tipped)])
    add(wall, number, tipped)
    wall = laid_too(wall, again)
    if not all(is_near(wall, wall.get(block), one, 1.0) for block, one in again):
        return False
    find_beds(wall)
    alone: cython.p_uchar = kept_flags(kept, len(wall.ids))
    alone[number] = 1
    loads: cython.p_double = loads_of(wall, alone, -1, kept)
    x: cython.double = loads[3 * number + 1]
    left: cython.bint = tipped.angle_deg > below.built[number].angle_deg
    bed: Bed = wall.beds[number]
    for k in range(0, ROW * bed.count, ROW):
        if bears(bed, k, False) and (bed.rows[k + X] <= x if left else bed.rows[k + X] >= x):
            return True
    return stays(wall, number, loads, False)


def rolled(wall, number, loads):
    """Let a block go under its load, and put down again what lies on it.

    It stays where it is held: what lies on it has no room to follow.
    """
    kept: list = []
    built = wall.built[number]
    rules = wall.how(built.size).rules
    x: cython.double = loads[3 * number + 1]
    y: cython.double = loads[3 * number + 2]
    marks: cython.p_uchar = kept_flags(kept, len(wall.ids))
    boxes: cython.p_double = kept_doubles(kept, 4 * wall.size)
    marks[number] = 1
    mark_burden(wall, marks)
    move_doubles(boxes, 0, wall.boxes, 0, 4 * wall.size)
    lifted = []
    for place in range(wall.size):
        one = wall.order[place]
        if marks[one]:
            lifted.append(one)
            # Nothing touches what has no box.
            wall.boxes[4 * place] = wall.boxes[4 * place + 1] = math.inf
            wall.boxes[4 * place + 2] = wall.boxes[4 * place + 3] = -math.inf
    corners = built.corners - (x, y)  # gravity acts there
    edges = polygon_edges(corners)
    status: cython.int = OVERLAPS
    for sticks in (True, False):
        way: Way = way_of(corners, edges, rules)
        way.sticks = sticks
        status = let_go(way, wall, x, y, 0.0)
        if status == RESTS:
            break
    rests_alone: cython.bint = False
    tipped = []
    if status not in (RESTS, OVERLAPS):
        own: Way = way_of(built.corners - (built.x, built.y), edges, rules)
        rests_alone = let_go(own, wall, built.x, built.y, 0.0) == RESTS
        for part in TIPS:
            less = rules._replace(turn=part * rules.turn, shift=part * rules.shift)
            way = way_of(corners, edges, less)
            let_go(way, wall, x, y, 0.0)
            end_x, end_y, turn_deg = way.here.x, way.here.y, math.degrees(way.here.turn)
            tipped.append(moved_with(built, (x, y), (end_x, end_y), turn_deg))
    move_doubles(wall.boxes, 0, boxes, 0, 4 * wall.size)
    if status == RESTS and way.here.x == x and way.here.y == y and way.here.turn == 0.0:
        return wall
    below: BuiltWall = copied(wall, ())
    take_up(below, marks)
    rest = None
    if status == RESTS:
        turn_deg = math.degrees(way.here.turn)
        rest = moved_with(built, (x, y), (way.here.x, way.here.y), turn_deg)
        x, y = place_on_grid(rest.x, rest.y)
        rest = replace(rest, x=x, y=y)
        add(below, number, rest)
    # What was pushed into another is put down again, too.
    again = [
        (wall.ids[one], wall.built[one]) for one in lifted if one != number or status == OVERLAPS
    ]
    after: BuiltWall = laid_too(below, again)
    if rests_alone and all(is_near(wall, after.get(block), one, HALF) for block, one in again):
        return wall  # what lies on it stays without it, so that it bears as little as it can
    if any(comes_back(below, number, put, again) for put in tipped):
        return wall
    lost = [block for block, one in again if after.get(block) is None]
    if rest is not None and lost:
        # What finds no place where it was goes with the block.
        start, end = (built.x, built.y), (rest.x, rest.y)
        turn_deg = rest.angle_deg - built.angle_deg
        again = [
            (i, moved_with(one, start, end, turn_deg) if i in lost else one) for i, one in again
        ]
        after = laid_too(below, again)
    if rest is not None or status == OVERLAPS:
        for piece in again:
            if after.get(piece[0]) is None:
                trial: BuiltWall = copied(after, [piece])
                if lay(trial, number_of(trial, piece[0]), piece[1]) == OVERLAPS:
                    return wall
    find_beds(after)
    return after


def is_near(wall: BuiltWall, one: Built | None, other: Built, share: float) -> bool:
    """Say whether a block lies within so much of the way to a fall from where it lay."""
    if one is None:
        return False
    rules = wall.how(one.size).rules
    turn_rad = math.radians(wrap_deg(one.angle_deg - other.angle_deg))
    way = math.hypot(one.x - other.x, one.y - other.y)
    return max(way / rules.shift, abs(turn_rad) / rules.turn) <= share


def moved_with(one: Built, start: Pair, end: Pair, turn_deg: float) -> Built:
    """Return a block that moves as a point does, and turns about it."""
    ((x, y),) = turn(np.array([(one.x - start[0], one.y - start[1])]), turn_deg).tolist()
    angle_deg = wrap_deg(one.angle_deg + turn_deg)
    return replace(one, x=x + end[0], y=y + end[1], angle_deg=angle_deg)
