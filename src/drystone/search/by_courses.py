"""Walls that are planned course by course, then laid."""

from dataclasses import replace
from itertools import pairwise

from numpy.random import Generator

from drystone.planner.build import Build
from drystone.planner.search_settings import LayingSettings
from drystone.planner.vary import multiplied
from drystone.search.course_task import task_of
from drystone.search.courses import CoursePlan, plan_courses
from drystone.search.goal import Courses, FoundWall
from drystone.search.mason import lay
from drystone.search.yard import Yard

AGAIN = 0.3
"""Evaluations of a plan that is changed, over those of a new one."""


def newly_planned(yard: Yard, rng: Generator) -> FoundWall | None:
    """Plan a wall, and lay it; None when no stone can be planned."""
    start = yard.planner().build
    plan = _planned(yard, start, int(rng.integers(2**31)))
    return None if plan is None else _laid(Courses(plan, (0,)), start, yard, rng)


def replanned(found: FoundWall, yard: Yard, rng: Generator) -> FoundWall | None:
    """Plan the upper courses of a wall again, and lay them; None when nothing can be planned."""
    begun, start = _begun(found, rng)
    plan = _planned(yard, start, int(rng.integers(2**31)), begun)
    if plan is None:
        return None
    kept = len(begun.ends) - 1
    # What could not be laid below may be planned above: no stone comes twice.
    above = {stone.stone_id for course in plan.courses[kept:] for stone in course}
    below = tuple(
        tuple(stone for stone in course if stone.stone_id not in above)
        for course in plan.courses[:kept]
    )
    begun = replace(begun, plan=CoursePlan(below + plan.courses[kept:], plan.cost))
    return _laid(begun, start, yard, rng)


def relaid(found: FoundWall, yard: Yard, rng: Generator) -> FoundWall:
    """Lay the upper courses of a wall again, with every weight multiplied by a random factor."""
    begun, start = _begun(found, rng)
    names = ("apart", "top", "width", "turn", "rest", "wedge", "llc")
    laying = multiplied(yard.settings.laying, names, yard.settings.search.spread, rng)
    return _laid(begun, start, yard, rng, laying)


def _begun(found: FoundWall, rng: Generator) -> tuple[Courses, Build]:
    """Draw how many courses of a wall stay; return these, and what is built then."""
    courses = found.courses
    assert courses is not None  # noqa: S101 - its caller looked
    kept = int(rng.integers(len(courses.ends) - 1))
    start = found.build.states()[courses.ends[kept]]
    return Courses(courses.plan, courses.ends[: kept + 1]), start


def _planned(
    yard: Yard, start: Build, seed: int, begun: Courses | None = None
) -> CoursePlan | None:
    """Plan a wall, or what goes on top of the courses that are laid."""
    workshop, settings = yard.workshop, yard.settings
    courses, ends = settings.courses, (0,) if begun is None else begun.ends
    if begun is not None:
        courses = replace(courses, evaluations=round(AGAIN * courses.evaluations))
    outlines = [one.settled.corners for one in start.wall.placements if one.settled]
    task = task_of(
        [workshop.stones.by_id(i) for i in workshop.remaining(start)],
        workshop.site.extent_px,
        1.0 / workshop.site.scale,
        settings.settle.outline_px,
        courses,
        laid=[outlines[first:end] for first, end in pairwise(ends)],
        book=workshop.book,
    )
    if task is None:
        return None
    return plan_courses(
        task,
        seed,
        begun=None if begun is None else begun.plan,
        keep=len(ends) - 1,
        pinned=settings.pin,
        until=yard.until,
    )


def _laid(
    begun: Courses, start: Build, yard: Yard, rng: Generator, laying: LayingSettings | None = None
) -> FoundWall:
    """Lay the courses of a plan that are not laid yet; the stones that are left go on top."""
    left = CoursePlan(begun.plan.courses[len(begun.ends) - 1 :], begun.plan.cost)
    states, solves = lay(left, start, yard, laying)
    ends = (*begun.ends, *(len(state.actions) for state in states[1:]))
    return FoundWall.of(yard.built_up(states[-1], rng), Courses(begun.plan, ends), solves)
