"""`drystone check` in the engine, and its pictures of what fails."""

import os
import shutil
import sys
from dataclasses import replace
from functools import partial

import pytest
from matplotlib.image import imread
from PIL import Image

from drystone.cli.commands import check as check_command
from drystone.drawing.pictures.check import views_of
from drystone.drawing.words.checked import NOTEWORTHY_PX, Checked, PhysicsCard
from drystone.io.plan_json import read_plan
from drystone.io.read_stones import read_stones
from drystone.physics.building import BlockMove, BuildSettings, BuildUp, build_up
from drystone.physics.scatter import TiltResult
from drystone.physics.tilt import TiltTrial
from drystone.verify.check import check_plan
from drystone.verify.outlines import plan_polygons
from tests.cli.conftest import keys, listed, rewrite
from tests.verify.exact_examples import hanging_example

NO_ENGINE = "pymunk is not installed (extra `physics`)"


def lift(plan):
    """Let the last stone hang in the air, under a higher sky."""
    plan["steps"][-1]["centroid"][1] += 3.0
    plan["wall"]["height"] += 9.0


def push(plan):
    """Push the second stone into its neighbours."""
    (_, second, *_) = (step for step in plan["steps"] if step["kind"] == "stone")
    second["centroid"][0] += 4.0


def is_picture(path):
    """Read it; an all-white one is none."""
    return bool(imread(path)[..., :3].std() > 0.01)


def test_a_plan_is_checked_from_its_own_folder(plan_copy, run, monkeypatch):
    (plan_copy / "rubble.png").rename(plan_copy.parent / "rubble.png")
    (plan_copy / "deeper").mkdir()
    for here, given in ((".", "."), (".", "plan.json"), ("deeper", "..")):
        monkeypatch.chdir(plan_copy / here)
        assert run("check", given).code == 0
    (plan_copy.parent / "rubble.png").unlink()
    run("check", plan_copy).refused("E202", "--stones", exit_code=3)


def test_a_wall_that_stands(standing, tmp_path, run):
    pytest.importorskip("pymunk", reason=NO_ENGINE)
    asked = ("check", standing, "--physics", "--json", "--picture", tmp_path / "x.png")
    report = run(*asked).json()
    assert keys(report, "physics") == listed("check")
    physics, metrics = report["physics"], report["metrics"]
    assert (report["ok"], physics["fallen"], physics["first_fall"]) == (True, [], None)
    assert 0.0 < physics["largest_move"] < 3.0
    for side in ("left", "right"):
        claims = metrics[f"alpha_{side}"], metrics[f"alpha_{side}_coulomb"]
        assert physics[f"alpha_{side}"] == min(claims)
        # The same physics, by forces and by motion; on the raster not quite the same joints.
        assert physics[f"tilt_{side}"] == pytest.approx(metrics[f"alpha_{side}"], rel=0.15)
    placed = [step.stone for step in read_plan(standing).stone_steps]
    assert [move["id"] for move in physics["moves"]] == placed
    assert not (standing / "check.png").exists()


def test_a_stone_that_falls_is_named_and_drawn(plan_copy, run, monkeypatch):
    """A fall is a failed check only where the engine was asked."""
    pytest.importorskip("pymunk", reason=NO_ENGINE)
    # By this measure the stone that settles by a px has fallen.
    strict, drawn = partial(build_up, settings=BuildSettings(moved_share=0.03)), "check.png"
    monkeypatch.setattr(check_command, "build_up", strict)
    assert run("check", plan_copy).code == 0
    assert not (plan_copy / drawn).exists()
    ran = run("check", plan_copy, "--physics")
    again = run("check", plan_copy, "--physics", "--json")
    report = again.json()
    assert (ran.code, again.code, report["ok"]) == (5, 5, False)
    physics = report["physics"]
    for said in (
        " is valid, but the wall falls in the engine\n", "  falls                stone ",
        "not tilted", f"{plan_copy / drawn}\n", f"after step {physics['first_fall']}\n",
    ):  # fmt: skip
        assert said in ran.out
    assert is_picture(plan_copy / drawn)
    assert report["picture"] == str(plan_copy / drawn)
    fall = ("E241", physics["first_fall"])
    assert [(p["code"], p["step"]) for p in report["problems"]] == [fall]
    assert [move["id"] for move in physics["moves"] if move["fell"]] == physics["fallen"]
    assert (physics["tilt_left"], physics["tilt_right"]) == (None, None)


