from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.statics.loads import Loads, growing_with_height, weight
from drystone.statics.sensitivity import friction_curve, friction_sensitivity
from tests.statics.walls import boxes, brick_model, coursed, irregular, limit_load, stacked
from tests.strategies import repeatable

STEP = 1e-5


def sensitivity(model, direction, loads=None):
    return friction_sensitivity(model, limit_load(model, direction, loads, mechanism=True), loads)


def everywhere(model, step):
    return replace(model, mu=model.mu + step)


def assert_slope(found, model, direction, changed, loads=None):
    """Equal to the slope at a regular point; at a kink between those of both sides."""
    low, mid, high = (
        limit_load(changed(model, step), direction, loads).alpha for step in (-STEP, 0, STEP)
    )
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
    labels = irregular(seed, 9, 90, 50) if tilted else coursed(seed, 3, 70)
    model = model_from_labels(labels, mu).model
    assume(limit_load(everywhere(model, -STEP), direction).success)
    assert_slope(sensitivity(model, direction), model, direction, everywhere)


def test_of_every_interface_it_is_the_slope_for_friction_there():
    model = brick_model(2, 2, 1.3, 0.43)
    faces = [replace(face, mu=0.35 + 0.04 * k) for k, face in enumerate(model.interfaces)]
    for k, face in enumerate(faces):
        others = *faces[:k], replace(face, mu=None), *faces[k + 1 :]
        wall = replace(model, mu=face.mu, interfaces=others)
        assert_slope(sensitivity(wall, "right"), wall, "right", everywhere)


@pytest.mark.parametrize("direction", ["left", "right"])
def test_other_loads_than_the_tilting_table(direction):
    model = brick_model(3, 3, 0.5, 0.4)
    for loads in (
        growing_with_height(model),
        Loads(weight(model), 3.0 * weight(model)[:, [1, 0, 2]]),
    ):
        found = sensitivity(model, direction, loads)
        assert found > 0.1
        assert_slope(found, model, direction, everywhere, loads)


def test_a_result_without_mechanism_has_no_sensitivity():
    model = brick_model(2, 2, 1.0, 0.5)
    with pytest.raises(ValueError, match="mechanism and forces"):
        friction_sensitivity(model, limit_load(model, "right"))
    falls = model_from_labels(stacked((20, 20, 0), (20, 20, 12))).model
    with pytest.raises(ValueError, match="optimal"):
        friction_sensitivity(falls, limit_load(falls, "right", mechanism=True))


def test_a_block_slides_and_then_rocks_along_the_curve():
    for at in friction_curve(boxes([0, 0, 1, 2])):
        assert at.alpha_left == pytest.approx(min(at.mu, 0.5))
        assert at.alpha_right == pytest.approx(min(at.mu, 0.5))


def test_a_wall_that_does_not_stand_has_no_number_on_the_curve():
    leaning = boxes([0, 0, 1, 1], [0.8, 1, 1, 1])
    assert {at.alpha_left for at in friction_curve(leaning)} == {None}
