"""`drystone bench` for public suites."""

import json

import pytest

from drystone_lab.suites import SUITES
from tests.lab.runs.bricks import picture

BRICKS = ("bench", "--suite", "bricks", "--quick", "--seeds", "1", "--policy", "paper", "random")


def test_suites_and_policies_are_named_once(run):
    lines = run("bench", "--list").out.splitlines()
    names = [name for line in lines for name in line.split(":")[0].split(", ")]
    assert names[: len(SUITES)] == list(SUITES)
    assert {"masons", "fourier", "all"} <= set(names)
    assert {"paper", "random", "lowest", "scalarised", "filter", "towers", "best"} <= set(names)
    assert len(set(names)) == len(names)


def test_both_spellings_are_the_same(run):
    ran = run(*BRICKS, "--json")
    assert (ran.code, "2 of 2 walls" in ran.err) == (0, True)
    named, positional = (
        {title: rows for title, rows in tables.items() if not title.startswith("Seconds")}
        for tables in (ran.json(), run("bench", "bricks", *BRICKS[3:], "--json").json())
    )
    assert any(title.startswith("Ranking") for title in named)
    assert named == positional
    walls = named["Walls: mean over seeds, standard deviation (±), best"]
    assert walls[0]["placed share"] == 1.0


def test_settings_hold_for_all(run, tmp_path):
    settings = tmp_path / "full.toml"
    settings.write_text('sampling = "full"\n', encoding="utf-8")
    ran = run(*BRICKS, "--settings", settings, "--store", tmp_path / "store")
    assert ran.code == 0
    plans = [json.loads(path.read_text()) for path in (tmp_path / "store" / "runs").iterdir()]
    assert {plan["plan"]["settings"]["sampling"] for plan in plans} == {"full"}
    settings.write_text("ban = [1]\n", encoding="utf-8")
    assert "E138" in run(*BRICKS, "--settings", settings).err


def test_a_store_has_a_history(run, tmp_path):
    store = tmp_path / "store"
    assert "E138" in run("bench", "--history").err
    assert "no runs" in run("bench", "--history", "--store", store).err
    assert run(*BRICKS, "--store", store).code == 0
    assert {path.name for path in store.iterdir()} >= {"runs.csv", "runs"}
    ran = run("bench", "--history", "--store", store, "--json", "-o", tmp_path / "pictures")
    (rows,) = ran.json().values()
    found = [(row["suite"], row["method"], row["runs"]) for row in rows]
    assert found == [("bricks/1", "paper", 1), ("bricks/1", "random", 1)]
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
