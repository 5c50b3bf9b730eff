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
    named = ran.json()
    assert any(title.startswith("Ranking") for title in named)
    positional = run("bench", "bricks", *BRICKS[3:], "--json").json()
    seconds = next(title for title in named if title.startswith("Seconds"))
    del named[seconds], positional[seconds]
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
    assert [(row["suite"], row["method"], row["runs"]) for row in rows] == [
        ("bricks/1", "paper", 1),
        ("bricks/1", "random", 1),
    ]
    assert rows[0]["placed share"] == 1.0
    picture = tmp_path / "pictures" / "history-bricks-1.png"
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert "no runs of 'masons'" in run("bench", "masons", "--history", "--store", store).err


@pytest.mark.parametrize("suite", ["masons", "walls"])
def test_other_stones_in_the_place_of_the_masons(suite, run, tmp_path):
    data, store = tmp_path / "data", tmp_path / "store"
    picture(data / "almeida" / "PR.png")
    kept = ("--store", store) if suite == "masons" else ()
    ran = run("bench", suite, "--quick", "--data", data, *kept)
    assert ran.code == 3
    assert f"E160 {data / 'almeida' / 'PR.png'}" in ran.err
    assert "drystone fetch almeida" in ran.err
    assert ran.out == ""
    assert not [path for path in store.rglob("*") if path.is_file()]
