import os
from dataclasses import replace
from itertools import chain, count, islice, product, repeat, starmap
from types import SimpleNamespace
from unittest.mock import Mock, call

import numpy as np
import pytest

from drystone.errors import DrystoneError, UsageError
from drystone.generate.brick import BrickSettings, brick_stones
from drystone.metrics.measure import measure_labels
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.planner.settings import method_settings
from drystone.search.plan_wall import plan_wall
from drystone_lab import search
from drystone_lab.runs.spec import generated
from drystone_lab.search import SearchRun
from drystone_lab.second_arrangement import finer_labels, finer_picture, second_arrangement
from drystone_lab.table import BenchSettings
from drystone_lab.walls import BRICKS, SEARCHED, UNSEEN, Target, chosen
from tests.metrics.walls import bricks
from tests.verify.exact_examples import exact_example

STONES = brick_stones(BrickSettings(count=4), np.random.default_rng(1))
WALL = Target("bricks", generated("brick", 1, count=4), 72, 24, 1.0)


def ticking():
    """A clock that goes on by a second whenever it is looked at."""
    return count().__next__


def looked_for(name, seconds, clock):
    return search.looked_at_times(search.WAYS[name], STONES, WALL, (seconds,), 1, clock)[0]


def clock_of(*times):
    return chain(times, repeat(times[-1])).__next__


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
    looked = looked_for(name, seconds, ticking())
    assert walls[0] <= looked.walls <= walls[1]
    assert looked.possible == 1.0
    assert looked.found.figures.stones == 4
    assert looked.found.build.wall.filling == pytest.approx(1.0)
    # The first wall counts however long it takes.
    assert looked_for(name, 1, clock_of(0, 100)).walls == 1


def test_the_search_is_that_of_a_plan_with_the_same_budget_and_another_has_no_courses():
    looked = looked_for("search", 50, ticking())
    settings = WALL.run(1, ("search.budget", looked.walls), method="best").settings()
    plan = plan_wall(STONES, 72, 24, seed=1, settings=settings, scale=1.0)
    np.testing.assert_array_equal(looked.found.build.wall.labels, plan.wall.labels)
    assert looked.found.figures.F_LR == pytest.approx(plan.metrics.F_LR, abs=1e-12)
    assert looked_for("without courses", 1, clock_of(0, 100)).found.courses is None


def test_restarts_keep_the_best_of_different_seeds_and_wedge_what_is_nearly_that(monkeypatch):
    planner = Mock(return_value=SimpleNamespace(steps=tuple))
    wedged = Mock(side_effect=lambda found, _: SimpleNamespace(merit=found.merit + 0.2))
    monkeypatch.setattr(search.Yard, "planner", planner)
    monkeypatch.setattr(search, "wedged", wedged)

    def restarts(*merits, wedges):
        """How many walls there are and what the best is worth, after each wall."""
        worth = iter(merits)
        built = SimpleNamespace(of=lambda _: SimpleNamespace(merit=next(worth)))
        monkeypatch.setattr(search, "FoundWall", built)
        settings = SimpleNamespace(search=SimpleNamespace(wedge_below=0.25))
        workshop = SimpleNamespace(stones=None, site=None)
        first = SimpleNamespace(seed=3, workshop=workshop, settings=settings)
        states = search._restarts(first, 0.0, ticking(), wedges=wedges)
        return [(state.walls, state.best().merit) for state in islice(states, len(merits))]

    found = restarts(1.0, 3.0, 2.0, 4.0, wedges=False)
    assert found == [(1, 1.0), (2, 3.0), (3, 3.0), (4, 4.0)]
    assert planner.mock_calls == [call(3 + search.BETWEEN_SEEDS * k) for k in (1, 2, 3)]
    found = restarts(1.0, 0.9, 0.96, 1.1, wedges=True)
    assert [merit for _, merit in found] == pytest.approx([1.2, 1.2, 1.2, 1.3])
    assert [one.args[0].merit for one in wedged.mock_calls] == [1.0, 0.96, 1.1]


