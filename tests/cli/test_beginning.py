"""--from begins a search with the wall of a plan."""

import json

from drystone.io.plan_json import read_plan
from tests.cli.conftest import EXACT, UNTRIED, WALL


def stones_of(folder):
    return [step.stone for step in read_plan(folder).stone_steps]


def test_the_plan_is_the_same_when_nothing_is_added(settled, rubble, tmp_path, run):
    # Another seed would give another wall.
    other = ["plan", rubble, *EXACT, *UNTRIED, "--seed", 5]
    assert run(*other, "-o", tmp_path / "alone").code in (0, 4)
    assert run(*other, "--from", settled, "-o", tmp_path / "out").code in (0, 4)
    assert read_plan(tmp_path / "out").steps == read_plan(settled).steps
    assert read_plan(tmp_path / "alone").steps != read_plan(settled).steps


def test_a_search_goes_on_from_a_plan(settled, rubble, tmp_path, run):
    asked = (*EXACT, *UNTRIED, "--budget", 3, "--from", settled)
    ran = run("plan", rubble, *asked, "-o", tmp_path / "out")
    assert ran.code in (0, 4)
    assert read_plan(tmp_path / "out").metrics.F_SF >= read_plan(settled).metrics.F_SF - 0.02
    assert run("check", tmp_path / "out", "--stones", rubble).code == 0


def test_what_is_banned_now_is_taken_out(settled, rubble, tmp_path, run):
    first = stones_of(settled)[0]
    asked = (*EXACT, *UNTRIED, "--from", settled, "--ban", first)
    ran = run("plan", rubble, *asked, "-o", tmp_path / "out")
    assert ran.code in (0, 4)
    assert f"W121 stones {first}" in ran.err
    assert first not in stones_of(tmp_path / "out")
    assert first in read_plan(tmp_path / "out").unused
    assert run("check", tmp_path / "out", "--stones", rubble).code == 0


def test_single_stones_are_settings(rubble, tmp_path, run):
    options = ["--ban", 2, "--ban", 5, 2, "--pin", 7, "--fixed-order"]
    assert run("plan", rubble, *WALL, *options, "-o", tmp_path / "out").code in (0, 4)
    plan = json.loads((tmp_path / "out" / "plan.json").read_text())
    assert plan["settings"]["ban"] == [2, 5]
    assert plan["settings"]["pin"] == [7]
    assert plan["settings"]["order"] == "given"
    placed = stones_of(tmp_path / "out")
    assert placed == sorted(placed)
    assert not {2, 5} & set(placed)
    assert run("check", tmp_path / "out", "--stones", rubble).code == 0


def test_a_pinned_stone_that_is_missing_is_said(rubble, tmp_path, run):
    every = [str(i) for i in range(1, 9)]
    small = ["--wall", "60x20", "--scale", "1", "--method", "paper", "--skip-too-large"]
    ran = run("plan", rubble, *small, "--pin", *every, "-o", tmp_path / "out")
    assert (ran.code, "W120 pinned stones found no place" in ran.err) == (4, True)
    first = ran.out.splitlines()[0]
    assert first.startswith("incomplete: ")
    assert first.endswith("; stones that are pinned are missing")
