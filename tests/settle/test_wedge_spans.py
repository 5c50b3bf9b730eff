"""Wedges anywhere under a stone, whatever they shall hold."""

import numpy as np
import pytest
import shapely
from hypothesis import given

from drystone.kernels.crevice import crevice
from drystone.kernels.polygons import no_polygons, on_grid
from drystone.settle.wedge import (
    PLACES,
    CreviceSlabs,
    WedgeLimits,
    all_spans,
    gridded,
    wedges_below,
)
from tests.naive.wedge_shape import objections
from tests.polygons import box
from tests.settle.piles import piles
from tests.settle.test_wedge import SIZES, STRICT
from tests.strategies import repeatable

POST, PLANK = box(13.0, 0.01, 16.0, 2.0), box(10.0, 2.01, 20.0, 4.0)
LIMITS = WedgeLimits(least_thickness=0.6, greatest_height=2.5)


def spans(limits):
    space = crevice(PLANK, no_polygons().added([POST]), limits.clearance_px)
    return all_spans(CreviceSlabs.of(space), PLACES, limits)


def test_each_part_of_a_crevice_has_its_places_and_itself():
    found = spans(LIMITS)
    left = [span for span in found if span[1] < 13.0]
    right = [span for span in found if span[0] > 16.0]
    assert found == left + right
    assert (10.0, pytest.approx(12.99)) in left
    assert (pytest.approx(16.01), 20.0) in right
    # As wide as high where there is room, 1.25 times.
    widths = sorted(stop - start for start, stop in right)
    assert widths[0] == pytest.approx(1.25 * 1.99)
    assert max(widths) == pytest.approx(3.99)
    starts = sorted(start for start, _ in right)
    assert starts[0] == pytest.approx(16.01)
    assert starts[-1] == pytest.approx(20.0 - 1.25 * 1.99)
    assert len(set(found)) == len(found)


def test_the_stone_is_no_obstacle_to_its_own_wedges():
    wall = no_polygons().added([POST, PLANK])
    wedges = list(wedges_below(wall, 1, LIMITS))
    assert len(wedges) == len(spans(LIMITS))
    assert {(float(w[:, 0].min()), float(w[:, 0].max())) for w in wedges} == {
        tuple(on_grid(np.array(span)).tolist()) for span in spans(LIMITS)
    }
    assert list(wedges_below(wall, 0, LIMITS)) == []


def test_corners_that_the_grid_makes_one_are_one():
    tiny = 1e-7
    corners = np.array([[0, tiny], [0, 0], [2, 0], [2, tiny], [2, 2 * tiny], [2, 1], [0, 1]])
    assert gridded(corners).tolist() == [[0, 0], [2, 0], [2, 1], [0, 1]]


@repeatable(60)
@given(piles())
def test_wedges_fit_and_overlap_nothing(pile):
    stone, around = pile
    limits = STRICT
    wall = around.added([stone])
    shapes = [shapely.Polygon(wall.polygon(i)) for i in range(len(wall))]
    below = shapely.union_all([shapely.box(-99, -9, 199, 0), *shapes[:-1]])
    for wedge in wedges_below(wall, len(around), limits):
        shape = shapely.Polygon(wedge)
        assert shape.is_valid
        assert shapely.LinearRing(wedge).is_ccw
        assert np.array_equal(on_grid(wedge), wedge)
        for body in (shapes[-1], below):
            gap = shape.distance(body)
            assert limits.clearance_px / 2 <= gap <= 2 * limits.clearance_px
        assert max(objections(wedge, *SIZES).values()) <= 1e-5
