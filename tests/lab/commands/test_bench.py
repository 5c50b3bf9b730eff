import json

import pytest

from drystone_lab import shear
from drystone_lab.commands.bench import GOES_BY, HISTORY, PUBLIC, SUITES
from drystone_lab.table import Table
from tests.lab.runs.bricks import picture


def test_a_suite_is_printed_makes_its_folder_and_fails_for_a_miss(tmp_path, run, monkeypatch):
    monkeypatch.setattr(shear, "predict", lambda *_: shear.ShearForces(20.0, 10.0))
    ran = run("bench", "shear", "--quick", "-o", tmp_path / "new")
    assert ran.code == 0
    assert "predicted over measured" in ran.out
    assert (tmp_path / "new").is_dir()
    assert "E129" in run("bench", "shear", "--quick", "-o", __file__).err
    table = Table("Cases", ("case", "verdict"), (("one", "pass"), ("other", "miss")))
    monkeypatch.setattr(shear, "run", lambda _: (table,))
    assert run("bench", "shear").code == 5
    assert run("bench", "shear", "--markdown").out.startswith("**Cases**")


def test_walls_say_that_data_is_missing(tmp_path, run, monkeypatch):
    monkeypatch.setattr("drystone.io.published._cache", lambda: None)
    for options in ((), ("--data", tmp_path), ("--data", tmp_path / "none")):
        ran = run("bench", "walls", *options)
        assert ran.code == 0
        assert "Rows need the published stone sets" in ran.out


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
        (("search", "--quick", "--only", "Q"), "--only"),
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


def test_suites_and_policies_are_named_once(run):
    lines = run("bench", "--list").out.splitlines()
    names = [name for line in lines for name in line.split(":")[0].split(", ")]
    assert names[: len(SUITES)] == list(SUITES)
    assert {"masons", "fourier", "all"} <= set(names)
    assert {"paper", "random", "lowest", "scalarised", "filter", "towers", "best"} <= set(names)
    assert len(set(names)) == len(names)


def test_both_spellings_are_the_same_settings_hold_for_all_and_a_store_has_a_history(run, tmp_path):
    store, settings = tmp_path / "store", tmp_path / "full.toml"
    settings.write_text('sampling = "full"\n', encoding="utf-8")
    assert "E138" in run("bench", "--history").err
    assert "no runs" in run("bench", "--history", "--store", store).err
    options = (
        "--quick", "--seeds", "1", "--policy", "paper", "random", "--settings", settings,
        "--store", store, "--json",
    )  # fmt: skip
    named = run("bench", "--suite", "bricks", *options)
    positional = run("bench", "bricks", *options)
    assert (named.code, "2 of 2 walls" in named.err) == (0, True)
    assert named.json() == positional.json()
    assert any(title.startswith("Ranking") for title in named.json())
    plans = [json.loads(path.read_text())["plan"] for path in (store / "runs").iterdir()]
    assert [plan["settings"]["sampling"] for plan in plans] == ["full", "full"]
    ran = run("bench", "--history", "--store", store, "--json", "-o", tmp_path / "pictures")
    (rows,) = ran.json().values()
    found = [(row["suite"], row["method"], row["runs"]) for row in rows]
    full = ' {"sampling": "full"}'
    assert found == [("bricks/1", f"paper{full}", 1), ("bricks/1", f"random{full}", 1)]
    drawn = tmp_path / "pictures" / "history-bricks-1.png"
    assert drawn.read_bytes().startswith(b"\x89PNG")
    assert "no runs of 'masons'" in run("bench", "masons", "--history", "--store", store).err


@pytest.mark.parametrize("suite", ["masons", "walls"])
def test_other_stones_in_the_place_of_the_masons(suite, run, tmp_path):
    other, store = picture(tmp_path / "data" / "almeida" / "PR.png"), tmp_path / "store"
    kept = ("--store", store) if suite == "masons" else ()
    ran = run("bench", suite, "--quick", "--data", tmp_path / "data", *kept)
    ran.refused(f"E160 {other}", "drystone fetch almeida", exit_code=3)
    assert not [path for path in store.rglob("*") if path.is_file()]
