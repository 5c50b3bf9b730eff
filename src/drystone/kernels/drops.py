"""Where a stone could go: its outline dropped onto a height profile, at every column.

The stone comes straight down until it touches.  What that costs is estimated from the profile
alone; the best few places are worth settling exactly.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels import profiles
from drystone.kernels.profiles import Floats, HeightProfile, StoneProfiles

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import doubles, doubles_out, flags, longs, longs_out

Lengths = NDArray[np.int64]

# Who rounds costs may need drops that cost so much more than the limit.
CLOSE = cython.declare(cython.double, 1e-9)

# Columns on which a stone is closer than this, in widths of a column, carry it.
TOUCHING = cython.declare(cython.double, 1.5)

# Cost of the joint of a stone on the ground, or with no joint below.
NO_JOINT = cython.declare(cython.double, 0.5)

# The same of a stone at an end of the wall: that of a top that slopes neither in nor out.
END = cython.declare(cython.double, 1.0)

# The last stage of `look_around`.
STAGES = cython.declare(cython.int, 3)

EDGE = cython.declare(cython.double, profiles.EDGE)
INFINITY = cython.declare(cython.double, np.inf)


class DropTerms(NamedTuple):
    """What a drop costs; lengths in source px."""

    cell_px: float  # width of a column: a px of the working resolution
    width_px: float  # of the wall
    height_px: float
    slack_px: float  # how far a stone may stand out over the wall's height: settling may sink it
    clearance_px: float  # how far it is lifted from where it touches
    # width of the narrowest stone: no farther from an end of the wall there are no joints
    narrowest_px: float
    mean_height_px: float  # of the stones: the units of the costs
    mean_area_px: float
    height: float  # weights of the costs of :func:`drystone.kernels.drops.drops`
    void: float
    gap: float
    slot: float
    headroom: float
    step: float
    joint: float
    # weight of how far the centroid is beside what carries the stone, in widths of the stone
    unbalanced: float
    # what the stones that are left cannot fill of a free width and of a free height, all in
    # working px; not negative
    rest_width_px: Lengths
    rest_height_px: Lengths


class Wanted(NamedTuple):
    """Which places are wanted."""

    spots: int  # how many of each stone at most
    apart_px: Floats  # (k,) how far those of one stone are apart at least, along the wall
    groups: NDArray[np.int64]  # (k,) group of each stone
    cheapest: int = 0  # how many of the cheapest drops are wanted, at least; 0 for all
    each: int = 1  # how many drops of a group count as such at most; not less than 1


def drops(
    profile: HeightProfile,
    stones: StoneProfiles,
    terms: DropTerms,
    constants: Floats,
    wanted: Wanted,
) -> tuple[list[Floats], float]:
    """Return the best places of stones that are dropped onto a height profile, each by itself.

    The wall is seen so that the building side is on the left; profiles of stones are measured from
    their centroids, with columns of the same width.  `constants` (k,) are the costs of the poses
    themselves.

    Returns of each stone rows (n, 4): x of its left end, y of its centroid, cost, and lean, which
    is how far the centroid is right (left when negative) of the columns that carry the stone, in
    widths of the stone.  The cheapest comes first, then the cheapest of those that are far enough
    from it, and so on; of equal costs the lower one, then the one further left.  Drops that cost
    more than the limit, by more than 1e-9, may be missing; it is infinite when all are there.

    The costs are those of :class:`DropTerms`, as the raster has them as far as a profile tells:
    `height` of the centroid and `step` from the left neighbour's top in mean stone heights; in mean
    stone areas `void` under the stone, `gap` to what first reaches over the middle of its height on
    the left (at most 1), and `slot` beside and `headroom` over it that the others cannot fill;
    `joint`, 1 - IWR.  Neighbour and joints are those of the boxes of polygons that show in the
    profile.  At an end of the wall the joint costs as much as a level top.
    """
    if len(profile.tops) != len(profile.owners):
        raise ValueError(f"{len(profile.tops)} tops have {len(profile.owners)} owners")
    if not (len(terms.rest_width_px) and len(terms.rest_height_px)):
        raise ValueError("what stones could fill is not known for any length")
    known = {len(stones.boxes), len(constants), len(wanted.apart_px), len(wanted.groups)}
    if len(known) > 1:
        raise ValueError(f"what is said of each stone is there for {sorted(known)} stones")
    if wanted.each < 1:
        raise ValueError(f"{wanted.each} of a group")
    size: cython.Py_ssize_t = len(constants)
    columns: cython.Py_ssize_t = len(profile.tops)
    numbers = _numbers(columns, stones, terms, wanted)
    # A stone has so many rows; few are the drops that limit how dear others may be.
    most: cython.Py_ssize_t = min(max(0, wanted.spots), int(numbers[:, 0].max(initial=0)))
    few: cython.Py_ssize_t = max(0, wanted.cheapest)
    widest: cython.Py_ssize_t = 1
    number: cython.p_longlong = longs(numbers)
    first: cython.p_longlong = longs(stones.first)
    for at in range(size):
        if number[3 * at] > 0:
            widest = max(widest, first[at + 1] - first[at])
    tops = np.ascontiguousarray(profile.tops)
    boxes = np.ascontiguousarray(shown(profile))
    rest_width = np.ascontiguousarray(terms.rest_width_px)
    rest_height = np.ascontiguousarray(terms.rest_height_px)
    constants = np.ascontiguousarray(constants)
    # What is cheap by itself first: it limits how dear the others may be.
    order_of = np.argsort(constants, kind="stable").astype(np.int64)
    rows, taken = np.empty((size, most, 4)), np.zeros(size, np.int64)
    out: cython.p_double = doubles_out(rows)
    ends: cython.p_longlong = longs_out(taken)
    order: cython.p_longlong = longs(order_of)
    constant: cython.p_double = doubles(constants)
    extents: cython.p_double = doubles(stones.boxes)
    space = np.empty((3 + widest, columns))
    more_space, stages = np.empty(columns, np.int64), np.empty(columns, np.uint8)
    costs, groups = np.empty(few), np.empty(few, np.int64)
    wall: DropWall = DropWall()
    wall.tops, wall.columns = doubles(tops), columns
    wall.boxes, wall.shown = doubles(boxes), len(boxes)
    wall.higher = longs(more_space)
    wall.rest_width, wall.longest_width = longs(rest_width), len(rest_width) - 1
    wall.rest_height, wall.longest_height = longs(rest_height), len(rest_height) - 1
    wall.sums = doubles(space[3:])
    weights: Terms = terms_of(terms)
    found: Places = Places()
    found.lift, found.lean = doubles(space[0]), doubles(space[1])
    found.cost, found.stage = doubles(space[2]), flags(stages)
    found.bottoms = doubles(stones.bottoms)
    kept: Kept = Kept()
    kept.cost, kept.group, kept.count = doubles(costs), longs(groups), 0
    kept.most, kept.each, kept.limit = few, wanted.each, INFINITY
    with cython.nogil:
        rise(wall)
        add_up(wall, widest)
        for turn in range(size):
            at = order[turn]
            found.count = number[3 * at]
            if found.count <= 0:
                continue
            found.first, found.columns = first[at], first[at + 1] - first[at]
            found.left, found.bottom = extents[4 * at], extents[4 * at + 1]
            found.right, found.top = extents[4 * at + 2], extents[4 * at + 3]
            lay_down(wall, weights, constant[at], found)
            ends[at] = take(
                wall, weights, number[3 * at + 1], kept.limit + CLOSE, found,
                out, 4 * most * at, most,
            )  # fmt: skip
            keep(kept, out, 4 * most * at, ends[at], number[3 * at + 2])
    return [mine[:count] for mine, count in zip(rows, taken.tolist(), strict=True)], kept.limit


def _numbers(
    columns: int, stones: StoneProfiles, terms: DropTerms, wanted: Wanted
) -> NDArray[np.int64]:
    """Return a row for each stone; every x is on a column edge.

    On how many columns, from the first on, its left end may be; how many columns its places are
    apart; its group.
    """
    room = terms.width_px - (stones.boxes[:, 2] - stones.boxes[:, 0])
    last = np.minimum(
        np.floor(room / terms.cell_px + profiles.EDGE), columns - np.diff(stones.first)
    )
    apart = np.ceil(wanted.apart_px / terms.cell_px - profiles.EDGE)
    numbers = np.empty((len(stones.boxes), 3), np.int64)
    numbers[:, 0] = np.maximum(last + 1.0, 0.0)
    numbers[:, 1] = np.minimum(np.maximum(apart, 1.0), max(1, columns))
    numbers[:, 2] = wanted.groups
    return numbers


def shown(profile: HeightProfile) -> Floats:
    """Return the boxes of the polygons that own columns, in their order."""
    owners = np.unique(profile.owners)
    owners = owners[owners >= 0]
    if len(owners) and owners[-1] >= len(profile.boxes):
        raise ValueError(f"a column of polygon {owners[-1]}, but there are {len(profile.boxes)}")
    return np.asarray(profile.boxes[owners])


@cython.cclass
class Terms:
    """The numbers of a :class:`DropTerms`, and weights of lengths and areas."""


@cython.cclass
class DropWall:
    """What stones are dropped on."""


@cython.cclass
class Places:
    """A stone, and the places where it was dropped."""


@cython.cclass
class Kept:
    """The cheapest drops of all stones so far, only so many of a group."""


def terms_of(terms):
    """Read the numbers of a :class:`DropTerms`."""
    read: Terms = Terms()
    read.cell, read.width, read.height = terms.cell_px, terms.width_px, terms.height_px
    read.slack, read.clearance = terms.slack_px, terms.clearance_px
    read.narrowest, read.mean_area = terms.narrowest_px, terms.mean_area_px
    read.gap, read.joint, read.unbalanced = terms.gap, terms.joint, terms.unbalanced
    read.of_height = terms.height / terms.mean_height_px
    read.of_step = terms.step / terms.mean_height_px
    read.of_void = terms.void / terms.mean_area_px
    read.of_slot = terms.slot / terms.mean_area_px
    read.of_headroom = terms.headroom / terms.mean_area_px
    least: cython.double = min(read.gap, read.of_slot, read.of_step, read.joint, read.unbalanced)
    read.rising = read.mean_area > 0.0 and least >= 0.0
    return read


def keep(kept, rows, start, count, group):
    """Take in the drops of a stone where they are among the cheapest; the limit may fall."""
    if kept.most <= 0:
        return
    for row in range(start, start + 4 * count, 4):
        of_group, dearest, dearest_of_group = 0, 0, 0
        for at in range(kept.count):
            if kept.cost[at] > kept.cost[dearest]:
                dearest = at
            if kept.group[at] == group:
                if not of_group or kept.cost[at] > kept.cost[dearest_of_group]:
                    dearest_of_group = at
                of_group += 1
        if of_group < kept.each and kept.count < kept.most:
            out = kept.count
            kept.count += 1
        else:
            out = dearest if of_group < kept.each else dearest_of_group
            if rows[row + 2] >= kept.cost[out]:
                continue
        kept.cost[out], kept.group[out] = rows[row + 2], group
    if kept.count == kept.most:
        kept.limit = kept.cost[0]
        for at in range(1, kept.count):
            kept.limit = max(kept.limit, kept.cost[at])


def take(wall, terms, apart, limit, found, out, start, most):
    """Write the cheapest places that are so many columns apart; return how many there are."""
    taken: cython.Py_ssize_t = 0
    if not terms.rising:
        for at in range(found.count):
            if found.cost[at] < INFINITY:
                look_around(wall, terms, found, at, STAGES)
    while taken < most:
        at = cheapest(wall, terms, limit, found)
        if at < 0:
            break
        near = start + 4 * taken
        out[near] = at * terms.cell
        out[near + 1] = found.lift[at] + terms.clearance
        out[near + 2] = found.cost[at]
        out[near + 3] = found.lean[at]
        taken += 1
        for near in range(max(0, at - apart + 1), min(found.count, at + apart)):
            found.cost[near] = INFINITY
    return taken


def cheapest(wall, terms, limit, found):
    """Return the place of the least cost; of equal ones the lower, then the first.

    -1 when it costs more than the limit.  Places that are dearer already than that, or than
    another one at last, are left as they are: they only become dearer.
    """
    for stage in range(1, STAGES + 1):
        # What costs least so far does not cost much more at last.
        best = least(found)
        if not found.cost[best] <= limit or found.cost[best] == INFINITY:
            return -1
        look_around(wall, terms, found, best, STAGES)
        limit = min(limit, found.cost[best])
        for at in range(found.count):
            if found.cost[at] <= limit and found.stage[at] < stage:
                look_around(wall, terms, found, at, stage)
                if stage == STAGES:
                    limit = min(limit, found.cost[at])
    best = least(found)
    return best if found.cost[best] <= limit else -1


def least(found):
    """Return the place that costs least so far; of equal ones the lower, then the first."""
    best: cython.Py_ssize_t = 0
    cost: cython.p_double = found.cost
    lift: cython.p_double = found.lift
    lowest: cython.double = cost[0]
    for at in range(1, found.count):
        if cost[at] <= lowest and (cost[at] < lowest or lift[at] < lift[best]):
            best, lowest = at, cost[at]
    return best


def rise(wall):
    """Find the next higher column to the right of each; past the last where there is none."""
    for at in range(wall.columns - 1, -1, -1):
        further = at + 1
        while further < wall.columns and wall.tops[further] <= wall.tops[at]:
            further = wall.higher[further]
        wall.higher[at] = further


def add_up(wall, widest):
    """Sum up as many columns as may be under a stone, but for its last one."""
    columns: cython.Py_ssize_t = wall.columns
    tops: cython.p_double = wall.tops
    sums: cython.p_double = wall.sums
    for at in range(columns):
        sums[at] = 0.0
    for k in range(widest - 1):
        row = k * columns
        for at in range(columns - k):
            sums[row + columns + at] = sums[row + at] + tops[at + k]


def lay_down(wall, terms, constant, found):
    """Drop the stone everywhere: what that costs without a look around."""
    before: cython.Py_ssize_t = found.columns - 1
    count: cython.Py_ssize_t = found.count
    hollow: cython.double = 0.0
    cell: cython.double = terms.cell
    width: cython.double = found.right - found.left
    last: cython.double = width - before * cell
    last_bottom: cython.double = found.bottoms[found.first + before]
    high: cython.double = terms.height
    highest: cython.double = terms.height + terms.slack
    wide: cython.double = cell * width
    top: cython.double = found.top
    most: cython.double = wall.longest_height
    of_height: cython.double = terms.of_height
    of_void: cython.double = terms.of_void
    of_headroom: cython.double = terms.of_headroom
    lift: cython.p_double = found.lift
    cost: cython.p_double = found.cost
    tops: cython.p_double = wall.tops
    under: cython.p_double = wall.sums
    row: cython.Py_ssize_t = before * wall.columns
    for k in range(found.first, found.first + before):
        hollow += found.bottoms[k]
    land(found, tops)
    for at in range(count):
        y = lift[at]
        void = cell * ((y * before + hollow) - under[row + at])
        void = void + last * ((y + last_bottom) - tops[before + at])
        free = cython.cast(cython.Py_ssize_t, min(max((high - (y + top)) / cell + EDGE, 0.0), most))
        price = constant + of_height * y
        price = price + of_void * void
        price = price + of_headroom * (wall.rest_height[free] * wide)
        cost[at] = INFINITY if y + top > highest else price
        found.stage[at] = 0


def land(found, tops):
    """Find where the stone touches at all places: four of its columns at a time."""
    j: cython.Py_ssize_t = 0
    count: cython.Py_ssize_t = found.count
    bottoms: cython.p_double = found.bottoms
    lift: cython.p_double = found.lift
    for at in range(count):
        lift[at] = -INFINITY
    while j + 4 <= found.columns:
        k = found.first + j
        one, two, three, four = bottoms[k], bottoms[k + 1], bottoms[k + 2], bottoms[k + 3]
        for at in range(count):
            high = max(lift[at], tops[at + j] - one)
            high = max(high, tops[at + j + 1] - two)
            high = max(high, tops[at + j + 2] - three)
            lift[at] = max(high, tops[at + j + 3] - four)
        j += 4
    while j < found.columns:
        one = bottoms[found.first + j]
        for at in range(count):
            lift[at] = max(lift[at], tops[at + j] - one)
        j += 1


def look_around(wall, terms, found, at, stage):
    """Add further costs of a place, up to a stage.

    The first is that of what is free beside the stone, then that of the left neighbour, then
    those of joints and of what carries it.
    """
    lift: cython.double = found.lift[at]
    left: cython.double = at * terms.cell
    right: cython.double = left + (found.right - found.left)
    bottom: cython.double = lift + found.bottom
    top: cython.double = lift + found.top
    cost: cython.double = found.cost[at]
    if found.stage[at] < 1 and stage >= 1:
        cost = with_room(cost, wall, terms, bottom, top, at, at + found.columns)
    if found.stage[at] < 2 and stage >= 2:
        cost = cost + terms.of_step * step(wall, left, bottom, right, top)
    if found.stage[at] < STAGES and stage >= STAGES:
        found.lean[at] = leaning(wall, terms, found, at)
        cost = cost + terms.joint * joint(wall, terms, left, bottom, right, top)
        cost = cost + terms.unbalanced * abs(found.lean[at])
    found.cost[at] = cost
    found.stage[at] = stage


def with_room(cost, wall, terms, bottom, top, at, end):
    """Add the costs of what is free on the left of a stone and on its right."""
    area: cython.double = 0.0
    middle: cython.double = (bottom + top) / 2.0
    foot: cython.double = bottom + terms.cell
    full: cython.double = terms.mean_area / terms.cell
    to_left: cython.Py_ssize_t = at - 1
    to_right: cython.Py_ssize_t = end
    while to_left >= 0 and wall.tops[to_left] < middle and area < full:
        area += top - max(wall.tops[to_left], bottom)
        to_left -= 1
    cost = cost + terms.gap * min(1.0, area * terms.cell / terms.mean_area)
    while to_right < wall.columns and wall.tops[to_right] <= foot:
        to_right = wall.higher[to_right]
    free = min(to_right - end, wall.longest_width)
    return cost + terms.of_slot * (wall.rest_width[free] * (terms.cell * (top - bottom)))


def step(wall, left, bottom, right, top):
    """Return how far the top is from level with the left neighbour's (Eq. 6)."""
    boxes: cython.p_double = wall.boxes
    nearest: cython.Py_ssize_t = -1
    for k in range(0, 4 * wall.shown, 4):
        if not 2.0 * boxes[k + 2] <= left + right:
            continue
        if nearest >= 0 and boxes[k + 2] < boxes[nearest + 2]:
            continue
        shared = min(boxes[k + 3], top) - max(boxes[k + 1], bottom)
        smaller = min(boxes[k + 3] - boxes[k + 1], top - bottom)
        if not 2.0 * shared >= smaller:
            continue
        if nearest < 0 or boxes[k + 2] > boxes[nearest + 2] or boxes[k + 3] > boxes[nearest + 3]:
            nearest = k
    return 0.0 if nearest < 0 else abs(top - boxes[nearest + 3])


