"""Which first walls are planned course by course."""

from dataclasses import replace

import pytest

from drystone.planner.solves import Solves
from drystone.search.course_plan import CoursePlan
from drystone.search.first_walls import BATCH, SHARE, STALE, batches, planned_share, stale
from drystone.search.found import Courses
from drystone.search.packed import Packed


def wall(merit: float, planned: bool) -> Packed:
    one = Packed((), None, merit, Solves(), None)
    return replace(one, courses=Courses(CoursePlan((), 0.0), (0,))) if planned else one


@pytest.mark.parametrize("count", range(14))
def test_batches_number_every_wall_but_the_very_first(count: int) -> None:
    numbers = [list(batch) for batch in batches(count)]
    assert [n for batch in numbers for n in batch] == list(range(1, count))
    # A smaller budget cuts the last batch, and changes no other: it repeats a part of a search.
    whole = [list(batch) for batch in batches(count + BATCH)]
    assert all(set(a) <= set(b) for a, b in zip(numbers, whole, strict=False))


@pytest.mark.parametrize("geometry", ["exact", "raster"])
def test_nothing_is_known_of_a_single_wall(geometry: str) -> None:
    assert planned_share([wall(1.0, planned=False)], geometry) == SHARE[geometry]


def test_the_share_follows_the_better_half() -> None:
    planned_win = [wall(k, planned=k >= 4) for k in range(8)]
    greedy_win = [wall(k, planned=k < 4) for k in range(8)]
    assert planned_share(planned_win, "exact") == (4 + 1) / 6
    assert planned_share(greedy_win, "exact") == 1 / 6
    assert planned_share(planned_win[::-1], "exact") == planned_share(planned_win, "exact")


def test_first_walls_end_when_they_beat_none_that_was_not_planned() -> None:
    rising = [wall(float(k), planned=False) for k in range(20)]
    assert not any(stale(rising[: k + 1]) for k in range(20))
    level = [wall(1.0, planned=False), *(wall(0.5, planned=k % 2 > 0) for k in range(STALE))]
    assert stale(level)
    assert not stale(level[:-1])
    assert not stale([*level, wall(2.0, planned=False)])
    assert not stale([*level, wall(2.0, planned=True), *level[1:]])
