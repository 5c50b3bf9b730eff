"""Which first walls are planned course by course."""

from dataclasses import replace

import pytest

from drystone.planner.solves import Solves
from drystone.search.course_plan import CoursePlan
from drystone.search.first_walls import (
    BATCH,
    FEW,
    NEAR,
    RARE,
    SHARE,
    STALE,
    batches,
    planned_share,
    stale,
    starts,
)
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


def test_a_kind_that_stays_behind_gets_a_small_share() -> None:
    """Merits .1 apart, so the best of some more is expected about .2 above the mean."""
    level = [wall(1.0 + 0.1 * (k % 3), planned=k % 2 > 0) for k in range(12)]
    assert planned_share(level, "exact") == SHARE["exact"]
    for planned, share in ((True, RARE), (False, 1.0 - RARE)):
        ahead = [wall(2.0 + 0.1 * (k % 3), planned=not planned) for k in range(6)]
        behind = [wall(1.0 + 0.1 * (k % 3), planned=planned) for k in range(6)]
        assert planned_share([*ahead, *behind], "exact") == share
        assert planned_share([*behind, *ahead], "raster") == share
        # Of too few nothing is known, however bad they are.
        assert planned_share([*ahead, *behind[: FEW - 1]], "exact") == SHARE["exact"]


def test_a_kind_that_differs_more_is_tried_for_longer() -> None:
    ahead = [wall(2.0 + 0.1 * (k % 3), planned=False) for k in range(6)]
    alike = [wall(1.0 + 0.1 * (k % 3), planned=True) for k in range(6)]
    different = [wall(0.5 + 0.6 * (k % 3), planned=True) for k in range(6)]
    assert planned_share([*ahead, *alike], "exact") == RARE
    assert planned_share([*ahead, *different], "exact") == SHARE["exact"]


def test_first_walls_end_when_they_beat_none_that_was_not_planned() -> None:
    rising = [wall(float(k), planned=False) for k in range(20)]
    assert not any(stale(rising[: k + 1]) for k in range(20))
    level = [wall(1.0, planned=False), *(wall(0.5, planned=k % 2 > 0) for k in range(STALE))]
    assert stale(level)
    assert not stale(level[:-1])
    assert not stale([*level, wall(2.0, planned=False)])
    assert not stale([*level, wall(2.0, planned=True), *level[1:]])


@pytest.mark.parametrize(("behind", "ends"), [(0.9 * NEAR, False), (1.1 * NEAR, True)])
def test_first_walls_do_not_end_while_planned_ones_may_win(behind: float, ends: bool) -> None:
    best = wall(1.0, planned=False)
    planned = [wall(1.0 - behind, planned=True)] * STALE
    assert stale([best, *planned]) is ends
    # Nor while too few of them are known.
    others = [wall(0.0, planned=False)] * STALE
    assert stale([best, *others, *planned[: FEW - 1]]) is False
    assert stale([best, *others, *planned[:FEW]]) is ends


def test_chains_begin_with_the_best_of_both_kinds() -> None:
    found = [wall(1.0 - k * 0.1 * NEAR, planned=k < 5) for k in range(12)]
    # Of the ten that are near the best, five are planned.
    begun = starts(found, 4)
    assert begun == [found[0], found[5], found[1], found[6]]
    assert starts(found[::-1], 4) == begun
    others = [replace(one, courses=None) for one in found]
    assert starts(others, 4) == others[:4]


def test_what_is_far_from_the_best_begins_no_chain_while_there_are_others() -> None:
    planned = [wall(1.0 - k * 0.1, planned=True) for k in range(6)]
    far = [wall(0.95 - NEAR, planned=False)]
    assert starts([*far, *planned], 4) == planned[:4]
    assert starts([*far, planned[0]], 4) == [planned[0], far[0], planned[0], planned[0]]
