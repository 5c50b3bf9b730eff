"""Friction of joints, what it is worth to a wall, and what only it holds on upright faces."""

from dataclasses import replace
from typing import get_args

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.statics.flow.release import held_by_upright_faces
from drystone.statics.joints import loose_blocks, slippery, with_head_friction
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import (
    LoadCase,
    Loads,
    growing_with_height,
    load_case,
    tilting_table,
    weight,
)
from drystone.statics.lp.extremes import Solver
from drystone.statics.model import GROUND, Interface
from drystone.statics.sensitivity import friction_curve, friction_sensitivity
from drystone_lab.statics_cases import arch
from tests.polygons import box_of
from tests.statics import walls
from tests.statics.walls import between_piers, boxes, brick_model, limit_load
from tests.strategies import repeatable


def test_head_joints_without_friction_weaken_a_bond_and_only_them():
    model = brick_model(6, 5, 1.0, 0.65)
    smooth = with_head_friction(model, 0.0)
    for before, after in zip(model.interfaces, smooth.interfaces, strict=True):
        assert after.mu == (0.0 if abs(before.normal[0]) == 1.0 else None)
    assert lateral_resistance(smooth).value < lateral_resistance(model).value - 1e-3


def test_blocks_that_nothing_carries():
    assert loose_blocks(boxes([0, 0, 3, 3], [5, 6, 3, 3], [8, 6, 4, 3])) == (2, 3)
    assert loose_blocks(boxes([0, 3, 1, 1], fixed=(1,))) == ()


def test_a_file_tells_the_friction_of_a_pair_of_head_joints_and_of_one_joint_which_wins():
    pair, friction = [[0, 0, 2, 1], [0, 1, 2, 1]], [{"between": [0, 1], "mu": 0.2}]
    model = model_from_json({"blocks_xywh": pair, "mu": 0.9, "friction": friction})
    assert {(i.block, i.other): i.mu for i in model.interfaces} == {(1, GROUND): 0.2, (2, 1): None}
    assert limit_load(model, "right").alpha == pytest.approx(0.2)
    upright = {"between": [2, 1], "points": [[1, 0], [1, 1]], "normal": [1, 0]}
    data = {"blocks_xywh": [[0, 0, 1, 1], [1, 0, 1, 1]], "mu_head": 0.1}
    assert [i.mu for i in model_from_json({**data, "interfaces": [upright]}).interfaces] == [0.1]
    own = {**upright, "mu": 0.9}
    assert [i.mu for i in model_from_json({**data, "interfaces": [own]}).interfaces] == [0.9]


def leaning(slope_deg, mu=0.58):
    """A face that rises so steeply, from the level."""
    angle = np.radians(slope_deg)
    normal = (-np.sin(angle), np.cos(angle))
    return Interface(2, 1, np.array([[0.0, 0.0], [1.0, 1.0]]), normal, mu)


@pytest.mark.parametrize("mu", [0.2, 0.58, 0.84, 1.0, 5.0])
def test_faces_within_the_friction_angle_of_the_vertical_are_slippery(mu):
    """There alone friction lifts what is under a face: mu |n_x| > |n_y|; never below 45 degrees."""
    limit = 90.0 - min(np.degrees(np.arctan(mu)), 45.0)
    for slope_deg, left in ((limit - 0.1, mu), (limit + 0.1, 0.0), (90.0, 0.0), (0.0, mu)):
        for turned in (slope_deg, -slope_deg, 180.0 - slope_deg):
            (found,) = slippery([leaning(turned, None)], mu)
            assert found.mu == left


def test_a_share_of_the_friction_stays_on_faces_less_steep_than_asked_for():
    faces = [leaning(70), leaning(80), leaning(20, 0.4), leaning(20, None)]
    found = slippery(faces, 0.6, steep=0.3, grip=0.5)
    assert [face.mu for face in found] == [0.29, 0.0, 0.2, 0.3]
    assert [face.normal for face in found] == [face.normal for face in faces]


@pytest.mark.parametrize(
    ("model", "named"),
    [
        *((walls.under_a_roof(slope_deg, 0.84), (2,)) for slope_deg in (0, 10, 25, 35)),
        (boxes(*([x, 0, 1, 4] for x in (0, 2, 4)), [1, 1, 1, 1], [3, 2, 1, 1]), (4, 5)),
        # Bonds, and a wedge that is carried by its weight.
        (brick_model(4, 4, 1.0, 0.3), ()),
        (walls.slot(-0.3, 0.3, 0.58), ()),
    ],
)
def test_all_blocks_are_named_that_hang_between_faces_or_under_them(model, named):
    assert held_by_upright_faces(model) == named


@pytest.mark.parametrize("solver", get_args(Solver))
def test_what_is_named_hangs_on_no_solver_nor_on_the_order_of_blocks(solver):
    """Bricks on a hanging one fall with it, and the piers stay, though they might be pushed."""
    piers = [0, 0, 1, 6], [2, 0, 1, 6]
    model = boxes(*piers, [1, 1, 1, 1], [1, 2, 1, 1], [1, 3, 1, 1])
    assert held_by_upright_faces(model, solver=solver) == (3, 4, 5)
    other = replace(model, blocks=model.blocks[::-1], interfaces=model.interfaces[::-1])
    assert held_by_upright_faces(other, solver=solver) == (5, 4, 3)


