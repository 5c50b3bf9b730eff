"""Stones that are lowered onto a wedge, from both sides."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.kernels.firmness import rest_margin
from drystone.kernels.polygons import GRID, area_and_centroid, mirrored_polygon, no_polygons
from drystone.settle.rest import SettlingScene, Turned
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import WedgeLimits
from drystone.settle.wedged import wedged

WIDTH = 60.0
SIDES = ("left", "right")
LIMITS = WedgeLimits(least_thickness=0.5, greatest_height=6.0, rest=0.2, contact_px=0.05)
POST = np.array([[11.0, 0.01], [14.0, 0.01], [14.0, 2.0], [11.0, 2.0]])
PLANK = np.array([[-5.0, -1.0], [5.0, -1.0], [5.0, 1.0], [-5.0, 1.0]])


def lowered(side, start=(15.0, 6.0), limits=LIMITS, others=(POST,)):
    """The plank let go as the side sees it, in a scene that it sees the same from either side."""
    around = no_polygons().added(others)
    around = around if side == "left" else around.mirrored(WIDTH)
    scene = SettlingScene.of(around, WIDTH, side, 0.58)
    return wedged(Turned.of(PLANK, 0.0, side, 20.0**0.5), scene, start, SettleSettings(), limits)


@pytest.mark.parametrize("side", SIDES)
def test_the_free_side_gets_a_wedge(side):
    found = lowered(side)
    x, wedge = found.repose.settled.x_px, found.wedge
    if side == "right":
        x, wedge = WIDTH - x, mirrored_polygon(wedge, WIDTH)
    assert (x, found.repose.settled.y_px) == pytest.approx((15.0, 3.01), abs=1e-4)
    assert (found.repose.angle_deg, found.repose.turned) == (0.0, False)
    left, low = wedge.min(axis=0)
    right, high = wedge.max(axis=0)
    assert left == pytest.approx(15.0, abs=1e-5)  # from the centre of mass on
    assert right - left == pytest.approx(1.25 * (high - low), abs=1e-4)
    assert (low, high) == pytest.approx((0.01, 2.0), abs=1e-4)


@pytest.mark.parametrize("side", SIDES)
def test_a_wedge_is_counter_clockwise_on_the_grid_and_holds_the_stone(side):
    found = lowered(side)
    assert area_and_centroid(found.wedge)[0] > 0.0
    assert (found.wedge * GRID == np.round(found.wedge * GRID)).all()
    around = no_polygons().added([POST])
    around = around if side == "left" else around.mirrored(WIDTH)
    settled = found.repose.settled
    here = settled.corners, (settled.x_px, settled.y_px)
    assert rest_margin(*here, around, WIDTH, 0.58, 0.05) == -1.0
    assert rest_margin(*here, around.added([found.wedge]), WIDTH, 0.58, 0.05) >= 0.2


@pytest.mark.parametrize("side", SIDES)
def test_no_wedge_where_none_is_needed_or_none_fits(side):
    assert lowered(side, (12.5, 6.0)) is None  # it lies over its support
    low = replace(LIMITS, greatest_height=1.9)
    assert lowered(side, limits=low) is None
    assert lowered(side, limits=replace(LIMITS, rest=9.0)) is None


@pytest.mark.parametrize("side", SIDES)
def test_what_slides_away_gets_no_wedge(side):
    roof = np.array([[5.0, 0.01], [25.0, 0.01], [15.0, 20.0]])
    assert lowered(side, (19.0, 25.0), others=(roof,)) is None
