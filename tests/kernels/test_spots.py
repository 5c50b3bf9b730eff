"""What rays meet, and the first of merits against all sorted (§3.6).

Where masks rest, and the best of these places by each rule, is in tests/placement.
"""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.bits import bit_landscape
from drystone.kernels.lowering import skyline
from drystone.kernels.rays import RaySums
from drystone.kernels.silhouette import silhouette
from drystone.kernels.spots import Eq12, best, best_by_eq12, threshold
from tests.naive import placement as naive
from tests.naive.rays import local_filling_ratio
from tests.strategies import landscapes, masks, repeatable


@repeatable(80)
@given(occupied=landscapes(14), mask=masks())
def test_shares_and_gaps_are_those_of_rays_shot_one_by_one(occupied, mask):
    at = naive.all_positions(occupied, mask)
    positions = np.array(at, np.int64).reshape(-1, 2)
    outline, sums = silhouette(mask), RaySums(occupied)
    expected = [local_filling_ratio(occupied, mask, *place) for place in at]
    # A share is one division of whole numbers: nothing is rounded twice.
    assert sums.filled_share(outline, positions).tolist() == expected
    gaps = [naive.gap_beside(occupied, mask, place) for place in at]
    assert sums.empty_beside(outline, positions).tolist() == gaps


def test_high_walls():
    occupied = np.ones((602, 5), bool)
    occupied[:2] = occupied[300] = False
    block = silhouette(np.ones((2, 2), bool))
    found = RaySums(occupied).filled_share(block, np.array([[0, 3]]))
    assert found.tolist() == [2 * 599 / (2 * 600 + 2 * 3)]


def test_the_threshold_itself_counts_as_below():
    assert threshold(np.array([0.0, 0.7, 0.7000001, 1.0]), 0.7).tolist() == [0, 0, 0.7000001, 1.0]


def test_a_place_further_on_is_not_passed_over_when_its_rays_are_all_filled():
    occupied = np.zeros((20, 100), bool)
    occupied[5:, :50] = occupied[10:, :] = occupied[:, 99] = True
    # Voids under the upper step, in whose corner is the most promising place.
    occupied[10:19, :40] = np.arange(40) % 10 == 5
    outline = silhouette(np.ones((5, 10), bool))
    positions = bit_landscape(occupied, skyline(occupied)).resting(outline)
    (place,) = best_by_eq12(positions, outline, RaySums(occupied), Eq12(15, 5.0, 0.7), 1)
    assert (place.row, place.col) == (5, 50)
    assert place.merit == round((1 + 1 - 0.55) * 1e12)


@repeatable(100)
@given(data=st.data(), tries=st.integers(1, 9))
def test_the_best_are_the_first_of_all_sorted(data, tries):
    worth = st.sampled_from([0.0, 0.5, 0.5 + 1e-14, 0.5 + 1e-11, 1.0])
    at = sorted(data.draw(st.sets(st.tuples(st.integers(0, 3), st.integers(0, 3)), min_size=1)))
    merits = {p: data.draw(worth) for p in at}
    arrays = np.array([merits[p] for p in at]), np.array(at)
    ranked = sorted(at, key=lambda p: (-round(merits[p], 12), -p[0], p[1]))
    assert [(row, col) for _, row, col in best(*arrays, tries)] == ranked[:tries]
    ranked = sorted(at, key=lambda p: (-p[0], -round(merits[p], 12), p[1]))
    lowest = best(*arrays, tries, lowest_first=True)
    assert [(row, col) for _, row, col in lowest] == ranked[:tries]
    assert all(merit == round(merits[row, col] * 1e12) for merit, row, col in lowest)
