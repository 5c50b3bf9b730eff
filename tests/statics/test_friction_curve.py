"""The load multiplier over friction."""

import pytest

from drystone.contacts.given import model_from_json
from drystone.statics.sensitivity import friction_curve


def test_a_block_slides_and_then_rocks():
    block = model_from_json({"blocks_xywh": [[0, 0, 1, 2]]})
    for at in friction_curve(block):
        assert at.alpha_left == pytest.approx(min(at.mu, 0.5))
        assert at.alpha_right == pytest.approx(min(at.mu, 0.5))


def test_a_wall_that_does_not_stand_has_no_number():
    leaning = model_from_json({"blocks_xywh": [[0, 0, 1, 1], [0.8, 1, 1, 1]]})
    assert {at.alpha_left for at in friction_curve(leaning)} == {None}
