import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.errors import InputError
from drystone.statics.joints import loose_blocks, slippery, with_head_friction
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, Interface
from tests.polygons import box
from tests.statics.walls import brick_model, limit_load

PAIR = [[0, 0, 2, 1], [0, 1, 2, 1]]


def test_head_joints_without_friction_weaken_a_bond_and_only_them():
    model = brick_model(6, 5, 1.0, 0.65)
    slippery = with_head_friction(model, 0.0)
    for before, after in zip(model.interfaces, slippery.interfaces, strict=True):
        assert after.mu == (0.0 if abs(before.normal[0]) == 1.0 else None)
    assert lateral_resistance(slippery).value < lateral_resistance(model).value - 1e-3


def test_friction_of_a_pair_from_a_file():
    data = {"blocks_xywh": PAIR, "mu": 0.9, "friction": [{"between": [1, 2], "mu": 0.3}]}
    assert limit_load(model_from_json(data), "right").alpha == pytest.approx(0.3)
    data["friction"] = [{"between": [0, 1], "mu": 0.2}]
    model = model_from_json(data)
    assert {(i.block, i.other): i.mu for i in model.interfaces} == {(1, GROUND): 0.2, (2, 1): None}


def test_interfaces_from_a_file_are_taken_as_they_are():
    data = {
        "blocks_xywh": PAIR,
        "mu": 0.9,
        "interfaces": [
            {"between": [1, 0], "points": [[0, 0], [2, 0]], "normal": [0, 2]},
            {"between": [2, 1], "points": [[0.5, 1], [1.5, 1]], "normal": [0, 1], "mu": 0.8},
        ],
    }
    model = model_from_json(data)
    assert [i.normal for i in model.interfaces] == [(0, 1), (0, 1)]
    # The upper block turns about x = 1.5: arm .5 at height .5 above the joint; mu is .8 there.
    assert limit_load(model, "right").alpha == pytest.approx(0.8)
    data["interfaces"][1]["mu"] = 5.0
    assert limit_load(model_from_json(data), "right").alpha == pytest.approx(0.9)
    data["mu"] = 5.0
    assert limit_load(model_from_json(data), "right").alpha == pytest.approx(1.0)


def test_a_guide_from_a_file():
    tall = {"id": 1, "polygon": [[0, 0], [1, 0], [1, 4], [0, 4]], "held": ["turn"]}
    assert limit_load(model_from_json({"blocks": [tall]}), "left").alpha == pytest.approx(0.58)


def test_weights_that_no_solver_tells_from_rounding_are_refused():
    heavy = [{"id": i, "polygon": box(i, 0, i + 1, 1).tolist()} for i in (1, 5)]
    heavy[1]["density"] = 1e7
    with pytest.raises(InputError, match="E303"):
        model_from_json({"blocks": heavy})
    heavy[1]["fixed"] = True
    assert len(model_from_json({"blocks": heavy}).blocks) == 2


def test_blocks_that_nothing_carries():
    labels = np.zeros((9, 12), np.uint32)
    labels[6:, :3], labels[:3, 5:8], labels[0:3, 8:] = 1, 2, 3
    model = model_from_labels(labels).model
    assert loose_blocks(model) == (2, 3)
    fixed = {"blocks": [{"id": 4, "polygon": [[0, 3], [1, 3], [1, 4]], "fixed": True}]}
    assert loose_blocks(model_from_json(fixed)) == ()


def test_what_is_said_of_one_joint_wins_over_what_is_said_of_all_head_joints():
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
