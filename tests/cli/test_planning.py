"""`drystone plan`: what it reads, writes, prints and returns."""

import re
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock

import numpy as np
import pytest
import tifffile
from PIL import Image
from rich.progress import Progress

from drystone.cli import planning, progress
from drystone.cli.planning import read_line
from drystone.drawing.words.planned import ending, profile_rows
from drystone.io.checkpoint import CHECKPOINT
from drystone.io.plan_json import read_plan
from drystone.io.wall_image import write_labels
from drystone.model.plan import PlanMetrics
from drystone.model.stone import Stone, StoneSet
from drystone.planner.events import Incumbent
from drystone.planner.profile import PARTS
from tests.cli.conftest import EXACT, SIZE, UNTRIED, WALL, keys, listed


def test_sizes_are_metres_centimetres_or_px():
    sizes = ((62, 24), (20, 30), (44, 30))
    three = StoneSet(tuple(Stone(i, np.ones(size[::-1], bool)) for i, size in enumerate(sizes, 1)))
    # Medians of the longer and of the shorter sides: 44 and 24 px.
    said = "Read 3 stones (largest 62 x 24 px, median 44 x 24 px), wall 280 x 80.5 px"
    assert read_line(three, (280.0, 80.5), None, None) == said
    assert "largest 3.10 x 1.20 m" in read_line(three, (280.0, 80.0), 20.0, None)
    assert read_line(StoneSet(()), (280.0, 80.0), None, None) == "Read 0 stones, wall 280 x 80 px"


def test_a_plan_begins_and_ends_with_what_is_read_and_written(rubble, tmp_path, run):
    """On stderr; stdout is a table."""
    out = tmp_path / "out"
    scaled = ("plan", rubble, "--px-per-m", 5000, *WALL[2:], "--wall", SIZE, "-o", out)
    ran = run(*scaled)
    first, odd, *_, last = ran.err.splitlines()
    assert first.startswith("drystone: Read 6 stones (largest ")
    assert "W123" in odd
    written = last.removeprefix(f"drystone: wrote to {out}: ").split()
    assert set(written) == {path.name for path in out.iterdir()} == FILES
    title, *rows = ran.out.splitlines()
    assert title.startswith(("complete: ", "incomplete: "))
    names = {row.split()[0] for row in rows}
    assert {"stones", "F_SF", "F_AV", "F_AH", "F_LR", "T_LEVEL", "E_FLUSH"} <= names
    assert rows[-1].split()[-1] == str(out / "report.html")
    assert (out / "report.html").read_text(encoding="utf-8").startswith("<!")
    for name in ("picture.png", "mechanism_left.png", "mechanism_right.png"):
        with Image.open(out / name) as picture:
            assert min(picture.size) > 100
    with Image.open(out / "build.gif") as film:
        assert film.n_frames == len(read_plan(out).steps) + 1
    quiet = run(*scaled, "--overwrite", "--json")
    assert [line.split()[1] for line in quiet.err.splitlines()] == ["W123"]


