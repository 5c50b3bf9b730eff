"""Stones of the noise levels, the walls they are for, and published walls as references."""

import numpy as np
import pytest

from drystone_lab.reproduce.noise import measured, reference_of
from drystone_lab.walls import NOISY


def test_generated_stones_stand_in_only_where_published_ones_are_not_at_hand(data_dir, tmp_path):
    counts = {wall.number: len(wall.source.stones(data_dir)) for wall in NOISY}
    assert counts == {10: 28, 20: 23, 30: 22, 40: 26, 50: 27, 60: 23, 70: 25, 80: 18}
    for wall in NOISY:
        assert wall.here(data_dir) is wall
        assert (wall.said, wall.width) == ("published", 0)
        made = wall.here(tmp_path)
        assert (made.name, made.number, made.scale) == (wall.name, wall.number, wall.scale)
        assert made.said == "generated: not in the data folder"
        stones = made.source.stones(None)
        assert stones.total_area_px / (made.width * made.height) == pytest.approx(0.696, abs=2e-3)


def two_piers(gap):
    """A slab on two stones, gap px above them, in an image of 60 x 120 px."""
    labels = np.zeros((60, 120), np.uint32)
    labels[40:, :40] = 1
    labels[40:, 80:] = 2
    labels[20 - gap : 40 - gap, :] = 3
    return labels


def test_a_reference_is_measured_on_all_of_its_image():
    found = measured(two_piers(0), 0.5)
    assert found.metrics.stones == 3
    assert found.metrics.F_SF == pytest.approx((2 * 40 * 20 + 120 * 20) / (60 * 120))
    assert found.metrics.F_LR is not None
    assert found.resistances == pytest.approx([found.metrics.F_LR] * 4)


def test_the_resistance_of_a_reference_needs_its_gaps_closed():
    # 8 px of the source are 4 of the image, and 20/3 px of the source 3.3 of it.
    found = measured(two_piers(8), 0.5)
    open_, _, twice, thrice = found.resistances
    assert open_ is twice is found.metrics.F_LR is None
    assert thrice is not None


def test_only_published_walls_are_references(data_dir):
    wall = NOISY[1]
    assert reference_of(wall.here(None), data_dir) is None
    assert reference_of(wall, None) is None
    found = reference_of(wall, data_dir).metrics
    assert found.stones == 23
    assert found.F_SF == pytest.approx(0.659, abs=5e-4)
