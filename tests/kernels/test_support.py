"""Where a mask stands and comes to rest, against walking pixel by pixel."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.raster import Mask
from drystone.kernels.support import Ends, resting_place, support_ends
from tests.naive import support as naive
from tests.naive.overlap import overlaps
from tests.naive.placement import all_positions
from tests.strategies import landscapes, masks, repeatable


def flat(ends: naive.Ends | None) -> Ends | None:
    return None if ends is None else (ends[0][0], ends[1][0], ends[0][1], ends[1][1])


@repeatable(100)
@given(data=st.data(), occupied=landscapes(14), mask=masks())
def test_support_ends_are_those_of_every_pixel_on_its_own(
    data: st.DataObject, occupied: Mask, mask: Mask
) -> None:
    free = [at for at in all_positions(occupied, mask) if not overlaps(occupied, mask, *at)]
    if free:
        at = data.draw(st.sampled_from(free))
        assert support_ends(occupied, mask, *at) == flat(naive.support_ends(occupied, mask, *at))


@repeatable(150)
@given(
    occupied=landscapes(14),
    mask=masks(),
    row=st.integers(-4, 16),
    col=st.integers(-2, 16),
    reach=st.integers(0, 4),
)
def test_a_mask_rests_in_the_nearest_row_that_a_walk_finds(
    occupied: Mask, mask: Mask, row: int, col: int, reach: int
) -> None:
    expected = naive.resting_row(occupied, mask, row, col, reach)
    place = resting_place(occupied, mask, row, col, reach)
    if expected is None:
        assert place is None
    else:
        ends = flat(naive.support_ends(occupied, mask, expected, col))
        assert place == (expected, ends)


@repeatable(100)
@given(occupied=landscapes(14), mask=masks(), row=st.integers(-2, 16), col=st.integers(0, 10))
def test_views_in_any_direction_are_read_in_place(
    occupied: Mask, mask: Mask, row: int, col: int
) -> None:
    """A mirrored view has negative strides, a window gaps between its rows."""
    frame = np.pad(occupied, ((0, 0), (2, 3)), constant_values=True)
    window, mirrored = frame[:, 2:-3], frame[:, ::-1][:, 3:-2]
    turned = np.asfortranarray(mask)
    place = resting_place(window, turned, row, col, 3)
    assert place == resting_place(occupied, mask, row, col, 3)
    other_col = occupied.shape[1] - col - mask.shape[1]
    other = resting_place(mirrored, mask[:, ::-1], row, other_col, 3)
    assert (other is None) == (place is None)
    if other is not None and place is not None:
        (left, right, left_row, right_row), width = place[1], occupied.shape[1]
        assert other == (place[0], (width - right, width - left, right_row, left_row))


def test_one_pixel_on_a_site_of_one_pixel() -> None:
    site, pixel = np.zeros((1, 1), bool), np.ones((1, 1), bool)
    assert support_ends(site, pixel, 0, 0) == (0, 1, 1, 1)
    assert resting_place(site, pixel, 0, 0, 0) == (0, (0, 1, 1, 1))
    assert resting_place(~site, pixel, 0, 0, 5) is None
    assert resting_place(site, pixel, 0, 1, 5) is None
    assert resting_place(site, pixel, 0, -1, 5) is None
    assert resting_place(site, np.ones((2, 1), bool), 0, 0, 5) is None


def test_the_nearest_row_that_rests_is_taken() -> None:
    occupied = np.zeros((24, 50), bool)
    occupied[20:, :14] = True

    def row_from(row: int, col: int) -> int | None:
        place = resting_place(occupied, np.ones((3, 5), bool), row, col, 3)
        return None if place is None else place[0]

    assert [row_from(row, 2) for row in (17, 15, 19, 13)] == [17, 17, 17, None]
    assert [row_from(row, 20) for row in (19, 23)] == [21, 21]  # on the ground
    assert [row_from(21, col) for col in (-1, 46)] == [None, None]


def test_of_the_pixels_of_a_column_the_lowest_counts() -> None:
    hook = np.array([[1, 1, 1], [0, 1, 0], [1, 1, 1]], bool)
    occupied = np.zeros((3, 3), bool)
    occupied[1, [0, 2]] = True
    assert support_ends(occupied, hook, 0, 0) == (0, 3, 3, 3)
    deeper = np.vstack([occupied, np.zeros((1, 3), bool)])
    assert support_ends(deeper, hook, 0, 0) == (0, 3, 1, 1)


@pytest.mark.parametrize(
    ("occupied_rows", "row", "found"),
    [
        ([3, 4, 5, 6, 8], 5, 7),  # two rows down
        ([4], 5, 3),  # two rows up, past what is in the way
        ([3, 4, 5, 6, 7], 5, None),
        ([1, 2, 3, 4, 5, 6, 7, 9], 5, None),  # three rows down
    ],
)
def test_rows_further_away_are_reached_past_others(
    occupied_rows: list[int], row: int, found: int | None
) -> None:
    occupied = np.zeros((20, 1), bool)
    occupied[occupied_rows] = True
    place = resting_place(occupied, np.ones((1, 1), bool), row, 0, 2)
    assert (place and place[0]) == found


def test_of_two_rows_equally_far_the_lower_one_is_taken() -> None:
    occupied = np.zeros((9, 3), bool)
    occupied[4] = True
    pixel = np.ones((1, 3), bool)
    assert resting_place(occupied, pixel, 4, 0, 1) == (3, (0, 3, 4, 4))
    occupied[6] = True
    assert resting_place(occupied, pixel, 4, 0, 1) == (5, (0, 3, 6, 6))
    assert resting_place(occupied, pixel, 4, 0, 0) is None


@pytest.mark.parametrize("at", [(-1, 0), (0, -1), (3, 0), (0, 4)])
def test_a_mask_outside_is_refused(at: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match="leaves the landscape"):
        support_ends(np.zeros((4, 5), bool), np.ones((2, 2), bool), *at)
