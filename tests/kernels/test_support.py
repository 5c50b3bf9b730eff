"""Where a mask stands and rests, and what is free around it, against walking pixel by pixel."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from drystone.kernels.support import (
    free_below,
    free_beside,
    gap_filling,
    resting_place,
    support_ends,
)
from tests.naive import support as naive
from tests.naive.overlap import overlaps
from tests.naive.placement import all_positions, gap_beside, void_below
from tests.naive.support import gap_pixels
from tests.strategies import landscapes, masks, repeatable


@st.composite
def seen(draw, arrays):
    """The same pixels as they lie, by columns, as a window of a frame, or read backwards."""
    array, way = draw(arrays), draw(st.sampled_from(["rows", "columns", "window", "backwards"]))
    if way == "columns":
        return np.asfortranarray(array)
    if way == "window":
        return np.pad(array, ((0, 0), (2, 3)), constant_values=True)[:, 2:-3]
    return np.ascontiguousarray(array[:, ::-1])[:, ::-1] if way == "backwards" else array


pictures, stones = seen(landscapes(14)), seen(masks())


@st.composite
def bars_over_columns(draw):
    """A bar at the top of columns of many heights."""
    free = draw(st.lists(st.integers(1, 5), min_size=1, max_size=8))
    occupied = np.arange(1 + max(free))[:, None] > np.array(free)
    return occupied, np.ones((1, len(free)), bool), (0, 0)


@st.composite
def free_places(draw):
    """A landscape, a mask, and where it overlaps nothing."""
    occupied, mask = draw(pictures), draw(stones)
    free = [at for at in all_positions(occupied, mask) if not overlaps(occupied, mask, *at)]
    assume(free)
    return occupied, mask, draw(st.sampled_from(free))


@repeatable(80)
@given(free_places())
def test_support_ends_are_those_of_every_pixel_on_its_own(scene):
    occupied, mask, at = scene
    assert support_ends(occupied, mask, *at) == naive.support_ends(occupied, mask, *at)


@repeatable(150)
@given(
    occupied=pictures,
    mask=stones,
    row=st.integers(-4, 16),
    col=st.integers(-2, 16),
    reach=st.integers(0, 4),
)
def test_a_mask_rests_in_the_nearest_row_that_a_walk_finds(occupied, mask, row, col, reach):
    expected = naive.resting_row(occupied, mask, row, col, reach)
    if expected is not None:
        expected = expected, naive.support_ends(occupied, mask, expected, col)
    assert resting_place(occupied, mask, row, col, reach) == expected


def lowest(mask):
    return np.asarray(mask.shape[0] - 1 - np.argmax(mask[::-1], axis=0))


@repeatable(100)
@given(free_places())
def test_free_space_is_counted_pixel_by_pixel(scene):
    occupied, mask, (row, col) = scene
    below = free_below(occupied, lowest(mask), row, col)
    columns, rows = range(mask.shape[1]), range(mask.shape[0])
    assert below.dtype == np.intp
    assert below.tolist() == [
        void_below(occupied, mask[:, j : j + 1], (row, col + j)) for j in columns
    ]
    beside = free_beside(occupied, mask, row, col)
    flipped_col = occupied.shape[1] - col - mask.shape[1]
    assert beside[0] == gap_beside(occupied, mask, (row, col))
    assert beside[-1] == min(
        gap_beside(occupied[:, ::-1], mask[k : k + 1, ::-1], (row + k, flipped_col)) for k in rows
    )


@repeatable(200)
@given(
    scene=free_places() | bars_over_columns(),
    columns=st.none() | st.tuples(st.integers(0, 7), st.integers(0, 7)),
    sizes=st.tuples(st.integers(1, 3), st.integers(0, 6)),
)
def test_a_filling_has_the_pixels_of_the_gap_that_is_lowest(scene, columns, sizes):
    occupied, mask, at = scene
    width, sizes = mask.shape[1], (sizes[0], sizes[0] + sizes[1])
    columns = (min(columns[0], width), min(columns[1], width)) if columns else (0, width)
    expected = gap_pixels(occupied, mask, at, columns, sizes)
    filling = gap_filling(occupied, mask, *at, columns, sizes)
    if filling is None:
        assert expected is None
        return
    pixels, top, left = filling
    assert {(top + i, left + j) for i, j in np.argwhere(pixels).tolist()} == expected
    assert pixels.dtype == bool
    assert pixels.any(axis=0).all()
    assert pixels[[0, -1]].any(axis=1).all()


@pytest.mark.parametrize("at", [(-1, 0), (0, -1), (3, 0), (0, 4)])
def test_masks_and_columns_outside_are_refused(at):
    """Of slices from the end NumPy would make something else."""
    occupied, mask = np.zeros((4, 5), bool), np.ones((2, 2), bool)
    for function, *more in ((support_ends,), (free_beside,), (gap_filling, (0, 2), (1, 3))):
        with pytest.raises(ValueError, match="leaves the landscape"):
            function(occupied, mask, *at, *more)
    if at[0] < 3:
        with pytest.raises(ValueError, match="leave the landscape"):
            free_below(occupied, lowest(mask), *at)
    for columns in ((0, -1), (-2, 2), (0, 3)):
        with pytest.raises(ValueError, match="columns"):
            gap_filling(occupied, mask, 0, 0, columns, (1, 3))
