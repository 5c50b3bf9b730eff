"""Corners of the convex hull of pixels: against shapely's."""

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.silhouette import pixel_hull
from tests.kernels.test_paths import noise
from tests.strategies import blobs, repeatable

shapes = st.tuples(st.integers(1, 9), st.integers(1, 9))


shares = st.sampled_from([0.1, 0.3, 0.8])
dust = st.builds(noise, shapes, shares, st.integers(0, 10**6))
pixels = st.one_of(dust, dust, blobs(max_px=16)).filter(lambda mask: bool(mask.any()))


@repeatable(150)
@given(pixels)
def test_corners_are_those_of_all_pixel_squares(mask):
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
