"""The wall: nothing overlaps, nothing leaves, nothing is changed afterwards."""

import numpy as np
import pytest
from hypothesis import given

from drystone.model.placement import Placement, Settled, Wedge
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall, outlined
from drystone.poses import PoseBook
from tests.polygons import box
from tests.strategies import repeatable, walls

POSED = PoseBook().pose(Stone(70_000, np.ones((2, 3), bool)), 0.0)


def test_adding_paints_stone_and_wedges_and_keeps_the_old_wall():
    empty = Wall.empty(Site(6, 4))
    wedge = Wedge(4_000_000_000, 70_000, np.ones((1, 2), bool), 3, 1)
    wall = empty.add(Placement(POSED, 1, 1), (wedge,))
    painted = np.zeros((4, 6), np.int64)
    painted[1:3, 1:4], painted[3, 1:3] = 70_000, 4_000_000_000
    assert np.array_equal(wall.labels, painted)
    assert not empty.occupied.any()
    assert (wall.height_px, empty.height_px) == (3, 0)
    assert [p.stone_id for p in wall.placements] == [70_000]
    assert wall.wedges == (wedge,)
    assert wedge.area_px == 2
    assert wall.filling == 6 / 24  # wedges do not count
    # Source pixels count, at the working scale.
    posed = PoseBook(0.5).pose(Stone(1, np.ones((5, 5), bool)), 0.0)
    wall = Wall.empty(Site(5, 5, scale=0.5)).add(Placement(posed, 5 - posed.height_px, 0))
    assert wall.filling == pytest.approx(25 / 4 / 25)


@pytest.mark.parametrize("place", [(-1, 0), (3, 0), (0, -1), (0, 4), (1, 2)])
def test_what_leaves_the_site_or_overlaps_is_refused(place):
    wall = Wall.empty(Site(6, 4)).add(Placement(POSED, 2, 0))
    with pytest.raises(ValueError, match="overlaps" if place == (1, 2) else "leaves the site"):
        wall.add(Placement(POSED, *place))
    with pytest.raises(ValueError, match="read-only"):
        wall.labels[0, 0] = 1
    assert wall.outlines is None
    for asked in (wall, wall.placements[0]):
        with pytest.raises(ValueError, match="pixels"):
            _ = asked.exact


@repeatable()
@given(wall=walls())
def test_labels_are_those_of_the_placements(wall):
    expected = np.zeros_like(wall.labels)
    for placement in wall.placements:
        mask, height = placement.posed.mask, wall.site.height_px
        for i, j in zip(*np.nonzero(mask), strict=True):
            expected[placement.row + i, placement.col + j] = placement.stone_id
        x, y = placement.centroid(height)
        local = placement.posed.stone.local_centroid
        assert x == pytest.approx(placement.col + local[0], abs=1 / 64)
        assert y == pytest.approx(height - placement.row - mask.shape[0] + local[1], abs=1 / 64)
    assert np.array_equal(wall.labels, expected)


def _settled(stone_id, left, low, right, high):
    """A box in source px; its pixels are of no account for a wall of outlines."""
    posed = PoseBook(0.5).pose(Stone(stone_id, np.ones((4, 4), bool)), 0.0)
    corners = box(left, low, right, high)
    centre = Settled((left + right) / 2.0, (low + high) / 2.0, corners)
    return Placement(posed, 0, 0, settled=centre)


def test_with_outlines_a_pixel_is_whose_share_is_largest_where_half_is_covered():
    empty, one = Wall.empty(Site(6, 3, 0.5), exact=True), _settled(3, 0.0, 0.0, 5.3, 4.0)
    pixels, corners = np.zeros((0, 0), bool), np.array([[8.2, 0], [9.2, 0], [9.2, 2]])
    wedges = Wedge(90, 9, pixels, 3, 0, corners), Wedge(91, 9, pixels, 3, 0)
    wall = empty.add(one).add(_settled(9, 5.3, 0.0, 8.2, 2.0), wedges)
    # The third column is shared, most of it the first stone's; the fifth is less than half full.
    assert wall.labels.tolist() == [[0] * 6, [3, 3, 3, 0, 0, 0], [3, 3, 3, 9, 0, 0]]
    assert not empty.occupied.any()
    assert wall.exact.ids == (3, 9, 90)
    assert wall.wedges == wedges
    assert wall.height_px == 2
    (block, kept), (other, of_wedge) = outlined(one, wedges)
    assert (block, other, of_wedge is corners, kept is one.exact.corners) == (3, 90, True, True)
