"""The walls of the other files here, from pixels: 20 px per brick height.

Edges of blocks are rounded to the nearest pixel corner, so that blocks of 4 x 1.75 are 46 or 45
pixels wide where 45.71 would be right; edges that lie above each other stay so.
"""

import pytest

from drystone.statics.limit import lateral_resistance
from drystone_lab.pixels import BRICK_PX, from_outlines, from_pixels, rasterised
from drystone_lab.statics_cases import WALLS


def alphas(model):
    both = lateral_resistance(model)
    return both.left.alpha, both.right.alpha


both_ways = pytest.mark.parametrize("model_of", [from_pixels, from_outlines])


@both_ways
@pytest.mark.parametrize("wall", WALLS[:5], ids=lambda wall: f"Ferris {wall.number}")
def test_walls_of_ferris_and_tin_loi(wall, model_of):
    model = model_of(rasterised(wall.rectangles, BRICK_PX / 1.75), 0.65)
    assert (len(model.blocks), len(model.interfaces)) == (wall.blocks, wall.contacts)
    assert alphas(model) == pytest.approx((wall.associative,) * 2, rel=0.01)


@both_ways
def test_running_bond_of_four_courses(model_of):
    rows = [
        [x, course, width, 1]
        for course in range(4)
        for x, width in (((0, 2), (2, 2)), ((0, 1), (1, 2), (3, 1)))[course % 2]
    ]
    assert alphas(model_of(rasterised(rows, BRICK_PX), 0.58)) == pytest.approx(
        (0.58, 0.58), rel=0.01
    )


@both_ways
@pytest.mark.parametrize(
    ("width", "height", "mu"), [(1, 1, 0.3), (1, 2, 0.7), (1, 4, 0.65), (2, 1, 0.65), (0.2, 1, 0.7)]
)
def test_single_block(width, height, mu, model_of):
    """min(mu, b/h), exact where edges lie on pixel edges."""
    expected = min(mu, width / height)
    found = alphas(model_of(rasterised([[0, 0, width, height]], BRICK_PX), mu))
    assert found == pytest.approx((expected, expected), abs=1e-8)


@both_ways
@pytest.mark.parametrize("shift", [0.2, 0.4])
def test_offset_stack(shift, model_of):
    """As in the closed forms, mu .9."""
    right = min((0.5 - shift) / 0.5, (1.0 - shift) / 2.0)
    found = alphas(model_of(rasterised([[0, 0, 1, 1], [shift, 1, 1, 1]], BRICK_PX), 0.9))
    assert found == pytest.approx(((1.0 + shift) / 2.0, right), abs=1e-8)
