"""Free space around a mask against walking pixel by pixel."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.columns import free_below, free_beside
from drystone.kernels.raster import Mask
from tests.naive import overlap as naive
from tests.naive.placement import all_positions, gap_beside, void_below
from tests.strategies import landscapes, masks, repeatable


@repeatable(80)
@given(data=st.data(), occupied=landscapes(14), mask=masks())
def test_free_space_is_counted_pixel_by_pixel(
    data: st.DataObject, occupied: Mask, mask: Mask
) -> None:
    free = [at for at in all_positions(occupied, mask) if not naive.overlaps(occupied, mask, *at)]
    if not free:
        return
    row, col = data.draw(st.sampled_from(free))
    bottom = mask.shape[0] - 1 - np.argmax(mask[::-1], axis=0)
    below = free_below(occupied, bottom, row, col)
    assert int(below.sum()) == void_below(occupied, mask, (row, col))
    beside = free_beside(occupied, mask, row, col)
    flipped_col = occupied.shape[1] - col - mask.shape[1]
    assert beside[0] == gap_beside(occupied, mask, (row, col))
    rows = [
        gap_beside(occupied[:, ::-1], mask[k : k + 1, ::-1], (row + k, flipped_col))
        for k in range(mask.shape[0])
    ]
    assert beside[-1] == min(rows)
