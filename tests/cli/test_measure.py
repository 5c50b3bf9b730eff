"""`drystone measure`: sizes and scales of the wall that is measured."""

import numpy as np
import pytest

from drystone.io.plan_json import read_plan
from drystone.io.wall_image import write_labels


@pytest.fixture
def tower(tmp_path):
    """A block of 20 x 40 px in a picture of 30 x 50 px."""
    labels = np.zeros((50, 30), np.uint32)
    labels[10:, 5:25] = 9
    write_labels(labels, tmp_path / "tower.png")
    return tmp_path / "tower.png"


def test_a_ruler_lies_in_the_picture_of_a_wall(tower, run):
    asked = ("measure", tower, "--wall", ".2mx.4m", "--json")
    inside = run(*asked, "--ruler", "0,0,30,0=.3m").json()
    assert inside == run(*asked, "--px-per-m", 100).json()
    # The picture is meant as it was given, also when a smaller one is measured.
    assert run(*asked, "--scale", ".5", "--ruler", "0,0,30,50=.3m").code == 0
    for beyond in ("0,0,9999,0=1m", "0,0,31,0=1m", "0,0,0,51=1m"):
        ran = run(*asked, "--ruler", beyond)
        assert (ran.code, ran.out) == (2, "")
        assert "E138 --ruler: the point" in ran.err
        assert "outside the picture, which is 30 x 50 px" in ran.err
    said = run("analyse", tower, "--ruler", "0,0,31,0=1m").err
    assert "E138 --ruler: the point 31,0 is outside the picture" in said


def test_a_ruler_of_a_plan_lies_in_the_picture_of_its_stones(finished, run):
    asked = ("measure", finished, "--wall", "1mx.36m", "--json")
    source = read_plan(finished).source
    width, height = source["width_px"], source["height_px"]
    assert (width, height) != (100, 36)
    assert run(*asked, "--ruler", f"0,0,{width},{height}=1m").code == 0
    ran = run(*asked, "--ruler", f"0,0,{width + 1},0=1m")
    assert (ran.code, f"E138 --ruler: the point {width + 1},0 is outside" in ran.err) == (2, True)
    assert f"which is {width} x {height} px" in ran.err


def test_another_scale_than_that_of_a_plan(metric, run):
    asked = ("--wall", ".5mx.18m")
    for option, value in (("--ruler", "0,0,50,0=5cm"), ("--px-per-m", "1000")):
        for command in (("measure", metric, *asked), ("analyse", metric)):
            ran = run(*command, option, value)
            assert (ran.code, ran.out) == (2, "")
            assert f"E131 {option}: the plan says 200 px a metre, the option 1000." in ran.err
            assert "plan again" in ran.err
    same = run("measure", metric, *asked, "--px-per-m", "200", "--json").json()
    assert same == run("measure", metric, "--json").json()
