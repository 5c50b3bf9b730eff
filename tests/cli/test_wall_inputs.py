"""Every command reads what `stones` reads, and `stones --to` converts it."""

import json

import numpy as np
import pytest
from PIL import Image

from drystone.io.wall_image import read_wall_image
from tests.io.test_walls import drawn

QUICK = ["--method", "paper", "--quiet"]


@pytest.mark.parametrize("form", ["coco", "y up"])
def test_outlines_in_every_command(form, tmp_path, run):
    path = drawn(form, tmp_path)
    told = run("analyse", path, "--json", "--associative-only").json()
    assert (told["blocks"], told["stands"]) == (3, True)
    measured = run("measure", path, "--json")
    assert measured.json()["stones"] == 3
    assert measured.json()["F_LR"] == pytest.approx(told["F_LR"], abs=0.05)
    assert "3 stones" in run("craft", path).out
    out = tmp_path / "out"
    assert run("plan", path, "--wall", "400x300", *QUICK, "-o", out).code in (0, 4)
    assert run("check", out, "--stones", path).code == 0


def test_the_scale_of_a_drawing_is_kept(tmp_path, run):
    path = drawn("dxf", tmp_path)
    assert "0.1 m wide, 0.05 m high" in run("analyse", path, "--mu", "1:2").out
    assert "0.1 m wide, 0.05 m high" in run("analyse", path, "--px-per-m", "3000").out
    assert run("measure", path, "--px-per-m", "3000").code == 0
    wall = run("measure", path, "--wall", "110x60mm", "--json").json()
    assert wall["F_SF"] < 0.7
    refused = run("measure", drawn("labelme", tmp_path), "--px-per-m", "3000")
    assert (refused.code, "would do nothing" in refused.err) == (2, True)


@pytest.mark.parametrize("command", ["analyse", "measure", "craft"])
def test_options_of_reading_are_those_of_stones(command, tmp_path, run):
    for form, last in (("labelme", 8), ("coco", 3)):
        path = drawn(form, tmp_path)
        less = run(command, path, "--skip", last, "--json")
        assert less.code == 0
        assert less.out != run(command, path, "--json").out
    wrong = run(command, drawn("labelme", tmp_path), "--mask")
    assert (wrong.code, "E118" in wrong.err) == (2, True)
    blocks = tmp_path / "blocks.json"
    blocks.write_text(json.dumps({"blocks_xywh": [[0, 0, 2, 1]]}))
    for options in (["--skip", "1"], ["--background", "255"], ["--holes", "keep"]):
        refused = run(command, blocks, *options)
        assert (refused.code, f"{options[0]} has no meaning" in refused.err) == (2, True)


@pytest.mark.parametrize(
    ("form", "ending"),
    [
        ("labelme", ".png"),
        ("dxf", ".tif"),
        ("y up", ".npy"),
        ("dxf", ".json"),
        ("labelme", ".json"),
    ],
)
def test_stones_are_converted_with_their_ids_and_scale(form, ending, tmp_path, run):
    path, to = drawn(form, tmp_path), tmp_path / "to" / f"labels{ending}"
    first = run("stones", path, "--to", to, "--json").json()
    again = run("stones", to, "--json").json()
    kept = ("stones", "total_area_px", "width_px", "height_px", "clusters")
    assert [again[name] for name in kept] == [first[name] for name in kept]
    scale = first["px_per_m"]
    assert again["px_per_m"] == scale
    assert run("stones", path, "--to", to).code == 2  # never over a file unasked
    assert run("stones", path, "--to", to, "--overwrite").code == 0
    if scale is not None:
        assert "m high" in run("analyse", to, "--close-gaps", "1", "--associative-only").out


def test_what_cannot_be_converted_is_refused_before_anything_is_written(tmp_path, run):
    for name in ("labels.bmp", "stones.json", "labels"):
        refused = run("stones", drawn("labelme", tmp_path), "--to", tmp_path / "to" / name)
        assert (refused.code, "E139" in refused.err) == (2, True)
    assert not (tmp_path / "to").exists()
    masks = tmp_path / "masks"
    masks.mkdir()
    for number in (1, 2):
        mask = np.zeros((30, 40), np.uint8)
        mask[5:20, 10 * number : 10 * number + 12] = 255
        Image.fromarray(mask).save(masks / f"{number}.png")
    among = run("stones", masks, "--to", masks / "all.png")
    assert (among.code, "E129" in among.err) == (2, True)
    told = run("stones", masks, "--to", tmp_path / "all.png")
    assert "in common went to the smaller one, from: 1 (30 px)" in told.out
    assert np.unique(read_wall_image(tmp_path / "all.png")).tolist() == [0, 1, 2]
