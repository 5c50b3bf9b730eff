"""Ways to look for a wall stop when the time is used up, and give the best wall until then."""

import os
from dataclasses import replace
from itertools import chain, count, product, repeat, starmap
from types import SimpleNamespace

import numpy as np
import pytest

from drystone.errors import DrystoneError, UsageError
from drystone.generate.brick import BrickSettings, brick_stones
from drystone.planner.settings import method_settings
from drystone.search.plan_wall import plan_wall
from drystone_lab import search as search_runs
from drystone_lab.runs.spec import generated
from drystone_lab.table import BenchSettings
from drystone_lab.walls import BRICKS, Target

STONES = brick_stones(BrickSettings(count=4), np.random.default_rng(1))
WALL = Target("bricks", generated("brick", 1, count=4), 72, 24, 1.0)


def ticking():
    """A clock that goes on by a second whenever it is looked at."""
    ticks = count()
    return lambda: next(ticks)


def looked_for(way, stones, target, seconds, seed, clock):
    return search_runs.looked_at_times(way, stones, target, (seconds,), seed, clock)[0]


def clock_of(*times):
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
    looked = looked_for(search_runs.WAYS[name], STONES, WALL, seconds, 1, ticking())
    assert walls[0] <= looked.walls <= walls[1]
    assert looked.possible == 1.0
    assert looked.found.figures.stones == 4
    assert looked.found.build.wall.filling == pytest.approx(1.0)


def test_the_search_is_that_of_a_plan_with_the_same_budget():
    looked = looked_for(search_runs.WAYS["search"], STONES, WALL, 50, 1, ticking())
    plan = plan_wall(STONES, 72, 24, seed=1, settings=search_runs.tries(looked.walls), scale=1.0)
    np.testing.assert_array_equal(looked.found.build.wall.labels, plan.wall.labels)
    assert looked.found.figures.F_LR == pytest.approx(plan.metrics.F_LR, abs=1e-12)


def test_the_first_wall_counts_however_long_it_takes_and_without_courses_has_none():
    looked = looked_for(search_runs.WAYS["without courses"], STONES, WALL, 1, 1, clock_of(0, 100))
    assert (looked.walls, looked.found.courses) == (1, None)


@pytest.fixture
def worth(monkeypatch):
    """Walls that are worth what is said, in place of built ones, and the seeds of all but one."""
    seeds = []

    def planner(*_, seed, **__):
        seeds.append(seed)
        return SimpleNamespace(steps=lambda: ())

    def of(*merits):
        values = iter(merits)
        found = SimpleNamespace(of=lambda _: SimpleNamespace(merit=next(values)))
        monkeypatch.setattr(search_runs, "FoundWall", found)
        monkeypatch.setattr(search_runs, "Planner", planner)
        settings = SimpleNamespace(search=SimpleNamespace(wedge_below=0.25))
        workshop = SimpleNamespace(stones=None, site=None)
        return SimpleNamespace(seed=3, seeds=seeds, workshop=workshop, settings=settings)

    return of


def test_restarts_keep_the_best_of_different_seeds(worth):
    first = worth(1.0, 3.0, 2.0, 4.0)
    states = search_runs._restarts(first, 0.0, ticking())
    found = [next(states) for _ in range(4)]
    assert [state.walls for state in found] == [1, 2, 3, 4]
    assert [state.best().merit for state in found] == [1.0, 3.0, 3.0, 4.0]
    assert first.seeds == [3 + search_runs.BETWEEN_SEEDS * k for k in (1, 2, 3)]


def test_wedges_go_into_walls_that_are_nearly_the_best(worth, monkeypatch):
    tried = []

    def wedged(found, *_):
        tried.append(found.merit)
        return SimpleNamespace(merit=found.merit + 0.2)

    monkeypatch.setattr(search_runs, "wedged", wedged)
    states = search_runs._restarts(worth(1.0, 0.9, 0.96, 1.1), 0.0, ticking(), wedges=True)
    assert [next(states).best().merit for _ in range(4)] == pytest.approx([1.2, 1.2, 1.2, 1.3])
    assert tried == [1.0, 0.96, 1.1]


