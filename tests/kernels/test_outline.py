"""Outlines: of pixels, of masks and their rays and hulls, and polygons in one array."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.outline import pixel_polygon, rasterise_polygon
from drystone.kernels.polygons import area_and_centroid, no_polygons, on_grid, place_on_grid
from drystone.kernels.silhouette import pixel_hull, silhouette
from tests.kernels.test_paths import noise
from tests.naive.outline import inside
from tests.polygons import moved, simple_polygons
from tests.strategies import blobs, masks, repeatable


@repeatable(150)
@given(masks(max_px=9))
def test_polygon_runs_counter_clockwise_along_pixel_edges_and_gives_the_mask_back(mask):
    polygon = pixel_polygon(mask)
    assert area_and_centroid(polygon)[0] == mask.sum()
    steps = np.roll(polygon, -1, axis=0) - polygon
    assert ((steps == 0).sum(axis=1) == 1).all()
    vertical = steps[:, 0] == 0
    assert (vertical != np.roll(vertical, 1)).all()
    assert polygon[0].tolist() == [np.flatnonzero(mask[-1])[0], 0]
    found, left, bottom = rasterise_polygon(polygon)
    assert (left, bottom) == (0, 0)
    np.testing.assert_array_equal(found, mask)


def test_polygon_passes_a_corner_where_two_pixels_touch_twice():
    ring = np.array([[1, 1, 0], [1, 0, 1], [1, 1, 1]], bool)
    polygon = pixel_polygon(ring)
    assert polygon.tolist().count([2.0, 2.0]) == 2
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


@repeatable(100)
@given(mask=masks(12))
def test_runs_are_those_of_the_mask_and_rays_what_is_left_of_it_or_below(mask):
    """Runs from the lowest row up."""
    outline, rays = silhouette(mask), silhouette(mask).rays
    painted = np.zeros_like(mask)
    for row, start, length in outline.runs.tolist():
        assert not painted[row, max(0, start - 1) : start + length + 1].any()
        painted[row, start : start + length] = True
    assert np.array_equal(painted, mask)
    order = [(-row, start) for row, start, _ in outline.runs.tolist()]
    assert order == sorted(order)
    assert (outline.height, outline.width) == mask.shape
    rows = range(mask.shape[0])
    assert outline.bottom.tolist() == [max(np.flatnonzero(column)) for column in mask.T]
    assert outline.area_from.tolist() == [mask[r:].sum() for r in rows] + [0]
    expected = {
        (i, j)
        for i, j in np.ndindex(mask.shape)
        if not mask[i, j] and (mask[i, j + 1 :].any() or mask[:i, j].any())
    }
    runs, others = [(row, 0, left) for row, left in enumerate(rays.left.tolist())], rays.runs
    assert all(start > rays.left[row] for row, start, _ in others.tolist())
    swept = [(row, j) for row, a, b in runs + others.tolist() for j in range(a, b)]
    assert len(swept) == rays.area
    assert sorted(swept) == sorted(expected)
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
    assert sorted(found.tolist()) == sorted(expected.tolist())
    ring = shapely.LinearRing(found)
    assert ring.is_ccw
    assert ring.is_simple
    # From the right end of the lowest edge to its left end.
    assert found[0].tolist() == [max(x[y == y.min()]) + 1, y.min()]
    assert found[-1].tolist() == [min(x[y == y.min()]), y.min()]


places = st.floats(-1e4, 1e4, allow_nan=False)
rings = st.builds(moved, simple_polygons(), places, places)


@given(rings)
def test_a_polygon_has_the_area_and_centroid_that_shapely_finds(corners):
    area, x, y = area_and_centroid(corners)
    near = shapely.Polygon(corners - corners[0])
    assert area == pytest.approx(near.area)
    assert (x - corners[0, 0], y - corners[0, 1]) == pytest.approx(near.centroid.coords[0])
    assert area_and_centroid(np.asfortranarray(corners)) == (area, x, y)


def test_what_has_no_area_has_no_centroid():
    assert np.isnan(area_and_centroid(np.zeros((3, 2)))[1:]).all()


@given(st.lists(rings, max_size=4), st.lists(rings, max_size=3))
def test_polygons_that_are_added_follow_the_others(some, more):
    both = no_polygons().added(some).added(more)
    assert len(both) == len(some + more)
    for i, corners in enumerate(some + more):
        assert (both.polygon(i) == corners).all()
        assert both.boxes[i].tolist() == [*corners.min(axis=0), *corners.max(axis=0)]
        ways = np.roll(corners, -1, axis=0) - corners
        unit, length = np.split(both.edges[both.first[i] : both.first[i + 1]], [2], axis=1)
        assert length[:, 0] == pytest.approx(np.hypot(*ways.T))
        assert unit * length == pytest.approx(ways)


@given(places, places)
def test_a_place_on_the_grid_is_that_of_an_array(x, y):
    assert place_on_grid(x, y) == tuple(on_grid(np.array([x, y])))
