"""Walls that are planned course by course, then laid."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from numpy.random import Generator

from drystone.kernels.polygons import Points
from drystone.planner.build import Build
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.laying_settings import LayingSettings
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.search.built_up import built_up
from drystone.search.course_plan import CoursePlan
from drystone.search.courses import plan_courses, replan_courses
from drystone.search.found import Courses, Found
from drystone.search.laid_courses import LaidCourses
from drystone.search.laying import lay

AGAIN = 0.3
"""Evaluations of a plan that is changed, over those of a new one."""


def newly_planned(
    workshop: Workshop, settings: PlannerSettings, rng: Generator, until: Deadline = NEVER
) -> Found | None:
    """Plan a wall, and lay it; None when no stone can be planned, `TimeIsUp` when time is up."""
    plan = _new_plan(workshop, settings, int(rng.integers(2**31)), until)
    if plan is None:
        return None
    start = Planner(workshop.stones, workshop.site, settings=settings, workshop=workshop).build
    return _laid(Courses(plan, (0,)), start, workshop, settings, settings.laying, rng, until)


def _new_plan(
    workshop: Workshop, settings: PlannerSettings, seed: int, until: Deadline
) -> CoursePlan | None:
    return plan_courses(
        [workshop.stones.by_id(i) for i in workshop.fitting],
        *workshop.site.extent_px,
        1.0 / workshop.site.scale,
        settings.settle.outline_px,
        settings.courses,
        seed,
        book=workshop.book,
        pinned=settings.pin,
        until=until,
    )


def replanned(
    found: Found,
    workshop: Workshop,
    settings: PlannerSettings,
    rng: Generator,
    until: Deadline = NEVER,
) -> Found | None:
    """Plan the upper courses of a wall again, and lay them; None when nothing can be planned."""
    courses = found.courses
    assert courses is not None  # noqa: S101 - its caller looked
    kept = int(rng.integers(len(courses.ends) - 1))
    start = found.build.states()[courses.ends[kept]]
    ends = courses.ends[: kept + 1]
    seed = int(rng.integers(2**31))
    plan = _upper_plan(courses.plan, start, ends, workshop, settings, seed, until)
    if plan is None:
        return None
    begun = Courses(_each_once(plan, kept), ends)
    return _laid(begun, start, workshop, settings, settings.laying, rng, until)


def _upper_plan(
    plan: CoursePlan,
    start: Build,
    ends: Sequence[int],
    workshop: Workshop,
    settings: PlannerSettings,
    seed: int,
    until: Deadline,
) -> CoursePlan | None:
    """Plan what goes on top of the courses that are laid."""
    kept, known, left = len(ends) - 1, settings.courses, workshop.remaining(start)
    quick = replace(known, evaluations=round(AGAIN * known.evaluations))
    outlines = _outlines(start, ends)
    cell_px = 1.0 / workshop.site.scale
    extent = workshop.site.extent_px
    return replan_courses(
        plan,
        kept,
        [workshop.stones.by_id(i) for i in left],
        *extent,
        cell_px,
        settings.settle.outline_px,
        settings=quick,
        seed=seed,
        laid=LaidCourses.of(outlines, extent[0], cell_px),
        book=workshop.book,
        pinned=settings.pin,
        until=until,
    )


def _each_once(plan: CoursePlan, kept: int) -> CoursePlan:
    """Leave out of the kept courses what is planned above, as it could not be laid below."""
    above = {stone.stone_id for course in plan.courses[kept:] for stone in course}
    below = tuple(
        tuple(stone for stone in course if stone.stone_id not in above)
        for course in plan.courses[:kept]
    )
    return CoursePlan(below + plan.courses[kept:], plan.cost)


def relaid(
    found: Found,
    workshop: Workshop,
    settings: PlannerSettings,
    rng: Generator,
    until: Deadline = NEVER,
) -> Found:
    """Lay the upper courses of a wall again, with other weights."""
    courses = found.courses
    assert courses is not None  # noqa: S101 - its caller looked
    kept = int(rng.integers(len(courses.ends) - 1))
    start = found.build.states()[courses.ends[kept]]
    begun = Courses(courses.plan, courses.ends[: kept + 1])
    laying = _varied(settings.laying, settings.search.spread, rng)
    return _laid(begun, start, workshop, settings, laying, rng, until)


def _laid(
    begun: Courses,
    start: Build,
    workshop: Workshop,
    settings: PlannerSettings,
    laying: LayingSettings,
    rng: Generator,
    until: Deadline,
) -> Found:
    """Lay the courses of a plan that are not laid yet; the stones that are left go on top."""
    left = CoursePlan(begun.plan.courses[len(begun.ends) - 1 :], begun.plan.cost)
    laid = lay(left, start, workshop, settings, laying, until)
    ends = (*begun.ends, *(len(state.actions) for state in laid.states[1:]))
    planner = built_up(laid.build, workshop, settings, rng, until)
    return Found.of(planner, Courses(begun.plan, ends), laid.solves)


def _outlines(build: Build, ends: Sequence[int]) -> list[list[Points]]:
    """Return the outlines of the stones of the courses that are laid, the lowest first."""
    outlines = [one.settled.corners for one in build.wall.placements if one.settled]
    return [outlines[start:end] for start, end in pairwise(ends)]


def _varied(laying: LayingSettings, spread: float, rng: Generator) -> LayingSettings:
    """Multiply every weight by a random factor."""
    names = ("apart", "top", "width", "turn", "rest", "wedge", "llc")
    return replace(
        laying, **{name: getattr(laying, name) * math.exp(spread * rng.normal()) for name in names}
    )
