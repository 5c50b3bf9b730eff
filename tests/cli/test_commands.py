"""The commands beside `plan`: what they print and write."""

import json
import re
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
import yaml
from PIL import Image

from drystone.craft import RULES
from drystone.io.plan_json import read_plan
from drystone.io.wall_image import read_wall_image, write_labels
from drystone.model.steps import piece_id
from tests.cli.conftest import contents, keys, listed, rewrite
from tests.craft.walls import painted, running_bond, stack_bond


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
    assert (ran.code, ran.out.startswith("rubble.png: 6 stones\n")) == (0, True)
    drawn = tmp_path / "new" / "stones.png"
    summary = run("stones", rubble, "--json", "-o", drawn).json()
    assert set(summary) == listed("stones")
    assert (summary["stones"], len(summary["sha256"]), summary["notices"]) == (6, 64, [])
    assert set(summary["clusters"]) == set("123456")
    assert "W123" in run("stones", rubble, "--px-per-m", 20_000).out
    with Image.open(drawn) as picture:
        assert min(picture.size) > 100


def test_analyse_draws(tmp_path, run):
    tower, floating, out = (tmp_path / name for name in ("tower.png", "floating.png", "out"))
    _tower(tower)
    ran = run("analyse", tower, "-o", out)
    assert (ran.code, {path.name for path in out.iterdir()}) == (0, ANALYSED)
    assert "Rocking of stone 9 about its left" in ran.out
    # A wall that does not stand is drawn as it falls, and says why.
    before = (out / "mechanism_left.png").read_bytes()
    labels = np.zeros((20, 20), np.uint32)
    labels[15:, 2:8], labels[5:10, 2:8] = 1, 2
    write_labels(labels, floating)
    ran = run("analyse", floating, "-o", out, "--overwrite")
    assert (ran.code, "unstable" in ran.out) == (5, True)
    measured = run("measure", floating, "--json")
    assert (measured.json()["F_LR"], "W302" in measured.err) == (None, True)
    labels[5:15, 7:17], labels[5:10, 2:7] = 2, 0
    write_labels(labels, floating)
    measured = run("measure", floating, "--json")
    assert (measured.json()["F_LR"], "The wall does not stand." in measured.err) == (None, True)
    # There are no forces that hold it: none of another wall may stay.
    assert {path.name for path in out.iterdir()} == {n for n in ANALYSED if "forces" not in n}
    assert (out / "mechanism_left.png").read_bytes() != before


def test_a_plan_needs_its_own_wall_image(plan_copy, run):
    path = plan_copy / "plan.json"
    measured, wider = (
        run("measure", plan_copy, "--json", *more).json() for more in ((), ("--wall", "140x30"))
    )
    assert wider["F_SF"] == pytest.approx(measured["F_SF"] / 2)
    rewrite(path, lambda plan: plan["settings"].pop("mu"))
    assert run("analyse", plan_copy, "--json").json()["mu"] == 0.58
    labels = read_wall_image(plan_copy / "wall.png").copy()
    labels[labels == labels.max()] = 77
    write_labels(labels, plan_copy / "wall.png")
    for command in ("analyse", "measure"):
        run(command, plan_copy).refused("E133", "other stones", exit_code=3)
    (plan_copy / "wall.png").unlink()
    run("analyse", path).refused("E133", exit_code=3)


def test_measure_can_follow_its_own_cure(tmp_path, run):
    labels, path = np.full((60, 60), 255, np.uint16), tmp_path / "white.png"
    labels[20:40, 10:50], labels[40:58, 10:50] = 3, 4
    write_labels(labels, path)
    cure = "Set those pixels to 0, or use --background 255 "
    run("measure", path).refused("E105", cure, exit_code=3)
    for command, counted in (("measure", "stones"), ("analyse", "blocks"), ("craft", "stones")):
        assert run(command, path, "--background", "255", "--json").json()[counted] == 2


@pytest.mark.parametrize("command", ["analyse", "measure", "craft"])
def test_what_was_done_to_a_picture_is_said_once(command, tmp_path, run):
    mask, path = np.zeros((40, 60), np.uint16), tmp_path / "mask.png"
    mask[5:40, 5:25] = mask[10:40, 30:55] = 255
    one = np.where(mask, 7, 0).astype(np.uint16)
    for labels, said in ((mask, ("W114", "2 components")), (one, ("W304 700 pixels of stone 7",))):
        write_labels(labels, path)
        told = run(command, path).err
        assert all(told.count(words) == 1 for words in said)
    assert "W304" not in run(command, _tower(tmp_path / "tower.png")).err
    labels = np.zeros((12, 16), np.uint8)
    labels[2:, 2:8], labels[2:, 8:14] = 1, 2
    Image.fromarray(labels).save(tmp_path / "a.tif", tiffinfo={274: 4})
    assert run(command, tmp_path / "a.tif", "--json").err.count("W173") == 1


