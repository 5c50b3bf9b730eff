"""Plans on outlines, the default of `best`, from `plan` to `check`, in px and in metres."""

import json
import re
import shutil

import numpy as np
import pytest

from drystone.io.plan_folder import BLOCKS
from drystone.io.plan_json import read_plan
from drystone.model.steps import piece_id
from tests.cli.conftest import EXACT, UNTRIED, listed, rewrite
from tests.cli.test_planning import FILES


def polygons(folder):
    """Return the outlines beside a plan by id, in the units of the plan."""
    blocks = json.loads((folder / BLOCKS).read_text(encoding="utf-8"))["blocks"]
    return {block["id"]: np.array(block["polygon"]) for block in blocks}


def test_best_plans_on_outlines_and_writes_them(rubble, settled, finished, tmp_path, run):
    assert {path.name for path in settled.iterdir()} == FILES | {BLOCKS}
    plan = read_plan(settled)
    assert (plan.method, plan.settings["geometry"]) == ("best", "exact")
    assert 'geometry = "exact"' in (settled / "settings.toml").read_text(encoding="utf-8")
    assert sorted(polygons(settled)) == sorted(map(piece_id, plan.steps))
    assert "their outlines" in (settled / "report.html").read_text(encoding="utf-8")
    # JSON says what the contact tolerance changes; there is none on pixels.
    seeded = ("plan", rubble, *EXACT, "--seed", 1)
    summary = run(*seeded, "-o", tmp_path, "--json", "--profile").json()
    assert None not in (summary["F_LR_half"], summary["F_LR_double"])
    assert summary["profile"]["parts"]["placement"] > 0
    for name in ("plan.json", BLOCKS, "wall.png", "picture.png"):
        assert (tmp_path / name).read_bytes() == (settled / name).read_bytes()
    metrics = read_plan(finished).metrics
    assert (metrics.F_LR_half, metrics.F_LR_double) == (None, None)


@pytest.mark.parametrize("planned", ["finished", "settled"])
def test_measure_and_analyse_say_what_the_plan_says(planned, run, request):
    folder = request.getfixturevalue(planned)
    plan, exact = read_plan(folder), planned == "settled"
    for given in (folder, folder / "plan.json"):
        report = run("analyse", given, "--json").json()
        for name in ("F_LR", "alpha_left"):
            assert report[name] == pytest.approx(getattr(plan.metrics, name))
        assert report["blocks"] == len(plan.steps)
        measured = run("measure", given, "--json").json()
        assert set(measured) == listed("measure")
        size = (measured["width"], measured["height"], measured["stones"])
        assert size == (70.0, 30.0, len(plan.stone_steps))
        for name in ("F_AV", "F_AH", "F_LR", "T_LEVEL", "E_FLUSH"):
            assert measured[name] == pytest.approx(getattr(plan.metrics, name))
        assert measured["F_SF"] == pytest.approx(plan.metrics.F_SF, rel=1e-6 if exact else 0.02)
    if exact:
        assert run("analyse", folder / BLOCKS, "--json").json()["F_LR"] == report["F_LR"]
    slippery = [run(one, folder, "--json", "--mu", ".2").json() for one in ("measure", "analyse")]
    assert slippery[0]["F_LR"] == pytest.approx(slippery[1]["F_LR"])
    assert slippery[0]["F_LR"] != pytest.approx(measured["F_LR"])


def test_metres(rubble, settled, metric, tmp_path, run):
    out = shutil.copytree(metric, tmp_path / "m")
    px, metres = read_plan(settled), read_plan(out)
    assert (metres.length_unit, metres.px_per_m) == ("m", 200.0)
    for one, other in zip(metres.stone_steps, px.stone_steps, strict=True):
        assert (one.stone, one.angle_deg) == (other.stone, other.angle_deg)
        assert np.array(one.centroid) * 200 == pytest.approx(np.array(other.centroid), abs=1e-9)
    there = polygons(out)
    for block, corners in polygons(settled).items():
        assert there[block] * 200 == pytest.approx(corners, abs=1e-9)
    assert (out / "wall.png").read_bytes() == (settled / "wall.png").read_bytes()
    assert run("check", out, "--stones", rubble).code == 0
    for folder in (settled, out):
        report = run("analyse", folder, "--json").json()
        assert report["F_LR"] == pytest.approx(px.metrics.F_LR)
    for by_px, accepted in ((0.005, True), (0.02, False)):

        def shift(blocks, by=by_px / 200):
            last = blocks["blocks"][-1]
            last["polygon"] = [[x + by, y] for x, y in last["polygon"]]

        rewrite(out / BLOCKS, shift)
        assert (run("analyse", out).code == 0) == accepted
    # The same stones in the same order, but in another unit.
    shutil.copy(settled / BLOCKS, out / BLOCKS)
    assert "stones in other places" in run("analyse", out).err


