"""Which first walls are planned course by course."""

from dataclasses import replace

import pytest

from drystone.planner.solves import Solves
from drystone.search.course_plan import CoursePlan
from drystone.search.first_walls import BATCH, SHARE, batches, planned_share
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


def test_nothing_is_known_of_a_single_wall() -> None:
    assert planned_share([wall(1.0, planned=False)]) == SHARE


def test_the_share_follows_the_better_half() -> None:
    planned_win = [wall(k, planned=k >= 4) for k in range(8)]
    greedy_win = [wall(k, planned=k < 4) for k in range(8)]
    assert planned_share(planned_win) == (4 + 1.5) / 6
    assert planned_share(greedy_win) == 1.5 / 6
    assert planned_share(planned_win[::-1]) == planned_share(planned_win)
