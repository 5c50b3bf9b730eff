"""The pixels that settled stones and wedges fill: those that become half full."""

import numpy as np
import pytest

from drystone.kernels.polygons import no_polygons
from drystone.model.outlines import Outlines
from drystone.model.placement import Settled
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.settle.placing import settled_in, settled_placement, settled_wedge
from drystone.settle.rest import SettlingScene, Turned, come_to_rest
from drystone.settle.settings import SettleSettings
from tests.polygons import box

STONE = Stone(5, np.ones((4, 6), bool))
BRICK = Stone(1, np.ones((6, 10), bool))


def placed(site, corners, moves=0):
    settled = Settled(*corners.mean(axis=0).tolist(), corners)
    return settled_placement(Outlines.empty(site), site, STONE, 12.5, settled, "right", moves)


def test_pixels_that_are_half_full_are_the_stones():
    site = Site(12, 8)
    made = placed(site, box(2.5, 0.0, 8.49, 3.5), moves=1)
    # Columns 2 to 7: the last column holds .49, the first .5; the top row is half full.
    assert (made.row, made.col, made.posed.mask.shape) == (4, 2, (4, 6))
    assert made.posed.mask[1:].all()
    assert made.posed.mask[0].tolist() == [False, True, True, True, True, True]
    assert (made.stone_id, made.posed.angle_deg, made.side) == (5, 12.5, "right")
    assert made.rotation_moves == 1
    assert made.settled is not None


@pytest.mark.parametrize("scale", [1.0, 0.5, 0.25])
def test_the_anchor_is_where_the_centroid_is(scale):
    site = Site(24, 16, scale)
    made = placed(site, box(3.3, 0.02, 19.7, 11.9))
    x, y = made.posed.anchor
    bottom = site.height_px - made.row - made.posed.height_px
    assert (made.col + x, bottom + y) == pytest.approx((11.5 * scale, 5.96 * scale))
    assert made.posed.scale == scale
    alone = Wall.empty(site, exact=True).add(made)
    assert np.array_equal(alone.labels[made.window] == 5, made.posed.mask)
    assert np.count_nonzero(alone.labels) == np.count_nonzero(made.posed.mask)


def test_no_pixel_of_the_wall_is_no_placement_and_over_its_edge_there_are_none():
    for corners in (box(5.1, 0.0, 5.5, 0.9), box(12.0, 0.0, 14.0, 3.0)):
        assert placed(Site(12, 8), corners) is None
    made = placed(Site(12, 8), box(-0.6, 0.0, 12.6, 8.6))
    assert (made.row, made.col, made.posed.mask.shape) == (0, 0, (8, 12))
    assert made.posed.anchor == pytest.approx((6.0, 4.3))


def test_wedges():
    site = Site(12, 8, 0.5)
    corners = box(4.0, 0.0, 8.0, 2.0)
    wedge = settled_wedge(Outlines.empty(site), site, 90, 5, corners)
    assert (wedge.id, wedge.under, wedge.row, wedge.col) == (90, 5, 7, 2)
    assert wedge.mask.tolist() == [[True, True]]
    assert wedge.corners is corners
    thin = settled_wedge(Outlines.empty(site), site, 91, 5, box(4.2, 0.0, 5.0, 1.0))
    assert thin.area_px == 0
    assert thin.corners is not None
    under = Outlines.empty(site).added([(5, box(4.0, 0.0, 6.0, 2.0))], 0.5)
    assert settled_wedge(under, site, 92, 5, corners).mask.tolist() == [[True]]


@pytest.mark.parametrize("top", [10.0, 14.0])  # of the smaller plate, and so which comes first
def test_arms_thinner_than_a_pixel_are_not_seen_nor_what_is_beyond_them(top):
    site = Site(24, 12, 0.5)
    # A dumb-bell: two plates that a bar of .4 working px joins.
    bell = np.array(
        [[2, 0], [14, 0], [14, 5.6], [26, 5.6], [26, 2], [34, 2], [34, top], [26, top], [26, 6.4],
         [14, 6.4], [14, 12], [2, 12]], float,
    )  # fmt: skip
    made = placed(site, bell)
    assert (made.row, made.col, made.posed.mask.shape) == (6, 1, (6, 6))
    assert made.posed.mask.all()


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
    x = rested.settled.corners[:, 0]
    assert 0.0 < max(-x.min(), x.max() - site.extent_px[0]) < beyond_px
    found = settled_in(Wall.empty(site, exact=True), BRICK, side, rested, wedge_id=9)
    placement = found.placement
    assert placement.posed.mask.all()
    end = placement.col if side == "left" else placement.col + placement.posed.width_px
    assert end == (0 if side == "left" else site.width_px)
