"""Plan a wall course by course: anneal the order of its stones on height profiles.

Stones of a course stand side by side, as near as their faces allow; each is dropped on the course
below and turned until it rests on two points.  How straight joints run is told from their ends
alone (DESIGN 5 measures it on pixels).

A course that is laid again takes from the old one the stones that lie where they did, on columns
that are as they were.  Courses have numbers in the arrays of a scene, and -1 is none; the ground
is 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from drystone.kernels import course_types
from drystone.kernels.course_types import (
    Arrangement,
    Cooling,
    Floats,
    Ground,
    Ints,
    Joints,
    Layout,
    Poses,
    Rules,
)

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.course_moves import (
        Dice,
        Draft,
        change,
        copy,
        drawn,
        left_of,
        parts_of,
        start,
        start_of,
    )
    from drystone.kernels.lists import doubles, ints, kept_doubles, kept_ints, longs, move_ints

# Evaluations after which a look is taken at whether to go on.
ROUND = 1024

# Numbers that are drawn to accept a costlier plan are rounded to one of so many.
LOGS = cython.declare(cython.int, 4096)

_LUCK: Floats = np.array([-math.log((i + 0.5) / LOGS) for i in range(LOGS)])
_LUCK.flags.writeable = False

COLUMN_BITS = cython.declare(cython.int, course_types.COLUMN_BITS)
COLUMN_UNITS = cython.declare(cython.int, course_types.COLUMN_UNITS)
PIXEL_UNITS = cython.declare(cython.int, course_types.PIXEL_UNITS)
SLOPE_BITS = cython.declare(cython.int, course_types.SLOPE_BITS)
SLOPE_ONE = cython.declare(cython.double, course_types.SLOPE_ONE)
PARTS = cython.declare(cython.int, course_types.PARTS)
TERMS = cython.declare(cython.int, course_types.TERMS)
STARTS = cython.declare(cython.int, course_types.STARTS)
INSET_OF = cython.declare(cython.int, course_types.INSET[0])
INSET_PARTS = cython.declare(cython.int, course_types.INSET[1])

# A bound of a cost is a sum in another order: far less than this share of it off.
ROUNDING = cython.declare(cython.double, 1e9)
INFINITY = cython.declare(cython.double, math.inf)

# Distance of the first start from the end, and open rows and columns around the wall, px.
FIRST_PX = cython.declare(cython.int, course_types.FIRST_PX)
PADDING_PX = cython.declare(cython.int, course_types.PADDING_PX)

# How many of the shortest paths are averaged.
SHORTEST = cython.declare(cython.int, 5)

# What a step up or down adds to a path, over 1024.
DIAGONAL = cython.declare(cython.longlong, 424)

# More than any way, and far from what an integer cannot hold.
FAR = cython.declare(cython.int, 1 << 29)


def evaluate(poses: Poses, plan: Arrangement, ground: Ground, rules: Rules) -> Layout:
    """Return where the stones of an arrangement lie, and what that costs."""
    check(poses, plan, ground, rules)
    courses: cython.int = len(plan.sizes)
    s: Scene = scene_on(ground, courses + 1, len(plan.order))
    furnish(s, poses, rules)
    now: Trial = trial_of(plan, courses, 0)
    cost: cython.double = laid_again(s, now, now, 0, INFINITY, INFINITY)
    stones = [s.most * i + j for i in range(1, courses + 1) for j in range(s.counts[i])]
    rows = [[s.terms[TERMS * i + j] for j in range(TERMS)] for i in range(1, courses + 1)]
    last: cython.Py_ssize_t = s.columns * courses
    end: cython.Py_ssize_t = s.most_joints * courses
    outside = plan.order[sum(plan.sizes.tolist()) :]
    whole = [0.0] * 14 + [float(poses.area[outside].sum()), s.across, s.down]
    return Layout(
        np.array([s.x[i] for i in stones], np.int32),
        np.array([s.y[i] for i in stones], np.int32),
        np.array([s.slope[i] for i in stones], np.int32),
        np.array([s.tops[last + i] for i in range(s.columns)], np.int32),
        np.array(
            [
                (s.joints[2 * (end + i)], s.joints[2 * (end + i) + 1])
                for i in range(s.joint_counts[courses])
            ],
            np.int32,
        ),
        np.array([*rows, whole], np.float64),
        cost,
    )


def anneal(
    poses: Poses,
    plan: Arrangement,
    ground: Ground,
    rules: Rules,
    cooling: Cooling,
    look: Callable[[], None] = lambda: None,
) -> tuple[Arrangement, float]:
    """Change an arrangement at random, at a falling temperature; return the cheapest, and its cost.

    A look is taken before the first evaluation and after every :data:`ROUND` of them; what it
    raises ends the annealing.
    """
    check(poses, plan, ground, rules)
    most: cython.int = rules.courses
    s: Scene = scene_on(ground, 2 * most + 1, len(plan.order))
    furnish(s, poses, rules)
    now: Trial = trial_of(plan, most, 0)
    trial: Trial = trial_of(plan, most, most)
    best: Trial = trial_of(plan, most, 0)
    dice: Dice = Dice(cooling.seed)
    luck: cython.p_double = doubles(_LUCK)
    evaluations: cython.Py_ssize_t = cooling.evaluations
    each: cython.Py_ssize_t = ROUND
    factor: cython.double = cooling.factor
    doubt: cython.double = cooling.doubt
    s.temperature = cooling.temperature
    now.cost = best.cost = laid_again(s, now, now, 0, INFINITY, doubt)
    now.laid = now.courses
    for done in range(0, evaluations, each):
        look()
        count = min(each, evaluations - done)
        with cython.nogil:
            search(s, now, trial, best, most, dice, luck, count, factor, doubt)
    return Arrangement(*parts_of(best)), best.cost


def check(poses: Poses, plan: Arrangement, ground: Ground, rules: Rules) -> None:
    """Refuse arrays that do not fit each other."""
    stones = poses.area.size
    courses = plan.sizes.size
    placed = int(plan.sizes.sum())
    if not np.array_equal(np.sort(plan.order), np.arange(stones)) or plan.turns.size != stones:
        raise ValueError("an arrangement has every stone once")
    if not 1 <= courses <= rules.courses or plan.sizes.min() < 1 or placed > stones:
        raise ValueError("courses must not be empty, nor too many")
    if plan.gaps.size != courses or not (abs(plan.gaps + 0.5) < plan.sizes + 1).all():
        raise ValueError("a gap must be in its course")
    if ((plan.turns < 0) | (plan.turns > 3)).any():
        raise ValueError("turns are quarters, 0 to 3")
    if np.diff(poses.first).max() > ground.tops.size or poses.width.max() > ground.width:
        raise ValueError("a stone is wider than the wall")
    joints = ground.joints.shape[0]
    if ground.joints.shape != (joints, 2) or ground.ways.shape != (joints, course_types.STARTS):
        raise ValueError("there is a way from each start to each joint")
    if min(rules.weights) < 0.0 or rules.reach < 1 or rules.joint < 0 or rules.steepest < 0:
        raise ValueError("weights and lengths must not be negative")


def ways_up(joints: Joints, below: Joints, ways: Ints, width: int) -> Ints:
    """Return how far paths from the bottom to the joints of a course go aside, (joints, STARTS).

    `ways` are those to the joints below.  Zeros beyond the starts.
    """
    nothing = np.zeros(0, np.int32)
    under = np.array(below, np.int32).reshape(-1, 2)
    s: Scene = scene_on(Ground(nothing, under, ways, nothing, width, 0), 2, len(joints))
    s.joint_counts[1] = len(joints)
    at: cython.Py_ssize_t = s.most_joints
    for i, (left, right) in enumerate(joints, s.most_joints):
        s.joints[2 * i], s.joints[2 * i + 1] = left, right
    go_up(s, 0, 1)
    found = [s.ways[STARTS * at + i] for i in range(STARTS * s.joint_counts[1])]
    return np.array(found, np.int32).reshape(-1, course_types.STARTS)


@cython.cclass
class Scene:
    """Stones, wall and rules, and room for courses.

    Stones and joints of a course begin at its number times the most of them.
    """


@cython.cclass
class Trial(Draft):
    """A draft, and the courses that are laid for it."""


def scene_on(ground, slots, stones):
    """Return a wall with room for so many courses, the ground among them, of so many stones."""
    s: Scene = Scene()
    given: cython.int = len(ground.joints)
    s.room = room = [ground]
    s.columns, s.most, s.most_joints = len(ground.tops), stones, max(stones + 1, given)
    s.wall_width, s.wall_height = ground.width, ground.height
    s.given, s.given_count = ints(ground.beds), len(ground.beds)
    s.pose, s.x = kept_ints(room, slots * stones), kept_ints(room, slots * stones)
    s.column, s.y = kept_ints(room, slots * stones), kept_ints(room, slots * stones)
    s.slope, s.rock = kept_ints(room, slots * stones), kept_ints(room, slots * stones)
    s.heights = kept_ints(room, PARTS * slots * stones)
    s.void, s.short_ = kept_doubles(room, slots * stones), kept_doubles(room, slots * stones)
    s.tops = kept_ints(room, slots * s.columns)
    s.joints = kept_ints(room, 2 * slots * s.most_joints)
    s.ways = kept_ints(room, STARTS * slots * s.most_joints)
    s.counts, s.gaps = kept_ints(room, slots), kept_ints(room, slots)
    s.joint_counts, s.beds = kept_ints(room, slots), kept_ints(room, 3 * slots)
    s.terms = kept_doubles(room, TERMS * slots)
    s.sure, s.costs = kept_doubles(room, slots), kept_doubles(room, slots)
    s.lift, s.seen = kept_ints(room, s.columns), kept_ints(room, slots)
    s.starts, s.top_starts = kept_ints(room, STARTS), kept_ints(room, STARTS)
    s.lengths, s.best = kept_ints(room, STARTS), kept_ints(room, STARTS)
    s.start_count = fill_starts(s.wall_width, s.starts)
    s.joint_counts[0] = given
    move_ints(s.tops, 0, ints(ground.tops), 0, s.columns)
    move_ints(s.joints, 0, ints(ground.joints), 0, 2 * given)
    move_ints(s.ways, 0, ints(ground.ways), 0, STARTS * given)
    return s


def furnish(s, poses, rules):
    """Let a scene point to poses, and take over rules."""
    weights = np.array(rules.weights, np.float64)
    s.room += [poses, weights]
    s.first, s.first_row, s.area = longs(poses.first), longs(poses.first_row), longs(poses.area)
    s.bottoms, s.tips = ints(poses.bottoms), ints(poses.tops)
    s.lefts, s.rights = ints(poses.lefts), ints(poses.rights)
    s.width, s.height, s.middle = ints(poses.width), ints(poses.height), ints(poses.middle)
    s.peaks = ints(poses.peaks)
    s.part_at, s.faces, s.weights = ints(poses.part_at), ints(poses.faces), doubles(weights)
    s.reach, s.margin, s.steepest = rules.reach, rules.margin, rules.steepest
    s.joint, s.target = rules.joint, rules.target
    return 0


def trial_of(plan, most, first_slot):
    """Return a trial whose courses come after a number; those of the ground come first."""
    trial: Trial = Trial()
    start(trial, plan, most)
    trial.slots = kept_ints(trial.room, most + 1)
    for i in range(1, most + 1):
        trial.slots[i] = first_slot + i
    trial.laid = 0
    trial.outer = trial.cost = 0.0
    return trial


def search(s, now, trial, best, most, dice, luck, evaluations, factor, doubt):
    """Anneal for a while."""
    for _ in range(evaluations):
        s.temperature *= factor
        copy(now, trial)
        lowest = change(trial, dice, most)
        if lowest < 0:
            continue
        limit = now.cost + s.temperature * luck[drawn(dice, LOGS)]
        trial.cost = laid_again(s, now, trial, lowest, limit, doubt)
        if not trial.cost <= limit:
            continue
        copy(trial, now)
        now.cost, now.outer, now.laid = trial.cost, trial.outer, trial.courses
        for i in range(lowest + 1, trial.courses + 1):
            now.slots[i], trial.slots[i] = trial.slots[i], now.slots[i]
        if now.cost < best.cost:
            copy(now, best)
            best.cost = now.cost


def laid_again(s, now, trial, lowest, limit, doubt):
    """Lay the courses of a trial from the lowest that changed, until it costs more than a limit.

    What it must cost at least is known before any stone is laid.
    """
    courses: cython.int = trial.courses
    highest: cython.int[1] = [0]
    bound: cython.double = limit + abs(limit) / ROUNDING
    was: cython.double = now.outer
    trial.outer = left_out(s, trial)
    cost: cython.double = trial.outer
    for course in range(lowest):
        slot = now.slots[course + 1]
        s.seen[course] = slot
        was += s.costs[slot]
        cost += s.costs[slot]
    sure = stood(s, now, trial, lowest, highest)
    if cost + sure > bound:
        return INFINITY
    s.changed = s.unchanged = 0
    below = now.slots[lowest]
    doubtful: cython.bint = courses == now.laid and highest[0] < courses - 1
    near: cython.double = 0.0
    if doubtful:
        for course in range(lowest, highest[0] + 1):
            was += s.costs[now.slots[course + 1]]
            near += s.sure[trial.slots[course + 1]]
    for course in range(lowest, courses):
        slot = trial.slots[course + 1]
        old = now.slots[course + 1] if course < now.laid else -1
        left: cython.double = bound - cost - sure
        if doubtful and course < courses - 1:
            if course > highest[0]:
                was += s.costs[old]
                near = s.sure[slot]
            left = min(left, was + (limit - now.cost + doubt) + (bound - limit) - cost - near)
        if not lay(s, below, old, course == courses - 1, left, slot):
            return INFINITY
        s.seen[course] = below = slot
        cost += s.costs[slot]
        sure -= s.sure[slot]
        near -= s.sure[slot]
        if cost + sure > bound:
            return INFINITY
        if doubtful and highest[0] <= course < courses - 1:
            if cost - was > limit - now.cost + doubt:
                return INFINITY
    return with_paths(s, now, trial, lowest, cost, bound)


def left_out(s, draft):
    """Return what the stones that are left out cost."""
    area: cython.longlong = 0
    for i in range(start_of(draft, draft.courses), draft.stones):
        area += s.area[draft.order[i]]
    return area * s.weights[14]


def with_paths(s, now, trial, lowest, cost, bound):
    """Add to the cost of all courses that of the paths along the joints of the wall."""
    courses: cython.int = trial.courses
    below = now.slots[lowest]
    last = trial.slots[courses] if courses > lowest else below
    top = top_of(s, last)
    s.across = across(s, courses, top)
    if cost + s.across * s.weights[15] > bound:
        return INFINITY
    for course in range(lowest + 1, courses + 1):
        slot = trial.slots[course]
        go_up(s, below, slot)
        below = slot
    s.down = down(s, last, top)
    return cost + (s.across * s.weights[15] + s.down * s.weights[16])


def stood(s, now, trial, lowest, highest):
    """Stand the stones of a trial side by side; return what its courses cost at least.

    The highest of its courses that changed is told.
    """
    place: cython.int = start_of(trial, lowest)
    was: cython.bint = True
    sure: cython.double = 0.0
    below = now.slots[lowest]
    for course in range(lowest, trial.courses):
        slot = trial.slots[course + 1]
        old = now.slots[course + 1] if course < now.laid else -1
        same: cython.bint = stand(s, trial, place, course, old, slot)
        if not same:
            highest[0] = course
        meet(s, below, old if same and was else -1, slot)
        was, below = same, slot
        sure += s.sure[slot]
        place += trial.sizes[course]
    return sure


def stand(s, draft, start, course, old, out):
    """Stand the stones of a course, at least one, side by side.

    Return whether they are those of an old course: then all that is known of it is copied but its
    tops and ways.  What is found here does not depend on how they lie.
    """
    count: cython.int = draft.sizes[course]
    gap: cython.int = draft.gaps[course]
    same: cython.bint = old >= 0 and s.counts[old] == count and s.gaps[old] == gap
    here: cython.Py_ssize_t = s.most * out
    there: cython.Py_ssize_t = s.most * old
    s.counts[out], s.gaps[out], s.joint_counts[out] = count, gap, count + 1
    for i in range(count):
        stone = draft.order[start + i]
        pose = 4 * stone + draft.turns[stone]
        s.pose[here + i] = pose
        same = same and s.pose[there + i] == pose
    if same:
        for i in range(count):
            s.x[here + i] = s.x[there + i]
            copy_stone(s, there + i, here + i)
        here, there = 2 * s.most_joints * out, 2 * s.most_joints * old
        move_ints(s.joints, here, s.joints, there, 2 * count + 2)
        for i in range(TERMS):
            s.terms[TERMS * out + i] = s.terms[TERMS * old + i]
        return True
    room = side_by_side(s, out)
    open_ends(s, out)
    left, right = s.pose[here], s.pose[here + count - 1]
    here = 2 * s.most_joints * out
    end = here + 2 * count
    s.terms[TERMS * out + 4] = max(0, -room)
    # How far the faces at the ends are from the ends of the wall.
    s.terms[TERMS * out + 12] = (
        s.joints[here + 1] + s.faces[2 * left]
        + s.joints[end + 1] - s.joints[end] + s.faces[2 * right + 1]
    )  # fmt: skip
    s.terms[TERMS * out + 13] = 0.0
    for i in range(s.most * out, s.most * out + count):
        high = s.height[s.pose[i]] - s.width[s.pose[i]]
        if high > 0:
            s.terms[TERMS * out + 13] += 1.0 * high / s.width[s.pose[i]]
    return False


def copy_stone(s, one, to):
    """Let a stone lie as in another course, but for its left end."""
    s.column[to], s.y[to], s.slope[to] = s.column[one], s.y[one], s.slope[one]
    s.rock[to], s.void[to], s.short_[to] = s.rock[one], s.void[one], s.short_[one]
    move_ints(s.heights, PARTS * to, s.heights, PARTS * one, PARTS)


def meet(s, below, old, out):
    """Count the joints of a course above those below, and add up what is known to cost.

    An old course has the same joints above the same.
    """
    t: cython.Py_ssize_t = TERMS * out
    s.terms[t + 3] = crossing(s, out, below) if old < 0 else s.terms[TERMS * old + 3]
    s.sure[out] = s.terms[t + 3] * s.weights[3]
    s.sure[out] += s.terms[t + 4] * s.weights[4] + s.terms[t + 12] * s.weights[12]
    s.sure[out] += s.terms[t + 13] * s.weights[13]


def side_by_side(s, out):
    """Find the left ends of the stones of a course; return the room that they leave."""
    inset: cython.int = 0
    total: cython.int = 0
    gap = s.gaps[out]
    from_left = left_of(gap)
    here: cython.Py_ssize_t = s.most * out
    before = s.pose[here]
    # Distances first, then places.
    room = s.wall_width
    s.x[here] = 0
    for i in range(here + 1, here + s.counts[out]):
        s.x[i] = nest(s, before, s.pose[i]) + s.joint
        room -= s.x[i]
        before = s.pose[i]
    room -= s.width[before]
    if gap < 0 and room > 0:
        inset = room * INSET_OF // INSET_PARTS
    for i in range(s.counts[out]):
        pose = s.pose[here + i]
        total += s.x[here + i]
        # What is laid from the right end is as far from there as it would be from a full course.
        x = total + inset if i < from_left else total + room - inset
        x = max(0, min(x, s.wall_width - s.width[pose]))
        s.x[here + i] = x
        s.column[here + i] = min(
            (x + COLUMN_UNITS // 2) >> COLUMN_BITS, s.columns - columns_of(s, pose)
        )
    return room


def nest(s, left, right):
    """Return how far apart the left ends of two neighbours are, their lowest points level."""
    rights: cython.p_int = s.rights
    lefts: cython.p_int = s.lefts
    one, two = s.first_row[left], s.first_row[right]
    most = rights[one] - lefts[two]
    for i in range(1, min(s.first_row[left + 1] - one, s.first_row[right + 1] - two)):
        here = rights[one + i] - lefts[two + i]
        most = here if here > most else most
    return most


def open_ends(s, out):
    """Find the ends of the head joints of a course, with what is free at the wall's ends."""
    here: cython.Py_ssize_t = s.most * out
    joint: cython.Py_ssize_t = 2 * s.most_joints * out
    count = s.counts[out]
    s.joints[joint], s.joints[joint + 1] = 0, s.x[here]
    for i in range(count):
        left = s.x[here + i] + s.width[s.pose[here + i]]
        right = s.x[here + i + 1] if i + 1 < count else s.wall_width
        if left > right:
            left = right = (left + right) >> 1
        s.joints[joint + 2 * i + 2], s.joints[joint + 2 * i + 3] = left, right


