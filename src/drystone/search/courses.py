"""Plan a wall course by course, before any stone is laid (docs/searching.md).

Stones are annealed on height profiles: their order, their courses, their quarter turns, and where
each course has its gap.
"""

import math
from collections.abc import Collection, Sequence

import numpy as np

from drystone.kernels.course_moves import Dice, left_of
from drystone.kernels.course_types import (
    COLUMN_UNITS,
    INSET,
    SLOPE_ONE,
    Arrangement,
    Cooling,
    Layout,
    Poses,
)
from drystone.kernels.courses import anneal, evaluate
from drystone.kernels.raster import turn
from drystone.model.placement import Side
from drystone.model.stone import Stone
from drystone.planner.course_settings import CourseSettings
from drystone.planner.deadline import NEVER, Deadline
from drystone.poses import PoseBook
from drystone.search.course_choice import choosing, taken
from drystone.search.course_plan import CoursePlan, PlannedStone
from drystone.search.course_task import Task, task_of
from drystone.search.laid_courses import LaidCourses

LOOKED_AT = 2
"""A plan is looked for as if there were at most so many times the stones that the wall takes."""


def plan_courses(  # noqa: PLR0913 - the wall, its stones and how
    stones: Collection[Stone],
    width_px: float,
    height_px: float,
    cell_px: float,
    tolerance_px: float,
    settings: CourseSettings,
    seed: int,
    *,
    laid: LaidCourses | None = None,
    book: PoseBook | None = None,
    pinned: Collection[int] = (),
    until: Deadline = NEVER,
) -> CoursePlan | None:
    """Plan a wall course by course."""
    size = (width_px, height_px)
    task = task_of(stones, size, cell_px, tolerance_px, settings, laid=laid, book=book)
    return None if task is None else planned_anew(task, settings, seed, pinned, until)


def replan_courses(  # noqa: PLR0913 - as above
    plan: CoursePlan,
    keep: int,
    stones: Collection[Stone],
    width_px: float,
    height_px: float,
    cell_px: float,
    tolerance_px: float,
    *,
    settings: CourseSettings,
    seed: int,
    laid: LaidCourses,
    book: PoseBook | None = None,
    pinned: Collection[int] = (),
    until: Deadline = NEVER,
) -> CoursePlan | None:
    """Plan the upper courses of a plan again, for what was really laid below."""
    size = (width_px, height_px)
    task = task_of(stones, size, cell_px, tolerance_px, settings, laid=laid, book=book)
    if task is None:
        return None
    return planned_again(task, plan, keep, settings, seed, pinned, until)


def planned_anew(
    task: Task,
    settings: CourseSettings,
    seed: int,
    pinned: Collection[int],
    until: Deadline = NEVER,
) -> CoursePlan:
    """Plan a wall from stones in random order; parameters as for :func:`plan_courses`."""
    looked_at = stones_looked_at(task)
    task = choosing(task, pinned)
    start = scattered(task, Dice(seed))
    return annealed(task, start, settings, settings.temperature, looked_at, seed, until)


def planned_again(
    task: Task,
    plan: CoursePlan,
    keep: int,
    settings: CourseSettings,
    seed: int,
    pinned: Collection[int],
    until: Deadline = NEVER,
) -> CoursePlan:
    """Plan upper courses again from what they are; parameters as for :func:`replan_courses`."""
    looked_at = stones_looked_at(task)
    task = choosing(task, pinned)
    start = resumed(task, plan.courses[keep:])
    if start is None:
        start = scattered(task, Dice(seed))
    warm = settings.temperature * settings.again
    found = annealed(task, start, settings, warm, looked_at, seed, until)
    return CoursePlan(plan.courses[:keep] + found.courses, found.cost)


