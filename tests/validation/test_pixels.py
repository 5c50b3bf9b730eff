"""The walls of the other files here, from pixels: 20 px per brick height.

Edges of blocks are rounded to the nearest pixel corner, so that blocks of 4 x 1.75 are 46 or 45
pixels wide where 45.71 would be right; edges that lie above each other stay so.
"""

import pytest

from drystone.statics.limit import lateral_resistance
from drystone_lab.pixels import BRICK_PX, from_outlines, from_pixels, rasterised
from drystone_lab.statics_cases import WALLS, closed_forms


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
@pytest.mark.parametrize("case", closed_forms(), ids=lambda case: f"{case.name}, mu {case.mu}")
def test_closed_forms(case, model_of):
    """Exact: all edges lie on pixel edges."""
    found = alphas(model_of(rasterised(case.rectangles, BRICK_PX), case.mu))
    assert found == pytest.approx((case.left, case.right), abs=1e-8)
