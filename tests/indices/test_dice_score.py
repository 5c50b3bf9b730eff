"""GDS (Eq. 5)."""

import numpy as np
import pytest
from hypothesis import given

from drystone.indices.dice_score import geometrical_dice_score_at
from drystone.kernels.merits import dice_score
from drystone.model.landscape import Landscape
from drystone.model.placement import Placement
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.poses import PoseBook
from tests.naive import indices as naive
from tests.strategies import posed_on_walls, repeatable


@repeatable()
@given(scene=posed_on_walls())
def test_gds_is_that_of_the_painted_box(scene: tuple[Wall, PosedStone, int, int]) -> None:
    wall, posed, row, col = scene
    stone = naive.painted(wall.occupied.shape, posed.mask, row, col)
    landscape = Landscape.of(wall)
    got = geometrical_dice_score_at(landscape, posed, row)
    assert got == pytest.approx(naive.dice_score(wall.occupied, stone))
    # The rule of placement counts with the same number, to the last bit.
    top = wall.site.height_px - wall.height_px
    inside = posed.mask[max(0, top - row) :].sum(dtype=np.int32)
    box_area = float(wall.site.width_px * wall.height_px)
    assert dice_score(np.array([inside], np.int32), posed.area_px, box_area).tolist() == [got]


def test_inside_outside_and_between() -> None:
    book = PoseBook()
    block = book.pose(Stone(1, np.ones((4, 4), bool)), 0.0)
    small = book.pose(Stone(2, np.ones((2, 2), bool)), 0.0)
    wall = Wall.empty(Site(20, 10))
    assert geometrical_dice_score_at(Landscape.of(wall), small, 8) == 0.0
    landscape = Landscape.of(wall.add(Placement(block, 6, 0)))
    got = [geometrical_dice_score_at(landscape, small, row) for row in (8, 4, 5)]
    assert got == pytest.approx([1.0, 0.0, 0.5 * 80 / 82])