def test_a_claim_that_the_engine_contradicts_fails(standing, tmp_path, run, monkeypatch):
    """Also when all numbers of the plan are those of its limit analysis."""
    pytest.importorskip("pymunk", reason=NO_ENGINE)
    weak = tuple(TiltResult(side, (TiltTrial(0.3, None, 0.0, 0.01),)) for side in ("left", "right"))
    monkeypatch.setattr(check_command, "tilt_of", lambda _: weak)
    standing = shutil.copytree(standing, tmp_path / "standing")
    assert run("check", standing).code == 0
    ran, report = (run("check", standing, "--physics", *more) for more in ((), ("--json",)))
    assert (ran.code, " is valid, but the engine contradicts it\n" in ran.out) == (5, True)
    for side in ("left", "right"):
        assert f"E242 tilted to the {side} the wall comes down by alpha = 0.310 in" in ran.out
    assert (report.code, report.json()["ok"]) == (5, False)
    assert [p["code"] for p in report.json()["problems"]] == ["E242", "E242"]


def test_what_is_not_built_in_the_engine(plan_copy, run, monkeypatch):
    pytest.importorskip("pymunk", reason=NO_ENGINE)
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "pymunk", None)
        run("check", plan_copy, "--physics").refused("E305")
        assert run("check", plan_copy).code == 0
    rewrite(plan_copy / "plan.json", lambda plan: plan["steps"][0].update(stone=99))
    ran = run("check", plan_copy, "--physics")
    said = "not built there, as a step of the plan places nothing"
    assert (ran.code, said in ran.out) == (5, True)
    assert run("check", plan_copy, "--physics", "--json").json()["physics"] is None


def test_a_plan_that_can_fall_when_it_is_let_go_is_not_said_to_stand(plan_copy):
    plan, stones = read_plan(plan_copy), read_stones(plan_copy / "rubble.png")
    loose = replace(plan, metrics=replace(plan.metrics, F_LR_coulomb=0.0))
    report, outlines = check_plan(plan, stones), plan_polygons(plan, stones)
    said = [Checked(one, stones, report, outlines).verdict for one in (plan, loose)]
    assert said == ["is valid, and the wall stands", "is valid, but let go the wall can fall"]


def views(plan, stones):
    """What a check draws of a plan that fails."""
    checked = Checked(plan, stones, check_plan(plan, stones), plan_polygons(plan, stones))
    return views_of(checked)


@pytest.mark.parametrize(("tamper", "code"), [(push, "E221"), (lift, "E230")])
def test_what_fails_is_drawn(tamper, code, plan_copy, run):
    rewrite(plan_copy / "plan.json", tamper)
    ran, again = run("check", plan_copy), run("check", plan_copy)
    path = plan_copy / "check.png"
    assert (ran.code, code in ran.out, f"picture  {path}\n" in ran.out) == (5, True, True)
    assert is_picture(path)
    assert f"picture  {path} (in place of that of an earlier check)\n" in again.out
    plan = read_plan(plan_copy)
    drawn = views(plan, read_stones(plan_copy / "rubble.png"))
    view = next(view for view in drawn if view.title.startswith(f"{code} step "))
    if tamper is push:
        assert (view.size, len(view.planned)) == ((70.0, 30.0), len(plan.steps))
        # What is named by the problem, with what it has in common with its neighbours.
        assert drawn[0] is view
        assert set() < set(view.concerned) < {step.stone for step in plan.stone_steps}
        assert view.common
    else:
        # An unstable wall may fall in many ways; in any of them this stone goes down.
        last = plan.stone_steps[-1].stone
        assert ("begins to fall" in view.title, last in view.concerned) == (True, True)
        assert (view.ended[last] - view.planned[last])[:, 1].max() < -1.0


