"""The support polyline over all supporters (§3.7, Fig. 9a, DESIGN 4.6)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.model.stone import Stone
from drystone.poses import PoseBook
from drystone.stabilise.support import Support, support_polyline
from tests.naive import support as naive
from tests.strategies import posed_on_walls, repeatable


def block(height, width):
    return PoseBook().pose(Stone(1, np.ones((height, width), bool)), 0.0)


def scene(*rows):
    """A landscape drawn with # for what is occupied."""
    return np.array([[letter == "#" for letter in row] for row in rows])


@repeatable(100)
@given(on_wall=posed_on_walls(), margin=st.sampled_from([0.0, 0.5, 1.5]))
def test_support_is_that_of_every_pixel_on_its_own(on_wall, margin):
    wall, posed, row, col = on_wall
    support = support_polyline(wall.occupied, posed, row, col)
    ends = naive.support_ends(wall.occupied, posed.mask, row, col)
    assert ((support.left_x, support.left_row), (support.right_x, support.right_row)) == ends
    x_c = col + posed.anchor[0]
    stable = naive.rests_stably(wall.occupied, posed.mask, row, col, x_c, margin)
    assert (support.falls(x_c, margin) == 0) == stable


def test_a_stone_that_bridges_two_pillars_is_stable():
    occupied = scene("..........", "..........", "##......##", "##......##")
    support = support_polyline(occupied, block(2, 10), 0, 0)
    assert support == Support(left_x=0, right_x=10, left_row=2, right_row=2)
    assert support.falls(5.0) == 0


@pytest.mark.parametrize(
    ("x_c", "margin", "falls"),
    [
        (1.9, 0.0, -1), (2.0, 0.0, 0), (6.0, 0.0, 0), (6.1, 0.0, 1),
        (2.9, 1.0, -1), (3.0, 1.0, 0), (5.1, 1.0, 1), (3.9, 3.0, -1), (4.1, 3.0, 1),
    ],
)  # fmt: skip
def test_it_falls_to_the_nearer_end(x_c, margin, falls):
    assert Support(2, 6, 9, 9).falls(x_c, margin) == falls
