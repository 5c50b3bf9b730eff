"""The load multiplier over friction."""

from dataclasses import replace
from itertools import pairwise

import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.statics.friction_curve import USUAL, friction_curve
from drystone.statics.limit import lateral_resistance
from tests.statics.walls import coursed


def test_a_block_slides_and_then_rocks() -> None:
    block = model_from_json({"blocks_xywh": [[0, 0, 1, 2]]})
    for at in friction_curve(block):
        assert at.alpha_left == pytest.approx(min(at.mu, 0.5))
        assert at.alpha_right == pytest.approx(min(at.mu, 0.5))


def test_it_is_the_analysis_at_each_coefficient() -> None:
    model = model_from_labels(coursed(seed=3, courses=4, length_px=90)).model
    curve = friction_curve(model)
    assert [at.mu for at in curve] == list(USUAL)
    for at in curve[::4]:
        both = lateral_resistance(replace(model, mu=at.mu))
        assert (at.alpha_left, at.alpha_right) == (both.left.alpha, both.right.alpha)
    assert all(a.alpha_left <= b.alpha_left + 1e-9 for a, b in pairwise(curve))


def test_a_wall_that_does_not_stand_has_no_number() -> None:
    leaning = model_from_json({"blocks_xywh": [[0, 0, 1, 1], [0.8, 1, 1, 1]]})
    assert friction_curve(leaning, mus=(0.5,))[0].alpha_left is None
