"""`drystone craft`: plans, label images and block models, table, JSON, pictures, bad input."""

import json
import re

import pytest
from PIL import Image

from drystone.craft import RULES
from drystone.io.plan_json import read_plan
from drystone.io.wall_image import write_labels
from tests.craft.walls import painted, running_bond, stack_bond


@pytest.fixture
def stack(tmp_path):
    path = tmp_path / "stack.png"
    write_labels(painted(stack_bond()), path)
    return path


def test_a_label_image_names_stones(stack, run):
    assert "good <= 1" not in run("craft", stack).out
    ran = run("craft", stack, "--explain")
    assert ran.code == 0
    assert ran.out.startswith(f"{stack}: 20 stones\n")
    assert "running joints    broken      5 courses (good <= 1, fair <= 2)" in ran.out
    assert "1, 5, 9, 13, 17, 2, 6, 10, 14, 18: 5 courses, 5.0 mean stone heights" in ran.out
    assert "and 9 more" in ran.out
    assert "What a flat picture does not show" in ran.out
    assert ran.err == ""


def test_cases_of_the_table_can_be_chosen(stack, run):
    assert "1, 5, 9" not in run("craft", stack, "--cases", 0).out
    assert re.search(r"and \d+ more", run("craft", stack).out)
    assert not re.search(r"and \d+ more", run("craft", stack, "--cases", 50).out)


def test_json_has_every_rule_and_case(stack, run):
    found = run("craft", stack, "--json").json()
    assert list(found["rules"]) == list(RULES)
    assert len(found["rules"]["cross_joints"]["cases"]) == 12
    assert found["rules"]["running_joints"]["number"] == 5.0
    assert found["rules"]["pins"]["verdict"] == "not judged"


def test_a_plan_names_steps(finished, run):
    plan = read_plan(finished / "plan.json")
    found = run("craft", finished, "--json").json()
    assert found["stones"] == len(plan.stone_steps)
    assert found["wedges"] == len(plan.wedge_steps)
    steps = {step.stone: step.step for step in plan.stone_steps}
    steps |= {step.id: step.step for step in plan.wedge_steps}
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


def test_limits_can_be_set(stack, run):
    limits = ("--limit", "running_joints=5:6", "--limit", "cross_joints=1:9")
    said = run("craft", stack, "--explain", *limits).out
    assert "running joints    good        5 courses (good <= 5, fair <= 6)" in said
    assert "cross joints      fair" in said


def test_pictures_are_drawn(tmp_path, run):
    wall, folder = tmp_path / "pair.png", tmp_path / "found"
    write_labels(painted(stack_bond(2, 1)), wall)
    assert run("craft", wall, "-o", folder).code == 0
    names = {f"{name}.png" for name in RULES} | {"craft.png"}
    assert {path.name for path in folder.iterdir()} == names
    with Image.open(folder / "craft.png") as sheet:
        assert sheet.width > 900