def test_an_arch_stands_by_friction_near_its_crown():
    """Joints near the keystone are upright; smooth ones carry one line of thrust only."""
    assert 8 in held_by_upright_faces(arch(15, 0.3, 0.5))


def test_the_dead_load_of_the_case_counts():
    """A smooth brick between piers rests where something carries its weight."""
    model = between_piers()
    table = tilting_table(model)
    lifted = table.dead * [[1], [1], [0]]
    assert held_by_upright_faces(model, Loads(lifted, table.live)) == ()


@pytest.mark.parametrize(("lean_deg", "named"), [(-20, (3,)), (20, (3,)), (40, ())])
def test_upright_is_what_gravity_makes_so(lean_deg, named):
    """A brick between piers that lean, drawn turned, with a tilt that turns gravity along."""
    for tilt_deg in (0, -20, 20):
        angle = np.radians(lean_deg - tilt_deg)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        boxed = [box_of(*row) for row in ([0, 9, 1, 3], [2, 9, 1, 3], [1, 10, 1, 1])]
        turned = enumerate(((box @ turn).tolist() for box in boxed), 1)
        blocks = [{"id": i, "polygon": p, "fixed": i < 3} for i, p in turned]
        case = LoadCase("tilting", tilt_deg, (), (), None)
        model, loads = load_case(case, model_from_json({"blocks": blocks, "mu": 0.6}))
        assert held_by_upright_faces(model, loads) == named


def test_friction_of_pairs_stays_on_other_faces():
    """A block on a bed of its own friction, tilted so that the model's would not do."""
    rows = [[0, 0, 4, 1], [0.5, 1, 1, 1]]
    friction = [{"between": pair, "mu": 0.5} for pair in ([2, 1], [1, 0])]
    model = model_from_json({"blocks_xywh": rows, "mu": 0.0, "friction": friction})
    table = tilting_table(model)
    pushed = Loads(table.dead + 0.3 * table.live * [[0.0], [1.0]], table.live)
    assert held_by_upright_faces(model, pushed) == ()


STEP = 1e-5


def sensitivity(model, direction, loads=None):
    return friction_sensitivity(model, limit_load(model, direction, loads, mechanism=True), loads)


def alpha_at(model, step, direction, loads=None):
    return limit_load(replace(model, mu=model.mu + step), direction, loads).alpha


def assert_slope(found, model, direction, loads=None):
    """Equal to the slope at a regular point; at a kink between those of both sides."""
    low, mid, high = (alpha_at(model, step, direction, loads) for step in (-STEP, 0, STEP))
    less, more = sorted(((mid - low) / STEP, (high - mid) / STEP))
    assert less - 1e-3 <= found <= more + 1e-3


@given(
    seed=st.integers(0, 10**6),
    direction=st.sampled_from(["left", "right"]),
    mu=st.sampled_from([0.3, 0.47, 0.61]),
    tilted=st.booleans(),
)
@repeatable(12)
def test_it_is_the_slope_of_alpha(seed, direction, mu, tilted):
    labels = walls.irregular(seed, 9, 90, 50) if tilted else walls.coursed(seed, 3, 70)
    model = model_from_labels(labels, mu).model
    assume(alpha_at(model, -STEP, direction) is not None)
    assert_slope(sensitivity(model, direction), model, direction)


def test_of_every_interface_it_is_the_slope_for_friction_there():
    model = brick_model(2, 2, 1.3, 0.43)
    faces = [replace(face, mu=0.35 + 0.04 * k) for k, face in enumerate(model.interfaces)]
    for k, face in enumerate(faces):
        others = *faces[:k], replace(face, mu=None), *faces[k + 1 :]
        wall = replace(model, mu=face.mu, interfaces=others)
        assert_slope(sensitivity(wall, "right"), wall, "right")


@pytest.mark.parametrize("direction", ["left", "right"])
def test_other_loads_than_the_tilting_table(direction):
    model = brick_model(3, 3, 0.5, 0.4)
    pushed = Loads(weight(model), 3.0 * weight(model)[:, [1, 0, 2]])
    for loads in (growing_with_height(model), pushed):
        found = sensitivity(model, direction, loads)
        assert found > 0.1
        assert_slope(found, model, direction, loads)


def test_a_result_without_mechanism_has_no_sensitivity():
    for model, mechanism, said in (
        (boxes([0, 0, 1, 2]), False, "mechanism and forces"),
        (boxes([0, 0, 1, 1], [0.8, 1, 1, 1]), True, "optimal"),
    ):
        with pytest.raises(ValueError, match=said):
            friction_sensitivity(model, limit_load(model, "right", mechanism=mechanism))


def test_a_block_slides_and_then_rocks_along_the_curve_and_what_falls_has_no_number_there():
    for at in friction_curve(boxes([0, 0, 1, 2])):
        assert (at.alpha_left, at.alpha_right) == pytest.approx((min(at.mu, 0.5),) * 2)
    leaning = boxes([0, 0, 1, 1], [0.8, 1, 1, 1])
    assert {at.alpha_left for at in friction_curve(leaning)} == {None}
