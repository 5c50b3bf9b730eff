"""Lowering from above: compiled and NumPy against going down pixel by pixel (§3.6)."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.backend import compiled
from drystone.kernels.lowering import (
    Positions,
    lowered_positions,
    lowered_positions_numpy,
    skyline,
    skyline_numpy,
)
from drystone.kernels.raster import Mask
from drystone.kernels.silhouette import Ints, silhouette
from tests.naive import placement as naive
from tests.strategies import landscapes, masks, repeatable

absent = pytest.mark.skipif(compiled("lowering") is None, reason="kernels are not compiled here")


@pytest.mark.parametrize(
    "tops_of",
    [
        pytest.param(skyline_numpy, id="numpy"),
        pytest.param(skyline, id="compiled", marks=absent),
    ],
)
def test_the_skyline_is_that_of_the_columns(tops_of: Callable[[Mask], Ints]) -> None:
    @repeatable(150)
    @given(occupied=landscapes(30))
    def check(occupied: Mask) -> None:
        height = occupied.shape[0]
        tops = [next((r for r in range(height) if col[r]), height) for col in occupied.T]
        assert tops_of(occupied).tolist() == tops
        assert tops_of(occupied).dtype == np.int32

    check()


@pytest.mark.parametrize(
    "lower",
    [
        pytest.param(lowered_positions_numpy, id="numpy"),
        pytest.param(lowered_positions, id="compiled", marks=absent),
    ],
)
def test_a_mask_comes_to_rest_as_pixel_by_pixel(lower: Callable[..., Positions]) -> None:
    @repeatable(150)
    @given(occupied=landscapes(14), mask=masks(), clearance=st.integers(0, 3))
    def check(occupied: Mask, mask: Mask, clearance: int) -> None:
        top = skyline_numpy(occupied)
        found = lower(top, silhouette(mask), occupied.shape[0], clearance)
        assert found.dtype == np.int64
        assert found.flags.c_contiguous
        expected = naive.positions_from_above(occupied, mask, clearance)
        assert found.tolist() == [list(at) for at in expected]

    check()
