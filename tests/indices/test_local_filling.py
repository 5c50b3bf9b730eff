"""LFR (Eq. 4, Fig. 7)."""

import numpy as np
import pytest
from hypothesis import given

from drystone.indices.local_filling import local_filling_ratio_at
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.poses import PoseBook
from tests.naive import rays as naive
from tests.strategies import posed_on_walls, repeatable


@repeatable()
@given(scene=posed_on_walls())
def test_lfr_is_that_of_rays(scene: tuple[Wall, PosedStone, int, int]) -> None:
    wall, posed, row, col = scene
    got = local_filling_ratio_at(Landscape.of(wall), posed, row, col)
    assert got == pytest.approx(naive.local_filling_ratio(wall.occupied, posed.mask, row, col))


def test_nothing_swept_is_full() -> None:
    block = PoseBook().pose(Stone(1, np.ones((2, 3), bool)), 0.0)
    landscape = Landscape.of(Wall.empty(Site(8, 4)))
    found = [local_filling_ratio_at(landscape, block, *at) for at in ((2, 0), (2, 4), (0, 0))]
    assert found == [1.0, 0.0, 0.0]
