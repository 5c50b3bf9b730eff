"""Filled share of the rays against shooting them pixel by pixel (Eq. 4)."""

import numpy as np
import pytest
from hypothesis import given

from drystone.kernels.raster import Mask
from drystone.kernels.rays import RaySums, ray_pattern
from tests.naive import rays as naive
from tests.naive.placement import all_positions
from tests.strategies import landscapes, masks, repeatable


@repeatable(80)
@given(occupied=landscapes(14), mask=masks())
def test_filled_share_is_that_of_rays_shot_one_by_one(occupied: Mask, mask: Mask) -> None:
    at = [p for p in all_positions(occupied, mask) if not (_view(occupied, mask, p) & mask).any()]
    positions = np.array(at, np.int64).reshape(-1, 2)
    shares = RaySums(occupied).filled_share(
        ray_pattern(mask), mask.shape, positions[:, 0], positions[:, 1]
    )
    expected = [naive.local_filling_ratio(occupied, mask, *p) for p in at]
    assert shares == pytest.approx(expected, abs=1e-12)


def _view(occupied: Mask, mask: Mask, at: tuple[int, int]) -> Mask:
    return occupied[at[0] : at[0] + mask.shape[0], at[1] : at[1] + mask.shape[1]]


def test_rays_go_left_and_down_only() -> None:
    mask = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], bool)
    pattern = ray_pattern(mask)
    swept = {
        (int(row), col)
        for row, start, stop in zip(pattern.rows, pattern.starts, pattern.stops, strict=True)
        for col in range(start, stop)
    }
    assert swept == {(0, 0), (2, 0), (2, 2)}
    assert pattern.area == 3