def crossing(s, out, below):
    """Return how much joints are above joints; what is free at the ends is none."""
    total: cython.double = 0.0
    joints: cython.p_int = s.joints
    here: cython.Py_ssize_t = 2 * s.most_joints * out
    there: cython.Py_ssize_t = 2 * s.most_joints * below
    reach = s.reach
    for i in range(here + 2, here + 2 * s.joint_counts[out] - 2, 2):
        left, right = joints[i], joints[i + 1]
        for j in range(there + 2, there + 2 * s.joint_counts[below] - 2, 2):
            distance = max(left - joints[j + 1], joints[j] - right, 0)
            if distance < reach:
                near = 1.0 - 1.0 * distance / reach
                total += near * near
    return total


def lay(s, below, old, last, left, out):
    """Lay the stones of a course on what is below, and count how they lie.

    Return False as soon as the stones cost more than what is left.

    The scene knows in which columns this is not what was below the old course, and then in which
    ones the tops are others.
    """
    if old < 0:
        s.changed, s.unchanged = 0, s.columns
    lower, upper = s.changed, s.unchanged
    here: cython.Py_ssize_t = s.most * out
    for i in range(s.counts[out]):
        stone = here + i
        first = s.column[stone]
        end = first + columns_of(s, s.pose[stone])
        was = found_in(s, old, i, s.counts[out], stone)
        if was < 0:
            drop(s, below, stone)
            widen(s, first, end)
        elif first < upper and lower < end:
            drop(s, below, stone)
            if s.y[stone] != s.y[was] or s.slope[stone] != s.slope[was]:
                widen(s, first, end)
        else:
            copy_stone(s, was, stone)
        left -= lies(s, stone, i > 0)
        if left < 0.0:
            return False
    if old >= 0:
        here = s.most * old
        for i in range(s.counts[old]):
            if found_in(s, out, i, s.counts[old], here + i) < 0:
                first = s.column[here + i]
                widen(s, first, first + columns_of(s, s.pose[here + i]))
    raise_tops(s, below, old, out)
    count_up(s, below, last, out)
    return True


