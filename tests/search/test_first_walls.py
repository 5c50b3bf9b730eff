"""Which first walls are planned course by course."""

from dataclasses import replace

import pytest

from drystone.planner.search_settings import SearchSettings
from drystone.planner.solves import Solves
from drystone.search.course_plan import CoursePlan
from drystone.search.first_walls import (
    BATCH,
    PROMISE,
    SHARE,
    STALE,
    WEIGHT,
    next_batch,
    planned_share,
    promised,
    stale,
)
from drystone.search.found import Courses
from drystone.search.packed import Packed


def wall(merit: float, planned: bool) -> Packed:
    one = Packed((), None, merit, Solves(), None)
    return replace(one, courses=Courses(CoursePlan((), 0.0), (0,))) if planned else one


def numbers(search: SearchSettings) -> list[list[int]]:
    """Batches of a search each of whose walls is better than the one before it."""
    found, batches = [wall(0.0, planned=True)], []
    while (batch := next_batch(found, search)) is not None:
        batches.append(list(batch[0]))
        found += [wall(float(number), planned=True) for number in batch[0]]
    return batches


@pytest.mark.parametrize("count", range(1, 14))
def test_batches_number_every_wall_but_the_very_first(count: int) -> None:
    listed = numbers(SearchSettings(budget=count, passes=24))
    assert [n for batch in listed for n in batch] == list(range(1, count))
    # A smaller budget cuts the last batch, and changes no other: it repeats a part of a search.
    whole = numbers(SearchSettings(budget=count + BATCH, passes=24))
    assert all(set(a) <= set(b) for a, b in zip(listed, whole, strict=False))
    # So do fewer passes.
    assert numbers(SearchSettings(budget=60, passes=count)) == listed


def test_a_batch_goes_on_as_it_began() -> None:
    found = [wall(float(k % 3), planned=k % 2 > 0) for k in range(3 * BATCH)]
    search = SearchSettings(budget=60)
    for begun in range(0, len(found), BATCH):
        numbers, share = next_batch(found[:begun], search) or (range(0), 0.0)
        for done in range(begun + 1, begun + BATCH):
            rest = range(done, numbers.stop)
            assert next_batch(found[:done], search) == (rest, share)


def test_nothing_is_known_of_a_single_wall() -> None:
    assert planned_share([wall(1.0, planned=False)]) == SHARE


def test_the_share_follows_the_better_half() -> None:
    planned_win = [wall(k, planned=k >= 4) for k in range(8)]
    greedy_win = [wall(k, planned=k < 4) for k in range(8)]
    usual = SHARE * WEIGHT
    assert planned_share(planned_win) == (4 + usual) / (4 + WEIGHT)
    assert planned_share(greedy_win) == usual / (4 + WEIGHT)
    assert planned_share(planned_win[::-1]) == planned_share(planned_win)


def test_planned_walls_are_worth_more_than_they_are_yet() -> None:
    one, other = wall(1.0, planned=True), wall(1.0, planned=False)
    assert [promised(one), promised(one, 0.5), promised(one, 0.0)] == [
        1 + PROMISE, 1 + 0.5 * PROMISE, 1.0,
    ]  # fmt: skip
    assert promised(other) == promised(other, 0.5) == 1.0
    # In the better half by their promise alone.
    behind = [wall(1.0, planned=False), wall(1.1 - PROMISE, planned=True)] * 4
    assert planned_share(behind) > SHARE


def test_first_walls_end_when_they_beat_none_that_was_not_planned() -> None:
    rising = [wall(float(k), planned=False) for k in range(20)]
    assert not any(stale(rising[: k + 1]) for k in range(20))
    level = [wall(1.0, planned=False), *(wall(0.3, planned=k % 2 > 0) for k in range(STALE))]
    assert stale(level)
    assert not stale(level[:-1])
    # It is looked at when a batch begins; one that is begun is built to its end.
    more = [wall(0.3, planned=False)] * (BATCH - len(level) % BATCH)
    assert next_batch(level, SearchSettings(budget=60)) is not None
    assert next_batch([*level, *more], SearchSettings(budget=60)) is None
    assert not stale([*level, wall(2.0, planned=False)])
    assert not stale([*level, wall(2.0, planned=True), *level[1:]])
    # A planned wall that is a little behind promises more.
    assert not stale([wall(1.0 - PROMISE / 2, planned=True), *level])
