"""A turned stone: its profile and its mirror image for views."""

import numpy as np
from hypothesis import given

from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from tests.strategies import repeatable, stones


@repeatable()
@given(stone=stones())
def test_profiles_are_the_outermost_pixels_of_the_columns(stone):
    posed = PosedStone(stone, 0.0, 1.0, stone.mask.copy(), (1.0, 1.0))
    assert (posed.height_px, posed.width_px) == stone.mask.shape
    assert posed.area_px == stone.area_px
    for col in range(posed.width_px):
        rows = [row for row in range(posed.height_px) if posed.mask[row, col]]
        assert (posed.top[col], posed.bottom[col]) == (rows[0], rows[-1])


def test_the_mirror_image_of_the_mirror_image_is_the_stone():
    mask = np.array([[1, 0, 0], [1, 1, 1]], bool)
    posed = PosedStone(Stone(1, mask), 0.0, 1.0, mask.copy(), (1.25, 0.75))
    assert posed.mirrored.mask.tolist() == [[False, False, True], [True, True, True]]
    assert posed.mirrored.anchor == (1.75, 0.75)
    assert np.array_equal(posed.mirrored.mirrored.mask, mask)
    assert posed.mirrored.mirrored.anchor == posed.anchor
