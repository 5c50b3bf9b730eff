"""Settled stones in walls of any size: the pixels end at the wall, and the stones are taken in."""

import numpy as np
import pytest

from drystone.kernels.polygons import no_polygons
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.settle.placing import settled_in, stands_out_px
from drystone.settle.rest import SettlingScene, Turned, come_to_rest
from drystone.settle.settings import SettleSettings

BRICK = Stone(1, np.ones((6, 10), bool))


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("scale", [1.0, 0.5])
@pytest.mark.parametrize(
    ("more_px", "beyond_px"),
    [(0.0, 0.5), (0.2, 0.6), (0.27, 0.45), (0.4, 0.5), (0.49, 1.0), (0.5, 0.5)],
)
def test_stones_are_taken_in_at_both_ends_however_wide_the_wall_is(side, scale, more_px, beyond_px):
    """A brick is settled at the end of an empty wall from which it is placed."""
    # Columns that are less than half in the wall have no pixels.
    site = Site.from_source((40.0 + more_px) / scale, 30.0 / scale, scale)
    settings = SettleSettings(beyond_px=beyond_px)
    turned = Turned.of(BRICK.outline_within(0.35), 0.0, side, BRICK.area_px**0.5)
    scene = SettlingScene.of(no_polygons(), site.extent_px[0], side, 0.58)
    rested = come_to_rest(turned, scene, (5.0, 3.02), settings)
    assert 0.0 < stands_out_px(rested.settled.corners, site) < beyond_px
    found = settled_in(Wall.empty(site, exact=True), BRICK, side, rested, wedge_id=9)
    placement = found.placement
    assert placement.posed.mask.all()
    end = placement.col if side == "left" else placement.col + placement.posed.width_px
    assert end == (0 if side == "left" else site.width_px)


def test_how_far_an_outline_stands_out():
    site = Site.from_source(20.3, 10.4, 0.5)
    box = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]])
    for shift, out_px in (
        ((-0.3, 0.0), 0.3),
        ((16.7, 0.0), 0.4),
        ((5.0, 7.9), 0.5),
        ((16.8, 7.6), 0.5),
        ((2.0, 1.0), -2.0),
        ((8.0, -3.0), -8.0),
    ):
        assert stands_out_px(box + np.array(shift), site) == pytest.approx(out_px)
