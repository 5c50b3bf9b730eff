"""The commands beside `plan`: what they print and write."""

from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
import yaml
from PIL import Image

from drystone.io.plan_json import read_plan
from drystone.io.wall_image import read_wall_image, write_labels
from tests.cli.conftest import rewrite


def _tower(path):
    """A block of 20 x 40 px on the ground: alpha is .5, F_SF 1."""
    labels = np.zeros((50, 30), np.uint32)
    labels[10:, 5:25] = 9
    write_labels(labels, path)
    return path


ANALYSED = {"contacts.png", "blocks.csv", "contacts.csv", "friction.png", "report.html"} | {
    f"{name}_{direction}{ending}"
    for direction in ("left", "right")
    for name, ending in (("mechanism", ".png"), ("mechanism", ".gif"), ("forces", ".png"))
}


def test_stones(rubble, tmp_path, run):
    ran = run("stones", rubble)
    assert ran.code == 0
    assert ran.out.startswith("rubble.png: 6 stones\n")
    summary = run("stones", rubble, "--json", "-o", tmp_path / "new" / "stones.png").json()
    assert summary["stones"] == 6
    assert len(summary["sha256"]) == 64
    assert set(summary["clusters"]) == {str(stone_id) for stone_id in range(1, 7)}
    assert summary["notices"] == []
    assert "W123" in run("stones", rubble, "--px-per-m", 20_000).out
    with Image.open(tmp_path / "new" / "stones.png") as picture:
        assert min(picture.size) > 100


def test_analyse_draws(tmp_path, run):
    tower, out = _tower(tmp_path / "tower.png"), tmp_path / "out"
    ran = run("analyse", tower, "-o", out)
    assert ran.code == 0
    assert {path.name for path in out.iterdir()} == ANALYSED
    for said in ("alpha = 0.5000", "Rocking of stone 9 about its left"):
        assert said in ran.out
    # A wall that does not stand is drawn as it falls, and says why.
    before = (out / "mechanism_left.png").read_bytes()
    labels = np.zeros((20, 20), np.uint32)
    labels[15:, 2:8], labels[5:10, 2:8] = 1, 2
    write_labels(labels, tmp_path / "floating.png")
    ran = run("analyse", tmp_path / "floating.png", "-o", out, "--overwrite")
    assert (ran.code, "unstable" in ran.out) == (5, True)
    assert "W302 1 of 2 blocks touch neither the ground" in ran.err
    measured = run("measure", tmp_path / "floating.png", "--json")
    assert (measured.json()["F_LR"], "W302" in measured.err) == (None, True)
    # There are no forces that hold it: none of another wall may stay.
    assert {path.name for path in out.iterdir()} == {n for n in ANALYSED if "forces" not in n}
    assert (out / "mechanism_left.png").read_bytes() != before


def test_analyse_and_measure_a_plan(plan_copy, run):
    plan = read_plan(plan_copy)
    for given in (plan_copy, plan_copy / "plan.json"):
        report = run("analyse", given, "--json").json()
        assert report["F_LR"] == pytest.approx(plan.metrics.F_LR)
        measured = run("measure", given, "--json").json()
        assert (measured["width"], measured["height"]) == (70.0, 30.0)
        assert measured["stones"] == len(plan.stone_steps)
        for name in ("F_AV", "F_AH", "F_LR", "T_LEVEL", "E_FLUSH"):
            assert measured[name] == pytest.approx(getattr(plan.metrics, name))
        assert measured["F_SF"] == pytest.approx(plan.metrics.F_SF, rel=0.02)
    wider = run("measure", plan_copy, "--json", "--wall", "140x30").json()
    assert wider["F_SF"] == pytest.approx(measured["F_SF"] / 2)
    rewrite(plan_copy / "plan.json", lambda plan: plan["settings"].pop("mu"))
    assert run("analyse", plan_copy, "--json").json()["mu"] == 0.58


def test_a_plan_needs_its_own_wall_image(plan_copy, run):
    labels = read_wall_image(plan_copy / "wall.png").copy()
    labels[labels == labels.max()] = 77
    write_labels(labels, plan_copy / "wall.png")
    for command in ("analyse", "measure"):
        run(command, plan_copy).refused("E133", "other stones", exit_code=3)
    (plan_copy / "wall.png").unlink()
    run("analyse", plan_copy / "plan.json").refused("E133", exit_code=3)


def test_measure_can_follow_its_own_cure(tmp_path, run):
    labels = np.full((60, 60), 255, np.uint16)
    labels[20:40, 10:50] = 3
    labels[40:58, 10:50] = 4
    write_labels(labels, tmp_path / "white.png")
    cure = "Set those pixels to 0, or use --background 255 "
    run("measure", tmp_path / "white.png").refused("E105", cure, exit_code=3)
    given = (tmp_path / "white.png", "--background", "255", "--json")
    assert run("measure", *given).json()["stones"] == 2
    assert run("analyse", *given).json()["blocks"] == 2
    assert run("craft", *given).json()["stones"] == 2


def test_the_stones_of_a_mask_are_told_apart_in_every_command(tmp_path, run):
    mask = np.zeros((40, 60), np.uint16)
    mask[5:40, 5:25] = mask[10:40, 30:55] = 255
    write_labels(mask, tmp_path / "mask.png")
    told = [run(name, tmp_path / "mask.png").err for name in ("analyse", "measure", "craft")]
    assert all("W114" in err and "2 components" in err for err in told)
    write_labels(np.where(mask, 7, 0).astype(np.uint16), tmp_path / "one.png")
    told = [run(name, tmp_path / "one.png").err for name in ("analyse", "measure", "craft")]
    assert all("W304 700 pixels of stone 7 lie apart" in err for err in told)
    assert "W304" not in run("measure", _tower(tmp_path / "tower.png")).err