def test_of_earlier_times_what_was_finished_by_then_counts():
    states = (search.WayState(n, lambda n=n: n) for n in count(1))
    # Started at 10; the walls are finished at 14, 15, 17, 17.5 and 21.
    clock = clock_of(10, 14, 15, 17, 17.5, 21)
    found = search.looked_at_times(lambda *_: states, STONES, WALL, (2, 6, 7, 10), 1, clock)
    # Nothing was there after 2 s, so it is the first wall, when it is finished.
    expected = [(1, 1, 4), (2, 2, 5), (3, 3, 7), (5, 5, 11)]
    assert [(one.found, one.walls, one.seconds) for one in found] == expected
    assert next(states).walls == 6  # none was begun after the last time


WALLS = [(BRICKS, BRICKS.stones(None))]
ONE_WAY = BenchSettings(quick=True, policies=("restarts",))


def test_what_the_table_holds_is_not_done_again_and_ways_take_turns(monkeypatch, tmp_path):
    done, said = [], []

    def do(task):
        """A wall of as many stones as the seed says."""
        done.append(task)
        return task, [result(placed=task.seed) | {"CPU s": each} for each in task.times]

    monkeypatch.setattr(search, "do", do)
    kept = replace(ONE_WAY, runs=tmp_path / "runs.csv", say=said.append)
    first = search.searched(WALLS, [1, 2], (1.0, 3.0), kept)
    assert [(task.seed, task.times) for task in done] == [(1, (1.0, 3.0)), (2, (1.0, 3.0))]
    runs = product([BRICKS.name], ["restarts"], (1, 2), (1.0, 3.0))
    assert first.keys() == set(starmap(SearchRun, runs))
    again = search.searched(WALLS, [2, 1], (3.0,), kept)
    assert len(done) == 2
    assert [(run.seed, one["placed"]) for run, one in again.items()] == [(2, 2), (1, 1)]
    # A time that is not there is looked for anew; what was there stays.
    search.searched(WALLS, [1], (2.0, 3.0), kept)
    assert done[2:] == [search.SearchTask(BRICKS, "restarts", 1, (2.0, 3.0), None)]
    assert len(search.read_results(tmp_path / "runs.csv")) == len(said) == 5
    assert said[-1].startswith("bricks, restarts, seed 1, 2 s: 1 of 9 stones, ")
    # Runs with other settings are others.
    aimed = replace(kept, changes=(("goal.F_AH", 1.5), ("goal.F_AV", 40)))
    (run,), _ = (search.searched(WALLS, [1], (1.0,), aimed) for _ in range(2))
    assert run == (BRICKS.name, "restarts, goal.F_AH = 1.5, goal.F_AV = 40", 1, 1.0)
    assert [task.changes for task in done[2:]] == [(), aimed.changes]
    assert len(search.read_results(tmp_path / "runs.csv")) == 6
    # Seeds are outermost.
    done.clear()
    search.searched(WALLS, [5, 6], (1.0,), replace(ONE_WAY, policies=("restarts", "search")))
    found = [(task.seed, task.way) for task in done]
    assert found == list(product((5, 6), ("restarts", "search")))


def test_settings_are_what_a_way_goes_by():
    task = search.SearchTask(BRICKS, "restarts", 1, (1e-6,), None)
    _, (plain,) = search.do(task)
    _, (halved,) = search.do(task._replace(changes=(("goal.filling", 0.0),)))
    lost = method_settings("best").goal.filling * plain["F_SF"] / plain["possible F_SF"]
    assert halved["merit"] == pytest.approx(plain["merit"] - lost)


class Deadly(str):
    """The name of a way at which its process dies, as soon as it hears of it."""

    __slots__ = ()

    def __reduce__(self):
        return os._exit, (1,)


def test_processes_do_what_one_does_and_what_ended_is_kept_when_one_dies(tmp_path, monkeypatch):
    times = (1e-6,)  # the first wall is always finished, and here none is begun after it
    one = search.searched(WALLS, [1], times, ONE_WAY)
    monkeypatch.setattr(search, "chosen_ways", lambda _: ("restarts", Deadly("unknown")))
    settings = replace(ONE_WAY, runs=tmp_path / "runs.csv", jobs=2)
    with pytest.raises(DrystoneError, match="E402") as caught:
        search.searched(WALLS, [1], times, settings)
    assert caught.value.where == "bricks, unknown, seed 1"
    found = search.read_results(tmp_path / "runs.csv")
    timeless = [{run: {**r, "CPU s": 0} for run, r in each.items()} for each in (one, found)]
    assert timeless[0] == timeless[1]


