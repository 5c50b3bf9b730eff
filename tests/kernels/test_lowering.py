"""Lowering from above, against going down pixel by pixel (§3.6)."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.lowering import lowered_positions, skyline
from drystone.kernels.silhouette import silhouette
from tests.naive import placement as naive
from tests.strategies import landscapes, masks, repeatable


@repeatable(100)
@given(occupied=landscapes(30))
def test_the_skyline_is_that_of_the_columns(occupied):
    height = occupied.shape[0]
    tops = [next((r for r in range(height) if col[r]), height) for col in occupied.T]
    assert skyline(occupied).tolist() == tops
    assert skyline(occupied).dtype == np.int32


@repeatable(120)
@given(occupied=landscapes(14), mask=masks(), clearance=st.integers(0, 3))
def test_a_mask_comes_to_rest_as_pixel_by_pixel(occupied, mask, clearance):
    found = lowered_positions(skyline(occupied), silhouette(mask), occupied.shape[0], clearance)
    assert found.dtype == np.int64
    assert found.flags.c_contiguous
    expected = naive.positions_from_above(occupied, mask, clearance)
    assert found.tolist() == [list(at) for at in expected]
