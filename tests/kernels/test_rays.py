"""What rays meet, against shooting them pixel by pixel (Eq. 4)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from drystone.kernels import rays as module
from drystone.kernels.backend import compiled
from drystone.kernels.lowering import skyline
from drystone.kernels.raster import Mask
from drystone.kernels.rays import RaySums, ray_sums
from drystone.kernels.silhouette import silhouette
from tests.kernels.twins import both_ways
from tests.naive import placement, rays
from tests.strategies import landscapes, masks, repeatable

kernel = both_ways(module)
absent = pytest.mark.skipif(compiled("rays") is None, reason="kernels are not compiled here")


@repeatable(80)
@given(occupied=landscapes(14), mask=masks())
def test_shares_and_gaps_are_those_of_rays_shot_one_by_one(occupied: Mask, mask: Mask) -> None:
    positions = np.array(placement.all_positions(occupied, mask), np.int64).reshape(-1, 2)
    outline, sums = silhouette(mask), ray_sums(occupied, int(skyline(occupied).min()))
    at = positions.tolist()
    expected = [rays.local_filling_ratio(occupied, mask, *place) for place in at]
    # A share is one division of whole numbers: nothing is rounded twice.
    assert sums.filled_share(outline, positions).tolist() == expected
    assert [sums.filled_share_at(outline, *place) for place in at] == expected
    gaps = [placement.gap_beside(occupied, mask, tuple(place)) for place in at]
    assert sums.empty_beside(outline, positions).tolist() == gaps


@absent
@repeatable(60)
@given(
    occupied=landscapes(16),
    mask=masks(),
    wide=st.integers(1, 20),
    high=st.sampled_from([1, 3, 20]),
    seed=st.integers(0, 99),
)
def test_both_twins_agree_on_large_images(
    occupied: Mask, mask: Mask, wide: int, high: int, seed: int
) -> None:
    scene = np.repeat(np.repeat(occupied, high, axis=0), wide, axis=1)
    free = np.subtract(scene.shape, mask.shape)
    if (free < 0).any():
        return
    at: NDArray[np.int64] = np.random.default_rng(seed).integers(0, free + 1, (30, 2))
    first, outline = int(skyline(scene).min()), silhouette(mask)
    fast, slow = ray_sums(scene, first), RaySums(scene, first)
    assert np.array_equal(fast.filled_share(outline, at), slow.filled_share(outline, at))
    assert np.array_equal(fast.empty_beside(outline, at), slow.empty_beside(outline, at))
    assert (fast.height, fast.width) == (slow.height, slow.width) == scene.shape


def test_high_walls() -> None:
    occupied = np.ones((602, 5), bool)
    occupied[:2] = occupied[300] = False
    block = silhouette(np.ones((2, 2), bool))
    found = ray_sums(occupied, 2).filled_share(block, np.array([[0, 3]]))
    assert found.tolist() == [2 * 599 / (2 * 600 + 2 * 3)]


def test_no_position_is_no_share() -> None:
    none = np.zeros((0, 2), np.int64)
    sums, outline = ray_sums(np.eye(3, dtype=bool), 0), silhouette(np.ones((2, 2), bool))
    assert sums.filled_share(outline, none).shape == (0,)
    assert sums.empty_beside(outline, none).shape == (0,)


@absent
@pytest.mark.parametrize("at", [(-1, 0), (0, -1), (2, 0), (0, 3)])
def test_compiled_code_does_not_read_outside_the_image(at: tuple[int, int]) -> None:
    fast = compiled("rays")
    assert fast is not None
    sums, outline = fast.RaySums(np.ones((3, 4), bool), 0), silhouette(np.ones((2, 2), bool))
    with pytest.raises(IndexError, match="leaves"):
        sums.filled_share_at(outline, *at)
    for asked in (sums.filled_share, sums.empty_beside):
        with pytest.raises(IndexError, match="leaves"):
            asked(outline, np.array([[0, 0], at]))
