"""Walls that are planned course by course, then laid."""

import math
from collections.abc import Sequence
from dataclasses import fields, replace
from itertools import pairwise

from numpy.random import Generator

from drystone.kernels.polygons import Points
from drystone.planner.build import Build
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.search.built_up import built_up
from drystone.search.course_plan import CoursePlan
from drystone.search.course_settings import CourseSettings
from drystone.search.courses import plan_courses, replan_courses
from drystone.search.found import Courses, Found
from drystone.search.laid_courses import LaidCourses
from drystone.search.laying import lay
from drystone.search.laying_settings import LayingSettings

AGAIN = 0.3
"""Evaluations of a plan that is changed, over those of a new one."""


def newly_planned(workshop: Workshop, settings: PlannerSettings, rng: Generator) -> Found | None:
    """Plan a wall, and lay it; None when no stone can be planned."""
    site = workshop.site
    plan = plan_courses(
        [workshop.stones.by_id(i) for i in workshop.fitting],
        *site.extent_px,
        1.0 / site.scale,
        settings.settle.outline_px,
        CourseSettings(),
        int(rng.integers(2**31)),
        book=workshop.book,
        pinned=settings.pin,
    )
    if plan is None:
        return None
    start = Planner(workshop.stones, site, settings=settings, workshop=workshop).build
    return _laid(Courses(plan, (0,)), start, workshop, settings, LayingSettings(), rng)


def replanned(
    found: Found, workshop: Workshop, settings: PlannerSettings, rng: Generator
) -> Found | None:
    """Plan the upper courses of a wall again, and lay them; None when nothing can be planned."""
    courses, site = found.courses, workshop.site
    assert courses is not None  # noqa: S101 - its caller looked
    kept = int(rng.integers(len(courses.ends) - 1))
    start = found.build.states()[courses.ends[kept]]
    settings_of_plan = CourseSettings()
    quick = replace(settings_of_plan, evaluations=round(AGAIN * settings_of_plan.evaluations))
    outlines = _outlines(start, courses.ends[: kept + 1])
    plan = replan_courses(
        courses.plan,
        kept,
        [workshop.stones.by_id(i) for i in workshop.remaining(start)],
        *site.extent_px,
        1.0 / site.scale,
        settings.settle.outline_px,
        settings=quick,
        seed=int(rng.integers(2**31)),
        laid=LaidCourses.of(outlines, site.extent_px[0], 1.0 / site.scale),
        book=workshop.book,
        pinned=settings.pin,
    )
    if plan is None:
        return None
    begun = Courses(_each_once(plan, kept), courses.ends[: kept + 1])
    return _laid(begun, start, workshop, settings, LayingSettings(), rng)


def _each_once(plan: CoursePlan, kept: int) -> CoursePlan:
    """Leave out of the kept courses what is planned above, as it could not be laid below."""
    above = {stone.stone_id for course in plan.courses[kept:] for stone in course}
    below = tuple(
        tuple(stone for stone in course if stone.stone_id not in above)
        for course in plan.courses[:kept]
    )
    return CoursePlan(below + plan.courses[kept:], plan.cost)


def relaid(found: Found, workshop: Workshop, settings: PlannerSettings, rng: Generator) -> Found:
    """Lay the upper courses of a wall again, with other weights."""
    courses = found.courses
    assert courses is not None  # noqa: S101 - its caller looked
    kept = int(rng.integers(len(courses.ends) - 1))
    start = found.build.states()[courses.ends[kept]]
    begun = Courses(courses.plan, courses.ends[: kept + 1])
    laying = _varied(LayingSettings(), settings.search.spread, rng)
    return _laid(begun, start, workshop, settings, laying, rng)


def _laid(
    begun: Courses,
    start: Build,
    workshop: Workshop,
    settings: PlannerSettings,
    laying: LayingSettings,
    rng: Generator,
) -> Found:
    """Lay the courses of a plan that are not laid yet; the stones that are left go on top."""
    left = CoursePlan(begun.plan.courses[len(begun.ends) - 1 :], begun.plan.cost)
    laid = lay(left, start, workshop, settings, laying)
    ends = (*begun.ends, *(len(state.actions) for state in laid.states[1:]))
    planner = built_up(laid.build, workshop, settings, rng)
    return Found.of(planner, Courses(begun.plan, ends), laid.solves)


def _outlines(build: Build, ends: Sequence[int]) -> list[list[Points]]:
    """Return the outlines of the stones of the courses that are laid, the lowest first."""
    settled = [placement.settled for placement in build.wall.placements]
    corners = [one.corners for one in settled if one is not None]
    return [corners[start:end] for start, end in pairwise(ends)]


def _varied(laying: LayingSettings, spread: float, rng: Generator) -> LayingSettings:
    """Return settings with every weight multiplied by a random factor."""
    weights = ("apart", "top", "width", "turn", "rest", "wedge")
    known = {field.name for field in fields(laying.let_go)}
    drawn = {
        name: getattr(laying.let_go, name) * math.exp(spread * rng.normal())
        for name in weights
        if name in known
    }
    return replace(
        laying,
        llc=laying.llc * math.exp(spread * rng.normal()),
        let_go=replace(laying.let_go, **drawn),
    )
