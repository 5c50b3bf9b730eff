"""Feasible positions (§3.6, Fig. 8, DESIGN 4.4)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.placement.feasible import can_be_lowered, feasible_positions
from drystone.poses import PoseBook
from tests.naive import placement as naive
from tests.strategies import landscapes, masks, repeatable


def found(occupied, mask, reach="any", clearance=0):
    posed = PoseBook().pose(Stone(1, mask), 0.0)
    positions = feasible_positions(Landscape(occupied, ()), posed, reach, clearance)
    return [list(at) for at in positions.tolist()]


@repeatable(80)
@given(occupied=landscapes(14), mask=masks())
def test_any_position_that_is_free_and_one_pixel_lower_is_not(occupied, mask):
    resting = [list(at) for at in naive.resting_positions(occupied, mask)]
    assert found(occupied, mask) == resting


@repeatable(80)
@given(occupied=landscapes(14), mask=masks())
def test_from_above_is_where_a_lowered_stone_comes_to_rest(occupied, mask):
    lowered = [list(at) for at in naive.positions_from_above(occupied, mask)]
    assert found(occupied, mask, "above") == lowered


@pytest.mark.parametrize("reach", ["any", "above"])
def test_a_stone_larger_than_the_site_fits_nowhere(reach):
    occupied = np.zeros((4, 6), bool)
    assert found(occupied, np.ones((5, 2), bool), reach) == []
    assert found(occupied, np.ones((2, 7), bool), reach) == []


@repeatable()
@given(landscapes(), masks(), st.integers(0, 3))
def test_what_can_be_lowered_is_what_reach_above_finds(occupied, mask, clearance):
    landscape = Landscape(occupied, ())
    posed = PosedStone(Stone(1, mask), 0.0, 1.0, mask.copy(), (0.5, 0.5))
    lowered = {tuple(p) for p in feasible_positions(landscape, posed, "above", clearance).tolist()}
    for row, col in feasible_positions(landscape, posed, "any").tolist():
        assert can_be_lowered(landscape, posed, row, col, clearance) == ((row, col) in lowered)
