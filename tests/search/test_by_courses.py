"""Walls that are planned course by course, and laid."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.random import Generator

from drystone.planner.build import Candidate
from drystone.planner.evaluate import Evaluator
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.search.by_courses import newly_planned, relaid, replanned
from drystone.search.chain import recreated
from drystone.search.found import Found
from drystone.search.packed import Packed, found_again
from tests.planner.scenes import RUBBLE_SITE, greedy, rubble

SETTINGS = greedy({"search": {"budget": 2}})

Change = Callable[[Found, Workshop, PlannerSettings, Generator], Found | None]


@pytest.fixture(scope="module")
def workshop() -> Workshop:
    return Workshop.prepare(rubble(), RUBBLE_SITE, SETTINGS)


@pytest.fixture(scope="module")
def planned(workshop: Workshop) -> Found:
    found = newly_planned(workshop, SETTINGS, np.random.default_rng(2))
    assert found is not None
    return found


def poses(found: Found) -> list[tuple[int, float, bytes]]:
    """Stones, angles and corners in the order of placement."""
    return [
        (p.stone_id, p.posed.angle_deg, p.settled.corners.tobytes())
        for p in found.build.wall.placements
        if p.settled is not None
    ]


def check(found: Found) -> None:
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
    measured = Found.measured(build, Workshop.prepare(rubble(), RUBBLE_SITE, SETTINGS), SETTINGS)
    assert (measured.figures, measured.merit) == (found.figures, found.merit)


def test_a_plan_is_laid_and_the_rest_goes_on_top(planned: Found, workshop: Workshop) -> None:
    check(planned)
    assert planned.figures is not None
    assert planned.figures.stones >= 6
    again = newly_planned(workshop, SETTINGS, np.random.default_rng(2))
    assert again is not None
    assert poses(again) == poses(planned)
    others = [newly_planned(workshop, SETTINGS, np.random.default_rng(k)) for k in (3, 4)]
    assert any(other is not None and poses(other) != poses(planned) for other in others)


@pytest.mark.parametrize("change", [replanned, relaid])
def test_lower_courses_stay(change: Change, planned: Found, workshop: Workshop) -> None:
    kept = set()
    for seed in range(6):
        new = change(planned, workshop, SETTINGS, np.random.default_rng(seed))
        assert new is not None
        check(new)
        same = [a == b for a, b in zip(poses(new), poses(planned), strict=False)]
        count = same.index(False) if False in same else len(same)
        assert planned.courses is not None
        kept.add(max(end for end in planned.courses.ends if end <= count))
    if change is replanned:
        assert len(kept) > 1


def test_changes_can_follow_each_other(planned: Found, workshop: Workshop) -> None:
    found, rng = planned, np.random.default_rng(0)
    for change in (replanned, relaid, replanned, replanned):
        new = change(found, workshop, SETTINGS, rng)
        if new is not None:
            found = new
        check(found)


def test_it_goes_through_a_message(planned: Found, workshop: Workshop) -> None:
    again = found_again(Packed.of(planned), workshop, SETTINGS)
    assert poses(again) == poses(planned)
    assert again.courses == planned.courses
    assert again.merit == planned.merit


def test_another_wall_is_not_taken_for_it(planned: Found) -> None:
    """What does not stand as it stood is an error, not another wall."""
    lower = greedy({"search": {"budget": 2}, "mu": 0.01})
    workshop = Workshop.prepare(rubble(), RUBBLE_SITE, lower)
    with pytest.raises(ValueError, match="do not stand"):
        found_again(Packed.of(planned), workshop, lower)


def test_nothing_can_be_planned_without_stones() -> None:
    settings = greedy({"search": {"budget": 2}, "skip_too_large": True})
    small = type(RUBBLE_SITE)(6, 6)
    workshop = Workshop.prepare(rubble(), small, settings)
    assert newly_planned(workshop, settings, np.random.default_rng(0)) is None
    assert Planner(rubble(), small, settings=settings).build.actions == ()


@pytest.mark.parametrize("change", [newly_planned, relaid, recreated])
def test_every_solve_that_failed_is_counted(
    change: Callable[..., Found | None],
    planned: Found,
    workshop: Workshop,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """While a plan is laid, while steps are taken again, and while stones are added."""
    judge, judged = Evaluator.judge, []

    def gives_up(*arguments: Any) -> Candidate:
        action = judge(*arguments)
        failed = len(judged) % 3 == 2
        judged.append(failed)
        return replace(action, failed=True, sturdy=False) if failed else action

    monkeypatch.setattr(Evaluator, "judge", gives_up)
    known = () if change is newly_planned else (planned,)
    found = change(*known, workshop, SETTINGS, np.random.default_rng(5))
    assert found is not None
    assert found.solves.failed == sum(judged) > 0