@pytest.mark.parametrize("kind", ["fourier", "polygon", "brick", "rubble"])
def test_generate(kind, tmp_path, run):
    made = []
    for name, seed in (("a.png", 1), ("new/b.tif", 1), ("c.png", 2)):
        ran = run("generate", kind, "-o", tmp_path / name, "--count", 4, "--seed", seed)
        assert (ran.code, ran.out.startswith("4 stones, ")) == (0, True)
        made.append(read_wall_image(tmp_path / name))
    first, again, other = made
    assert np.array_equal(first, again)
    assert set(np.unique(first).tolist()) == {0, 1, 2, 3, 4}
    assert np.array_equal(first, other) == (kind == "brick")  # all bricks are alike
    if kind == "brick":
        # Numbers are written as everywhere else, which TOML alone does not read.
        sizes = ("--count", 2, "--set", "height_px=6", "--set", "aspect=.5", "--overwrite")
        assert run("generate", kind, "-o", tmp_path / "a.png", *sizes).code == 0
        assert np.bincount(read_wall_image(tmp_path / "a.png").ravel())[1:].tolist() == [18, 18]
        small = run("generate", kind, "-o", tmp_path / "a.png", *sizes, "--set", "height_px=4")
        assert "W113 reading leaves out 2 stones of less than 10 px" in small.err