def test_of_earlier_times_what_was_finished_by_then_counts():
    states = (search_runs.WayState(n, lambda n=n: n) for n in count(1))
    # Started at 10; the walls are finished at 14, 15, 17, 17.5 and 21.
    clock = clock_of(10, 14, 15, 17, 17.5, 21)
    found = search_runs.looked_at_times(lambda *_: states, STONES, WALL, (2, 6, 7, 10), 1, clock)
    # Nothing was there after 2 s, so it is the first wall, when it is finished.
    assert [(one.found, one.walls, one.seconds) for one in found] == [
        (1, 1, 4), (2, 2, 5), (3, 3, 7), (5, 5, 11)
    ]  # fmt: skip
    assert next(states).walls == 6  # none was begun after the last time


@pytest.mark.parametrize(("name", "times"), [("restarts", (2, 4, 9)), ("search", (40, 80, 150))])
def test_what_is_asked_on_the_way_changes_nothing(name, times):
    asked = search_runs.looked_at_times(search_runs.WAYS[name], STONES, WALL, times, 1, ticking())
    alone = looked_for(search_runs.WAYS[name], STONES, WALL, times[-1], 1, ticking())
    assert [one.walls for one in asked] == sorted(one.walls for one in asked)
    assert (asked[-1].walls, asked[-1].seconds) == (alone.walls, alone.seconds)
    assert asked[-1].found.merit == alone.found.merit
    assert asked[0].walls < alone.walls


WALLS = [(BRICKS, BRICKS.stones(None))]
ONE_WAY = BenchSettings(quick=True, policies=("restarts",))


@pytest.fixture
def done(monkeypatch):
    """Tasks that were done; their walls have as many stones as their seed says."""
    tasks = []

    def do(task):
        tasks.append(task)
        figures = dict.fromkeys((*search_runs.FIGURES, *search_runs.SPENT), 0.5)
        return task, [figures | {"placed": task.seed, "CPU s": each} for each in task.times]

    monkeypatch.setattr(search_runs, "do", do)
    return tasks


def test_what_the_table_holds_is_not_done_again(done, tmp_path):
    said = []
    kept = replace(ONE_WAY, runs=tmp_path / "runs.csv", say=said.append)
    first = search_runs.searched(WALLS, [1, 2], (1.0, 3.0), kept)
    assert [(task.seed, task.times) for task in done] == [(1, (1.0, 3.0)), (2, (1.0, 3.0))]
    runs = product([BRICKS.name], ["restarts"], (1, 2), (1.0, 3.0))
    assert first.keys() == set(starmap(search_runs.SearchRun, runs))
    again = search_runs.searched(WALLS, [2, 1], (3.0,), kept)
    assert len(done) == 2
    assert [(run.seed, one["placed"]) for run, one in again.items()] == [(2, 2), (1, 1)]
    # A time that is not there is looked for anew; what was there stays.
    search_runs.searched(WALLS, [1], (2.0, 3.0), kept)
    assert done[2:] == [search_runs.SearchTask(BRICKS, "restarts", 1, (2.0, 3.0), None)]
    assert len(search_runs.read_results(tmp_path / "runs.csv")) == len(said) == 5
    assert said[-1].startswith("bricks, restarts, seed 1, 2 s: 1 of 9 stones, ")


def test_seeds_are_outermost_and_ways_take_turns(done):
    search_runs.searched(WALLS, [5, 6], (1.0,), replace(ONE_WAY, policies=("restarts", "search")))
    found = [(task.seed, task.way) for task in done]
    assert found == list(product((5, 6), ("restarts", "search")))


