"""The support polyline over all supporters (§3.7, Fig. 9a, DESIGN 4.6)."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.stabilise.stabilise import Support, support_polyline
from tests.naive import support as naive
from tests.strategies import posed_on_walls, repeatable


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


@pytest.mark.parametrize(
    ("x_c", "margin", "falls"),
    [
        (1.9, 0.0, -1), (2.0, 0.0, 0), (6.0, 0.0, 0), (6.1, 0.0, 1),
        (2.9, 1.0, -1), (3.0, 1.0, 0), (5.1, 1.0, 1), (3.9, 3.0, -1), (4.1, 3.0, 1),
    ],
)  # fmt: skip
def test_it_falls_to_the_nearer_end(x_c, margin, falls):
    assert Support(2, 6, 9, 9).falls(x_c, margin) == falls
