"""`drystone bench`."""

import pytest

from drystone_lab import shear
from drystone_lab.commands import bench
from drystone_lab.suites import GOES_BY, HISTORY, PUBLIC
from drystone_lab.table import Table


def test_a_suite_is_printed_and_has_a_folder_for_pictures(tmp_path, run, monkeypatch):
    monkeypatch.setattr(shear, "predict", lambda *_: shear.ShearForces(20.0, 10.0))
    ran = run("bench", "shear", "--quick", "-o", tmp_path / "new")
    assert ran.code == 0
    assert "predicted over measured" in ran.out
    assert (tmp_path / "new").is_dir()
    assert "E129" in run("bench", "shear", "--quick", "-o", __file__).err


def test_walls_say_that_data_is_missing(tmp_path, run, monkeypatch):
    monkeypatch.setattr("drystone.io.published._cache", lambda: None)
    for options in ((), ("--data", tmp_path), ("--data", tmp_path / "none")):
        ran = run("bench", "walls", *options)
        assert ran.code == 0
        assert "Rows need the published stone sets" in ran.out


def test_a_miss_is_a_failed_check(run, monkeypatch):
    table = Table("Cases", ("case", "verdict"), (("one", "pass"), ("other", "miss")))
    monkeypatch.setattr(bench, "run_suite", lambda *_: (table,))
    assert run("bench", "statics").code == 5
    assert run("bench", "statics", "--markdown").out.startswith("**Cases**")


def test_searches_are_kept_and_not_done_again(run, tmp_path):
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
    ("who", "given"),
    [("statics", ["statics"]), ("search", ["search"]), ("packing", ["packing"]),
     (PUBLIC, ["bricks"]), (HISTORY, ["--history", "--store", "x"])],
)  # fmt: skip
def test_options_that_a_suite_does_not_go_by(who, given, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    values = {
        "policy": "random", "settings": "x.toml", "dask": "tcp://localhost:1", "store": "x",
        "only": "R", "runs": "runs.csv", "output": "x", "jobs": 2, "seeds": 2, "seed": 2,
        "seconds": 1, "again": None, "shake": None, "quick": None,
    }  # fmt: skip
    assert set(values) == {name for names in GOES_BY.values() for name in names}
    for name in set(values) - set(GOES_BY[who]):
        flag = "-o" if name == "output" else f"--{name}"
        value = [] if values[name] is None else [values[name]]
        run("bench", *given, flag, *value).refused(f"E138 {flag}: ", "Leave it out")
    assert not any(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ((), "suite"),
        (("speed",), "'speed'"),
        (("search", "--policy", "annealing"), "--policy"),
        (("search", "--only", "Q"), "--only"),
        (("search", "--seconds", "0"), "--seconds"),
        (("bricks", "--again"), "--again"),
        (("bricks", "--suite", "masons"), "two suites"),
        (("bricks", "--only", "R"), "--only"),
        (("statics", "--history", "--store", "x"), "no suite 'statics'"),
        (("bricks", "--jobs", "2", "--dask", "tcp://localhost:1"), "--dask"),
    ],
)
def test_options_that_make_no_sense(options, named, run):
    run("bench", *options).refused("E138", named)
