"""Packed-bit overlap and lowering against loops over pixels (§3.6)."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.bits import BitLandscape, drop_rows, row_runs
from drystone.kernels.raster import Mask
from tests.naive import overlap as naive
from tests.strategies import landscapes, masks, repeatable


@repeatable(150)
@given(occupied=landscapes(), mask=masks(9))
def test_overlap_is_that_of_two_loops(occupied: Mask, mask: Mask) -> None:
    assert np.array_equal(
        BitLandscape(occupied).overlap(mask), naive.overlap_everywhere(occupied, mask)
    )


def test_a_long_run_does_not_see_the_next_row() -> None:
    occupied = np.zeros((4, 9), bool)
    occupied[1:, 0] = True
    free = ~BitLandscape(occupied).overlap(np.ones((1, 8), bool))
    assert free.tolist() == [[True, True], [False, True], [False, True], [False, True]]


def test_asking_changes_nothing_so_threads_may_share_it() -> None:
    landscape = BitLandscape(np.eye(20, dtype=bool))
    before = {name: repr(value) for name, value in vars(landscape).items()}
    landscape.overlap(np.ones((3, 17), bool))
    assert {name: repr(value) for name, value in vars(landscape).items()} == before


def test_a_mask_that_is_too_large_has_no_position() -> None:
    landscape = BitLandscape(np.zeros((4, 6), bool))
    assert landscape.overlap(np.ones((5, 2), bool)).shape == (0, 5)
    assert landscape.overlap(np.ones((4, 7), bool)).shape == (1, 0)


@repeatable()
@given(mask=masks(9))
def test_row_runs_give_back_the_mask(mask: Mask) -> None:
    painted = np.zeros_like(mask)
    for row, runs in enumerate(row_runs(mask)):
        for start, length in runs:
            assert not painted[row, max(0, start - 1) : start + length].any()
            painted[row, start : start + length] = True
    assert np.array_equal(painted, mask)


@repeatable(100)
@given(data=st.data(), occupied=landscapes(), mask=masks(6))
def test_drop_rows_lower_pixel_by_pixel(data: st.DataObject, occupied: Mask, mask: Mask) -> None:
    height = occupied.shape[0]
    top = np.where(occupied.any(axis=0), np.argmax(occupied, axis=0), height)
    bottom = mask.shape[0] - 1 - np.argmax(mask[::-1], axis=0)
    rows = drop_rows(top, bottom)
    assert rows.size == max(0, occupied.shape[1] - mask.shape[1] + 1)
    if rows.size:
        col = data.draw(st.integers(0, rows.size - 1))
        expected = naive.lowered(occupied, mask, col)
        assert (rows[col] if rows[col] >= 0 else None) == expected
