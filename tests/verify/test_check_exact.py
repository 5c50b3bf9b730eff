"""Plans of exact geometry are verified on their outlines."""

import json
from dataclasses import replace

import numpy as np
import pytest

from drystone.io.plan_json import plan_from_json, plan_to_json
from drystone.verify.check import check_plan
from drystone.verify.replay import PENETRATION_PX
from drystone.verify.report import PrefixAlpha
from tests.verify.exact_examples import GAP_PX, block_model, exact_example, hanging_example
from tests.verify.examples import L_STONE, SLAB, WEDGE
from tests.verify.tampering import changed, codes, moved, reshaped, step_of, with_setting


@pytest.fixture(scope="module")
def true():
    return exact_example()


def lowered_top(polygon, by):
    return polygon - (polygon == polygon.max(axis=0)) * (0, by)


def raised_floor(polygon, by):
    return polygon + (polygon == polygon.min(axis=0)) * (0, by)


@pytest.mark.parametrize(
    ("scale", "px_per_m"), [(1.0, None), (1.0, 137.0), (0.5, None), (0.5, 200.0)]
)
def test_true_plan_passes_in_any_unit_and_at_any_scale(scale, px_per_m):
    made = exact_example(scale, px_per_m)
    plan = plan_from_json(json.loads(json.dumps(plan_to_json(made.plan))))
    labels, blocks = made.wall.labels, block_model(made)
    report = check_plan(plan, made.stones, wall_labels=labels, blocks=blocks)
    assert report.problems == ()
    assert report.notes == ()
    assert report.geometry == report.as_dict()["geometry"] == "exact"
    assert (report.overlap_depth, report.overlap_depth_at, report.buried) == (0.0, None, ())
    assert report.area_error == 0
    assert report.metrics.F_LR_half == pytest.approx(1.0)  # slabs and blocks slide before they tip
    assert report.prefixes[0].alpha_left == pytest.approx(0.58)
    assert [prefix.step for prefix in report.prefixes] == [1, 2, 4, 5, 6]


# What is changed in the plan, and the codes that name it: exactly these.
EXACT = {
    "stone left of the wall": (lambda p: moved(p, 3, -0.31, 0), {"E220"}),
    "stone in the ground": (lambda p: moved(p, 5, 0, -0.07), {"E220"}),
    "stone right of the wall": (lambda p: moved(p, 300, 0.31, 0), {"E220"}),
    "stone above the top": (lambda p: moved(p, SLAB, 0, 4.3), {"E220"}),
    "stone .2 px into what is below": (lambda p: moved(p, SLAB, 0, -0.2), {"E221"}),
    "stone .2 px into its neighbour": (lambda p: moved(p, 300, -2.2, 0), {"E221"}),
    "stone in another": (lambda p: moved(p, 300, 2 - 74, 2), {"E221"}),
    "stone turned into another": (
        lambda p: changed(p, SLAB, angle_deg=181.0, rotation_moves=1), {"E221"}),
    "wedge .2 px into its stone": (
        lambda p: reshaped(p, lambda w: w + np.array([0, 0.2])), {"E221"}),
    "wedge clockwise": (lambda p: reshaped(p, lambda w: w[::-1]), {"E222"}),
    "wedge that crosses itself": (lambda p: reshaped(p, lambda w: w[[0, 2, 1, 3]]), {"E222"}),
    "wedge without area": (lambda p: reshaped(p, lambda w: w * (1, 0)), {"E222"}),
    "wedge far outside": (lambda p: reshaped(p, lambda w: w * 1e9), {"E220"}),
    "wedge too small": (lambda p: with_setting(p, "wedge", thickness=0.5), {"E224"}),
    "wedge too high": (lambda p: with_setting(p, "wedge", height=0.1), {"E224"}),
    "two rotation moves": (lambda p: changed(p, 3, rotation_moves=2), {"E235"}),
    "a turn that is none": (
        lambda p: changed(with_setting(p, "stabilise", method="wedge"), 3, rotation_moves=1),
        {"E235"}),
}  # fmt: skip


@pytest.mark.parametrize("name", EXACT)
def test_tampering_is_caught_by_its_code(true, name):
    change, expected = EXACT[name]
    report = check_plan(change(true.plan), true.stones)
    assert codes(report) == expected
    assert not report.ok


