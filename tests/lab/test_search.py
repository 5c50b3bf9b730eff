"""The comparison of methods: bricks, of which all is known, and results made by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.metrics.measure import measure_labels
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone_lab import search
from drystone_lab.search import (
    FIGURES,
    SPENT,
    SearchRun,
    append_results,
    masons_row,
    masons_walls,
    result_of,
    searched_walls,
    second_of,
)
from drystone_lab.second_arrangement import finer_labels, second_arrangement
from drystone_lab.table import BenchSettings
from drystone_lab.walls import UNSEEN, chosen
from tests.metrics.walls import bricks
from tests.verify.exact_examples import exact_example


def result(walls=1, **figures):
    return dict.fromkeys(FIGURES, 1.0) | figures | dict(zip(SPENT, (0.75, walls, 2.5), strict=True))


def test_bricks_fill_their_wall_by_every_method():
    said, ways = [], ["restarts", "restarts with wedges", "search", "without courses"]
    settings = BenchSettings(quick=True, seconds=(0.02,), seeds=1, say=said.append)
    walls, differences, masons = search.run(settings)
    found = [(row["wall"], row["method"]) for row in walls.records()]
    assert found == [("bricks", way) for way in ways]
    for row in walls.records():
        assert (row["range"], row["placed"]) == ("9-9 of 9", 9)
        for name in ("F_SF", "possible F_SF", "F_LR"):
            assert row[name] == pytest.approx(1.0, abs=1e-3)
        assert row["2nd F_AV"] > row["F_AV"] > 0
        assert row["walls"] >= 1
    others = [(row["wall"], row["more than"]) for row in differences.records()]
    assert others == [("bricks", way) for way in ways if way != "search"]
    assert differences.records()[0]["placed"] == "+0 (+0 to +0)"
    assert masons.rows == ()
    assert len(said) == 4
    assert said[2].startswith("bricks, search, seed 0, 0.02 s: 9 of 9 stones, F_SF 1, F_AV ")


def kept_tables(path, by_method, **asked):
    """Return the tables of results that are kept: of the seeds from 3 after each of the times."""
    runs = {
        SearchRun("bricks", method, 3 + k, seconds): one
        for (method, seconds), found in by_method.items()
        for k, one in enumerate(found)
    }
    append_results(path, runs.items())
    seeds = max(map(len, by_method.values()))
    usual = {"quick": True, "seed": 3, "seeds": seeds, "only": ("bricks",), "runs": path}
    return search.run(BenchSettings(**(usual | asked)))


def test_each_time_has_its_medians_and_differences(tmp_path):
    by_method = {
        ("restarts", 1.0): [result(merit=1.0, F_AH=4.0), result(merit=3.0, F_AH=4.0)],
        ("search", 1.0): [result(merit=2.0, F_AH=1.0), result(merit=3.0, F_AH=3.0)],
        ("restarts", 2.0): [result(5, placed=7, F_AV=None), result(8, placed=9, F_AV=3.0)],
        ("search", 2.0): [result(merit=9.0)] * 2,
    }
    ways = ("search", "restarts")
    tables = kept_tables(tmp_path / "runs.csv", by_method, seconds=(2.0, 1.0, 2.0), policies=ways)
    titles = ("Best walls after {} s of CPU time", "What the search has more after {} s")
    assert [table.title.split(",")[0] for table in tables[:4]] == [
        title.format(seconds) for seconds in (1, 2) for title in titles
    ]
    (difference,) = tables[1].records()
    told = ("more than", "merit higher", "merit", "F_AH")
    found = ("restarts", "1 of 2", "+0.5 (+0 to +1)", "-2 (-3 to -1)")
    assert tuple(difference[name] for name in told) == found
    restarts, _ = tables[2].records()
    told = ("wall", "method", "range", "placed", "F_AV", "possible F_SF", "walls")
    found = ("bricks", "restarts", "7-9 of 9", 8, 3.0, 0.75, 6.5)
    assert tuple(restarts[name] for name in told) == found


def test_results_with_settings_are_in_the_tables_that_say_so(tmp_path):
    by_method = {
        ("search", 1.0): [result(merit=1.0)],
        ("search, goal.F_AV = 24.0", 1.0): [result(merit=2.0)],
    }
    for changes, merit in (((("goal.F_AV", 24.0),), 2.0), ((), 1.0)):
        table, differences, _ = kept_tables(
            tmp_path / f"{merit}.csv", by_method,
            seconds=(1.0,), policies=("search",), changes=changes,
        )  # fmt: skip
        (row,) = table.records()
        assert (row["method"], row["merit"], differences.rows) == ("search", merit, ())
        assert ("With goal.F_AV = 24.0." in table.notes) == bool(changes)


def test_a_result_holds_the_figures_by_both_definitions():
    wall = Wall(Site(40, 18), bricks(3, 2, 6, 20))
    told = {"F_SF": 0.8, "F_AV": 30.0, "F_AH": 2.0, "F_LR": 0.5, "T_LEVEL": 0.1, "E_FLUSH": 0.2}
    figures = SimpleNamespace(stones=7, **told)
    found = SimpleNamespace(figures=figures, merit=12.0, build=SimpleNamespace(wall=wall))
    looked = SimpleNamespace(found=found, walls=4, possible=0.9, seconds=20.5)
    second = second_arrangement(finer_labels(wall.labels))
    assert result_of(looked) == told | {
        "placed": 7, "2nd F_AV": second.F_AV, "2nd F_AH": second.F_AH,
        "merit": 12.0, "possible F_SF": 0.9, "walls": 4, "CPU s": 20.5,
    }  # fmt: skip
    found.figures = None
    with pytest.raises(ValueError, match="no stone"):
        result_of(looked)
    # A wall of outlines is looked at on its outlines; here all are on whole pixels.
    wall = exact_example().wall
    found = second_of(wall)
    assert found == second_arrangement(finer_labels(wall.labels))
    assert found == second_of(Wall(wall.site, np.zeros((1, 1), np.uint32), (), wall.outlines))


@pytest.mark.parametrize(
    ("name", "code"), [("geometry", "E138"), ("search.budget", "E138"), ("goal.wonder", "E123")]
)
def test_settings_that_no_search_can_go_by_are_refused(name, code):
    with pytest.raises(UsageError, match=code):
        search.run(BenchSettings(quick=True, changes=((name, 1),)))


@pytest.mark.parametrize("target", UNSEEN, ids=lambda target: target.name)
def test_unseen_sets_stay_the_same_and_suit_their_walls(target):
    stones = target.stones(None)
    assert target.name.endswith(f" {len(stones)}")
    assert stones.total_area_px / (target.width * target.height) == pytest.approx(0.8, rel=0.01)


def test_walls_are_chosen_by_the_beginnings_of_their_names():
    found = searched_walls(BenchSettings(only=("R", "PR 6")))
    assert [target.name for target in found] == ["R framed", "PR 600x160"]
    with pytest.raises(UsageError, match="E138"):
        chosen(UNSEEN, ("rubble", "Q"))


def test_a_masons_wall_by_both_definitions():
    labels = np.kron(bricks(4, 4, 10, 24), np.ones((2, 2), np.uint32))
    name, size, stones, *figures = masons_row("bricks", labels, 0.5)
    assert (name, size, stones) == ("bricks", "96x40", len(np.unique(labels)))
    first = measure_labels(labels[::2, ::2])
    second = second_arrangement(finer_labels(labels[::2, ::2]))
    assert figures == [1.0, first.F_AV, first.F_AH, *[second.F_AV, second.F_AH] * 2]


def test_the_masons_walls_are_those_of_the_published_data(data_dir):
    rows = {row["wall"]: row for row in masons_walls(BenchSettings(data=data_dir)).records()}
    for name, figures in {"R": (33.95, 0.59), "PR": (29.50, 1.50), "IR": (23.77, 3.69)}.items():
        assert (rows[name]["F_AV"], rows[name]["F_AH"]) == pytest.approx(figures, abs=0.006)
