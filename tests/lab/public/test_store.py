"""Results by version in an SQLite file."""

import csv
import sqlite3
from contextlib import closing
from dataclasses import replace
from importlib.util import find_spec

import pytest

from drystone.errors import PlanError, UsageError
from drystone_lab.public.history import drawn_history, history_table, medians_of
from drystone_lab.public.store import COLUMNS, BenchStore, KeptRun

RUN = KeptRun(
    run_key="a", suite="bricks", suite_version=1, wall="bricks 2:1", method="paper", settings="{}",
    seed=0, version="0.9.0", placed=30, stones=40, F_SF=0.8, F_AV=7.0, F_AH=1.3, F_LR=None,
    T_LEVEL=0.0, E_FLUSH=0.0, wedge_area=0.0, seconds=0.5, pga_g=None, shaken="no",
    made_at="2026-01-01T00:00:00+00:00", platform="Linux x86_64",
)  # fmt: skip


def test_runs_come_back_as_they_were(tmp_path):
    store = BenchStore(tmp_path / "new")
    assert store.runs() == ()
    later = replace(RUN, run_key="b", version="0.10.0", F_LR=0.5, pga_g=0.25, shaken="yes")
    store.put([later, RUN])
    assert store.runs() == (later, RUN)
    store.put([replace(RUN, seconds=9.0)])
    assert [run.seconds for run in store.runs()] == [0.5, 9.0]


def test_exports_hold_all_runs(tmp_path):
    store = BenchStore(tmp_path)
    store.put([RUN, replace(RUN, run_key="b", seed=1, F_LR=0.1)])
    written = store.export()
    with (tmp_path / "runs.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == COLUMNS
    assert [(row["seed"], row["F_LR"], row["F_SF"]) for row in rows] == [
        ("0", "", "0.8"),
        ("1", "0.1", "0.8"),
    ]
    assert len(written) == (1 if find_spec("pyarrow") is None else 2)


def test_parquet_has_types(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet", reason="extra `bench` is not installed")
    store = BenchStore(tmp_path)
    store.put([RUN])
    store.export()
    table = parquet.read_table(tmp_path / "runs.parquet")
    assert table.column_names == list(COLUMNS)
    assert str(table.schema.field("F_LR").type) == "double"
    assert table.to_pylist()[0]["F_LR"] is None
    assert table.to_pylist()[0]["stones"] == 40


def test_a_database_that_another_run_writes_to(tmp_path, monkeypatch):
    store, connect = BenchStore(tmp_path), sqlite3.connect
    store.put([RUN])
    monkeypatch.setattr(sqlite3, "connect", lambda path: connect(path, timeout=0.0))
    with closing(connect(tmp_path / "bench.sqlite")) as other:
        other.execute("BEGIN EXCLUSIVE")
        with pytest.raises(UsageError) as caught:
            store.put([RUN])
    assert caught.value.code == "E149"
    assert store.runs() == (RUN,)


def test_a_database_on_a_full_disk(tmp_path, monkeypatch):
    store, connect = BenchStore(tmp_path), sqlite3.connect
    store.put([RUN])

    def full(path):
        connection = connect(path)
        connection.execute("PRAGMA max_page_count = 1")
        return connection

    monkeypatch.setattr(sqlite3, "connect", full)
    with pytest.raises(PlanError) as caught:
        store.put([replace(RUN, run_key=str(k), wall="w" * 1000) for k in range(100)])
    assert caught.value.code == "E206"
    assert caught.value.where == str(tmp_path / "bench.sqlite")
    assert store.runs() == (RUN,)


HISTORY = [
    replace(RUN, run_key=f"{version}{seed}", version=version, seed=seed, F_SF=start + 0.1 * seed)
    for version, start in (("0.10.0", 0.6), ("0.9.0", 0.5), ("0.10.0rc1", 0.4))
    for seed in range(3)
]


def test_medians_by_version_oldest_first():
    rows = history_table(medians_of(HISTORY)).records()
    assert [row["version"] for row in rows] == ["0.9.0", "0.10.0rc1", "0.10.0"]
    assert [row["F_SF"] for row in rows] == pytest.approx([0.6, 0.5, 0.7])
    assert rows[0]["placed share"] == 0.75
    assert rows[0]["F_LR"] is None
    assert rows[0]["runs"] == 3


def test_versions_with_other_runs_are_not_compared():
    assert len(history_table(medians_of(HISTORY)).notes) == 1
    (_, warning) = history_table(medians_of(HISTORY[1:])).notes
    assert "bricks/1 paper" in warning


def test_settings_make_another_method():
    other = replace(RUN, run_key="c", settings='{"sampling": "full"}')
    methods = [one.method for one in medians_of([RUN, other])]
    assert methods == ["paper", 'paper {"sampling": "full"}']


def test_a_picture_has_a_panel_for_each_figure_that_is_there():
    figure = drawn_history(medians_of(HISTORY))
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert labels == ["placed share", "F_SF", "F_AV", "F_AH", "wall, s"]
    (line,) = figure.axes[1].lines
    assert line.get_ydata().tolist() == pytest.approx([0.6, 0.5, 0.7])
    assert figure.axes[1].get_xticklabels()[0].get_text() == "0.9.0"
