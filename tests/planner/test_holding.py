"""Whether an engine lets a stone stay: flat on the ground it does, on an edge it does not."""

import numpy as np
import pytest

from drystone.model.placement import Placement
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Group, Wall
from drystone.planner.holding import holds
from drystone.poses import PoseBook

pytest.importorskip("pymunk")
BRICK = Stone(2, np.ones((10, 30), bool))


def put(posed, row, col):
    return Group(Placement(posed, row, col, "left"))


@pytest.mark.parametrize(("col", "stays"), [(20, True), (8, True), (40, False)])
def test_a_brick_stays_where_its_middle_is_borne(col, stays):
    book = PoseBook()
    below = put(book.pose(Stone(1, np.ones((10, 30), bool)), 0.0), 30, 20)
    wall = Wall.empty(Site(100, 40)).add(below.placement)
    assert holds(wall, put(book.pose(BRICK, 0.0), 20, col), 0.58) is stays
