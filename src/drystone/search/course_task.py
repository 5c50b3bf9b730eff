"""A wall to be planned course by course, in the whole numbers of the kernels."""

import math
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from drystone.kernels.course_types import (
    COLUMN_UNITS,
    SLOPE_ONE,
    Ground,
    Poses,
    Rules,
    Weights,
)
from drystone.model.stone import Stone
from drystone.planner.course_settings import CourseSettings
from drystone.poses import PoseBook
from drystone.search.course_poses import Quarters, quarters_of
from drystone.search.laid_courses import LaidCourses, ground_of


@dataclass(frozen=True, eq=False)
class Task:
    """A wall to be planned, in the whole numbers of the kernels."""

    quarters: Quarters  # The stones
    ground: Ground  # What they are laid on
    rules: Rules  # How
    unit_px: float  # A unit in source px


def task_of(
    stones: Collection[Stone],
    size_px: tuple[float, float],
    cell_px: float,
    tolerance_px: float,
    settings: CourseSettings,
    *,
    laid: LaidCourses | None = None,
    book: PoseBook | None = None,
) -> Task | None:
    """Return what the kernels are asked; None when no stone fits into the wall.

    Parameters are those of :func:`drystone.search.courses.plan_courses`, the size of the wall as
    a pair.
    """
    column_px = 0.5 * cell_px
    unit_px = column_px / COLUMN_UNITS
    quarters = quarters_of(stones, size_px, column_px, tolerance_px, book or PoseBook())
    if quarters is None:
        return None
    ground = ground_of(laid, size_px, column_px)
    rules = rules_of(settings, quarters.poses, ground.height)
    return Task(quarters, ground, rules, unit_px)


def rules_of(settings: CourseSettings, poses: Poses, height: int) -> Rules:
    """Return settings in units."""
    area = float(poses.area.mean()) * COLUMN_UNITS
    size = math.sqrt(area)
    part = size * poses.peaks.shape[1]
    stones = poses.area.size
    weights = Weights(
        step=settings.step / size,
        level=settings.level / part,
        top=settings.top / part,
        joint=settings.joint,
        overflow=settings.overflow / size,
        slack=settings.slack * COLUMN_UNITS / (area * size),
        void=settings.void * COLUMN_UNITS / area,
        turn=settings.turn / size,
        rock=settings.rock / size,
        support=settings.support,
        overhead=settings.overhead / size,
        high=settings.high,
        flush=settings.flush / size,
        left_out=settings.left_out * COLUMN_UNITS / area,
        across=settings.across * stones,
        down=settings.down * stones,
    )
    return Rules(
        weights,
        reach=max(1, round(settings.reach * size)),
        margin=settings.margin,
        steepest=round(math.tan(math.radians(settings.steepest_deg)) * COLUMN_UNITS * SLOPE_ONE),
        joint=round(settings.apart * size),
        courses=most_courses(poses, height),
        target=settings.target,
    )


def most_courses(poses: Poses, height: int) -> int:
    """Return how many courses a plan may have: twice what a wall of flat stones needs."""
    flat_height = float(np.median(poses.height.reshape(-1, 4).min(axis=1)))
    return max(1, min(poses.area.size, math.ceil(2.0 * height / max(flat_height, 1.0)) + 2))
