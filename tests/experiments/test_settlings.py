"""The suite of settlings; no time is asserted, only what is counted."""

import pytest

from drystone.experiments import settlings
from drystone.experiments.exact_walls import QUICK
from drystone.experiments.table import BenchSettings

SETTINGS = BenchSettings(quick=True)


@pytest.fixture(scope="module")
def tables():
    return settlings.run(SETTINGS)


@pytest.fixture(scope="module")
def attempts():
    (target,) = QUICK
    return settlings._attempts(target, target.stones(SETTINGS))


def test_every_settling_ends_in_one_way(tables, attempts):
    (row,) = tables[0].records()
    assert (row["wall"], row["settlings"]) == ("bricks", len(attempts))
    assert sum(row[f"{end} %"] for end in ("rest", "fall", "too far", "other")) == pytest.approx(
        100
    )
    assert row["rest %"] >= 50
    assert 0 < row["median"] <= row["95 %"] <= row["99 %"] <= row["longest"]
    assert row["steps"] >= 1


def test_parts_are_in_the_time_of_the_whole(tables):
    (row,) = tables[1].records()
    assert (row["wall"], row["stones"]) == ("bricks", 9)
    assert row["poses tried"] > 9
    parts = ("placement", "stabilisation", "contacts", "limit analysis", "indices")
    assert all(row[part] > 0 for part in parts)
    assert sum(row[part] for part in parts) <= row["1 thread"]


def test_a_machine_with_one_core_has_all_columns(monkeypatch):
    for cores in (1, None):
        monkeypatch.setattr(settlings.os, "cpu_count", lambda cores=cores: cores)
        whole = settlings.run(SETTINGS)
        assert all(len(row) == len(table.columns) for table in whole for row in table.rows)
        assert whole[1].records()[0]["1 threads"] > 0


def test_what_is_let_go_is_in_the_scene(attempts):
    assert len({len(one.scene.polygons) for one in attempts}) == 3  # every third step of nine
    for one in attempts[::7]:
        x, y = one.start
        assert 0 <= x <= 108
        assert y > 0


def test_the_least_of_several_times_counts(attempts, monkeypatch):
    clock = iter([0.0, 5.0, 10.0, 12.0, 20.0, 23.0, 30.0, 34.0, 40.0, 46.0])
    monkeypatch.setattr(settlings.time, "perf_counter", lambda: next(clock))
    assert settlings._least_ms(attempts[0]) == 2000.0