def result(walls=1, **figures):
    spent = dict(zip(search.SPENT, (0.75, walls, 2.5), strict=True))
    return dict.fromkeys(search.FIGURES, 1.0) | spent | figures


WEDGED = result(17, placed=58, F_SF=0.1 + 0.2, F_AV=None, F_AH=1e-7, merit=-1.25)
RUNS = {
    SearchRun("rubble, 60, exact", "restarts with wedges", 3, 60.0): WEDGED,
    SearchRun("R, raster", "search", 4, 0.5): result(1, placed=34),
}


def test_what_is_read_is_what_was_written_and_the_last_of_two_equal_runs_counts(tmp_path):
    path = tmp_path / "runs.csv"
    assert search.read_results(path) == {}
    for one in RUNS.items():
        search.append_results(path, [one])
    assert search.read_results(path) == RUNS
    lines = path.read_text(encoding="utf-8").splitlines()
    assert (lines[0], len(lines)) == (",".join(search.KINDS), 3)
    run, other = RUNS
    search.append_results(path, [(run, RUNS[other])])
    assert search.read_results(path)[run] == RUNS[other]
    words = search.in_words(WEDGED, 60)
    assert words.startswith("58 of 60 stones, F_SF 0.3, F_AV -, F_AH 1e-07, ")
    assert words.endswith("merit -1.25, 17 walls")
    # A cell without a value is refused where there must be one.
    text = path.read_text(encoding="utf-8")
    for number, cell in ((3, ",0.5,"), (2, ",2.5\n")):
        path.write_text(text.replace(cell, f",{cell[-1]}"), encoding="utf-8")
        with pytest.raises(UsageError, match=f"^E148 {path}:{number}: "):
            search.read_results(path)


def test_bricks_fill_their_wall_by_every_method():
    said, ways = [], ["restarts", "restarts with wedges", "search", "without courses"]
    settings = BenchSettings(quick=True, seconds=(0.02,), seeds=1, say=said.append)
    walls, differences, masons = search.run(settings)
    assert [(r["wall"], r["method"]) for r in walls.records()] == [("bricks", way) for way in ways]
    for row in walls.records():
        assert (row["range"], row["placed"]) == ("9-9 of 9", 9)
        for name in ("F_SF", "possible F_SF", "F_LR"):
            assert row[name] == pytest.approx(1.0, abs=1e-3)
        assert row["2nd F_AV"] > row["F_AV"] > 0
        assert row["walls"] >= 1
    others = [(row["wall"], row["more than"]) for row in differences.records()]
    assert others == [("bricks", way) for way in ways if way != "search"]
    assert differences.records()[0]["placed"] == "+0 (+0 to +0)"
    assert (masons.rows, len(walls.notes)) == ((), 4)
    assert len(said) == 4
    assert said[2].startswith("bricks, search, seed 0, 0.02 s: 9 of 9 stones, F_SF 1, F_AV ")


def test_each_time_has_its_medians_and_differences_of_runs_with_its_settings(tmp_path):
    few, many = result(5, placed=7, F_AV=None), result(8, placed=9, F_AV=3.0)
    by_method = {
        ("restarts, mu = 0.5", 1.0): [result(merit=1.0, F_AH=4.0), result(merit=3.0, F_AH=4.0)],
        ("search, mu = 0.5", 1.0): [result(merit=2.0, F_AH=1.0), result(merit=3.0, F_AH=3.0)],
        ("restarts, mu = 0.5", 2.0): [few, many],
        ("search, mu = 0.5", 2.0): [result(merit=9.0)] * 2,
        ("search", 2.0): [result(merit=7.0)] * 2,  # of other settings
    }
    runs = {
        SearchRun("bricks", method, 3 + k, seconds): one
        for (method, seconds), found in by_method.items()
        for k, one in enumerate(found)
    }
    search.append_results(tmp_path / "runs.csv", runs.items())
    tables = search.run(
        BenchSettings(
            quick=True, seed=3, seeds=2, only=("bricks",), runs=tmp_path / "runs.csv",
            seconds=(2.0, 1.0, 2.0), policies=("search", "restarts"), changes=(("mu", 0.5),),
        )
    )  # fmt: skip
    titles = ("Best walls after {} s of CPU time", "What the search has more after {} s")
    assert [table.title.split(",")[0] for table in tables[:4]] == [
        title.format(seconds) for seconds in (1, 2) for title in titles
    ]
    (difference,) = tables[1].records()
    told = ("more than", "merit higher", "merit", "F_AH")
    found = ("restarts", "1 of 2", "+0.5 (+0 to +1)", "-2 (-3 to -1)")
    assert tuple(difference[name] for name in told) == found
    restarts, searched = tables[2].records()
    assert (searched["merit"], "With mu = 0.5." in tables[2].notes) == (9.0, True)
    told = ("wall", "method", "range", "placed", "F_AV", "possible F_SF", "walls")
    found = ("bricks", "restarts", "7-9 of 9", 8, 3.0, 0.75, 6.5)
    assert tuple(restarts[name] for name in told) == found


