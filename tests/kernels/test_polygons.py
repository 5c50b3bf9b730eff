"""Polygons in one array."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.polygons import (
    area_and_centroid,
    no_polygons,
    on_grid,
    place_on_grid,
)
from tests.strategies import repeatable

places = st.floats(-1e4, 1e4, allow_nan=False)


@st.composite
def rings(draw):
    """Draw a polygon that is seen whole from a point, counter-clockwise."""
    radii = np.array(draw(st.lists(st.floats(1.0, 20.0), min_size=3, max_size=12)))
    angles = 2 * np.pi * np.arange(len(radii)) / len(radii)
    way = np.column_stack([np.cos(angles), np.sin(angles)])
    return (draw(places), draw(places)) + radii[:, None] * way


@repeatable()
@given(rings())
def test_a_polygon_has_the_area_and_centroid_that_shapely_finds(corners):
    area, x, y = area_and_centroid(corners)
    near = shapely.Polygon(corners - corners[0])
    assert area == pytest.approx(near.area)
    assert (x - corners[0, 0], y - corners[0, 1]) == pytest.approx(near.centroid.coords[0])
    assert area_and_centroid(np.asfortranarray(corners)) == (area, x, y)


@repeatable()
@given(st.lists(rings(), max_size=4), st.lists(rings(), max_size=3))
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
