"""How the stones of courses lie on each other, by height profiles, and what that costs.

The twin of `compiled/course_cost.pyx`.  Stones of a course stand side by side, as near as their
faces allow; each is dropped on the course below and turned until it rests on two points.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from drystone.kernels.course_paths import (
    Bed,
    Joints,
    apart,
    bed_percent,
    crossing_percent,
    path_starts,
    ways_up,
)
from drystone.kernels.course_types import (
    COLUMN_BITS,
    COLUMN_UNITS,
    INSET,
    PARTS,
    SLOPE_BITS,
    SLOPE_ONE,
    TERMS,
    Arrangement,
    Floats,
    Ground,
    Ints,
    Layout,
    Longs,
    Poses,
    Rules,
    left_of,
)


class Rest(NamedTuple):
    """How a stone lies on a profile.

    Parameters
    ----------
    y : int
        Its lowest point before it turned.
    slope : int
        By how much it turned.
    rock : int
        How much further its upper side would have to go down to touch.
    left, right : int
        Columns in which it is carried on both sides of its centroid.
    void : int
        What is void below it.
    """

    y: int
    slope: int
    rock: int
    left: int
    right: int
    void: int


class Below(NamedTuple):
    """What a course is laid on.

    Parameters
    ----------
    tops : (columns,) int32 array
        Its height.
    joints : list of (int, int)
        Head joints of the course below and what is free at its ends; empty on bare ground.
    ways : (n, STARTS) int32 array
        How far paths to these go aside.
    """

    tops: Ints
    joints: Joints
    ways: Ints


class LaidCourse(NamedTuple):
    """A course where it lies.

    Parameters
    ----------
    x, y, slope : list of int
        Of its stones.
    above : Below
        What is there for the next one.
    bed : (int, int, int)
        Height of its top at the ends of the wall, and its ups and downs.
    terms : list of float
        What is counted.
    cost : float
        Of it.
    """

    x: list[int]
    y: list[int]
    slope: list[int]
    above: Below
    bed: Bed
    terms: list[float]
    cost: float


def evaluate_python(poses: Poses, plan: Arrangement, ground: Ground, rules: Rules) -> Layout:
    """Return what :func:`drystone.kernels.courses.evaluate` returns, by Python."""
    below = on_ground(ground)
    ends = [0, *np.cumsum(plan.sizes).tolist()]
    outer = outer_terms(poses, plan.order[ends[-1] :].tolist())
    cost = weighted(outer, rules)
    laid: list[LaidCourse] = []
    for course, (start, end) in enumerate(pairwise(ends)):
        stones = plan.order[start:end].tolist()
        posed = [4 * stone + int(plan.turns[stone]) for stone in stones]
        last = course == len(plan.sizes) - 1
        gap = int(plan.gaps[course])
        laid.append(lay_course(poses, posed, gap, below, ground, rules, last=last))
        below = laid[-1].above
        cost += laid[-1].cost
    whole = path_terms(laid, ground, rules)
    cost += weighted(whole, rules)
    whole[13] = outer[13]
    return Layout(
        np.array([x for course in laid for x in course.x], np.int32),
        np.array([y for course in laid for y in course.y], np.int32),
        np.array([slope for course in laid for slope in course.slope], np.int32),
        below.tops.copy(),
        np.array(below.joints, np.int32).reshape(-1, 2),
        np.array([*(course.terms for course in laid), whole], np.float64),
        cost,
    )


def on_ground(ground: Ground) -> Below:
    """Return what the first course is laid on."""
    return Below(ground.tops, [(int(a), int(b)) for a, b in ground.joints], ground.ways)


def outer_terms(poses: Poses, left_out: list[int]) -> list[float]:
    """Return what is counted of the stones that are left out."""
    terms = [0.0] * TERMS
    terms[13] = float(int(poses.area[left_out].sum()))
    return terms


def path_terms(laid: list[LaidCourse], ground: Ground, rules: Rules) -> list[float]:
    """Return what is counted of paths along the joints of a whole wall."""
    terms = [0.0] * TERMS
    above = laid[-1].above
    top = int(above.tops.max())
    beds = [(int(a), int(b), int(c)) for a, b, c in ground.beds]
    beds += [course.bed for course in laid]
    terms[14] = bed_percent(beds, top, ground.width)
    starts = path_starts(ground.width)
    if starts:
        crossed = crossing_percent(above.joints, above.ways, starts, top)
        terms[15] = max(0.0, rules.target - crossed)
    return terms


def weighted(terms: list[float], rules: Rules) -> float:
    """Return the sum of terms times their weights, one after the other."""
    cost = 0.0
    for term, weight in zip(terms, rules.weights, strict=True):
        cost += term * weight
    return cost


def lay_course(
    poses: Poses,
    posed: list[int],
    gap: int,
    below: Below,
    ground: Ground,
    rules: Rules,
    *,
    last: bool,
) -> LaidCourse:
    """Lay a course on what is there.

    Parameters
    ----------
    poses : Poses
        Of all stones.
    posed : list of int
        Poses of the course's stones from left to right, at least one.
    gap : int
        How many are laid from the left end; see :class:`~.course_types.Arrangement`.
    below : Below
        What is there.
    ground : Ground
        For the room that there is.
    rules : Rules
        How.
    last : bool
        Whether nothing is laid on it.
    """
    terms = [0.0] * TERMS
    x, room = side_by_side(poses, posed, gap, ground.width, rules)
    terms[4] = float(max(0, -room))
    y, slope, peaks = [], [], []
    tops = below.tops.copy()
    for pose, place in zip(posed, x, strict=True):
        column = column_of(poses, pose, place, tops.size)
        rest = dropped(poses, pose, column, below.tops, rules)
        y.append(rest.y)
        slope.append(rest.slope)
        own = raised(poses, pose, column, rest, tops)
        peaks += own
        count_rest(poses, pose, rest, rules, terms)
        if max(own) > ground.height:
            terms[10] += float(max(own) - ground.height)
            terms[11] += 1.0
    mean = count_top(peaks, terms, last=last)
    joints = open_ends(poses, posed, x, ground.width)
    terms[3] = crossing(joints[1:-1], below.joints[1:-1], rules.reach)
    terms[5] = slack(joints, below.tops, mean)
    terms[12] = float(
        joints[0][1]
        + int(poses.faces[posed[0], 0])
        + joints[-1][1]
        - joints[-1][0]
        + int(poses.faces[posed[-1], 1])
    )
    ways = ways_up(joints, below.joints, below.ways, path_starts(ground.width))
    bed = (peaks[0], peaks[-1], int(terms[0]))
    above = Below(tops, joints, ways)
    return LaidCourse(x, y, slope, above, bed, terms, weighted(terms, rules))


def side_by_side(
    poses: Poses, posed: list[int], gap: int, width: int, rules: Rules
) -> tuple[list[int], int]:
    """Return the left ends of the stones of a course, and the room that they leave.

    Stones that are too wide for the wall together overlap at the gap; none stands out.
    """
    count = len(posed)
    apart = [nest(poses, posed[i], posed[i + 1]) + rules.joint for i in range(count - 1)]
    room = width - int(poses.width[posed[-1]]) - sum(apart)
    inset = 0 if gap >= 0 or room < 0 else room * INSET[0] // INSET[1]
    from_left = left_of(gap)
    x = [inset] * count
    for i in range(1, from_left):
        x[i] = x[i - 1] + apart[i - 1]
    if from_left < count:
        x[-1] = width - int(poses.width[posed[-1]]) - inset
        for i in range(count - 2, from_left - 1, -1):
            x[i] = x[i + 1] - apart[i]
    for i in range(count):
        x[i] = max(0, min(x[i], width - int(poses.width[posed[i]])))
    return x, room


def nest(poses: Poses, left: int, right: int) -> int:
    """Return how far apart the left ends of two neighbours are, their lowest points level."""
    one, two = int(poses.first_row[left]), int(poses.first_row[right])
    shared = min(int(poses.first_row[left + 1]) - one, int(poses.first_row[right + 1]) - two)
    return int((poses.rights[one : one + shared] - poses.lefts[two : two + shared]).max())


def column_of(poses: Poses, pose: int, place: int, columns: int) -> int:
    """Return the column that a pose's first column is on, the nearest to its left end."""
    count = int(poses.first[pose + 1] - poses.first[pose])
    return min((place + COLUMN_UNITS // 2) >> COLUMN_BITS, columns - count)


def dropped(poses: Poses, pose: int, column: int, below: Ints, rules: Rules) -> Rest:
    """Drop a pose on a profile and turn it until it rests on both sides of its centroid."""
    first, end = int(poses.first[pose]), int(poses.first[pose + 1])
    middle = int(poses.middle[pose])
    lift = below[column : column + end - first].astype(np.int64) - poses.bottoms[first:end]
    if end - first == 1:
        return Rest(int(lift[0]), 0, 0, 0, 0, 0)
    left, right = carriers(lift, middle)
    slope = divided((int(lift[right]) - int(lift[left])) * SLOPE_ONE, right - left)
    slope = max(-rules.steepest, min(slope, rules.steepest))
    lift -= tilted(slope, end - first, middle)
    left, right = carriers(lift, middle)
    y = max(int(lift[left]), int(lift[right]))
    rock = abs(int(lift[left]) - int(lift[right]))
    void = y * (end - first) - int(lift.sum())
    return Rest(y, slope, rock, left, right, void)


def carriers(lift: Longs, middle: int) -> tuple[int, int]:
    """Return where lifts are largest left and right of the middle, the outermost of equals."""
    left = int(np.argmax(lift[:middle]))
    right = lift.size - 1 - int(np.argmax(lift[middle:][::-1]))
    return left, right


def tilted(slope: int, count: int, middle: int) -> Longs:
    """Return by how much the columns of a pose go up when it turns about its middle."""
    moved: Longs = (slope * (np.arange(count, dtype=np.int64) - middle)) >> SLOPE_BITS
    return moved


def divided(number: int, by: int) -> int:
    """Divide whole numbers, towards zero, as C does."""
    return number // by if number >= 0 else -(-number // by)


def raised(poses: Poses, pose: int, column: int, rest: Rest, tops: Ints) -> list[int]:
    """Raise a profile by a stone, in place; return the heights of the parts of its top."""
    first, end = int(poses.first[pose]), int(poses.first[pose + 1])
    middle = int(poses.middle[pose])
    tip = (rest.y + poses.tops[first:end] + tilted(rest.slope, end - first, middle)).astype(
        np.int32
    )
    over = tops[column : column + end - first]
    np.maximum(over, tip, out=over)
    return [
        rest.y
        + int(poses.peaks[pose, part])
        + ((rest.slope * (int(poses.part_at[pose, part]) - middle)) >> SLOPE_BITS)
        for part in range(PARTS)
    ]


def count_rest(poses: Poses, pose: int, rest: Rest, rules: Rules, terms: list[float]) -> None:
    """Count how a stone lies."""
    count = int(poses.first[pose + 1] - poses.first[pose])
    terms[6] += float(rest.void)
    terms[7] += float((abs(rest.slope) * count) >> SLOPE_BITS)
    terms[8] += float(rest.rock)
    if count > 1:
        middle = int(poses.middle[pose])
        inside = min(middle - rest.left, rest.right + 1 - middle)
        short = rules.margin - float(inside) / float(count)
        if short > 0.0:
            terms[9] += short


def count_top(peaks: list[int], terms: list[float], *, last: bool) -> int:
    """Count how the top of a course goes up and down, and how far it is off its mean: returned."""
    terms[0] = float(sum(abs(b - a) for a, b in pairwise(peaks)))
    mean = divided(sum(peaks), len(peaks))
    off = float(sum(abs(peak - mean) for peak in peaks))
    terms[2 if last else 1] = off
    return mean


def open_ends(poses: Poses, posed: list[int], x: list[int], width: int) -> Joints:
    """Return the ends of the head joints of a course, with what is free at the wall's ends."""
    joints = [(0, x[0])]
    for i in range(len(posed) - 1):
        left, right = x[i] + int(poses.width[posed[i]]), x[i + 1]
        if left > right:
            left = right = (left + right) >> 1
        joints.append((left, right))
    return [*joints, (x[-1] + int(poses.width[posed[-1]]), width)]


def crossing(joints: Joints, below: Joints, reach: int) -> float:
    """Return how much joints are above joints: 1 for each right above another, 0 at the reach."""
    total = 0.0
    for joint in joints:
        for other in below:
            distance = apart(joint, other)
            if distance < reach:
                near = 1.0 - float(distance) / float(reach)
                total += near * near
    return total


def slack(joints: Joints, below: Ints, mean: int) -> float:
    """Return the widths of joints times what is free in them from below to a mean height."""
    total = 0.0
    for left, right in joints:
        free = mean - below[left >> COLUMN_BITS : right >> COLUMN_BITS].astype(np.int64)
        total += float(right - left) * float(int(free[free > 0].sum()))
    return total


def floats(rules: Rules) -> Floats:
    """Return the weights as an array, for the compiled twin."""
    return np.array(rules.weights, np.float64)
