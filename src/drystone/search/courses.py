"""Plan a wall course by course, before any stone is laid (docs/searching.md).

Stones are annealed on height profiles: their order, their courses, their quarter turns, and where
each course has its gap.
"""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from drystone.kernels.course_moves import Dice, left_of
from drystone.kernels.course_types import (
    COLUMN_UNITS,
    INSET,
    SLOPE_ONE,
    Arrangement,
    Cooling,
    Layout,
)
from drystone.kernels.courses import anneal, evaluate
from drystone.kernels.polygons import turn
from drystone.model.placement import Side
from drystone.planner.deadline import NEVER, Deadline
from drystone.search.course_task import CourseTask


@dataclass(frozen=True)
class PlannedStone:
    """Where a stone shall lie in the wall frame, source px, as far as height profiles tell."""

    stone_id: int
    angle_deg: float  # counter-clockwise from the source image
    side: Side  # from which end of the wall its course is laid up to it
    x_px: float  # of its centroid
    y_px: float
    left_px: float  # its box
    right_px: float
    top_px: float


@dataclass(frozen=True)
class CoursePlan:
    """A wall planned course by course."""

    # The lowest first; each in the order of laying: from both ends to the course's gap.
    courses: tuple[tuple[PlannedStone, ...], ...]
    cost: float  # what the plan was found to cost, lower is better


def plan_courses(
    task: CourseTask,
    seed: int,
    *,
    begun: CoursePlan | None = None,
    keep: int = 0,
    pinned: Collection[int] = (),
    until: Deadline = NEVER,
) -> CoursePlan:
    """Plan a wall from stones in random order, or the upper courses of a plan that is `begun`.

    Of that one the lowest courses stay, as many as `keep`; annealing starts with the upper ones,
    at `settings.again` of the temperature, and the cost is theirs.  Pinned stones cost ten times
    as much when they are left out.
    """
    settings = task.settings
    looked_at = min(len(task.stones), 2 * task.taken)  # of a large stock not all
    task = task.choosing(pinned)
    start = None if begun is None else resumed(task, begun.courses[keep:])
    if start is None:
        start = _scattered(task, Dice(seed))
    temperature = settings.temperature * (1.0 if begun is None else settings.again)
    count = min(settings.evaluations * looked_at, settings.most_evaluations)
    factor = (settings.coldest / temperature) ** (1.0 / count)
    cooling = Cooling(count, temperature, factor, seed, settings.doubt)
    best, _ = anneal(task.poses, start, task.ground, task.rules, cooling, until.look)
    found = placed(task, best, evaluate(task.poses, best, task.ground, task.rules))
    kept = () if begun is None else begun.courses[:keep]
    return CoursePlan(kept + found.courses, found.cost)


def _scattered(task: CourseTask, dice: Dice) -> Arrangement:
    """Return stones in random order, lying flat, in courses that are full, up to the top.

    In no more courses than a plan may have: slabs between higher stones could need more.
    """
    poses = task.poses
    count = poses.area.size
    order = list(range(count))
    for i in range(count - 1, 0, -1):
        j = dice.below(i + 1)
        order[i], order[j] = order[j], order[i]
    turns = []
    for heights in poses.height.reshape(-1, 4).tolist():
        flat = [i for i in range(4) if heights[i] <= min(heights) + 1]
        turns.append(flat[dice.below(len(flat))])
    sizes, width, height, tallest = [0], 0, int(task.ground.tops.mean()), 0
    for stone in order:
        pose = 4 * stone + turns[stone]
        if sizes[-1] and width + int(poses.width[pose]) > task.ground.width:
            height += tallest // sizes[-1]
            if height >= task.ground.height or len(sizes) == task.rules.courses:
                break
            sizes.append(0)
            width = tallest = 0
        sizes[-1] += 1
        width += int(poses.width[pose])
        tallest += int(poses.height[pose])
    return _arrangement(order, turns, sizes, [(size + 1) // 2 for size in sizes])


def _arrangement(*parts: list[int]) -> Arrangement:
    return Arrangement(*(np.array(part, np.int32) for part in parts))


def resumed(task: CourseTask, courses: Sequence[Sequence[PlannedStone]]) -> Arrangement | None:
    """Return the arrangement of planned courses, without stones that are gone or banned.

    Courses above those that a plan of the other stones may have are left out.
    """
    width_px = task.ground.width * task.unit_px
    number = {stone.id: i for i, stone in enumerate(task.stones)}
    order: list[int] = []
    turns = [0] * len(number)
    sizes: list[int] = []
    gaps: list[int] = []
    for course in courses:
        there = [
            stone
            for stone in sorted(course, key=lambda stone: stone.left_px)
            if stone.stone_id in number
            and stone.angle_deg in task.angles_deg[number[stone.stone_id]]
        ]
        if len(sizes) == task.rules.courses:
            break
        for stone in there:
            i = number[stone.stone_id]
            order.append(i)
            turns[i] = task.angles_deg[i].index(stone.angle_deg)
        if there:
            sizes.append(len(there))
            from_left = sum(stone.side == "left" for stone in there)
            free = width_px - sum(stone.right_px - stone.left_px for stone in there)
            ends = there[0].left_px, width_px - there[-1].right_px
            keeps_away = min(ends) > 0.5 * INSET[0] / INSET[1] * free > 0.0
            gaps.append(-1 - from_left if keeps_away else from_left)
    if not sizes:
        return None
    return _arrangement(order + sorted({*range(len(number))} - {*order}), turns, sizes, gaps)


def placed(task: CourseTask, plan: Arrangement, layout: Layout) -> CoursePlan:
    """Return an arrangement as a plan in the wall frame."""
    courses, start = [], 0
    for size, gap in zip(plan.sizes.tolist(), plan.gaps.tolist(), strict=True):
        from_left = left_of(gap)
        stones = [
            _placed_stone(task, plan, layout, start + i, "left" if i < from_left else "right")
            for i in range(size)
        ]
        courses.append((*stones[:from_left], *stones[from_left:][::-1]))
        start += size
    return CoursePlan(tuple(courses), layout.cost)


def _placed_stone(
    task: CourseTask, plan: Arrangement, layout: Layout, place: int, side: Side
) -> PlannedStone:
    stone = int(plan.order[place])
    quarter = int(plan.turns[stone])
    corners = task.corners[4 * stone + quarter]
    left, bottom = corners.min(axis=0).tolist()
    tilt_deg = math.degrees(math.atan(int(layout.slope[place]) / (SLOPE_ONE * COLUMN_UNITS)))
    x = int(layout.x[place]) * task.unit_px - left
    y = int(layout.y[place]) * task.unit_px - bottom
    return PlannedStone(
        task.stones[stone].id,
        task.angles_deg[stone][quarter],
        side,
        x_px=x,
        y_px=y,
        left_px=x + left,
        right_px=x + float(corners[:, 0].max()),
        top_px=y + float(turn(corners, tilt_deg)[:, 1].max()),
    )
