"""What rays meet, against shooting them pixel by pixel (Eq. 4)."""

import numpy as np
from hypothesis import given

from drystone.kernels.rays import RaySums
from drystone.kernels.silhouette import silhouette
from tests.naive import placement, rays
from tests.strategies import landscapes, masks, repeatable


@repeatable(80)
@given(occupied=landscapes(14), mask=masks())
def test_shares_and_gaps_are_those_of_rays_shot_one_by_one(occupied, mask):
    at = placement.all_positions(occupied, mask)
    positions = np.array(at, np.int64).reshape(-1, 2)
    outline, sums = silhouette(mask), RaySums(occupied)
    expected = [rays.local_filling_ratio(occupied, mask, *place) for place in at]
    # A share is one division of whole numbers: nothing is rounded twice.
    assert sums.filled_share(outline, positions).tolist() == expected
    gaps = [placement.gap_beside(occupied, mask, place) for place in at]
    assert sums.empty_beside(outline, positions).tolist() == gaps


def test_high_walls():
    occupied = np.ones((602, 5), bool)
    occupied[:2] = occupied[300] = False
    block = silhouette(np.ones((2, 2), bool))
    found = RaySums(occupied).filled_share(block, np.array([[0, 3]]))
    assert found.tolist() == [2 * 599 / (2 * 600 + 2 * 3)]
