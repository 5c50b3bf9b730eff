"""What commands read: outlines and drawings as pictures, and bad input refused by its code."""

import json
import os
from itertools import product

import numpy as np
import pytest
from PIL import Image

from drystone.io.plan_json import read_plan
from drystone.io.wall_image import read_wall_image
from tests.cli.conftest import WALL
from tests.io import labelled
from tests.io.test_walls import drawn

SIZES = [(90, 40), (70, 42), (84, 38), (60, 44), (96, 36), (72, 40)]
BOXES = [
    labelled.box(x, y, x + width, y + height)
    for (y, x), (width, height) in zip(product((10, 70), (10, 120, 230)), SIZES, strict=True)
]
"""The outlines of six blocks, side by side in two rows, px or mm."""

WALL_M = ("--wall", "0.25mx0.12m")


def planned(run, path, out, *options):
    """Plan a wall of the six blocks, check it, and read the plan."""
    ran = run("plan", path, *options, "--method", "paper", "--quiet", "-o", out)
    assert ran.code in (0, 4), ran.err
    assert run("check", out, "--stones", path, "--json").json()["ok"]
    return read_plan(out)


@pytest.mark.parametrize(
    "reading", [{}, {"px_per_m": 800.0, "unit": "mm", "up": "z-back"}], ids=["plain", "told"]
)
def test_a_drawing_has_a_scale_and_its_plan_holds(tmp_path, run, reading):
    path = labelled.written(tmp_path, "dxf", [("stones", ring) for ring in BOXES])
    said = run("stones", path).out
    assert "2100 px a metre" in said
    assert "W119 the longer side of the median stone is 0.078 m" in said
    options = [word for n, value in reading.items() for word in (f"--{n.replace('_', '-')}", value)]
    plan = planned(run, path, tmp_path / "out", *WALL_M, *options)
    assert (plan.length_unit, plan.px_per_m) == ("m", reading.get("px_per_m", 2100.0))
    assert plan.source.get("reading", {}) == reading
    assert run("check", tmp_path / "out", "--json").json()["ok"]


def test_classes_and_frames_are_chosen_and_kept_in_the_plan(tmp_path, run):
    frame = labelled.box(2, 2, 338, 128)
    labels = [*["granite"] * 4, *["slate"] * 2, "granite"]
    path = labelled.written(tmp_path, "labelme", zip(labels, [*BOXES, frame], strict=True))
    for options, count in (
        ((), 6),
        (("--label", "slate"), 2),
        (("--label", "slate", "Granite"), 6),
        (("--label", "granite", "--keep", 5, "--skip", 1), 1),
    ):
        assert run("stones", path, *options, "--json").json()["stones"] == count
    run("stones", path, "--label", "marble").refused("granite, slate")
    # Px of an image are not drawn again.
    options = ("--label", "granite", "--px-per-m", "1000")
    plan = planned(run, path, tmp_path / "out", *WALL_M, *options)
    assert (plan.source["reading"], plan.px_per_m) == ({"label": ["granite"]}, 1000.0)
    assert plan.source["stones"] == 4


def test_outlines_are_analysed_measured_and_looked_at_and_the_scale_is_kept(tmp_path, run):
    path = drawn("y up", tmp_path)
    told = run("analyse", path, "--json", "--associative-only").json()
    assert (told["blocks"], told["stands"]) == (3, True)
    measured = run("measure", path, "--json").json()
    assert measured["stones"] == 3
    assert measured["F_LR"] == pytest.approx(told["F_LR"], abs=0.05)
    assert "3 stones" in run("craft", path).out
    path = drawn("dxf", tmp_path)
    for options in (("--mu", "1:2"), ("--px-per-m", "3000")):
        assert "0.1 m wide, 0.05 m high" in run("analyse", path, *options).out
    assert run("measure", path, "--px-per-m", "3000").code == 0
    assert run("measure", path, "--wall", "110x60mm", "--json").json()["F_SF"] < 0.7
    run("measure", drawn("labelme", tmp_path), "--px-per-m", "3000").refused("would do nothing")


