import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.outline import pixel_polygon, rasterise_polygon
from tests.naive.outline import inside
from tests.strategies import masks, repeatable


def _area(polygon):
    x, y = polygon.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


@repeatable(150)
@given(masks(max_px=9))
def test_rasterising_the_polygon_of_a_mask_gives_the_mask_back(mask):
    found, left, bottom = rasterise_polygon(pixel_polygon(mask))
    assert (left, bottom) == (0, 0)
    np.testing.assert_array_equal(found, mask)


@repeatable(150)
@given(masks(max_px=9))
def test_polygon_runs_counter_clockwise_along_pixel_edges(mask):
    polygon = pixel_polygon(mask)
    assert _area(polygon) == mask.sum()
    steps = np.roll(polygon, -1, axis=0) - polygon
    assert ((steps == 0).sum(axis=1) == 1).all()
    vertical = steps[:, 0] == 0
    assert (vertical != np.roll(vertical, 1)).all()
    start = polygon[0]
    assert start[1] == 0
    assert start[0] == np.flatnonzero(mask[-1])[0]


def test_polygon_passes_a_corner_where_two_pixels_touch_twice():
    ring = np.array([[1, 1, 0], [1, 0, 1], [1, 1, 1]], bool)
    polygon = pixel_polygon(ring)
    corners = [tuple(corner) for corner in polygon.tolist()]
    assert corners.count((2.0, 2.0)) == 2
    assert _area(polygon) == 7
    np.testing.assert_array_equal(rasterise_polygon(polygon)[0], ring)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([[0, 0]], "no pixel"),
        ([[1, 0, 1]], "several pieces"),
        ([[1, 0], [0, 1]], "several pieces"),
        ([[1, 1, 1], [1, 0, 1], [1, 1, 1]], "hole"),
    ],
)
def test_masks_that_one_polygon_cannot_describe_are_refused(rows, message):
    with pytest.raises(ValueError, match=message):
        pixel_polygon(np.array(rows, bool))


@repeatable(150)
@given(st.integers(0, 10**6), st.integers(3, 9), st.sampled_from([0.4, 3.0, 9.0]), st.booleans())
def test_pixels_of_any_polygon_are_those_of_loops(seed, count, size, halves):
    """Polygons that cross themselves among them, and corners that are centres of pixels."""
    polygon = np.random.default_rng(seed).uniform(-size, size, (count, 2))
    if halves:
        polygon = np.round(2 * polygon) / 2
    mask, left, bottom = rasterise_polygon(polygon)
    found = {
        (left + col, bottom + mask.shape[0] - 1 - row) for row, col in np.argwhere(mask).tolist()
    }
    reach = range(-11, 11)
    corners = polygon.tolist()
    assert found == {(x, y) for x in reach for y in reach if inside(corners, x + 0.5, y + 0.5)}
    assert not mask.size or (mask[[0, -1]].any(axis=1).all() and mask[:, [0, -1]].any(axis=0).all())
