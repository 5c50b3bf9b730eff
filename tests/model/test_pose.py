"""A turned stone: its profile and its mirror image for views."""

import numpy as np
from hypothesis import given

from drystone.model.pose import PosedStone
from tests.strategies import repeatable, stones


@repeatable()
@given(stone=stones())
def test_profiles_are_the_outermost_pixels_and_a_mirror_image_is_mirrored(stone):
    posed = PosedStone(stone, 0.0, 1.0, stone.mask.copy(), (1.25, 0.75))
    assert (posed.height_px, posed.width_px) == stone.mask.shape
    assert posed.area_px == stone.area_px
    for col in range(posed.width_px):
        rows = [row for row in range(posed.height_px) if posed.mask[row, col]]
        assert (posed.top[col], posed.bottom[col]) == (rows[0], rows[-1])
    assert np.array_equal(posed.mirrored.mask, stone.mask[:, ::-1])
    assert posed.mirrored.anchor == (posed.width_px - 1.25, 0.75)