@pytest.mark.parametrize("command", ["analyse", "measure", "craft"])
def test_options_of_reading_are_those_of_stones(command, tmp_path, run):
    for form, last in (("labelme", 8), ("coco", 3)):
        path = drawn(form, tmp_path)
        less = run(command, path, "--skip", last, "--json")
        assert less.code == 0
        assert less.out != run(command, path, "--json").out
    run(command, drawn("labelme", tmp_path), "--mask").refused("E118")
    blocks = tmp_path / "blocks.json"
    blocks.write_text(json.dumps({"blocks_xywh": [[0, 0, 2, 1]]}))
    for options in (["--skip", "1"], ["--background", "255"], ["--holes", "keep"]):
        run(command, blocks, *options).refused(f"{options[0]} has no meaning")


def test_stones_are_converted_with_their_ids_and_scale_or_refused(tmp_path, run):
    path, to = drawn("dxf", tmp_path), tmp_path / "to" / "labels.tif"
    for name in ("labels.bmp", "stones.json", "labels"):
        run("stones", path, "--labels", to.with_name(name)).refused("E139")
    assert not to.parent.exists()
    first = run("stones", path, "--labels", to, "--json").json()
    again = run("stones", to, "--json").json()
    for name in ("stones", "total_area_px", "width_px", "height_px", "clusters", "px_per_m"):
        assert again[name] == first[name]
    assert "m high" in run("analyse", to, "--close-gaps", "1", "--associative-only").out
    holed = np.pad(np.ones((12, 16), np.uint8), 9)
    holed[14:18, 12:17] = 0
    Image.fromarray(holed).save(tmp_path / "holed.png")
    kept, outlines = ("--holes", "keep", "--json"), tmp_path / "holed.json"
    run("stones", tmp_path / "holed.png", "--no-mask", *kept, "--labels", outlines)
    assert run("stones", outlines, *kept).json()["total_area_px"] == 12 * 16 - 20
    masks = tmp_path / "masks"
    masks.mkdir()
    for number in (1, 2):
        mask = np.zeros((30, 40), np.uint8)
        mask[5:20, 10 * number : 10 * number + 12] = 255
        Image.fromarray(mask).save(masks / f"{number}.png")
    told = run("stones", masks, "--labels", tmp_path / "all.png")
    assert "in common went to the smaller one, from: 1 (30 px)" in told.out
    assert np.unique(read_wall_image(tmp_path / "all.png")).tolist() == [0, 1, 2]


def test_numbers_of_a_plan_that_none_can_have(plan_copy, run):
    whole = (plan_copy / "plan.json").read_text()
    for path, value, code in (
        ("wall width", 1e308, "E205"),
        ("wall width", 1e9, "E121"),
        ("steps 0 centroid", [1e308, 1e308], "E205"),
        ("settings mu", "x", "E205"),
        ("settings mu", 1e308, "E205"),
        ("settings settle", 3, "E205"),
        ("metrics F_SF", 1e308, "E205"),
        ("stopped", ["deep"], "E132"),
    ):
        at = plan = json.loads(whole)
        *within, last = path.split()
        for name in within:
            at = at[int(name) if name == "0" else name]
        at[last] = value
        text = json.dumps(plan).replace('["deep"]', "[" * 900 + "]" * 900)
        (plan_copy / "plan.json").write_text(text)
        ran = run("measure", plan_copy)
        ran.refused(f"drystone: {code} ", exit_code=2 if code == "E121" else 3)
        checked = run("check", plan_copy, "--stones", plan_copy / "rubble.png")
        assert checked.err.startswith(f"drystone: {'E203' if code == 'E132' else 'E2'}")
        assert "Warning" not in ran.err + checked.err


@pytest.mark.parametrize("command", ["measure", "segment", "check", "plan"])
def test_pipes_are_not_waited_for(command, tmp_path, run, rubble):
    pipe, out = tmp_path / "pipe.png", ("-o", tmp_path / "out")
    os.mkfifo(pipe)
    given = {"plan": (*WALL, *out), "segment": out}.get(command, ())
    run(command, pipe, *given).refused("it is a pipe, and no regular file", exit_code=3)
    if command == "plan":
        run(command, rubble, *given, "--settings", pipe).refused("E128", exit_code=3)


def test_a_byte_order_mark_is_no_fault(settled_copy, run):
    for path in settled_copy.glob("*.json"):
        path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert [run(command, settled_copy).code for command in ("check", "measure")] == [0, 0]
