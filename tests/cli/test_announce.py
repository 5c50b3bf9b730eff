"""What a plan says before it begins, and what it wrote."""

import argparse

import numpy as np
from PIL import Image

from drystone.cli import planning
from drystone.cli.planning import read_line
from drystone.io.plan_json import read_plan
from drystone.model.stone import Stone, StoneSet
from tests.cli.conftest import WALL


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
    out = tmp_path / "out"
    scaled = ("--px-per-m", 5000, *WALL[2:], "--wall", "100x36")
    ran = run("plan", rubble, *scaled, "-o", out)
    first, odd, *_, last = ran.err.splitlines()
    assert first.startswith("drystone: Read 8 stones (largest ")
    assert "W123" in odd
    written = last.removeprefix(f"drystone: wrote to {out}: ").split()
    assert set(written) == {path.name for path in out.iterdir()}
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
