"""`drystone plan`: what it writes, prints and returns."""

import json
import re

import numpy as np
import pytest
import tifffile
from PIL import Image

from drystone.io.plan_json import read_plan
from drystone.io.wall_image import write_labels
from drystone.planner.profile import PARTS
from tests.cli.conftest import WALL

FILES = {
    "plan.json", "settings.toml", "wall.png", "picture.png", "mechanism_left.png",
    "mechanism_right.png", "report.html", "build.gif",
}  # fmt: skip


def test_all_files_are_written(finished):
    assert {path.name for path in finished.iterdir()} == FILES
    for name in ("picture.png", "mechanism_left.png", "mechanism_right.png"):
        with Image.open(finished / name) as picture:
            assert min(picture.size) > 100
    assert (finished / "report.html").read_text(encoding="utf-8").startswith("<!")
    plan = json.loads((finished / "plan.json").read_text(encoding="utf-8"))
    assert plan["units"] == {"length": "px", "px_per_m": None, "working_scale": 1.0}
    assert plan["wall"] == {"width": 70.0, "height": 30.0}
    assert (plan["method"], plan["seed"], plan["source"]["path"]) == ("paper", 1, "rubble.png")
    stones = [step["stone"] for step in plan["steps"] if step["kind"] == "stone"]
    assert sorted(stones + plan["unused"]) == list(range(1, 7))


def test_json_has_the_summary_and_where_the_time_went(rubble, tmp_path, run):
    ran = run("plan", rubble, *WALL, "-o", tmp_path / "json", "--json", "--profile")
    summary = ran.json()
    profile = summary.pop("profile")
    plan = read_plan(summary["plan"])
    assert (summary["placed"], summary["stones"]) == (len(plan.stone_steps), 6)
    assert (summary["unused"], summary["stopped"]) == (list(plan.unused), plan.stopped)
    assert summary["F_LR"] == plan.metrics.F_LR
    assert summary["seconds"] > 0
    assert (summary["status"], ran.code) in {("complete", 0), ("incomplete", 4)}
    parts = profile["parts"]
    assert list(parts) == [*PARTS, "search", "other"]
    assert all(parts[part] > 0 for part in PARTS if part != "metrics")
    # Only methods that go back look at metrics while planning.
    assert parts["metrics"] == parts["search"] == 0
    assert sum(parts.values()) == pytest.approx(profile["seconds"])
    assert profile["candidates"] >= profile["steps"] >= 5
    assert 0 < profile["longest_step"] <= profile["seconds"]
    threads = run("plan", rubble, *WALL, "--profile", "--jobs", "2", "-o", tmp_path / "table")
    for said in ("where the time went", "limit analysis", "2; parts are summed over them"):
        assert said in threads.out
    assert "search" not in threads.out


def test_a_folder_with_files_is_refused_and_not_touched(rubble, tmp_path, run):
    (tmp_path / "diary.txt").write_text("mine", encoding="utf-8")
    (tmp_path / "plan.json").write_text("also mine", encoding="utf-8")
    run("plan", rubble, *WALL, "-o", tmp_path).refused("E129", "--overwrite")
    assert (tmp_path / "plan.json").read_text(encoding="utf-8") == "also mine"
    assert {path.name for path in tmp_path.iterdir()} == {"diary.txt", "plan.json"}
    ran = run("plan", rubble, *WALL, "-o", tmp_path, "--overwrite")
    assert ran.code in (0, 4)
    assert (tmp_path / "diary.txt").read_text(encoding="utf-8") == "mine"
    assert read_plan(tmp_path / "plan.json").stone_steps
    for place in ("diary.txt", "diary.txt/below"):
        ran = run("plan", rubble, *WALL, "-o", tmp_path / place, "--overwrite")
        assert "is a file, not a folder. Choose another folder with -o" in ran.err


def test_equal_seeds_give_equal_bytes_and_others_do_not(finished, rubble, tmp_path, run):
    def files(name, *options):
        assert run("plan", rubble, *WALL, "-o", tmp_path / name, *options).code in (0, 4)
        return tuple((tmp_path / name / f).read_bytes() for f in ("plan.json", "wall.png"))

    first = tuple((finished / f).read_bytes() for f in ("plan.json", "wall.png"))
    assert files("again", "--seed", 1, "--jobs", 2) == first
    assert files("other", "--seed", 2)[1] != first[1]


def test_stones_too_large(rubble, tmp_path, run):
    small = ("--wall", "60x15", "--scale", "1", "--method", "paper", "-o", tmp_path / "out")
    run("plan", rubble, *small).refused("E120", "--skip-too-large")
    ran = run("plan", rubble, *small, "--skip-too-large", "--json")
    assert ran.code in (0, 4)
    plan = read_plan(tmp_path / "out")
    said = run("plan", rubble, *small, "--overwrite").err.splitlines()[-1]
    named = said.split("stones ")[1].split(" fit", maxsplit=1)[0].split(", ")
    assert set() < {int(text) for text in named} <= set(plan.unused)
    assert ran.json()["unused"] == list(plan.unused)
    assert run("check", tmp_path / "out", "--stones", rubble).code == 0


def test_ids_above_16_bits_survive(tmp_path, run):
    labels = np.zeros((40, 70), np.uint32)
    for place, stone_id in enumerate((3, 300, 70_000)):
        labels[5 + 10 * place : 13 + 10 * place, 5 : 45 + 5 * place] = stone_id
    write_labels(labels, tmp_path / "stones.tif")
    out = tmp_path / "out"
    asked = ("--wall", "70x40", "--scale", "1", "--method", "paper", "-o", out)
    assert run("plan", tmp_path / "stones.tif", *asked).code in (0, 4)
    assert not (out / "wall.png").exists()
    wall = tifffile.imread(out / "wall.tif")
    assert wall.dtype == np.uint32
    plan = read_plan(out)
    assert {step.stone for step in plan.stone_steps} == {3, 300, 70_000}
    wedges = {step.id for step in plan.wedge_steps}
    assert set(np.unique(wall).tolist()) - {0} == {3, 300, 70_000} | wedges
    assert run("check", out, "--stones", tmp_path / "stones.tif").code == 0
    # A later plan of smaller ids into the same folder leaves no wall of the earlier one.
    labels[labels == 70_000] = 7
    write_labels(labels, tmp_path / "small.png")
    run("plan", tmp_path / "small.png", *asked, "--overwrite")
    assert (out / "wall.png").exists()
    assert not (out / "wall.tif").exists()


def test_a_wall_is_complete_or_not(bricks, tmp_path, run):
    asked = ("plan", bricks, "--method", "paper", "--json", "-o", tmp_path, "--overwrite")
    filled = run(*asked, "--wall", "60x20")
    assert (filled.code, filled.json()["F_SF"], filled.json()["unused"]) == (0, 1.0, [])
    # A scale is chosen: the stones are smaller than the planner likes.
    assert filled.json()["working_scale"] == read_plan(tmp_path).working_scale == 1.0
    ran = run(*asked, "--wall", "300x80")
    summary = ran.json()
    assert (ran.code, summary["status"], summary["placed"]) == (4, "incomplete", 6)
    assert re.match(r"the top is at 0\.\d{3} of the wall's height", summary["shortfall"])
    assert run("check", tmp_path, "--stones", bricks).code == 0