def lies(s, stone, beside):
    """Return what a stone costs where it lies, and its step to the stone before it in a course."""
    at: cython.Py_ssize_t = PARTS * stone
    steps: cython.int = 0
    for j in range(at if beside else at + 1, at + PARTS):
        steps += abs(s.heights[j] - s.heights[j - 1])
    steep = (abs(s.slope[stone]) * columns_of(s, s.pose[stone])) >> SLOPE_BITS
    w: cython.p_double = s.weights
    settled = s.void[stone] * w[6] + steep * w[7] + s.rock[stone] * w[8] + s.short_[stone] * w[9]
    return settled + steps * w[0]


def columns_of(s, pose):
    """Return over how many columns a pose is."""
    return s.first[pose + 1] - s.first[pose]


def found_in(s, course, i, count, stone):
    """Return a stone in the same pose on the same columns in another course, or -1.

    It is looked for as far from the left and from the right end of the course.
    """
    if course < 0:
        return -1
    for _ in range(2):
        other: cython.Py_ssize_t = s.most * course + i
        if 0 <= i < s.counts[course] and s.pose[other] == s.pose[stone]:
            return other if s.column[other] == s.column[stone] else -1
        i += s.counts[course] - count
    return -1


def widen(s, first, last):
    """Make some columns a part of those that changed."""
    if s.changed == s.unchanged:
        s.changed, s.unchanged = first, last
    else:
        s.changed, s.unchanged = min(s.changed, first), max(s.unchanged, last)