@pytest.mark.parametrize("kind", ["fourier", "polygon", "brick", "rubble"])
def test_generate(kind, tmp_path, run):
    paths = [tmp_path / name for name in ("a.png", "new/b.tif", "c.png")]
    for path, seed in zip(paths, (1, 1, 2), strict=True):
        ran = run("generate", kind, "-o", path, "--count", 4, "--seed", seed)
        assert ran.code == 0
        assert ran.out.startswith("4 stones, ")
    first, again, other = (read_wall_image(path) for path in paths)
    assert (first == again).all()
    assert set(np.unique(first).tolist()) == {0, 1, 2, 3, 4}
    if kind != "brick":  # all bricks are alike
        assert first.shape != other.shape or (first != other).any()
        return
    # Numbers are written as everywhere else, which TOML alone does not read.
    sizes = ("--count", 2, "--set", "height_px=6", "--set", "aspect=.5", "--overwrite")
    assert run("generate", kind, "-o", paths[0], *sizes).code == 0
    assert [int((read_wall_image(paths[0]) == stone).sum()) for stone in (1, 2)] == [18, 18]


def test_demo_needs_nothing_and_can_be_checked(tmp_path, run, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ran = run("demo", "--method", "paper", "--scale", ".125")
    assert ran.code in (0, 4)
    out = tmp_path / "drystone-demo"
    assert str(Path("drystone-demo") / "report.html") in ran.out
    assert {"stones.png", "plan.json", "picture.png", "report.html"} <= {
        path.name for path in out.iterdir()
    }
    assert run("check", out).code == 0
    run("demo", "--method", "paper").refused("E129")
    run("demo", "--method", "wurst", "-o", "other").refused("wurst")
    assert not (tmp_path / "other").exists()


def test_measure(finished, tmp_path, run):
    tower = _tower(tmp_path / "tower.png")
    assert run("measure", tower, "--json").json()["F_SF"] == 1.0
    given = run("measure", tower, "--json", "--wall", "40x50").json()
    assert given["F_SF"] == pytest.approx(20 * 40 / (40 * 50))
    reduced = run("measure", tower, "--json", "--scale", ".5", "--wall", "40x50").json()
    assert (reduced["width"], reduced["height"]) == (20.0, 25.0)
    assert reduced["F_SF"] == pytest.approx(given["F_SF"])
    asked = ("measure", tower, "--json", "--wall", ".4mx.5m")
    assert run(*asked, "--px-per-m", "100").json() == given
    assert run(*asked, "--ruler", "0,0,30,0=.3m").json() == given
    # The picture is meant as it was given, also when a smaller one is measured.
    assert run(*asked, "--scale", ".5", "--ruler", "0,0,30,50=.3m").code == 0
    beyond = "E138 --ruler: the point 31,0 is outside the picture, which is 30 x 50 px"
    for command in (asked, ("analyse", tower)):
        run(*command, "--ruler", "0,0,31,0=1m").refused(beyond)
    assert "in a picture of 30 x 50 px" in run("measure", tower).out
    # A plan keeps its wall.
    whole = run("measure", finished, "--json").json()
    half = run("measure", finished, "--scale", ".5", "--json").json()
    assert half["F_SF"] == pytest.approx(whole["F_SF"])
    assert (half["width"], half["height"]) == (whole["width"] / 2, whole["height"] / 2)


def test_a_ruler_of_a_plan_lies_in_the_picture_of_its_stones(finished, run):
    asked = ("measure", finished, "--wall", ".7mx.3m", "--json")
    source = read_plan(finished).source
    width, height = source["width_px"], source["height_px"]
    assert (width, height) != (70, 30)
    assert run(*asked, "--ruler", f"0,0,{width},{height}=1m").code == 0
    said = f"E138 --ruler: the point {width + 1},0 is outside", f"which is {width} x {height} px"
    run(*asked, "--ruler", f"0,0,{width + 1},0=1m").refused(*said)


def test_another_scale_than_that_of_a_plan(metric, run):
    asked = ("--wall", ".35mx.15m")
    for option, value in (("--ruler", "0,0,50,0=5cm"), ("--px-per-m", "1000")):
        for command in (("measure", metric, *asked), ("analyse", metric)):
            said = f"E131 {option}: the plan says 200 px a metre, the option 1000."
            run(*command, option, value).refused(said, "plan again")
    same = run("measure", metric, *asked, "--px-per-m", "200", "--json").json()
    assert same == run("measure", metric, "--json").json()


def test_cite_says_what_the_citation_file_says(run):
    """The file is not installed; it goes by the version of the package."""
    cff = yaml.safe_load((Path(__file__).parents[2] / "CITATION.cff").read_text("utf-8"))
    ran = run("cite")
    assert ran.code == 0
    assert cff["version"] == version("drystone")
    (paper,) = cff["references"]
    told = [cff[name] for name in ("title", "version", "date-released", "license")]
    for said in (*told, paper["year"], *(one["family-names"] for one in paper["authors"])):
        assert str(said) in ran.out
    assert ran.out.count("{") == ran.out.count("}")
