"""Plan a wall of pixels course by course: stones are as wide and as high as their masks."""

from collections.abc import Collection

import numpy as np

from drystone.kernels.course_types import COLUMN_UNITS
from drystone.kernels.polygons import Points
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.workshop import Workshop
from drystone.search.course_plan import CoursePlan
from drystone.search.course_poses import Quarters, poses_of
from drystone.search.course_settings import CourseSettings
from drystone.search.course_task import Task, rules_of
from drystone.search.courses import planned_again, planned_anew
from drystone.search.laid_courses import LaidCourses, ground_of
from drystone.search.pixel_outlines import posed_outline


def plan_pixel_courses(
    workshop: Workshop,
    settings: CourseSettings,
    seed: int,
    *,
    pinned: Collection[int] = (),
    until: Deadline = NEVER,
) -> CoursePlan | None:
    """Plan a wall of pixels course by course; None when no stone fits.

    Parameters
    ----------
    workshop : Workshop
        Stones and site.
    settings, seed, pinned, until
        As for :func:`drystone.search.courses.plan_courses`.
    """
    task = pixel_task(workshop, workshop.fitting, settings)
    return None if task is None else planned_anew(task, settings, seed, pinned, until)


def replan_pixel_courses(  # noqa: PLR0913 - as above
    plan: CoursePlan,
    keep: int,
    stone_ids: Collection[int],
    workshop: Workshop,
    settings: CourseSettings,
    seed: int,
    *,
    laid: LaidCourses,
    pinned: Collection[int] = (),
    until: Deadline = NEVER,
) -> CoursePlan | None:
    """Plan the upper courses of a plan again, for what was really laid below; None as above.

    Parameters
    ----------
    plan : CoursePlan
        Its upper courses are where annealing starts.
    keep : int
        So many of its courses stay as they are.
    stone_ids : collection of int
        Those that are not laid yet.
    workshop, settings, seed, pinned, until
        As for :func:`plan_pixel_courses`.
    laid : LaidCourses
        What is there.
    """
    task = pixel_task(workshop, stone_ids, settings, laid)
    if task is None:
        return None
    return planned_again(task, plan, keep, settings, seed, pinned, until)


def pixel_task(
    workshop: Workshop,
    stone_ids: Collection[int],
    settings: CourseSettings,
    laid: LaidCourses | None = None,
) -> Task | None:
    """Return what the kernels are asked; None when no stone fits into the wall."""
    site = workshop.site
    cell_px = 1.0 / site.scale
    column_px = 0.5 * cell_px
    quarters = pixel_quarters([workshop.stones.by_id(i) for i in stone_ids], workshop, column_px)
    if quarters is None:
        return None
    ground = ground_of(laid, pixel_extent(site), column_px)
    rules = rules_of(settings, quarters.poses, ground.height)
    return Task(quarters, ground, rules, column_px / COLUMN_UNITS)


def pixel_extent(site: Site) -> tuple[float, float]:
    """Return the width and height of the pixels of a wall, source px."""
    return site.width_px / site.scale, site.height_px / site.scale


def pixel_quarters(
    stones: Collection[Stone], workshop: Workshop, column_px: float
) -> Quarters | None:
    """Turn stones by quarters; None when none fits into the wall."""
    site, book = workshop.site, workshop.book
    fitting: list[Stone] = []
    angles: list[tuple[float, ...]] = []
    corners: list[Points] = []
    for stone in stones:
        posed = {angle: book.pose(stone, angle) for angle in book.angles(stone, "quarter")}
        possible = [
            angle
            for angle, one in posed.items()
            if one.width_px <= site.width_px and one.height_px <= site.height_px
        ]
        if possible:
            outlines = {angle: posed_outline(posed[angle]) for angle in possible}
            fitting.append(stone)
            angles.append(tuple(possible[i % len(possible)] for i in range(4)))
            corners += [outlines[angle] for angle in angles[-1]]
    if not fitting:
        return None
    areas = np.array([stone.area_px for stone in fitting], np.float64)
    poses = poses_of(corners, areas, column_px)
    return Quarters(tuple(fitting), tuple(angles), tuple(corners), poses)