def test_a_plan_needs_its_own_blocks(settled_copy, run):
    path = settled_copy / BLOCKS
    foreign = re.sub(r'"id": *\d+', '"id": 99', path.read_text(), count=1)
    for text, *said in (
        (foreign, "E133", "has other stones than the plan"),
        ("[1]", "E133", "is not a block model"),
        ("{}", "E303", "there is neither"),
        ("{", "E132", "is not valid JSON", "or plan again"),
        (None, "E133", "there is no blocks.json beside the plan"),
    ):
        path.unlink() if text is None else path.write_text(text)
        for command in ("measure", "analyse"):
            run(command, settled_copy).refused(*said, exit_code=3)
        # It takes the outlines from the stones, and compares these.
        ran = run("check", settled_copy)
        assert (ran.code, "E238" in ran.out) == ((5, True) if path.exists() else (0, False))


def test_entries_that_the_files_beside_a_plan_contradict_are_named(metric, tmp_path, run):
    first = read_plan(metric).stone_steps[0]

    def step(plan):
        return plan["steps"][first.step - 1]

    name = f"of step {first.step} (stone {first.stone}) is"
    turned = first.angle_deg / 2 + 20
    for tamper, said, known_before in (
        (lambda plan: step(plan).update(angle_deg=turned), f"angle_deg {name} {turned}", False),
        (lambda plan: step(plan).update(source_centroid=[1, 2]), f"source_centroid {name}", False),
        (lambda plan: plan["settings"].update(mu=0.3), "settings.mu is 0.3 by the plan", True),
        (lambda plan: plan["units"].update(px_per_m=100), "units.px_per_m is 100.0 by the", True),
        (lambda plan: plan["units"].update(working_scale=0.1), "the size of wall.png (wall", True),
        (lambda plan: plan["wall"].update(width=9), "the size of wall.png (wall times", True),
    ):
        out = shutil.copytree(metric, tmp_path / "m", dirs_exist_ok=True)
        rewrite(out / "plan.json", tamper)
        for command in (("analyse", out), ("export", out, "--to", "poses")):
            run(*command).refused("E133", said, exit_code=3)
        # A folder of before has blocks without poses and a scale: what the image tells is left.
        rewrite(out / BLOCKS, forget)
        ran = run("analyse", out)
        assert (ran.code, "E133" in ran.err) == ((3, True) if known_before else (0, False))
    out = shutil.copytree(metric, tmp_path / "m", dirs_exist_ok=True)
    rewrite(out / BLOCKS, forget)
    assert run("analyse", out, "--json").json() == run("analyse", metric, "--json").json()


def forget(blocks):
    del blocks["px_per_m"]
    for block in blocks["blocks"]:
        block.pop("angle_deg", None)
        block.pop("source_centroid", None)


def test_a_wedge_in_another_place_is_not_that_of_the_plan(settled_copy, run):
    """A stone of the plan stands for a wedge here, so that there is one in any case."""
    first, *_, last = read_plan(settled_copy).steps
    corners = polygons(settled_copy)[piece_id(last)].tolist()
    wedge = {"step": last.step, "kind": "wedge", "id": piece_id(last), "under": first.stone,
             "alpha_left": 0.1, "alpha_right": 0.1}  # fmt: skip
    for up, said in ((0.0, ""), (0.02, "has its stones in other places")):
        wedge["polygon"] = [[x, y + up] for x, y in corners]
        rewrite(settled_copy / "plan.json", lambda plan: plan["steps"].__setitem__(-1, wedge))
        ran = run("analyse", settled_copy)
        assert (ran.code == 0, said in ran.err) == (not said, True)


def test_files_of_an_earlier_plan_do_not_stay(settled_copy, rubble, tmp_path, run):
    again = (*UNTRIED, "-o", settled_copy, "--overwrite", "--seed", 1)
    assert run("plan", rubble, *EXACT, "--geometry", "raster", *again).code in (0, 4)
    assert {path.name for path in settled_copy.iterdir()} == FILES | {"rubble.png"}
    on_pixels = run("analyse", settled_copy, "--json").json()
    assert on_pixels["F_LR"] == pytest.approx(read_plan(settled_copy).metrics.F_LR)
    # A wall without stones, none of which rests firmly enough, has no mechanism to draw, and no
    # film.
    firm = tmp_path / "firm.toml"
    firm.write_text("[settle]\nmargin = 1000.0\n", encoding="utf-8")
    assert run("plan", rubble, *EXACT, "--settings", firm, *again).code == 4
    left = {path.name for path in settled_copy.iterdir()}
    gone = {"mechanism_left.png", "mechanism_right.png", "build.gif"}
    assert left == (FILES | {BLOCKS, "rubble.png"}) - gone
    assert polygons(settled_copy) == {}
    assert run("check", settled_copy).code == 0


def test_the_outlines_are_checked_and_the_engine_builds_them(settled_copy, run):
    ran = run("check", settled_copy)
    assert (ran.code, "is valid, and the wall stands\n" in ran.out) == (0, True)
    assert "0.00 source px deep by the outlines" in ran.out
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    ran = run("check", settled_copy, "--physics", "--json")
    report = ran.json()
    assert (report["geometry"], report["overlap_depth"]) == ("exact", 0.0)
    assert (ran.code == 0) == report["ok"] == (not report["physics"]["fallen"])
    assert {move["id"] for move in report["physics"]["moves"]} == set(polygons(settled_copy))
