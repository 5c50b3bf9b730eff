"""Course plans that choose from a large stock, and take what is pinned."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.generate.rubble import RubbleSettings, rubble_stones
from drystone.model.stone import StoneSet
from drystone.planner.course_settings import CourseSettings
from drystone.search.course_choice import HIGH, LEFT_OUT, PINNED, choosing, taken
from drystone.search.course_task import Task, task_of
from drystone.search.courses import plan_courses

TOLERANCE_PX = 0.35


@pytest.fixture(scope="module")
def rubble() -> StoneSet:
    return rubble_stones(RubbleSettings(count=24), np.random.default_rng(3))


def task(stones: StoneSet, share: float) -> Task:
    """A wall of a share of the stones' area."""
    side = (share * stones.total_area_px) ** 0.5
    found = task_of(stones.stones, (2 * side, side / 2), 4.0, TOLERANCE_PX, CourseSettings())
    assert found is not None
    return found


def test_a_stock_that_is_about_enough_changes_nothing(rubble: StoneSet) -> None:
    for share in (0.7, 1.0, 1.5):
        one = task(rubble, share)
        assert choosing(one, ()) is one
    assert taken(task(rubble, 1.5)) == 24


def test_with_plenty_standing_out_is_worse_than_being_left_out(rubble: StoneSet) -> None:
    one = task(rubble, 0.25)
    weights, changed = one.rules.weights, choosing(one, ()).rules.weights
    assert taken(one) == pytest.approx(0.25 * 24, abs=2)
    assert changed.left_out == LEFT_OUT * weights.left_out
    assert changed.high == HIGH * weights.high
    assert changed.across == pytest.approx(weights.across * taken(one) / 24)
    assert changed.down == pytest.approx(weights.down * taken(one) / 24)
    assert (
        changed._replace(**{n: getattr(weights, n) for n in ("left_out", "high", "across", "down")})
        == weights
    )
    mean = float(one.quarters.poses.area.mean())
    assert changed.high > 2.0 * changed.left_out * mean


def test_what_is_laid_counts_as_stock(rubble: StoneSet) -> None:
    """The last stones of a set that is just enough leave no choice, those of a large stock do."""
    one = task(rubble, 0.8)
    ground = one.ground
    assert choosing(one, ()) is one
    tops = np.full_like(ground.tops, round(0.3 * ground.height))
    later = replace(one, ground=ground._replace(tops=tops))
    assert choosing(later, ()).rules != later.rules


def test_pinned_stones_are_left_out_last(rubble: StoneSet) -> None:
    one = task(rubble, 1.0)
    number = 5
    pinned = choosing(one, [one.quarters.stones[number].id]).quarters.poses.area
    expected = one.quarters.poses.area.copy()
    expected[number] *= PINNED
    assert pinned.tolist() == expected.tolist()


def test_a_plan_from_a_large_stock_takes_the_pinned_ones(rubble: StoneSet) -> None:
    side = (0.3 * rubble.total_area_px) ** 0.5
    quick = CourseSettings(evaluations=30)

    def ids(pinned: list[int]) -> set[int]:
        plan = plan_courses(
            rubble.stones, 2 * side, side / 2, 4.0, TOLERANCE_PX, quick, 1, pinned=pinned
        )
        assert plan is not None
        return {stone.stone_id for course in plan.courses for stone in course}

    free = ids([])
    assert len(free) < 16
    left = sorted({stone.id for stone in rubble} - free)[:3]
    assert set(left) <= ids(left)
