"""Which stones a course plan takes: those that are pinned, and the best of a large stock."""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from drystone.kernels.course_types import COLUMN_UNITS
from drystone.search.course_task import Task

PINNED = 10
"""A pinned stone that is left out counts so many times its area."""

PLENTY = 1.5
"""From so many times the area of the wall on, a stock leaves a choice."""

LEFT_OUT, HIGH = 0.5, 5.0
"""Factors on the weights of what is left out and of what stands out above the wall when there is a
choice: else stones would be planned above the wall's height, where they cannot be laid, as they
cost less there than left out."""


def taken(task: Task) -> int:
    """Return about how many stones the wall takes, at most all."""
    poses, ground = task.quarters.poses, task.ground
    room = ground.width * ground.height / COLUMN_UNITS
    return max(1, min(poses.area.size, round(room / float(np.median(poses.area)))))


def choosing(task: Task, pinned: Collection[int]) -> Task:
    """Return a task for annealing that chooses stones."""
    return _with_pinned(_of_plenty(task), pinned)


def _of_plenty(task: Task) -> Task:
    poses, ground, weights = task.quarters.poses, task.ground, task.rules.weights
    room = ground.width * ground.height / COLUMN_UNITS
    stock = int(poses.area.sum()) + int(ground.tops.sum())
    if stock <= PLENTY * room:
        return task
    share = taken(task) / poses.area.size  # these count by the stone that the wall takes
    changed = weights._replace(
        left_out=LEFT_OUT * weights.left_out,
        high=HIGH * weights.high,
        across=share * weights.across,
        down=share * weights.down,
    )
    return replace(task, rules=task.rules._replace(weights=changed))


def _with_pinned(task: Task, pinned: Collection[int]) -> Task:
    if not pinned:
        return task
    quarters = task.quarters
    factors = [PINNED if stone.id in pinned else 1 for stone in quarters.stones]
    area = quarters.poses.area * np.array(factors, np.int64)
    return replace(task, quarters=replace(quarters, poses=quarters.poses._replace(area=area)))