def first_of(lift, end):
    """Return where a lift is largest before an end, the first of equals."""
    most = lift[0]
    for i in range(1, end):
        most = lift[i] if lift[i] > most else most
    for i in range(end):
        if lift[i] == most:
            return i
    return 0


def last_of(lift, start, end):
    """Return where a lift is largest, the last of equals."""
    most = lift[start]
    for i in range(start + 1, end):
        most = lift[i] if lift[i] > most else most
    for i in range(end - 1, start - 1, -1):
        if lift[i] == most:
            return i
    return start


def drop(s, below, stone):
    """Drop a stone on a profile and turn it until it rests on both sides of its centroid."""
    pose = s.pose[stone]
    count = columns_of(s, pose)
    middle = s.middle[pose]
    at: cython.Py_ssize_t = s.columns * below + s.column[stone]
    first: cython.Py_ssize_t = s.first[pose]
    lift: cython.p_int = s.lift
    tops: cython.p_int = s.tops
    bottoms: cython.p_int = s.bottoms
    slope: cython.int = 0
    total: cython.longlong = 0
    for j in range(count):
        lift[j] = tops[at + j] - bottoms[first + j]
    y = lift[0]
    s.rock[stone] = 0
    s.void[stone] = s.short_[stone] = 0.0
    if count > 1:
        left, right = first_of(lift, middle), last_of(lift, middle, count)
        steep = (lift[right] - lift[left]) * SLOPE_ONE / (right - left)
        # Towards zero, as long numbers are divided.
        slope = cython.cast(cython.int, max(-s.steepest, min(steep, s.steepest)))
        if slope != 0:
            tilt = -slope * middle
            for j in range(count):
                lift[j] -= tilt >> SLOPE_BITS
                tilt += slope
            left, right = first_of(lift, middle), last_of(lift, middle, count)
        for j in range(count):
            total += lift[j]
        y = max(lift[left], lift[right])
        s.rock[stone] = abs(lift[left] - lift[right])
        s.void[stone] = cython.cast(cython.longlong, y) * count - total
        inside = min(middle - left, right + 1 - middle)
        s.short_[stone] = max(0.0, s.margin - 1.0 * inside / count)
    s.y[stone], s.slope[stone] = y, slope
    for j in range(PARTS):
        part = PARTS * pose + j
        tilt = (slope * (s.part_at[part] - middle)) >> SLOPE_BITS
        s.heights[PARTS * stone + j] = y + s.peaks[part] + tilt


