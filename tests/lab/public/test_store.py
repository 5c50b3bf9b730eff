"""Results by version in a table."""

import csv
from dataclasses import astuple, replace

import pytest

from drystone.errors import InputError, UsageError
from drystone.io.folder_lock import locked
from drystone_lab.public.history import drawn_history, history_table, medians_of
from drystone_lab.public.store import COLUMNS, KeptRun, keep, kept_runs

RUN = KeptRun(
    run_key="a", suite="bricks", suite_version=1, wall="bricks 2:1", method="paper", settings="{}",
    seed=0, version="0.9.0", placed=30, stones=40, F_SF=0.8, F_AV=7.0, F_AH=1.3, F_LR=None,
    T_LEVEL=0.0, E_FLUSH=0.0, wedge_area=0.0, seconds=0.5, pga_g=None, shaken="no",
    made_at="2026-01-01T00:00:00+00:00", platform="Linux x86_64",
)  # fmt: skip


def test_runs_come_back_as_they_were_in_order(tmp_path):
    store = tmp_path / "new"
    assert kept_runs(store) == ()
    later = replace(RUN, run_key="b", version="0.10.0", F_LR=0.1 + 0.2, pga_g=0.25, shaken="yes")
    keep(store, [RUN, later])
    assert kept_runs(store) == (later, RUN)
    keep(store, [replace(RUN, seconds=9.0)])
    assert [run.seconds for run in kept_runs(store)] == [0.5, 9.0]
    with (store / "runs.csv").open(newline="") as file:
        columns, first, second = csv.reader(file)
    assert tuple(columns) == COLUMNS
    assert first == [str(value) for value in astuple(later)]
    assert second[COLUMNS.index("F_LR")] == ""


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (lambda text: text.replace("run_key,", "key,"), 1),
        (lambda text: text.replace(",0.8,", ",much,"), 2),
        (lambda text: text.replace(",0.5,", ",,"), 2),
        (lambda text: text[:-40], 2),
    ],
)
def test_other_files_are_not_taken_for_tables(tmp_path, change, line):
    keep(tmp_path, [RUN])
    path = tmp_path / "runs.csv"
    path.write_text(change(path.read_text()))
    for read in (kept_runs, lambda folder: keep(folder, [RUN])):
        with pytest.raises(InputError, match=f"^E401 {path}:{line}: "):
            read(tmp_path)


def test_a_table_that_another_run_writes_to(tmp_path):
    keep(tmp_path, [RUN])
    with locked(tmp_path), pytest.raises(UsageError, match="E149"):
        keep(tmp_path, [replace(RUN, run_key="b")])
    assert kept_runs(tmp_path) == (RUN,)


HISTORY = [
    replace(RUN, run_key=f"{version}{seed}", version=version, seed=seed, F_SF=start + 0.1 * seed)
    for version, start in (("0.10.0", 0.6), ("0.9.0", 0.5), ("0.10.0rc1", 0.4))
    for seed in range(3)
]


def test_medians_by_version_oldest_first():
    rows = history_table(medians_of(HISTORY)).records()
    assert [row["version"] for row in rows] == ["0.9.0", "0.10.0rc1", "0.10.0"]
    assert [row["F_SF"] for row in rows] == pytest.approx([0.6, 0.5, 0.7])
    assert [rows[0][name] for name in ("placed share", "F_LR", "runs")] == [0.75, None, 3]


def test_versions_with_other_runs_are_not_compared_and_settings_make_another_method():
    assert len(history_table(medians_of(HISTORY)).notes) == 1
    (_, warning) = history_table(medians_of(HISTORY[1:])).notes
    assert "bricks/1 paper" in warning
    other = replace(RUN, run_key="c", settings='{"sampling": "full"}')
    methods = [one.method for one in medians_of([RUN, other])]
    assert methods == ["paper", 'paper {"sampling": "full"}']


def test_a_picture_has_a_panel_for_each_figure_that_is_there():
    axes = drawn_history(medians_of(HISTORY)).axes
    labels = ["placed share", "F_SF", "F_AV", "F_AH", "wall, s"]
    assert [ax.get_ylabel() for ax in axes] == labels
    assert axes[1].lines[0].get_ydata().tolist() == pytest.approx([0.6, 0.5, 0.7])
    assert axes[1].get_xticklabels()[0].get_text() == "0.9.0"