# Changes with more than one consequence: these codes are among those found.
AMONG = {
    "stone lifted beyond the tolerance": (lambda p: moved(p, 300, 0, 0.11), {"E230"}),
    "stone lifted within the tolerance": (lambda p: moved(p, 300, 0, 0.06), {"E234"}),
    "stone turned by 1 degree": (lambda p: changed(p, 3, angle_deg=1.0), {"E235"}),
    "stone turned further than it may": (
        lambda p: changed(p, 3, angle_deg=12.1, rotation_moves=1), {"E235"}),
    "wedge too low": (lambda p: reshaped(p, lambda w: lowered_top(w, 0.2)), {"E223", "E230"}),
    "wedge hanging": (lambda p: reshaped(p, lambda w: raised_floor(w, 0.2)), {"E223"}),
    "wedge narrower": (lambda p: reshaped(p, lambda w: w - (w == w.max(axis=0)) * (0.5, 0)),
                       {"E234"}),
    "wedge elsewhere": (lambda p: reshaped(p, lambda w: w - (12, 0)), {"E223", "E230", "E236"}),
    "contact tolerance": (
        lambda p: with_setting(p, "settle", contact_px=GAP_PX / 2, clearance_px=GAP_PX / 8),
        {"E223", "E230"}),
    "raster": (lambda p: replace(p, settings={**p.settings, "geometry": "raster"}), {"E234"}),
    "unit of length": (lambda p: replace(p, px_per_m=2.0, length_unit="m"), {"E230"}),
}  # fmt: skip


@pytest.mark.parametrize("name", AMONG)
def test_tampering_with_consequences_is_caught(true, name):
    change, expected = AMONG[name]
    report = check_plan(change(true.plan), true.stones, wall_labels=true.wall.labels)
    assert codes(report) >= expected


@pytest.mark.parametrize(("into", "allowed"), [(0.04, True), (0.06, False)])
def test_penetration_is_allowed_up_to_a_limit(true, into, allowed):
    report = check_plan(moved(true.plan, SLAB, 0, -GAP_PX - into), true.stones)
    assert ("E221" not in codes(report)) is allowed
    assert report.overlap_depth == pytest.approx(into, abs=1e-6)
    assert report.overlap_depth_at in {(3, SLAB), (SLAB, WEDGE)}
    assert (into <= PENETRATION_PX) is allowed


def test_what_lies_in_a_stone_that_lies_in_another_is_named_too(true):
    """The slab in the first stone, and one more in the end of the slab."""
    lowered = moved(true.plan, SLAB, 0, -0.2)
    x, y = step_of(lowered, SLAB).centroid
    plan = changed(lowered, 300, centroid=(x + 24.0, y))
    said = [p for p in check_plan(plan, true.stones).problems if p.code == "E221"]
    for stone, other in ((SLAB, 3), (300, SLAB)):
        mine = [p.message for p in said if p.step == step_of(plan, stone).step]
        assert any(f"source px deep in stone {other}." in message for message in mine)


def test_depth_is_said_in_source_px_and_of_wedges_too():
    made = exact_example(0.5, 200.0)
    plan = reshaped(made.plan, lambda w: w - (0, 1.2 / 200))
    report = check_plan(plan, made.stones)
    assert report.overlap_depth == pytest.approx(1.2 - GAP_PX, abs=1e-6)
    assert report.overlap_depth_at == (5, WEDGE)
    (problem,) = (p for p in report.problems if p.code == "E221")
    assert "1.19 source px deep in stone 5" in problem.message
    assert problem.step == step_of(made.plan, WEDGE).step


def test_edges_of_the_wall_are_named_in_source_px():
    made = exact_example(0.5)
    report = check_plan(moved(made.plan, 300, 0.75, -0.25), made.stones)
    (problem,) = report.problems
    assert problem.code == "E220"
    assert "0.24 px below the ground, 0.75 px right of the right" in problem.message


def test_stone_that_hangs_between_others_does_not_stand(true):
    # As near to its neighbours as contacts are, with nothing below it.
    hanging = moved(true.plan, L_STONE, 2.0 - GAP_PX, 3.0)
    report = check_plan(hanging, true.stones)
    step = step_of(true.plan, L_STONE).step
    assert {p.code for p in report.problems if p.step == step} >= {"E230"}
    assert PrefixAlpha(step, None, None) in report.prefixes


def test_stone_that_only_friction_on_upright_faces_holds_is_named():
    hanging = hanging_example()
    problems = check_plan(hanging.plan, hanging.stones).problems
    assert [(problem.code, problem.step) for problem in problems] == [("E237", 3)]
