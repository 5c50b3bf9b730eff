"""The wall: nothing overlaps, nothing leaves, nothing is changed afterwards."""

import numpy as np
import pytest
from hypothesis import given

from drystone.model.placement import Placement, Wedge
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.poses import PoseBook
from tests.strategies import repeatable, walls

POSED = PoseBook().pose(Stone(70_000, np.ones((2, 3), bool)), 0.0)


def test_adding_paints_stone_and_wedges_and_keeps_the_old_wall() -> None:
    empty = Wall.empty(Site(6, 4))
    wedge = Wedge(4_000_000_000, 70_000, np.ones((1, 2), bool), 3, 1)
    wall = empty.add(Placement(POSED, 1, 1), (wedge,))
    assert wall.labels.tolist() == [
        [0, 0, 0, 0, 0, 0],
        [0, 70_000, 70_000, 70_000, 0, 0],
        [0, 70_000, 70_000, 70_000, 0, 0],
        [0, 4_000_000_000, 4_000_000_000, 0, 0, 0],
    ]
    assert not empty.occupied.any()
    assert (wall.height_px, empty.height_px) == (3, 0)
    assert [p.stone_id for p in wall.placements] == [70_000]
    assert wall.wedges == (wedge,)
    assert wedge.area_px == 2
    assert wall.filling == 6 / 24  # wedges do not count


@pytest.mark.parametrize(("row", "col"), [(-1, 0), (3, 0), (0, -1), (0, 4)])
def test_leaving_the_site_is_refused(row: int, col: int) -> None:
    with pytest.raises(ValueError, match="leaves the site"):
        Wall.empty(Site(6, 4)).add(Placement(POSED, row, col))


def test_overlap_is_refused() -> None:
    wall = Wall.empty(Site(6, 4)).add(Placement(POSED, 2, 0))
    with pytest.raises(ValueError, match="overlaps"):
        wall.add(Placement(POSED, 1, 2))


def test_labels_are_read_only() -> None:
    with pytest.raises(ValueError, match="read-only"):
        Wall.empty(Site(6, 4)).labels[0, 0] = 1


def test_filling_counts_source_pixels_at_the_working_scale() -> None:
    posed = PoseBook(0.5).pose(Stone(1, np.ones((5, 5), bool)), 0.0)
    wall = Wall.empty(Site(5, 5, scale=0.5)).add(Placement(posed, 5 - posed.height_px, 0))
    assert wall.filling == pytest.approx(25 / 4 / 25)


@repeatable()
@given(wall=walls())
def test_labels_are_those_of_the_placements(wall: Wall) -> None:
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
