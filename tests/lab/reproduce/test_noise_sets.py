"""Stones of the noise levels, the walls they are for, and published walls as references."""

import numpy as np
import pytest
from PIL import Image

from drystone.io.read_stones import read_stones
from drystone_lab.reproduce.noise_sets import (
    AREA_SHARE,
    ASPECT,
    COUNT,
    NOISES,
    PUBLISHED,
    generated_set,
    measured,
    noise_set,
    reference_of,
)


def test_levels_without_published_stones_are_generated_and_say_so():
    assert NOISES == (10, 20, 30, 40, 50, 60, 70, 80)
    for noise in NOISES:
        wall = noise_set(noise)
        assert wall.number == noise
        assert wall.stand_in is ("generated" in wall.name) is (noise not in PUBLISHED)
        assert (wall.width == 0) is not wall.stand_in
    assert dict(noise_set(60).source.settings) == {"count": COUNT, "noise": 0.6}


def test_generated_stones_are_the_share_of_their_wall_that_published_ones_are(data_dir):
    shares, aspects, counts = [], [], []
    for noise in PUBLISHED:
        path = data_dir / noise_set(noise).source.name
        with Image.open(path) as image:
            width, height = image.size
        stones = read_stones(path)
        shares.append(stones.total_area_px / (width * height))
        aspects.append(width / height)
        counts.append(len(stones))
    assert pytest.approx(np.mean(shares), abs=5e-4) == AREA_SHARE
    assert pytest.approx(np.mean(aspects), abs=5e-3) == ASPECT
    assert round(np.mean(counts)) == COUNT
    wall = generated_set(80, 12, 0.2)
    area = sum(stone.mask.sum() for stone in wall.source.stones(None))
    assert area / (wall.width * wall.height) == pytest.approx(AREA_SHARE, abs=2e-3)
    assert wall.width / wall.height == pytest.approx(ASPECT, abs=0.01)


def two_piers(gap):
    """A slab on two stones, gap px above them, in an image of 60 x 120 px."""
    labels = np.zeros((60, 120), np.uint32)
    labels[40:, :40] = 1
    labels[40:, 80:] = 2
    labels[20 - gap : 40 - gap, :] = 3
    return labels


def test_a_reference_is_measured_on_all_of_its_image():
    found = measured(two_piers(0), 0.5)
    assert found.stones == 3
    assert found.F_SF == pytest.approx((2 * 40 * 20 + 120 * 20) / (60 * 120))
    assert found.resistance is not None
    assert found.F_LR == pytest.approx([found.resistance] * 4)


def test_the_resistance_of_a_reference_needs_its_gaps_closed():
    # 8 px of the source are 4 of the image, and 20/3 px of the source 3.3 of it.
    found = measured(two_piers(8), 0.5)
    open_, _, twice, thrice = found.F_LR
    assert open_ is None
    assert twice is None
    assert thrice is not None
    assert found.metric("F_LR") is found.resistance is None
    assert found.metric("F_SF") == found.F_SF


def test_only_published_walls_are_references(data_dir):
    assert reference_of(noise_set(30), data_dir) is None
    assert reference_of(noise_set(20), None) is None
    found = reference_of(noise_set(20), data_dir)
    assert found is not None
    assert found.stones == 23
    assert found.F_SF == pytest.approx(0.659, abs=5e-4)