def joint(wall, terms, left, bottom, right, top):
    """Return 1 - IWR (Eq. 9)."""
    boxes: cython.p_double = wall.boxes
    middle: cython.double = (bottom + top) / 2.0
    ratios: cython.double = 0.0
    least_one: cython.double = INFINITY
    least_two: cython.double = INFINITY
    one: cython.Py_ssize_t = -1
    two: cython.Py_ssize_t = -1
    if min(left, terms.width - right) < terms.narrowest:
        return END
    if bottom < terms.cell / 2.0:
        return NO_JOINT
    for k in range(0, 4 * wall.shown, 4):
        if boxes[k + 3] > middle:
            continue
        rise_ = boxes[k + 3] - bottom
        away = boxes[k + 2] - left
        distance = away * away + rise_ * rise_
        if boxes[k + 2] < terms.width - terms.narrowest and distance < least_one:
            one, least_one = k, distance
        away = boxes[k] - right
        distance = away * away + rise_ * rise_
        if boxes[k] > terms.narrowest and distance < least_two:
            two, least_two = k, distance
    if one < 0 and two < 0:
        return NO_JOINT
    if one >= 0:
        ratios = min(1.0, abs(boxes[one + 2] - left) / (boxes[one + 2] - boxes[one]))
    if two >= 0:
        ratios += min(1.0, abs(boxes[two] - right) / (boxes[two + 2] - boxes[two]))
    return 1.0 - ratios / (2.0 if one >= 0 and two >= 0 else 1.0)


def leaning(wall, terms, found, at):
    """Return how far the centroid is right of what carries the stone, in widths."""
    bottoms: cython.p_double = found.bottoms
    tops: cython.p_double = wall.tops
    first: cython.Py_ssize_t = found.first
    start: cython.Py_ssize_t = 0
    end: cython.Py_ssize_t = found.columns - 1
    lift: cython.double = found.lift[at]
    width: cython.double = found.right - found.left
    limit: cython.double = TOUCHING * terms.cell
    # One column at least touches.
    while start < end and (lift + bottoms[first + start]) - tops[at + start] >= limit:
        start += 1
    while end > start and (lift + bottoms[first + end]) - tops[at + end] >= limit:
        end -= 1
    left = -found.left - start * terms.cell
    right = -found.left - min(width, (end + 1) * terms.cell)
    return (min(0.0, left) + max(0.0, right)) / width