def test_a_result_holds_the_figures_by_both_definitions():
    wall = Wall(Site(40, 18), bricks(3, 2, 6, 20))
    told = {"F_SF": 0.8, "F_AV": 30.0, "F_AH": 2.0, "F_LR": 0.5, "T_LEVEL": 0.1, "E_FLUSH": 0.2}
    figures = SimpleNamespace(stones=7, **told)
    found = SimpleNamespace(figures=figures, merit=12.0, build=SimpleNamespace(wall=wall))
    looked = SimpleNamespace(found=found, walls=4, possible=0.9, seconds=20.5)
    second = second_arrangement(finer_labels(wall.labels))
    assert search.result_of(looked) == told | {
        "placed": 7, "2nd F_AV": second[0], "2nd F_AH": second[1],
        "merit": 12.0, "possible F_SF": 0.9, "walls": 4, "CPU s": 20.5,
    }  # fmt: skip
    found.figures = None
    with pytest.raises(ValueError, match="no stone"):
        search.result_of(looked)
    # A wall of outlines is looked at on its outlines; here all are on whole pixels.
    wall = exact_example().wall
    found = second_arrangement(finer_labels(wall.labels))
    without_pixels = Wall(wall.site, np.zeros((1, 1), np.uint32), (), wall.outlines)
    assert second_arrangement(finer_picture(without_pixels)) == found


@pytest.mark.parametrize("target", UNSEEN, ids=lambda target: target.name)
def test_unseen_sets_stay_the_same_and_suit_their_walls(target):
    stones = target.stones(None)
    assert target.name.endswith(f" {len(stones)}")
    assert stones.total_area_px / (target.width * target.height) == pytest.approx(0.8, rel=0.01)


def test_walls_are_chosen_by_the_beginnings_of_their_names_and_some_settings_refused():
    found = chosen((*SEARCHED, *UNSEEN), ("R", "PR 6"))
    assert [target.name for target in found] == ["R framed", "PR 600x160"]
    for name, code in (("geometry", "E138"), ("search.budget", "E138"), ("goal.wonder", "E123")):
        with pytest.raises(UsageError, match=code):
            search.run(BenchSettings(quick=True, changes=((name, 1),)))


def test_a_masons_wall_by_both_definitions():
    labels = np.kron(bricks(4, 4, 10, 24), np.ones((2, 2), np.uint32))
    name, size, stones, *figures = search.masons_row("bricks", labels, 0.5)
    assert (name, size, stones) == ("bricks", "96x40", len(np.unique(labels)))
    first = measure_labels(labels[::2, ::2])
    second = second_arrangement(finer_labels(labels[::2, ::2]))
    assert figures == [1.0, first.F_AV, first.F_AH, *second, *second]


def test_the_masons_walls_are_those_of_the_published_data(data_dir):
    rows = {row["wall"]: row for row in search.masons_walls(BenchSettings(data=data_dir)).records()}
    for name, *figures in (("R", 33.95, 0.59, 51.08, 2.05), ("PR", 29.50, 1.50, 39.73, 2.48),
                           ("IR", 23.77, 3.69, 31.66, 5.09)):  # fmt: skip
        found = [rows[name][figure] for figure in ("F_AV", "F_AH", "2nd F_AV", "2nd F_AH")]
        assert found == pytest.approx(figures, abs=0.006)
