"""What rays meet: compiled and NumPy against shooting them pixel by pixel (Eq. 4)."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.lowering import Positions, skyline_numpy
from drystone.kernels.raster import Mask
from drystone.kernels.rays import RaySums, RaySumsNumpy, ray_sums
from drystone.kernels.silhouette import silhouette
from tests.naive import placement, rays
from tests.strategies import landscapes, masks, repeatable

absent = pytest.mark.skipif(compiled("rays") is None, reason="kernels are not compiled here")
twins = pytest.mark.parametrize(
    "sums_of",
    [
        pytest.param(RaySumsNumpy, id="numpy"),
        pytest.param(ray_sums, id="compiled", marks=absent),
    ],
)
SumsOf = Callable[[Mask, int], RaySums]


def positions_of(occupied: Mask, mask: Mask) -> Positions:
    return np.array(placement.all_positions(occupied, mask), np.int64).reshape(-1, 2)


def first_row(occupied: Mask) -> int:
    return int(skyline_numpy(occupied).min())


@twins
def test_filled_share_is_that_of_rays_shot_one_by_one(sums_of: SumsOf) -> None:
    @repeatable(80)
    @given(occupied=landscapes(14), mask=masks())
    def check(occupied: Mask, mask: Mask) -> None:
        positions, outline = positions_of(occupied, mask), silhouette(mask)
        sums = sums_of(occupied, first_row(occupied))
        expected = [rays.local_filling_ratio(occupied, mask, *at) for at in positions.tolist()]
        # A share is one division of whole numbers: nothing is rounded twice.
        assert sums.filled_share(outline, positions).tolist() == expected
        at_once = [sums.filled_share_at(outline, *at) for at in positions.tolist()]
        assert at_once == expected

    check()


@twins
def test_empty_beside_is_counted_pixel_by_pixel(sums_of: SumsOf) -> None:
    @repeatable(80)
    @given(occupied=landscapes(14), mask=masks())
    def check(occupied: Mask, mask: Mask) -> None:
        positions = positions_of(occupied, mask)
        sums = sums_of(occupied, first_row(occupied))
        expected = [placement.gap_beside(occupied, mask, tuple(at)) for at in positions.tolist()]
        assert sums.empty_beside(silhouette(mask), positions).tolist() == expected

    check()


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
    fast, slow = ray_sums(scene, first_row(scene)), RaySumsNumpy(scene, first_row(scene))
    outline = silhouette(mask)
    assert np.array_equal(fast.filled_share(outline, at), slow.filled_share(outline, at))
    assert np.array_equal(fast.empty_beside(outline, at), slow.empty_beside(outline, at))
    assert (fast.height, fast.width) == (slow.height, slow.width) == scene.shape


@twins
def test_high_walls(sums_of: SumsOf) -> None:
    occupied = np.ones((602, 5), bool)
    occupied[:2] = occupied[300] = False
    found = sums_of(occupied, 2).filled_share(silhouette(np.ones((2, 2), bool)), np.array([[0, 3]]))
    assert found.tolist() == [2 * 599 / (2 * 600 + 2 * 3)]


@twins
def test_no_position_is_no_share(sums_of: SumsOf) -> None:
    none = np.zeros((0, 2), np.int64)
    sums, outline = sums_of(np.eye(3, dtype=bool), 0), silhouette(np.ones((2, 2), bool))
    assert sums.filled_share(outline, none).shape == (0,)
    assert sums.empty_beside(outline, none).shape == (0,)


@absent
@pytest.mark.parametrize("at", [(-1, 0), (0, -1), (2, 0), (0, 3)])
def test_compiled_code_does_not_read_outside_the_image(at: tuple[int, int]) -> None:
    sums, outline = ray_sums(np.ones((3, 4), bool), 0), silhouette(np.ones((2, 2), bool))
    with pytest.raises(IndexError, match="leaves"):
        sums.filled_share_at(outline, *at)
    with pytest.raises(IndexError, match="leaves"):
        sums.filled_share(outline, np.array([[0, 0], at]))
    with pytest.raises(IndexError, match="leaves"):
        sums.empty_beside(outline, np.array([[0, 0], at]))