def test_runs_with_other_settings_are_others(done, tmp_path):
    plain = replace(ONE_WAY, runs=tmp_path / "runs.csv")
    aimed = replace(plain, changes=(("goal.F_AH", 1.5), ("goal.F_AV", 40)))
    _, (run,), _ = (search_runs.searched(WALLS, [1], (1.0,), one) for one in (plain, aimed, aimed))
    assert run == (BRICKS.name, "restarts, goal.F_AH = 1.5, goal.F_AV = 40", 1, 1.0)
    assert [task.changes for task in done] == [(), aimed.changes]
    assert len(search_runs.read_results(tmp_path / "runs.csv")) == 2


def test_settings_are_what_a_way_goes_by():
    task = search_runs.SearchTask(BRICKS, "restarts", 1, (1e-6,), None)
    _, (plain,) = search_runs.do(task)
    _, (halved,) = search_runs.do(replace(task, changes=(("goal.filling", 0.0),)))
    lost = method_settings("best").goal.filling * plain["F_SF"] / plain["possible F_SF"]
    assert halved["merit"] == pytest.approx(plain["merit"] - lost)


class Deadly(str):
    """The name of a way at which its process dies, as soon as it hears of it."""

    __slots__ = ()

    def __reduce__(self):
        return os._exit, (1,)


def test_processes_do_what_one_does_and_what_ended_is_kept_when_one_dies(tmp_path, monkeypatch):
    times = (1e-6,)  # the first wall is always finished, and here none is begun after it
    one = search_runs.searched(WALLS, [1], times, ONE_WAY)
    monkeypatch.setattr(search_runs, "chosen_ways", lambda _: ("restarts", Deadly("unknown")))
    settings = replace(ONE_WAY, runs=tmp_path / "runs.csv", jobs=2)
    with pytest.raises(DrystoneError, match="E402") as caught:
        search_runs.searched(WALLS, [1], times, settings)
    assert caught.value.where == "bricks, unknown, seed 1"
    found = search_runs.read_results(tmp_path / "runs.csv")
    timeless = [{run: {**r, "CPU s": 0} for run, r in each.items()} for each in (one, found)]
    assert timeless[0] == timeless[1]


def result(*values):
    return dict(zip((*search_runs.FIGURES, *search_runs.SPENT), values, strict=True))


RUNS = {
    search_runs.SearchRun("rubble, 60, exact", "restarts with wedges", 3, 60.0): result(
        58, 0.1 + 0.2, None, 1e-7, 1.0, 2.5, 3.0, 0.0, 0.5, -1.25, 0.8, 17, 60.123
    ),
    search_runs.SearchRun("R, raster", "search", 4, 0.5): result(34, *[0.25] * 9, 1, 1, 1.5),
}


def test_what_is_read_is_what_was_written_and_the_last_of_two_equal_runs_counts(tmp_path):
    path = tmp_path / "runs.csv"
    assert search_runs.read_results(path) == {}
    for one in RUNS.items():
        search_runs.append_results(path, [one])
    assert search_runs.read_results(path) == RUNS
    lines = path.read_text(encoding="utf-8").splitlines()
    assert (lines[0], len(lines)) == (",".join(search_runs.COLUMNS), 3)
    (run, first), (_, second) = RUNS.items()
    search_runs.append_results(path, [(run, second)])
    assert search_runs.read_results(path)[run] == second
    words = search_runs.in_words(first, 60)
    assert words.startswith("58 of 60 stones, F_SF 0.3, F_AV -, F_AH 1e-07, ")
    assert words.endswith("merit -1.25, 17 walls")


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (lambda text: text.replace("wall,", "stone,", 1), 1),
        (lambda _: "", 1),
        (lambda text: text[:-20], 3),
        (lambda text: text.replace(",60.0,", ",long,"), 2),
    ],
)
def test_other_files_are_not_taken_for_tables(change, line, tmp_path):
    path = tmp_path / "runs.csv"
    search_runs.append_results(path, RUNS.items())
    path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(UsageError, match=f"^E148 {path}:{line}: "):
        search_runs.read_results(path)
