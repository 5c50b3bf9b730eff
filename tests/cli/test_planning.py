"""A plan says what it reads and writes, begins with --from, and tells where its time went."""

import argparse

import numpy as np
import pytest
from PIL import Image

from drystone.cli import planning
from drystone.cli.planning import read_line
from drystone.drawing.words.planned import profile_rows, profile_summary
from drystone.io.plan_json import read_plan
from drystone.model.stone import Stone, StoneSet
from drystone.search.plan_wall import plan_wall
from tests.cli.conftest import EXACT, UNTRIED, WALL
from tests.planner import scenes


def stones(*sizes):
    masks = (np.ones((height, width), bool) for width, height in sizes)
    return StoneSet(tuple(Stone(i, mask) for i, mask in enumerate(masks, 1)))


def test_sizes_are_metres_centimetres_or_px():
    three = stones((62, 24), (20, 30), (44, 30))
    said = read_line(three, (280.0, 80.0), 200.0, 10.7)
    # Medians of the longer and of the shorter sides: 44 and 24 px.
    assert said == (
        "Read 3 stones (largest 31.0 x 12.0 cm, median 22.0 x 12.0 cm), wall 1.40 x 0.40 m, "
        "estimate 11 s"
    )
    assert read_line(three, (280.0, 80.5), None, None) == (
        "Read 3 stones (largest 62 x 24 px, median 44 x 24 px), wall 280 x 80.5 px"
    )
    assert "largest 3.10 x 1.20 m" in read_line(three, (280.0, 80.0), 20.0, None)
    assert read_line(StoneSet(()), (280.0, 80.0), None, None) == "Read 0 stones, wall 280 x 80 px"


def test_a_plan_begins_and_ends_with_what_is_read_and_written(rubble, tmp_path, run):
    """On stderr; stdout is a table."""
    out = tmp_path / "out"
    scaled = ("--px-per-m", 5000, *WALL[2:], "--wall", "70x30")
    ran = run("plan", rubble, *scaled, "-o", out)
    first, odd, *_, last = ran.err.splitlines()
    assert first.startswith("drystone: Read 6 stones (largest ")
    assert "W123" in odd
    written = last.removeprefix(f"drystone: wrote to {out}: ").split()
    assert set(written) == {path.name for path in out.iterdir()}
    title, *rows = ran.out.splitlines()
    assert title.startswith(("complete: ", "incomplete: "))
    names = {row.split()[0] for row in rows}
    assert {"stones", "F_SF", "F_AV", "F_AH", "F_LR", "T_LEVEL", "E_FLUSH"} <= names
    assert rows[-1].split()[-1] == str(out / "report.html")
    with Image.open(out / "build.gif") as film:
        assert film.n_frames == len(read_plan(out).steps) + 1
    quiet = run("plan", rubble, *scaled, "-o", out, "--overwrite", "--json")
    assert [line.split()[1] for line in quiet.err.splitlines()] == ["W123"]


def test_a_long_film_is_left_to_export(tmp_path, monkeypatch):
    result = argparse.Namespace(plan=argparse.Namespace(stone_steps=[None] * 3))
    monkeypatch.setattr(planning, "FILM_STONES", 2)
    (tmp_path / "build.gif").touch()
    planning.write_film(result, tmp_path)
    assert list(tmp_path.iterdir()) == []


def stones_of(folder):
    return [step.stone for step in read_plan(folder).stone_steps]


def test_the_plan_is_the_same_when_nothing_is_added(settled, rubble, tmp_path, run):
    # Another seed would give another wall.
    other = ["plan", rubble, *EXACT, *UNTRIED, "--seed", 5]
    assert run(*other, "-o", tmp_path / "alone").code in (0, 4)
    assert run(*other, "--from", settled, "-o", tmp_path / "out").code in (0, 4)
    assert read_plan(tmp_path / "out").steps == read_plan(settled).steps
    assert read_plan(tmp_path / "alone").steps != read_plan(settled).steps


def test_a_search_goes_on_from_a_plan_and_what_is_banned_now_is_taken_out(
    settled, rubble, tmp_path, run
):
    asked = ("plan", rubble, *EXACT, *UNTRIED, "--from", settled)
    assert run(*asked, "--budget", 3, "-o", tmp_path / "on").code in (0, 4)
    assert read_plan(tmp_path / "on").metrics.F_SF >= read_plan(settled).metrics.F_SF - 0.02
    first = stones_of(settled)[0]
    ran = run(*asked, "--ban", first, "-o", tmp_path / "out")
    assert ran.code in (0, 4)
    assert f"W121 stones {first}" in ran.err
    assert first not in stones_of(tmp_path / "out")
    assert first in read_plan(tmp_path / "out").unused
    assert run("check", tmp_path / "out", "--stones", rubble).code == 0


def test_a_pinned_stone_that_is_missing_is_said(rubble, tmp_path, run):
    every = [str(i) for i in range(1, 7)]
    small = ["--wall", "60x20", "--scale", "1", "--method", "paper", "--skip-too-large"]
    ran = run("plan", rubble, *small, "--pin", *every, "-o", tmp_path / "out")
    assert (ran.code, "W120 pinned stones found no place" in ran.err) == (4, True)
    first = ran.out.splitlines()[0]
    assert first.startswith("incomplete: ")
    assert first.endswith("; stones that are pinned are missing")


@pytest.fixture(scope="module")
def searched():
    """A small wall, and three more that are searched."""
    changes = {"search": {"budget": 4}, "settle": {"trials": 0}, "goal": {"fallen": 0.0}}
    settings = scenes.greedy(changes)
    return plan_wall(scenes.rubble(1), 100, 36, settings=settings, scale=1.0)


@pytest.mark.parametrize("jobs", [1, 2])
def test_the_search_is_a_row_and_its_workers_are_processes(searched, jobs):
    summary = profile_summary(searched, jobs)
    parts = summary["parts"]
    assert sum(parts.values()) == pytest.approx(summary["seconds"])
    assert parts["search"] > 0
    assert parts["other"] >= 0
    lines = dict(profile_rows(summary))
    assert lines["search"].endswith("%")  # no microseconds a candidate
    assert lines["processes"] == f"{jobs}; the search is by the clock"
    assert "threads" not in lines
    assert lines["steps"].endswith("(without those of the search)")
    assert lines["candidates"].endswith("(without those of the search)")
