"""Walls that are planned course by course, and laid."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial, partialmethod
from typing import Any

import numpy as np
import pytest
from numpy.random import Generator

from drystone.planner.assemble import Frame
from drystone.planner.build import Build
from drystone.planner.evaluate import Evaluator, Loaded
from drystone.planner.events import Stopped
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.search.by_courses import newly_planned, relaid, replanned
from drystone.search.chain import recreated
from drystone.search.course_plan import CoursePlan
from drystone.search.found import Found
from drystone.search.laying import Laid, lay
from drystone.search.packed import Packed, found_again
from drystone.search.plan_result import finish
from drystone.statics.incremental import IncrementalResult
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from drystone.verify.check import check_plan
from tests.planner import scenes
from tests.planner.scenes import RUBBLE_SITE, greedy, rubble

Change = Callable[[Found, Workshop, PlannerSettings, Generator], Found | None]


@pytest.fixture(scope="module")
def settings() -> PlannerSettings:
    return greedy({"search": {"budget": 2}})


@pytest.fixture(scope="module")
def workshop(settings: PlannerSettings) -> Workshop:
    return Workshop.prepare(rubble(), RUBBLE_SITE, settings)


@pytest.fixture(scope="module")
def planned(workshop: Workshop, settings: PlannerSettings) -> Found:
    # Not the cheapest plan of all, which would only be found again.
    found = newly_planned(workshop, settings, np.random.default_rng(14))
    assert found is not None
    return found


def poses(found: Found) -> list[tuple[int, float, object]]:
    """Stones, angles and corners or places in the order of placement."""
    return [
        (
            p.stone_id,
            p.posed.angle_deg,
            p.settled.corners.tobytes() if p.settled else (p.row, p.col),
        )
        for p in found.build.wall.placements
    ]


def check(found: Found, workshop: Workshop, settings: PlannerSettings) -> None:
    """The wall stands at every step, and the ends of its courses are those of its steps."""
    courses, build = found.courses, found.build
    assert courses is not None
    assert courses.ends[0] == 0
    assert list(courses.ends) == sorted(courses.ends)
    assert courses.ends[-1] <= len(build.actions)
    assert len(courses.ends) == len(courses.plan.courses) + 1
    stones = [stone.stone_id for course in courses.plan.courses for stone in course]
    assert len(set(stones)) == len(stones)
    assert len(build.states()) == len(build.actions) + 1
    assert all(a.sturdy and a.resistance.stable for a in build.actions)
    placed = [p.stone_id for p in build.wall.placements]
    assert len(set(placed)) == len(placed)
    measured = Found.measured(build, workshop, settings)
    assert (measured.figures, measured.merit) == (found.figures, found.merit)


def test_a_plan_is_laid_and_the_rest_goes_on_top(
    planned: Found, workshop: Workshop, settings: PlannerSettings
) -> None:
    check(planned, workshop, settings)
    assert planned.figures is not None
    assert planned.figures.stones >= 6
    again = newly_planned(workshop, settings, np.random.default_rng(14))
    assert again is not None
    assert poses(again) == poses(planned)
    others = [newly_planned(workshop, settings, np.random.default_rng(k)) for k in (3, 4)]
    assert any(other is not None and poses(other) != poses(planned) for other in others)


@pytest.mark.parametrize("change", [replanned, relaid])
def test_lower_courses_stay(
    change: Change,
    planned: Found,
    workshop: Workshop,
    settings: PlannerSettings,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    begun: list[int] = []

    def spied(plan: CoursePlan, start: Build, *rest: Any) -> Laid:
        begun.append(len(start.actions))
        return lay(plan, start, *rest)

    monkeypatch.setattr("drystone.search.by_courses.lay", spied)
    assert planned.courses is not None
    ends, changed = planned.courses.ends, set[int]()
    for seed in range(12):
        new = change(planned, workshop, settings, np.random.default_rng(seed))
        assert new is not None
        check(new, workshop, settings)
        same = [a == b for a, b in zip(poses(new), poses(planned), strict=False)]
        count = same.index(False) if False in same else len(same)
        # How many stay is what is drawn first.
        kept = int(np.random.default_rng(seed).integers(len(ends) - 1))
        assert begun.pop() == ends[kept] <= count
        if poses(new) != poses(planned):
            changed.add(kept)
    assert changed - {0}


def test_changes_can_follow_each_other(
    planned: Found, workshop: Workshop, settings: PlannerSettings
) -> None:
    found, rng = planned, np.random.default_rng(0)
    for change in (replanned, relaid, replanned, replanned):
        new = change(found, workshop, settings, rng)
        if new is not None:
            found = new
        check(found, workshop, settings)


def test_it_goes_through_a_message(
    planned: Found, workshop: Workshop, settings: PlannerSettings
) -> None:
    again = found_again(Packed.of(planned), workshop, settings)
    assert poses(again) == poses(planned)
    assert again.courses == planned.courses
    assert again.merit == planned.merit


@pytest.mark.parametrize("settings", ["exact"], indirect=True)  # pixels stand without friction
def test_another_wall_is_not_taken_for_it(planned: Found, settings: PlannerSettings) -> None:
    """What does not stand as it stood is an error, not another wall."""
    lower = settings.updated({"mu": 0.01})
    workshop = Workshop.prepare(rubble(), RUBBLE_SITE, lower)
    with pytest.raises(ValueError, match="do not stand"):
        found_again(Packed.of(planned), workshop, lower)


def test_nothing_can_be_planned_without_stones(settings: PlannerSettings) -> None:
    settings = settings.updated({"skip_too_large": True})
    small = type(RUBBLE_SITE)(6, 6)
    workshop = Workshop.prepare(rubble(), small, settings)
    assert newly_planned(workshop, settings, np.random.default_rng(0)) is None
    assert scenes.finish(Planner(rubble(), small, settings=settings)).build.actions == ()


@pytest.mark.parametrize("change", [newly_planned, relaid, recreated])
def test_every_solve_that_failed_is_counted(
    change: Callable[..., Found | None],
    planned: Found,
    workshop: Workshop,
    settings: PlannerSettings,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """While a plan is laid, while steps are taken again, and while stones are added."""
    solved: list[bool] = []
    given_up = LimitResult(LimitStatus.FAILED, "left")

    def gives_up(solve: Callable[..., Loaded], *arguments: Any) -> Loaded:
        loaded = solve(*arguments)
        failed = len(solved) % 3 == 2
        solved.append(failed)
        nothing = IncrementalResult(LateralResistance(given_up, given_up, loaded.model.mu))
        return replace(loaded, grown=nothing) if failed else loaded

    for name in ("loaded", "_of_pixels"):
        fails = partial(gives_up, getattr(Evaluator, name))
        monkeypatch.setattr(Evaluator, name, partialmethod(fails))
    known = () if change is newly_planned else (planned,)
    found = change(*known, workshop, settings, np.random.default_rng(5))
    assert found is not None
    assert found.solves.failed == sum(solved) > 0


def test_what_was_planned_passes_the_check_of_plans(
    planned: Found, workshop: Workshop, settings: PlannerSettings
) -> None:
    site = workshop.site
    begun = Planner(workshop.stones, site, settings=settings, workshop=workshop)
    begun.build = planned.build
    frame = Frame(*site.extent_px, site)
    provenance = {"version": "0", "method": "best", "seed": 0, "settings": settings.as_dict()}
    result = finish(begun, frame, Stopped("stones", "no stones are left"), provenance, 0.0)
    assert check_plan(result.plan, workshop.stones).problems == ()
