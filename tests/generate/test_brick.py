import math

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.generate.brick import BrickSettings, brick_stones


@pytest.mark.parametrize(("aspect", "width"), [(2, 24), (3, 36), (2.5, 30)])
def test_bricks_are_exact(aspect, width):
    stones = brick_stones(BrickSettings(count=7, aspect=aspect), np.random.default_rng(0))
    assert [stone.mask.shape for stone in stones] == [(12, width)] * 7
    assert [stone.area_px for stone in stones] == [12 * width] * 7


def test_the_narrowest_brick():
    stones = brick_stones(BrickSettings(count=1, aspect=1.5 / 12), np.random.default_rng(0))
    assert [stone.mask.shape for stone in stones] == [(12, 2)]


def test_halves_are_half_as_wide_and_lie_among_the_others():
    settings = BrickSettings(count=20, halves=8)
    stones = brick_stones(settings, np.random.default_rng(0))
    widths = [stone.mask.shape[1] for stone in stones]
    assert sorted(widths) == [18] * 8 + [36] * 20
    assert widths != sorted(widths)
    assert widths != sorted(widths, reverse=True)


@pytest.mark.parametrize(
    "wrong",
    [
        {"count": 0},
        {"count": -1, "halves": 2},
        {"height_px": 0},
        {"aspect": 0.05},
        {"aspect": 1.49 / 12},
        {"aspect": -1e308},  # the product is not finite
        {"aspect": math.nan},
    ],
)
def test_impossible_settings(wrong):
    with pytest.raises(UsageError, match="E130 generate brick"):
        BrickSettings(**wrong)