def raise_tops(s, below, old, out):
    """Raise what is below by the stones of a course, where that is not what it was."""
    columns: cython.Py_ssize_t = s.columns
    here: cython.Py_ssize_t = columns * out
    there: cython.Py_ssize_t = columns * old
    tops: cython.p_int = s.tops
    tips: cython.p_int = s.tips
    if old >= 0:
        move_ints(tops, here, tops, there, columns)
    move_ints(tops, here + s.changed, tops, columns * below + s.changed, s.unchanged - s.changed)
    for stone in range(s.most * out, s.most * out + s.counts[out]):
        pose = s.pose[stone]
        column, count = s.column[stone], columns_of(s, pose)
        if column >= s.unchanged or s.changed >= column + count:
            continue
        at: cython.Py_ssize_t = here + column
        first: cython.Py_ssize_t = s.first[pose]
        y, slope = s.y[stone], s.slope[stone]
        tilt = -slope * s.middle[pose]
        for j in range(count):
            tip = y + tips[first + j] + (tilt >> SLOPE_BITS)
            tilt += slope
            tops[at + j] = tip if tip > tops[at + j] else tops[at + j]
    if old >= 0:
        end = s.unchanged
        while s.changed < end and tops[here + s.changed] == tops[there + s.changed]:
            s.changed += 1
        while s.changed < end and tops[here + end - 1] == tops[there + end - 1]:
            end -= 1
        s.unchanged = end