def test_demo_needs_nothing_and_can_be_checked(tmp_path, run, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # As where nothing is compiled: a wall that ends too low is a failed demonstration.
    ran = run("demo", "--budget", 1)
    assert ran.code == 0
    assert str(Path("drystone-demo") / "report.html") in ran.out
    written = {path.name for path in Path("drystone-demo").iterdir()}
    assert written >= {"stones.png", "plan.json", "picture.png", "report.html"}
    assert run("check", "drystone-demo").code == 0
    run("demo", "--budget", 1).refused("E129")
    run("demo", "--method", "wurst", "-o", "other").refused("wurst")
    assert not Path("other").exists()


def test_measure(finished, tmp_path, run):
    tower = _tower(tmp_path / "tower.png")

    def measured(*options, given=tower):
        return run("measure", given, "--json", *options).json()

    assert measured()["F_SF"] == 1.0
    # It takes no block model (E134), other than analyse.
    assert ["block model" in run(one, "--help").out for one in ("measure", "analyse")] == [0, 1]
    given = measured("--wall", "40x50")
    assert given["F_SF"] == pytest.approx(20 * 40 / (40 * 50))
    reduced = measured("--scale", ".5", "--wall", "40x50")
    assert (reduced["width"], reduced["height"]) == (20.0, 25.0)
    assert reduced["F_SF"] == pytest.approx(given["F_SF"])
    asked = ("--wall", ".4mx.5m")
    assert measured(*asked, "--px-per-m", "100") == given
    assert measured(*asked, "--ruler", "0,0,30,0=.3m") == given
    # The picture is meant as it was given, also when a smaller one is measured.
    assert run("measure", tower, *asked, "--scale", ".5", "--ruler", "0,0,30,50=.3m").code == 0
    beyond = "E138 --ruler: the point 31,0 is outside the picture, which is 30 x 50 px"
    for command in (("measure", tower, *asked), ("analyse", tower)):
        run(*command, "--ruler", "0,0,31,0=1m").refused(beyond)
    assert "in a picture of 30 x 50 px" in run("measure", tower).out
    # A plan keeps its wall.
    whole, half = measured(given=finished), measured("--scale", ".5", given=finished)
    assert half["F_SF"] == pytest.approx(whole["F_SF"])
    assert (half["width"], half["height"]) == (whole["width"] / 2, whole["height"] / 2)


def test_a_ruler_of_a_plan_lies_in_the_picture_of_its_stones(finished, metric, run):
    asked = ("measure", finished, "--wall", ".7mx.3m", "--json")
    source = read_plan(finished).source
    width, height = source["width_px"], source["height_px"]
    assert (width, height) != (70, 30)
    assert run(*asked, "--ruler", f"0,0,{width},{height}=1m").code == 0
    said = f"E138 --ruler: the point {width + 1},0 is outside", f"which is {width} x {height} px"
    run(*asked, "--ruler", f"0,0,{width + 1},0=1m").refused(*said)
    asked = ("measure", metric, "--wall", ".35mx.15m")
    for option, value in (("--ruler", "0,0,50,0=5cm"), ("--px-per-m", "1000")):
        said = f"E131 {option}: the plan says 200 px a metre, the option 1000."
        for command in (asked, ("analyse", metric)):
            run(*command, option, value).refused(said, "plan again")
    same = run(*asked, "--px-per-m", "200", "--json").json()
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


def test_a_label_image_names_stones(tmp_path, run):
    stack = tmp_path / "stack.png"
    write_labels(painted(stack_bond()), stack)
    ran, found = run("craft", stack, "-o", tmp_path / "found"), contents(tmp_path / "found")
    assert ("good <= 1" in ran.out, "and 9 more" in ran.out) == (False, True)
    assert found.keys() == {f"{name}.png" for name in RULES} | {"craft.png"}
    with Image.open(tmp_path / "found" / "craft.png") as sheet:
        assert sheet.width > 900
    ran = run("craft", stack, "--explain")
    assert (ran.code, "W301 4 empty rows" in ran.err) == (0, True)
    assert ran.out.startswith(f"{stack}: 20 stones\n")
    for said in (
        "running joints    broken      5 courses (good <= 1, fair <= 2)",
        "1, 5, 9, 13, 17, 2, 6, 10, 14, 18: 5 courses, 5.0 mean stone heights",
        "What a flat picture does not show",
    ):
        assert said in ran.out
    assert "1, 5, 9" not in run("craft", stack, "--cases", 0).out
    assert not re.search(r"and \d+ more", run("craft", stack, "--cases", 50).out)
    limits = ("--limit", "running_joints=5:6", "--limit", "cross_joints=1:9")
    said = run("craft", stack, "--explain", *limits).out
    assert "running joints    good        5 courses (good <= 5, fair <= 6)" in said
    assert "cross joints      fair" in said


def test_a_plan_names_steps(finished, run):
    plan = read_plan(finished / "plan.json")
    found = run("craft", finished, "--json").json()
    assert (set(found), list(found["rules"])) == (listed("craft"), list(RULES))
    assert found["stones"] == len(plan.stone_steps)
    assert found["wedges"] == len(plan.wedge_steps)
    steps = {piece_id(step): step.step for step in plan.steps}
    cases = [case for rule in found["rules"].values() for case in rule["cases"]]
    assert cases
    for case in cases:
        assert case["steps"] == [steps[stone] for stone in case["stones"]]
    assert "(step " in run("craft", finished / "plan.json").out


def test_a_block_model_is_a_wall_too(tmp_path, run):
    path = tmp_path / "blocks.json"
    blocks = [{"id": i, "polygon": loop.tolist()} for i, loop in running_bond().items()]
    path.write_text(json.dumps({"blocks": blocks}), encoding="utf-8")
    found = run("craft", path, "--json").json()["rules"]
    assert found["one_over_two"]["number"] == 1.0
    assert found["one_over_two"]["figures"]["share that touches two or more below"] == 1.0
    named = run("craft", path, "--wedges", 1, 2, "--json").json()
    assert (named["stones"], named["wedges"]) == (len(blocks) - 2, 2)
    assert named["rules"]["pins"]["number"] > 0


def test_a_wall_is_rehearsed_with_the_errors_that_are_given(settled, tmp_path, run):
    picture = tmp_path / "risk.png"
    ran = run("rehearse", settled, "--precision", "1.5%", "--runs", 4, "-o", picture)
    assert (ran.code, ran.out.startswith(f"{settled}: whole in ")) == (0, True)
    assert "judge                       exact settling" in ran.out
    with Image.open(picture) as drawn:
        assert drawn.width > 500
    asked = ("--precision", "2px,1.5deg", "--outline", "0.5px", "--runs", 4, "--json")
    report = run("rehearse", settled, *asked).json()
    found = keys(report, "errors").union(*report["stones"], ("runs", "low", "median", "high"))
    assert found == listed("rehearse")
    assert report["errors"] == {"placement": 2.0, "angle_deg": 1.5, "outline": 0.5}
    # Friction does not change the other errors; hardly any lets stones slide off each other.
    for more, same in ((("--seed", 1), 0), (("--mu", 0.58), 1), (("--mu", "0.05:0.06"), 0)):
        assert (report == run("rehearse", settled, *asked, *more).json()) == bool(same)


def test_the_rest_is_planned_again_after_every_stone(settled, run):
    asked = ("--closed-loop", "--runs", 2)
    report = run("rehearse", settled, *asked, "--json").json()
    assert (report["loop"], report["judge"], report["whole"]) == ("closed", "settling", 2)
    assert report == run("rehearse", settled, *asked, "--json").json()
    assert "fell on the way" in run("rehearse", settled, *asked).out


def test_a_wall_that_falls_as_it_is_planned_is_a_failed_check(settled_copy, run):
    files = settled_copy / "blocks.json", settled_copy / "plan.json"
    blocks, plan = (json.loads(file.read_text()) for file in files)
    last = blocks["blocks"][-1]
    last["polygon"] = [[x, y + 50.0] for x, y in last["polygon"]]
    (step,) = (step for step in plan["steps"] if step.get("stone") == last["id"])
    step["centroid"][1] += 50.0
    for file, value in zip(files, (blocks, plan), strict=True):
        file.write_text(json.dumps(value))
    ran = run("rehearse", settled_copy, "--runs", 1)
    assert ran.code == 5
    assert f"stone {last['id']} falls even where it is planned" in ran.out