def test_a_stone_that_hangs_by_friction_is_drawn_where_it_hangs():
    hanging = hanging_example()
    (view,) = views(hanging.plan, hanging.stones)
    assert ("E237" in view.title, list(view.concerned), bool(view.ended)) == (True, [3], False)


def test_a_picture_where_it_is_asked_for(plan_copy, tmp_path, run, monkeypatch):
    path = tmp_path / "new" / "wall.png"
    ran = run("check", plan_copy, "--picture", path)
    assert (ran.code, f"picture  {path}\n" in ran.out) == (0, True)
    assert is_picture(path)
    rewrite(plan_copy / "plan.json", push)
    before = path.read_bytes()
    assert run("check", plan_copy, "--picture", path, "--overwrite").code == 5
    assert path.read_bytes() != before
    assert not (plan_copy / "check.png").exists()

    def refuse(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "replace", refuse)
    ran = run("check", plan_copy)
    assert (ran.code, "E221" in ran.out, "picture  not written: " in ran.out) == (5, True, True)
    assert "(Permission denied). Give a place with --picture." in ran.out
    assert run("check", plan_copy, "--json").json()["picture"] is None


def test_stones_with_other_bytes_are_named_as_such(plan_copy, run):
    """The same picture, saved anew."""
    path = plan_copy / "rubble.png"
    with Image.open(path) as opened:
        opened.copy().save(path, compress_level=1)
    other = f"E202 {plan_copy}: {path} is another file than the 'rubble.png'"
    run("check", plan_copy).refused(other, exit_code=3)
    ran = run("check", plan_copy, "--stones", path)
    assert (ran.code, "E210" in ran.out) == (5, True)
    rewrite(plan_copy / "plan.json", lambda plan: plan["source"].update(sha256=""))
    ran = run("check", plan_copy)
    assert (ran.code, "The bytes of the source were not compared" in ran.out) == (0, True)


def test_words_of_the_engine(plan_copy):
    """Where the plan has no overlap, nothing but the engine has pushed stones apart."""
    move, plan = BlockMove(3, 0.2, 0.01, 0.1, 0.46, fell=False), read_plan(plan_copy)
    built = BuildUp((move,), {}, (0.0,), (1, 2), None, 0.58)
    found = check_plan(plan, read_stones(plan_copy / "rubble.png"))
    for depth, why in ((NOTEWORTHY_PX, "what overlaps cannot stay"), (0.0, "others had moved")):
        rows = dict(PhysicsCard(plan, replace(found, overlap_depth=depth), built, None).rows())
        assert f"0.46 source px deep (stone 3): {why} " in rows["  pushed apart"]
    assert rows["  restless"].endswith("when the time of steps 1, 3 was up")
    # What is judged is the smaller of two claims, of which one may be missing.
    for less, said in ((0.234, "0.234"), (None, f"{plan.metrics.alpha_left:.3f}")):
        claimed = replace(plan, metrics=replace(plan.metrics, alpha_left_coulomb=less))
        rows = dict(PhysicsCard(claimed, found, built, None).rows())
        assert rows["  tilted to the left"].endswith(f"; the plan claims {said}")


def test_what_cannot_be_seen_is_not_drawn(plan_copy, tmp_path, run):
    path, unseen = plan_copy / "check.png", tmp_path / "none.png"
    rewrite(plan_copy / "plan.json", lambda plan: plan["metrics"].update(F_LR=0.99))
    ran = run("check", plan_copy)
    assert (ran.code, "picture" in ran.out, path.exists()) == (5, False, False)
    rewrite(plan_copy / "plan.json", lambda plan: plan.update(steps=[]))
    assert (run("check", plan_copy, "--picture", unseen).code, unseen.exists()) == (5, False)