def count_up(s, below, last, out):
    """Count how the stones of a course lie, and what the course costs."""
    t: cython.Py_ssize_t = TERMS * out
    here: cython.Py_ssize_t = s.most * out
    end: cython.Py_ssize_t = here + s.counts[out]
    terms: cython.p_double = s.terms
    before = s.heights[PARTS * here]
    peaks: cython.longlong = 0
    steps: cython.longlong = 0
    off: cython.longlong = 0
    cost: cython.double = 0.0
    s.beds[3 * out] = before
    for i in range(TERMS):
        if i not in (3, 4, 12, 13):
            terms[t + i] = 0.0
    for stone in range(here, end):
        steep = abs(s.slope[stone])
        terms[t + 6] += s.void[stone]
        terms[t + 7] += (steep * columns_of(s, s.pose[stone])) >> SLOPE_BITS
        terms[t + 8] += s.rock[stone]
        terms[t + 9] += s.short_[stone]
        highest = s.wall_height
        for j in range(PARTS * stone, PARTS * stone + PARTS):
            peak = s.heights[j]
            highest = max(highest, peak)
            steps += abs(peak - before)
            before = peak
            peaks += peak
        if highest > s.wall_height:
            terms[t + 10] += highest - s.wall_height
            terms[t + 11] += 1.0
    s.beds[3 * out + 1], s.beds[3 * out + 2] = before, steps
    terms[t] = steps
    mean = cython.cast(cython.int, peaks / (PARTS * s.counts[out]))
    for j in range(PARTS * here, PARTS * end):
        off += abs(s.heights[j] - mean)
    terms[t + 2 if last else t + 1] = off
    terms[t + 5] = slack(s, below, mean, out)
    for i in range(TERMS):
        cost += terms[t + i] * s.weights[i]
    s.costs[out] = cost


