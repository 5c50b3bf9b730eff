"""A stone far lighter than the others falls at its own load, not at that of the wall."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.extremes import units_of_light_blocks
from drystone.statics.lp.program import assemble
from drystone.statics.result import LimitStatus
from tests.statics.walls import boxes, coursed
from tests.strategies import repeatable


@given(
    side=st.floats(100, 1500), height=st.floats(1.8, 3), solver=st.sampled_from(["highs", "auto"])
)
@repeatable(20)
def test_a_speck_on_a_block_overturns_by_its_own_shape(side, height, solver):
    model = model_from_json({"blocks_xywh": [[0, 0, side, side], [side / 3, side, 1, height]]})
    both = lateral_resistance(model, solver=solver, mechanism=True)
    assert (both.left.alpha, both.right.alpha) == pytest.approx((1 / height, 1 / height), rel=1e-6)
    # Alone, and turning: the large one stays.
    speed = np.abs(both.right.mechanism.velocity)
    assert speed[0].max() < 1e-6 * speed[1].max()


def test_a_speck_that_stands_on_nothing_brings_the_wall_down():
    model = model_from_json({"blocks_xywh": [[0, 0, 900, 900], [899.6, 900, 1, 2]]})
    assert lateral_resistance(model).left.status is LimitStatus.UNSTABLE


@pytest.mark.parametrize("count", [3, 10])
def test_slivers_under_a_heavy_block_have_an_answer(count):
    thin = 3e-6 * 50
    slivers = [[0, thin * k, 100, thin] for k in range(count)]
    model = model_from_json({"blocks_xywh": [*slivers, [0, thin * count, 100, 50]]})
    both = lateral_resistance(model)
    assert (both.left.alpha, both.right.alpha) == pytest.approx((0.58, 0.58))


def test_what_weighs_nothing_falls_at_no_load_of_its_own():
    model = boxes([0, 0, 9, 9], [8, 9, 2, 2])
    for density in (0.0, 1e-12):
        weightless = replace(model.blocks[1], density=density)
        both = lateral_resistance(replace(model, blocks=(model.blocks[0], weightless)))
        assert (both.left.alpha, both.right.alpha) == pytest.approx((0.58, 0.58))


def test_walls_of_like_stones_have_the_units_of_the_wall():
    model = model_from_labels(coursed(3, 3, 60)).model
    assert units_of_light_blocks(model, assemble(model)) is None