def test_a_long_film_is_left_to_export(tmp_path, monkeypatch):
    result = SimpleNamespace(plan=SimpleNamespace(stone_steps=[None] * 3))
    monkeypatch.setattr(planning, "FILM_STONES", 2)
    (tmp_path / "build.gif").touch()
    planning.write_film(result, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_search_goes_on_from_a_plan_without_what_is_banned(settled, rubble, tmp_path, run):
    out = tmp_path / "out"

    def planned(*options):
        ran = run("plan", rubble, *EXACT, *UNTRIED, *options, "-o", out, "--overwrite")
        assert ran.code in (0, 4)
        return read_plan(out), ran.err

    whole, begun = read_plan(settled), ("--from", settled)
    # The plan is the same when nothing is added; another seed would give another wall.
    assert planned("--seed", 5)[0].steps != whole.steps
    assert planned("--seed", 5, *begun)[0].steps == whole.steps
    on, _ = planned("--from", out, "--budget", 3)
    assert on.metrics.F_SF >= whole.metrics.F_SF - 0.02
    first = whole.steps[0].stone
    other, said = planned(*begun, "--ban", first)
    assert f"W121 stones {first}" in said
    assert first not in {step.stone for step in other.stone_steps}
    assert first in other.unused
    assert run("check", out, "--stones", rubble).code == 0


def test_what_is_left_over_is_said_as_it_is():
    why = "no stone that is left can be placed"
    for placed, unused, said in (
        (0, (1, 2, 9), "0 of 3 stones placed; none found a place to rest"),
        (
            1,
            (2, 3, 9),
            "1 of 4 stones placed; stones 2 and 3 found no place to rest",
        ),  # 9 is banned
        (1, (2, 3, 4, 9), "1 of 5 stones placed; 3 others found no place to rest"),
    ):
        plan = SimpleNamespace(stone_steps=range(placed), unused=unused, settings={"ban": [9]})
        result = SimpleNamespace(plan=plan, status="complete", message=why, shortfall="")
        assert ending(result) == f"complete: {said}"


FILES = {
    "plan.json", "settings.toml", "wall.png", "picture.png", "mechanism_left.png",
    "mechanism_right.png", "report.html", "build.gif",
}  # fmt: skip


def test_json_has_the_summary_and_where_the_time_went(rubble, tmp_path, run):
    ran = run("plan", rubble, *WALL, "-o", tmp_path / "json", "--json", "--profile")
    summary = ran.json()
    profile, plan = summary.pop("profile"), read_plan(summary["plan"])
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
    out = run("plan", rubble, *WALL, "--profile", "--jobs", "2", "-o", tmp_path / "table").out
    bound = f"(the maximum for these stones is {summary['F_SF_bound']:.3f})"
    for said in ("where the time went", "limit analysis", "2; parts are summed over them", bound):
        assert said in out
    assert summary["F_SF"] <= summary["F_SF_bound"]
    assert "search" not in out


def test_a_folder_with_files_is_refused_and_not_touched(finished, rubble, tmp_path, run):
    diary, plan, asked = tmp_path / "diary.txt", tmp_path / "plan.json", ("plan", rubble, *WALL)
    diary.write_text("mine", encoding="utf-8")
    run(*asked, "-o", tmp_path).refused("E129", "not empty. Choose another")
    for name in (CHECKPOINT, "plan.json"):
        (tmp_path / CHECKPOINT).unlink(missing_ok=True)
        (tmp_path / name).write_text("also mine", encoding="utf-8")
        run(*asked, "-o", tmp_path).refused("E129", "not empty. Add --resume to go on")
        run("demo", "-o", tmp_path).refused("E129", "not empty. Choose another")  # it cannot
    assert plan.read_text(encoding="utf-8") == "also mine"
    assert set(tmp_path.iterdir()) == {diary, plan}
    # Another seed gives another wall.
    assert run(*asked, "-o", tmp_path, "--overwrite", "--seed", 2).code in (0, 4)
    assert diary.read_text(encoding="utf-8") == "mine"
    assert (tmp_path / "wall.png").read_bytes() != (finished / "wall.png").read_bytes()
    for place in (diary, diary / "below"):
        ran = run(*asked, "-o", place, "--overwrite")
        assert "is a file, not a folder. Choose another folder with -o" in ran.err


def test_stones_too_large(rubble, tmp_path, run):
    out = tmp_path / "out"
    small = ("--wall", "60x15", "--scale", "1", "--method", "paper", "-o", out, "--overwrite")
    ran = run("plan", rubble, *small, "--skip-too-large", "--json")
    assert ran.code in (0, 4)
    plan = read_plan(out)
    said = run("plan", rubble, *small).err.splitlines()[-1]
    named = said.split("stones ")[1].split(" fit", maxsplit=1)[0].split(", ")
    assert set() < {int(text) for text in named} <= set(plan.unused)
    assert ran.json()["unused"] == list(plan.unused)
    assert run("check", out, "--stones", rubble).code == 0
    # One that is pinned is missed.
    lower = ("--wall", "60x20", *small[2:], "--skip-too-large", "--pin", *range(1, 7))
    ran = run("plan", rubble, *lower)
    assert (ran.code, "W120 pinned stones found no place" in ran.err) == (4, True)
    assert "(1 is a full wall)" in ran.out
    first = ran.out.splitlines()[0]
    assert first.startswith("incomplete: ")
    assert first.endswith("; stones that are pinned are missing")


def test_ids_above_16_bits_survive(tmp_path, run):
    labels, out, ids = np.zeros((40, 70), np.uint32), tmp_path / "out", {3, 300, 70_000}
    for place, stone_id in enumerate(sorted(ids)):
        labels[5 + 10 * place : 13 + 10 * place, 5 : 45 + 5 * place] = stone_id
    large, small = tmp_path / "stones.tif", tmp_path / "small.png"
    write_labels(labels, large)
    asked = ("--wall", "70x40", "--scale", "1", "--method", "paper", "-o", out)
    assert run("plan", large, *asked).code in (0, 4)
    assert not (out / "wall.png").exists()
    wall, plan = tifffile.imread(out / "wall.tif"), read_plan(out)
    assert wall.dtype == np.uint32
    assert {step.stone for step in plan.stone_steps} == ids
    wedges = {step.id for step in plan.wedge_steps}
    assert set(np.unique(wall).tolist()) - {0} == ids | wedges
    assert run("check", out, "--stones", large).code == 0
    # A later plan of smaller ids into the same folder leaves no wall of the earlier one.
    write_labels(np.where(labels == 70_000, 7, labels), small)
    run("plan", small, *asked, "--overwrite")
    assert [(out / name).exists() for name in ("wall.png", "wall.tif")] == [True, False]


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


def test_walls_to_choose_from(rubble, tmp_path, run):
    out = tmp_path / "out"
    choice = out / "pareto"
    search = ("plan", rubble, *EXACT[:-1], "3", "--seed", "1", *UNTRIED)
    ran = run(*search, "--pareto", "--json", "--profile", "--jobs", 2, "-o", out)
    assert ran.code in (0, 4)
    summary = ran.json()
    # The search is a row without microseconds a candidate, and its workers are processes.
    parts, lines = summary["profile"]["parts"], dict(profile_rows(summary["profile"]))
    assert sum(parts.values()) == pytest.approx(summary["profile"]["seconds"])
    assert parts["search"] > 0 <= parts["other"]
    assert lines["search"].endswith("%")
    assert lines["processes"] == "2; the search is by the clock"
    assert "threads" not in lines
    for row in ("steps", "candidates"):
        assert lines[row].endswith("(without those of the search)")
    walls, metrics = summary["pareto"], set(PlanMetrics.__dataclass_fields__)
    found = keys(summary, "profile").union(*walls)
    assert found - metrics == listed("plan") - metrics  # "the metrics" on the page
    assert metrics - found == {"alpha_left_coulomb", "alpha_right_coulomb"}
    assert len(walls) > 1
    names = [f"{k:02}" for k in range(1, len(walls) + 1)]
    assert [one["plan"] for one in walls] == [str(choice / k / "plan.json") for k in names]
    assert (choice / "01" / "plan.json").read_bytes() == (out / "plan.json").read_bytes()
    for one in walls:
        plan = read_plan(Path(one["plan"]))
        assert one["placed"] == len(plan.stone_steps)
        for name in ("F_SF", "F_AV", "F_AH", "F_LR"):
            assert one[name] == getattr(plan.metrics, name)
        assert run("check", one["plan"], "--stones", rubble).code == 0
    assert (out / "pareto.png").read_bytes().startswith(b"\x89PNG")

    # Fewer walls than before leave none of an earlier search.
    mine = choice / "02" / "mine.txt"
    mine.write_text("kept")
    few = run("plan", rubble, *EXACT, *UNTRIED, "--pareto", "--overwrite", "-o", out)
    header, row = few.out.splitlines()[-2:]
    assert header.split() == ["F_SF", "F_AV", "F_AH", "F_LR", "stones"]
    metrics = read_plan(out).metrics
    assert row.split()[:3] == ["pareto/01", f"{metrics.F_SF:.3f}", f"{metrics.F_AV:.1f}"]
    assert (choice / "01" / "plan.json").exists()
    assert list(mine.parent.iterdir()) == [mine]
    # Walls to choose from do not outlive their search.
    assert run("plan", rubble, *WALL, "--overwrite", "-o", out).code in (0, 4)
    assert not (out / "pareto.png").exists()
    assert [path for path in choice.rglob("*") if path.is_file()] == [mine]


def test_the_bar_tells_of_walls_and_then_of_repairs():
    bar, best = Progress(), {"F_SF": 0.9, "F_LR": 0.5, "F_AV": 1.0, "F_AH": 1.0}
    shown = progress._StepBar(bar, 5, 32, timed=False)
    for turn, made in ((0, "32 walls"), (3, "repairs 3")):
        shown.on_walls(Incumbent(32, 5, 1.0, **best, repairs=turn))
        assert bar.tasks[-1].description == f"{made}; best: 5 stones, F_SF 0.900, F_LR 0.50"


def test_a_terminal_sees_stones_and_walls(rubble, tmp_path, run, monkeypatch):
    plan = ("plan", rubble, "--overwrite", "-o", tmp_path / "out")
    monkeypatch.setenv("FORCE_COLOR", "1")  # the terminal that pytest does not have
    ran = run(*plan, *EXACT, *UNTRIED, "--budget", 2)
    assert "filling" in ran.err
    assert "; best: " in ran.err
    assert "filling 0" not in ran.out
    for option in ("--quiet", "--json"):
        assert run(*plan, *WALL, option).err == ""


@pytest.mark.parametrize("command", ["check", "measure", "craft"])
def test_what_takes_long_says_so(command, settled, rubble, run, monkeypatch):
    """Nothing is shown of what is soon done; the bar comes when the time is up."""
    due = []  # whether the time of a timer is up at once, or never

    def timer(_, show):
        return Mock(start=show if due else Mock())

    monkeypatch.setattr(progress, "Timer", timer)
    monkeypatch.setenv("FORCE_COLOR", "1")
    asked = (command, settled, *(("--stones", rubble) if command == "check" else ()))
    assert run(*asked).err == ""
    due.append(True)
    ran = run(*asked)
    assert "the wall" in ran.err or "every step" in ran.err
    assert run(*asked, "--json").err == ""
