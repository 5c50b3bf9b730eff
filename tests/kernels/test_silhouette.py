"""Runs, underside, rays (Eq. 4) and hull of a mask: against pixels one by one, and shapely."""

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.silhouette import pixel_hull, silhouette
from tests.kernels.test_paths import noise
from tests.strategies import blobs, masks, repeatable


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


shapes = st.tuples(st.integers(1, 9), st.integers(1, 9))
shares = st.sampled_from([0.1, 0.3, 0.8])
dust = st.builds(noise, shapes, shares, st.integers(0, 10**6))
pixels = st.one_of(dust, dust, blobs(max_px=16)).filter(lambda mask: bool(mask.any()))


@repeatable(150)
@given(pixels)
def test_corners_of_the_hull_are_those_of_all_pixel_squares(mask):
    rows, cols = np.nonzero(mask)
    x, y = cols, mask.shape[0] - 1 - rows
    squares = shapely.multipoints(
        np.concatenate([np.column_stack([x + i, y + j]) for i in (0, 1) for j in (0, 1)])
    )
    expected = shapely.get_coordinates(squares.convex_hull)[:-1].astype(int)
    found = pixel_hull(mask)
    assert len(found) == len(expected)
    assert set(map(tuple, found.tolist())) == set(map(tuple, expected.tolist()))
    ring = shapely.LinearRing(found)
    assert ring.is_ccw
    assert ring.is_simple
    # From the right end of the lowest edge to its left end.
    assert found[0].tolist() == [max(x[y == y.min()]) + 1, y.min()]
    assert found[-1].tolist() == [min(x[y == y.min()]), y.min()]
