"""`drystone bench`."""

from pathlib import Path

import pytest

from drystone_lab.commands import bench
from drystone_lab.suites import SUITES
from drystone_lab.table import Table
from tests.cli.conftest import Run


def test_suites_are_named_one_a_line(run: Run) -> None:
    lines = run("bench", "--list").out.splitlines()
    assert [line.split(":")[0] for line in lines][: len(SUITES)] == list(SUITES)


@pytest.mark.parametrize("suite", [(), ("speed",)])
def test_a_suite_that_is_none(suite: tuple[str, ...], run: Run) -> None:
    ran = run("bench", *suite)
    assert ran.code == 2
    assert "E138" in ran.err


def test_a_suite_is_printed_and_has_a_folder_for_pictures(tmp_path: Path, run: Run) -> None:
    ran = run("bench", "shear", "--quick", "-o", tmp_path / "new")
    assert ran.code == 0
    assert "predicted over measured" in ran.out
    assert (tmp_path / "new").is_dir()
    assert "E129" in run("bench", "shear", "--quick", "-o", __file__).err


def test_a_suite_without_pictures_makes_no_folder_for_them(tmp_path: Path, run: Run) -> None:
    ran = run("bench", "photos", "--quick", "-o", tmp_path / "new")
    assert ran.code == 2
    assert "E138 -o: the suite 'photos' draws no pictures." in ran.err
    assert "it is for shear" in ran.err
    assert not (tmp_path / "new").exists()


def test_walls_say_that_data_is_missing(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("drystone.io.published._cache", lambda: None)
    for options in ((), ("--data", tmp_path), ("--data", tmp_path / "none")):
        ran = run("bench", "walls", *options)
        assert ran.code == 0
        assert "Rows need the published stone sets" in ran.out


def test_planned_walls_are_solved_alike(data_dir: Path, run: Run) -> None:
    ran = run("bench", "walls", "--quick", "--data", data_dir, "--json")
    (rows,) = ran.json().values()
    assert [row["verdict"] for row in rows] == ["pass"]
    assert rows[0]["certified"] == rows[0]["answers"] == 2 * rows[0]["steps"] > 50
    assert rows[0]["largest difference"] <= 1e-8


def test_a_miss_is_a_failed_check(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    table = Table("Cases", ("case", "verdict"), (("one", "pass"), ("other", "miss")))
    monkeypatch.setattr(bench, "run_suite", lambda *_: (table,))
    assert run("bench", "statics").code == 5
    assert run("bench", "statics", "--markdown").out.startswith("**Cases**")


def test_searches_are_kept_and_not_done_again(run: Run, tmp_path: Path) -> None:
    table = tmp_path / "runs.csv"
    options = (
        "bench", "search", "--quick", "--seconds", ".01", ".02", "--seeds", "1", "--only",
        "bricks", "--policy", "restarts", "--runs", table,
    )  # fmt: skip
    first, again = run(*options), run(*options)
    assert first.out.startswith("Best walls after 0.01 s of CPU time, medians of 1 seeds")
    assert (first.code, again.code) == (0, 0)
    assert first.out == again.out
    assert (len(first.err.splitlines()), again.err) == (2, "")
    table.write_text("stones", encoding="utf-8")
    assert "E148" in run(*options).err


@pytest.mark.parametrize(
    "options",
    [
        ("shear", "--seconds", "1"),
        ("engine", "--seeds", "2"),
        ("statics", "--only", "R"),
        ("packing", "--seeds", "2"),
        ("packing", "--runs", "runs.csv"),
        ("bricks", "--runs", "runs.csv"),
        ("shear", "--jobs", "2"),
        ("search", "--policy", "annealing"),
        ("search", "--only", "Q"),
        ("search", "--seconds", "0"),
    ],
)
def test_options_that_a_suite_does_not_go_by(options: tuple[str, ...], run: Run) -> None:
    ran = run("bench", *options)
    assert ran.code == 2
    assert "E138" in ran.err
    assert options[1] in ran.err