def slack(s, below, mean, out):
    """Return the widths of joints times what is free in them from below to a mean height."""
    total: cython.double = 0.0
    at: cython.Py_ssize_t = s.columns * below
    here: cython.Py_ssize_t = 2 * s.most_joints * out
    for i in range(here, here + 2 * s.joint_counts[out], 2):
        left, right = s.joints[i], s.joints[i + 1]
        free: cython.longlong = 0
        for j in range(at + (left >> COLUMN_BITS), at + (right >> COLUMN_BITS)):
            if mean > s.tops[j]:
                free += mean - s.tops[j]
        total += (right - left) * free
    return total


def fill_starts(side, starts):
    """Find where paths across a side start; return how many there are."""
    side_px = (side + PIXEL_UNITS - 1) // PIXEL_UNITS + PADDING_PX
    count: cython.int = 0
    px: cython.int = FIRST_PX
    while px < side_px - FIRST_PX and count < STARTS:
        starts[count] = px * PIXEL_UNITS - PIXEL_UNITS // 2
        px += max(1, side_px // STARTS)
        count += 1
    return count


def apart(joints, at, left, right):
    """Return how far a joint and a stretch are apart, 0 when they overlap."""
    return max(0, joints[at] - right, left - joints[at + 1])


def ordered(s, course):
    """Return whether both ends of joints go from left to right."""
    here: cython.Py_ssize_t = 2 * s.most_joints * course
    for i in range(here + 2, here + 2 * s.joint_counts[course]):
        if s.joints[i] < s.joints[i - 2]:
            return False
    return True


def shorten(ways, at, others, start, aside):
    """Shorten ways to other ways that go aside somewhat more, where these are shorter."""
    for i in range(STARTS):
        here = others[start + i] + aside
        ways[at + i] = here if here < ways[at + i] else ways[at + i]


def go_up(s, below, out):
    """Find how far paths from the bottom to the joints of a course go aside."""
    joints: cython.p_int = s.joints
    here: cython.Py_ssize_t = s.most_joints * out
    there: cython.Py_ssize_t = s.most_joints * below
    end: cython.Py_ssize_t = here + s.joint_counts[out]
    bare: cython.bint = s.joint_counts[below] == 0
    for j in range(here, end):
        for i in range(STARTS):
            way = FAR if i < s.start_count else 0
            if bare and i < s.start_count:
                way = apart(joints, 2 * j, s.starts[i], s.starts[i])
            s.ways[STARTS * j + i] = way
    if bare:
        return
    if ordered(s, out) and ordered(s, below):
        sweep(s, below, out)
        return
    for j in range(here, end):
        for k in range(there, there + s.joint_counts[below]):
            aside = apart(joints, 2 * j, joints[2 * k], joints[2 * k + 1])
            shorten(s.ways, STARTS * j, s.ways, STARTS * k, aside)


def sweep(s, below, out):
    """Shorten ways to those over joints below, all from left to right.

    The best way to some place over joints that end left of it stays the best further right.
    """
    joints: cython.p_int = s.joints
    ways: cython.p_int = s.ways
    best: cython.p_int = s.best
    here: cython.Py_ssize_t = s.most_joints * out
    there: cython.Py_ssize_t = s.most_joints * below
    end: cython.Py_ssize_t = there + s.joint_counts[below]
    k: cython.Py_ssize_t = there
    for i in range(STARTS):
        best[i] = FAR
    for j in range(here, here + s.joint_counts[out]):
        left, right = joints[2 * j], joints[2 * j + 1]
        while k < end and joints[2 * k + 1] <= left:
            shorten(best, 0, ways, STARTS * k, -joints[2 * k + 1])
            k += 1
        shorten(ways, STARTS * j, best, 0, left)
        # Right above.
        above = k
        while above < end and joints[2 * above] < right:
            shorten(ways, STARTS * j, ways, STARTS * above, 0)
            above += 1
    for i in range(STARTS):
        best[i] = FAR
    k = end - 1
    for j in range(here + s.joint_counts[out] - 1, here - 1, -1):
        right = joints[2 * j + 1]
        while k >= there and joints[2 * k] >= right:
            shorten(best, 0, ways, STARTS * k, joints[2 * k])
            k -= 1
        shorten(ways, STARTS * j, best, 0, -right)


def top_of(s, last):
    """Return the height of a wall."""
    at: cython.Py_ssize_t = s.columns * last
    top = s.tops[at]
    for i in range(at + 1, at + s.columns):
        top = s.tops[i] if s.tops[i] > top else top
    return top


def across(s, courses, top):
    """Return F_AH of a whole wall, in percent, as far as bed joints tell."""
    half = PIXEL_UNITS // 2
    count: cython.int = fill_starts(top, s.top_starts)
    for i in range(count):
        s.lengths[i] = FAR
    # Along the ground, and over the top.
    along_bed(s, -half, -half, 0, top, count)
    along_bed(s, top + half, top + half, 0, top, count)
    for i in range(0, 3 * s.given_count, 3):
        along_bed(s, s.given[i], s.given[i + 1], s.given[i + 2], top, count)
    for i in range(courses):
        bed = 3 * s.seen[i]
        along_bed(s, s.beds[bed], s.beds[bed + 1], s.beds[bed + 2], top, count)
    return mean_percent(s.lengths, count, s.wall_width + 2 * PIXEL_UNITS)


def down(s, last, top):
    """Return by how much F_AV is short of its target, as far as head joints tell."""
    here: cython.Py_ssize_t = s.most_joints * last
    if s.start_count == 0:
        return 0.0
    for i in range(s.start_count):
        at = s.starts[i]
        least = FAR
        for j in range(here, here + s.joint_counts[last]):
            least = min(least, s.ways[STARTS * j + i] + apart(s.joints, 2 * j, at, at))
        s.lengths[i] = least
    crossed = mean_percent(s.lengths, s.start_count, top + 2 * PIXEL_UNITS)
    return max(0.0, s.target - crossed)


def along_bed(s, left, right, ups, top, count):
    """Shorten paths to those along a bed joint where it is nearer."""
    more: cython.int = (DIAGONAL * ups) >> 10
    for i in range(count):
        y = top - s.top_starts[i]
        s.lengths[i] = min(s.lengths[i], abs(y - left) + abs(y - right) + more)


def mean_percent(lengths, count, straight):
    """Return the mean of the shortest lengths over what is straight, in percent; 0 for none."""
    few = min(count, SHORTEST)
    total: cython.longlong = 0
    if count == 0:
        return 0.0
    for i in range(1, count):
        held = lengths[i]
        j = i
        while j > 0 and lengths[j - 1] > held:
            lengths[j] = lengths[j - 1]
            j -= 1
        lengths[j] = held
    for i in range(few):
        total += lengths[i]
    return 100.0 * total / (few * 1.0 * straight)