def scattered(task: Task, dice: Dice) -> Arrangement:
    """Return stones in random order, lying flat, in courses that are full, up to the top.

    In no more courses than a plan may have: slabs between higher stones could need more.
    """
    poses = task.quarters.poses
    count = poses.area.size
    order = list(range(count))
    for i in range(count - 1, 0, -1):
        j = dice.below(i + 1)
        order[i], order[j] = order[j], order[i]
    turns = [flat(poses, stone, dice) for stone in range(count)]
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
    return arrangement(order, turns, sizes, [(size + 1) // 2 for size in sizes])


def flat(poses: Poses, stone: int, dice: Dice) -> int:
    """Return one of the turns in which a stone is not higher than in the others."""
    heights = poses.height[4 * stone : 4 * stone + 4].tolist()
    turns = [i for i in range(4) if heights[i] <= min(heights) + 1]
    return turns[dice.below(len(turns))]


def arrangement(
    order: list[int], turns: list[int], sizes: list[int], gaps: list[int]
) -> Arrangement:
    """Return an arrangement of lists."""
    return Arrangement(*(np.array(part, np.int32) for part in (order, turns, sizes, gaps)))


def resumed(task: Task, courses: Sequence[Sequence[PlannedStone]]) -> Arrangement | None:
    """Return the arrangement of planned courses, without stones that are gone or banned.

    Courses above those that a plan of the other stones may have are left out.
    """
    quarters, width_px = task.quarters, task.ground.width * task.unit_px
    number = {stone.id: i for i, stone in enumerate(quarters.stones)}
    order: list[int] = []
    turns = [0] * len(number)
    sizes: list[int] = []
    gaps: list[int] = []
    for course in courses:
        there = [
            stone
            for stone in sorted(course, key=lambda stone: stone.left_px)
            if stone.stone_id in number
            and stone.angle_deg in quarters.angles_deg[number[stone.stone_id]]
        ]
        if len(sizes) == task.rules.courses:
            break
        for stone in there:
            i = number[stone.stone_id]
            order.append(i)
            turns[i] = quarters.angles_deg[i].index(stone.angle_deg)
        if there:
            sizes.append(len(there))
            from_left = sum(stone.side == "left" for stone in there)
            gaps.append(-1 - from_left if keeps_away(there, width_px) else from_left)
    if not sizes:
        return None
    order += [i for i in range(len(number)) if i not in set(order)]
    return arrangement(order, turns, sizes, gaps)


def keeps_away(course: Sequence[PlannedStone], width_px: float) -> bool:
    """Say whether a course, from left to right, keeps away from both ends of the wall."""
    free = width_px - sum(stone.right_px - stone.left_px for stone in course)
    ends = course[0].left_px, width_px - course[-1].right_px
    return min(ends) > 0.5 * INSET[0] / INSET[1] * free > 0.0


def stones_looked_at(task: Task) -> int:
    """Return for how many stones plans are looked at; of a large stock not for all."""
    return min(len(task.quarters.stones), LOOKED_AT * taken(task))


def annealed(
    task: Task,
    start: Arrangement,
    settings: CourseSettings,
    temperature: float,
    stones: int,
    seed: int,
    until: Deadline = NEVER,
) -> CoursePlan:
    """Anneal an arrangement, and say where its stones lie in the wall frame."""
    count = min(settings.evaluations * stones, settings.most_evaluations)
    factor = (settings.coldest / temperature) ** (1.0 / count)
    cooling = Cooling(count, temperature, factor, seed, settings.doubt)
    poses = task.quarters.poses
    plan, _ = anneal(poses, start, task.ground, task.rules, cooling, until.look)
    return placed(task, plan, evaluate(poses, plan, task.ground, task.rules))


def placed(task: Task, plan: Arrangement, layout: Layout) -> CoursePlan:
    """Return an arrangement as a plan in the wall frame, source px."""
    courses, start = [], 0
    for size, gap in zip(plan.sizes.tolist(), plan.gaps.tolist(), strict=True):
        sides: list[Side] = ["left" if i < left_of(gap) else "right" for i in range(size)]
        stones = [planned(task, plan, layout, start + i, side) for i, side in enumerate(sides)]
        left, right = stones[: left_of(gap)], stones[left_of(gap) :]
        courses.append((*left, *right[::-1]))
        start += size
    return CoursePlan(tuple(courses), layout.cost)


def planned(task: Task, plan: Arrangement, layout: Layout, place: int, side: Side) -> PlannedStone:
    """Return one stone of an arrangement."""
    stone = int(plan.order[place])
    quarter = int(plan.turns[stone])
    corners = task.quarters.corners[4 * stone + quarter]
    left, bottom = corners.min(axis=0).tolist()
    tilt_deg = math.degrees(math.atan(int(layout.slope[place]) / (SLOPE_ONE * COLUMN_UNITS)))
    x = int(layout.x[place]) * task.unit_px - left
    y = int(layout.y[place]) * task.unit_px - bottom
    return PlannedStone(
        task.quarters.stones[stone].id,
        task.quarters.angles_deg[stone][quarter],
        side,
        x,
        y,
        x + left,
        x + float(corners[:, 0].max()),
        y + float(turn(corners, tilt_deg)[:, 1].max()),
    )
