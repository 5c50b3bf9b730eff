"""Stones that are lowered onto a wedge, from both sides."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.kernels.polygons import GRID, area_and_centroid, mirrored_polygon, no_polygons
from drystone.kernels.settling import rest_margin
from drystone.settle.rest import SettlingScene, Turned
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import WedgeLimits, wedged
from tests.polygons import box, box_about

WIDTH = 60.0
SIDES = ("left", "right")
LIMITS = WedgeLimits(least_thickness=0.5, greatest_height=6.0, rest=0.2, contact_px=0.05)
POST, PLANK = box(11.0, 0.01, 14.0, 2.0), box_about(10.0, 2.0)


def lowered(side, start=(15.0, 6.0), limits=LIMITS, others=(POST,)):
    """The plank let go as the side sees it, in a scene that it sees the same from either side."""
    around = no_polygons().added(others)
    around = around if side == "left" else around.mirrored(WIDTH)
    scene = SettlingScene.of(around, WIDTH, side, 0.58)
    return wedged(Turned.of(PLANK, 0.0, side, 20.0**0.5), scene, start, SettleSettings(), limits)


@pytest.mark.parametrize("side", SIDES)
def test_the_free_side_gets_a_wedge_that_holds_the_stone(side):
    found = lowered(side)
    settled, wedge = found.repose.settled, found.wedge
    assert area_and_centroid(wedge)[0] > 0.0
    assert (wedge * GRID == np.round(wedge * GRID)).all()
    assert (found.repose.angle_deg, found.repose.turned) == (0.0, False)
    corners, x = settled.corners, settled.x_px
    if side == "right":
        corners, wedge = (mirrored_polygon(one, WIDTH) for one in (corners, wedge))
        x = WIDTH - x
    assert (x, settled.y_px) == pytest.approx((15.0, 3.01), abs=1e-4)
    (left, low), (right, high) = wedge.min(axis=0), wedge.max(axis=0)
    assert left == pytest.approx(15.0, abs=1e-5)  # from the centre of mass on
    assert right - left == pytest.approx(1.25 * (high - low), abs=1e-4)
    assert (low, high) == pytest.approx((0.01, 2.0), abs=1e-4)
    here = corners, (x, settled.y_px)
    for wedges, firm in (([], False), ([wedge], True)):
        around = no_polygons().added([POST, *wedges])
        assert (rest_margin(*here, around, WIDTH, 0.58, 0.05) >= 0.2) == firm


@pytest.mark.parametrize("side", SIDES)
def test_no_wedge_where_none_is_needed_or_none_fits_or_the_stone_slides_away(side):
    assert lowered(side, (12.5, 6.0)) is None  # it lies over its support
    low = replace(LIMITS, greatest_height=1.9)
    assert lowered(side, limits=low) is None
    assert lowered(side, limits=replace(LIMITS, rest=9.0)) is None
    roof = np.array([[5.0, 0.01], [25.0, 0.01], [15.0, 20.0]])
    assert lowered(side, (19.0, 25.0), others=(roof,)) is None
