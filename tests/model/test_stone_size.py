"""One measure of stones: the smallest rectangle."""

import numpy as np
import pytest

from drystone.model.stone_size import median_sides, sides_px, sizes_of


@pytest.mark.parametrize("angle_deg", [0, 10, 30, 45, 70, 90])
@pytest.mark.parametrize("size", [(120, 60), (120, 120)])
def test_a_turned_stone_has_its_own_sides(size, angle_deg):
    rows, cols = np.mgrid[-100:101, -100:101]
    at = (cols + 1j * rows) * np.exp(1j * np.deg2rad(angle_deg))
    mask = (abs(at.real) <= size[0] / 2) & (abs(at.imag) <= size[1] / 2)
    # The box of a square that lies at 45 degrees, and its longest direction, have 170 px.
    assert sides_px(mask) == pytest.approx(size, abs=1.2)


def test_room_around_stones_changes_nothing_and_the_median_is_that_of_either_side():
    labels = np.zeros((50, 60), np.uint16)
    labels[10:14, 20:29] = 7
    labels[30:40, 40:42] = 2
    two, seven = sizes_of(labels)
    assert (two.id, two.at_px, two.area_px) == (2, (41.0, 35.0), 20)
    assert (seven.id, seven.at_px, seven.area_px) == (7, (24.5, 12.0), 36)
    assert (seven.length_px, seven.width_px) == sides_px(labels == 7) == (9.0, 4.0)
    assert sides_px(np.ones((1, 1), bool)) == (1.0, 1.0)
    assert sides_px(np.ones((7, 1), bool)) == sides_px(np.ones((1, 7), bool)) == (7.0, 1.0)
    assert median_sides([(6.0, 2.0), (9.0, 1.0)]) == (7.5, 1.5)
