"""Walls that are drawn."""

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.generate import BrickSettings, brick_stones
from drystone_lab.rl.draw import KINDS, DrawSettings, draw_wall, in_order


@pytest.mark.parametrize("kind", KINDS)
def test_size_and_surplus_are_those_asked_for(kind):
    settings = DrawSettings(kinds=(kind,), stones=30, size_px=16.0, surplus=1.3, aspect=2.0)
    stones, site = draw_wall(settings, np.random.default_rng(3))
    assert [stone.id for stone in stones] == list(range(1, 31))
    assert (stones.total_area_px / 30) ** 0.5 == pytest.approx(16.0, rel=0.12)
    area = site.width_px * site.height_px
    assert stones.total_area_px / area == pytest.approx(1.3, rel=0.03)
    assert site.width_px / site.height_px == pytest.approx(2.0, rel=0.03)


def test_order_keeps_every_stone():
    bricks = brick_stones(BrickSettings(count=8, halves=4), np.random.default_rng(1))
    again = in_order(bricks, np.random.default_rng(2))
    widths = [[stone.mask.shape[1] for stone in some] for some in (bricks, again)]
    assert widths[0] != widths[1]
    assert sorted(widths[0]) == sorted(widths[1])


@pytest.mark.parametrize(
    "wrong",
    [{"kinds": ()}, {"kinds": ("marble",)}, {"stones": 2}, {"size_px": 3.0}, {"surplus": 0.0},
     {"aspect": 0.0}],
)  # fmt: skip
def test_refuses(wrong):
    with pytest.raises(UsageError, match="E123"):
        DrawSettings(**wrong)
