"""Ways to look for a wall stop when the time is used up, and give the best wall until then."""

from collections.abc import Iterator
from itertools import chain, count, repeat
from types import SimpleNamespace

import numpy as np
import pytest

from drystone.generate.brick import BrickSettings, brick_stones
from drystone.search.plan_wall import plan_wall
from drystone_lab import search_ways
from drystone_lab.runs.spec import generated
from drystone_lab.search_runs import BETWEEN_SEEDS, SearchWay, WayState, looked_at_times, tries
from drystone_lab.walls import Target

STONES = brick_stones(BrickSettings(count=4), np.random.default_rng(1))
WALL = Target("bricks", generated("brick", 1, count=4), 72, 24, 1.0)
WAYS = {way.name: way for way in search_ways.WAYS}


def ticking() -> search_ways.Clock:
    """A clock that goes on by a second whenever it is looked at."""
    ticks = count()
    return lambda: next(ticks)


def looked_for(way, stones, target, seconds, seed, clock):
    return looked_at_times(way, stones, target, (seconds,), seed, clock)[0]


def clock_of(*times: float) -> search_ways.Clock:
    values = chain(times, repeat(times[-1]))
    return lambda: next(values)


@pytest.mark.parametrize(
    ("name", "seconds", "walls"),
    [
        ("restarts", 3, (4, 4)),
        ("restarts with wedges", 3, (4, 4)),
        # A search looks at the clock inside every wall.
        ("search", 150, (3, 10)),
        ("without courses", 150, (3, 10)),
    ],
)
def test_what_is_begun_in_time_counts(name, seconds, walls):
    looked = looked_for(WAYS[name], STONES, WALL, seconds, 1, ticking())
    assert walls[0] <= looked.walls <= walls[1]
    assert looked.possible == 1.0
    assert looked.found.figures.stones == 4
    assert looked.found.build.wall.filling == pytest.approx(1.0)


def test_the_search_is_that_of_a_plan_with_the_same_budget():
    looked = looked_for(WAYS["search"], STONES, WALL, 50, 1, ticking())
    plan = plan_wall(STONES, 72, 24, seed=1, settings=tries(looked.walls), scale=1.0)
    np.testing.assert_array_equal(looked.found.build.wall.labels, plan.wall.labels)
    assert looked.found.figures.F_LR == pytest.approx(plan.metrics.F_LR, abs=1e-12)


def test_without_courses_there_are_none():
    assert looked_for(WAYS["without courses"], STONES, WALL, 1, 1, ticking()).found.courses is None


def test_the_first_wall_counts_however_long_it_takes():
    looked = looked_for(WAYS["search"], STONES, WALL, 1, 1, clock_of(0, 100))
    assert looked.walls == 1


def test_the_time_is_counted_from_the_start():
    asked: list[int] = []

    def states(*_: object) -> Iterator[WayState]:
        for number in count(1):
            asked.append(number)
            yield WayState(number, lambda number=number: number)  # type: ignore[misc, return-value]

    way = SearchWay("by hand", states)
    looked = looked_for(way, STONES, WALL, 5, 1, clock_of(10, 14.9, 15, 15.1))
    assert (looked.found, looked.walls) == (3, 3)
    assert asked == [1, 2, 3]  # the third was begun in time, and finished after it
    assert looked.seconds == pytest.approx(5.1)


class Fake:
    """In place of a planner: builds nothing, and its wall is worth what is said."""

    merits: Iterator[float]
    seeds: list[int]

    def __init__(self, *_: object, seed: int, **__: object) -> None:
        self.seeds.append(seed)

    @staticmethod
    def steps() -> tuple[()]:
        return ()


@pytest.fixture
def worth(monkeypatch):
    """Walls that are worth what is said, in place of built ones."""

    def of(*merits: float) -> SimpleNamespace:
        values = iter(merits)
        Fake.seeds = []
        found = SimpleNamespace(of=lambda _: SimpleNamespace(merit=next(values)))
        monkeypatch.setattr(search_ways, "FoundWall", found)
        monkeypatch.setattr(search_ways, "Planner", Fake)
        return SimpleNamespace(
            seed=3,
            workshop=SimpleNamespace(stones=None, site=None),
            settings=SimpleNamespace(search=SimpleNamespace(wedge_below=0.25)),
        )

    return of


def test_restarts_keep_the_best_of_different_seeds(worth):
    states = search_ways._restarts(worth(1.0, 3.0, 2.0, 4.0), 0.0, ticking())
    found = [next(states) for _ in range(4)]
    assert [state.walls for state in found] == [1, 2, 3, 4]
    assert [state.best().merit for state in found] == [1.0, 3.0, 3.0, 4.0]
    assert Fake.seeds == [3 + BETWEEN_SEEDS * k for k in (1, 2, 3)]


def test_wedges_go_into_walls_that_are_nearly_the_best(worth, monkeypatch):
    tried = []

    def wedged(found, *_):
        tried.append(found.merit)
        return SimpleNamespace(merit=found.merit + 0.2)

    monkeypatch.setattr(search_ways, "wedged", wedged)
    states = search_ways._restarts_with_wedges(worth(1.0, 0.9, 0.96, 1.1), 0.0, ticking())
    assert [next(states).best().merit for _ in range(4)] == pytest.approx([1.2, 1.2, 1.2, 1.3])
    assert tried == [1.0, 0.96, 1.1]


def test_of_earlier_times_what_was_finished_by_then_counts():
    walls = [WayState(n, lambda n=n: n) for n in range(1, 6)]
    way = SearchWay("five walls", lambda *_: iter(walls))
    # Started at 10; the walls are finished at 14, 15, 17, 17.5 and 21.
    clock = clock_of(10, 14, 15, 17, 17.5, 21)
    found = looked_at_times(way, STONES, WALL, (2, 6, 7, 10), 1, clock)
    # Nothing was there after 2 s, so it is the first wall, when it is finished.
    assert [(one.found, one.walls, one.seconds) for one in found] == [
        (1, 1, 4), (2, 2, 5), (3, 3, 7), (5, 5, 11)
    ]  # fmt: skip


@pytest.mark.parametrize(("name", "times"), [("restarts", (2, 4, 9)), ("search", (40, 80, 150))])
def test_what_is_asked_on_the_way_changes_nothing(name, times):
    asked = looked_at_times(WAYS[name], STONES, WALL, times, 1, ticking())
    alone = looked_for(WAYS[name], STONES, WALL, times[-1], 1, ticking())
    assert [one.walls for one in asked] == sorted(one.walls for one in asked)
    assert (asked[-1].walls, asked[-1].seconds) == (alone.walls, alone.seconds)
    assert asked[-1].found.merit == alone.found.merit
    assert asked[0].walls < alone.walls
