"""Runs, underside and rays of a mask: against pixels one by one (Eq. 4)."""

import numpy as np
from hypothesis import given

from drystone.kernels.silhouette import silhouette
from tests.strategies import masks, repeatable


@repeatable(100)
@given(mask=masks(12))
def test_runs_give_back_the_mask_from_the_lowest_row_up(mask):
    outline = silhouette(mask)
    painted = np.zeros_like(mask)
    for row, start, length in outline.runs.tolist():
        assert not painted[row, max(0, start - 1) : start + length + 1].any()
        painted[row, start : start + length] = True
    assert np.array_equal(painted, mask)
    order = [(-row, start) for row, start, _ in outline.runs.tolist()]
    assert order == sorted(order)
    assert (outline.height, outline.width) == mask.shape
    rows = range(mask.shape[0])
    columns = mask.T.tolist()
    assert outline.bottom.tolist() == [max(r for r in rows if col[r]) for col in columns]
    assert outline.area_from.tolist() == [mask[r:].sum() for r in rows] + [0]


@repeatable(100)
@given(mask=masks(12))
def test_swept_is_what_is_left_of_the_mask_or_below_it(mask):
    rays = silhouette(mask).rays
    height, width = mask.shape
    expected = {
        (i, j)
        for i in range(height)
        for j in range(width)
        if not mask[i, j] and (mask[i, j + 1 :].any() or mask[:i, j].any())
    }
    runs = [(row, 0, left) for row, left in enumerate(rays.left.tolist())]
    others = rays.runs.tolist()
    assert all(start > rays.left[row] for row, start, _ in others)
    swept = [(row, j) for row, a, b in runs + others for j in range(a, b)]
    assert len(swept) == len(set(swept)) == rays.area
    assert set(swept) == expected
    assert rays.left.tolist() == [int(np.argmax(row)) for row in mask]
