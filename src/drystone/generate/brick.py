"""Bricks: stones of which everything is known in closed form."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from drystone.generate.layout import check_room, check_setting, stones_of
from drystone.model.settings import typed
from drystone.model.stone import StoneSet


@typed
@dataclass(frozen=True, kw_only=True)
class BrickSettings:
    """Equal bricks.

    Parameters
    ----------
    count : int
        Number of whole bricks; with `halves` at least one.
    height_px : int
        Height of a brick, at least 1 px.
    aspect : float
        Width over height, 2 or 3 for usual bricks; the width is rounded to whole px, at least 2.
    halves : int
        Number of half bricks, as wide as floor(width / 2).
    """

    count: int = 60
    height_px: int = 12
    aspect: float = 3.0
    halves: int = 0

    def __post_init__(self) -> None:
        numbers = self.count >= 0 and self.halves >= 0 and self.count + self.halves >= 1
        check_setting(numbers, "there must be at least one brick", "brick")
        check_setting(self.height_px >= 1, "the height must be 1 px or more", "brick")
        # Checked before it is rounded: a product that is not finite has no whole px.
        width_px = self.height_px * self.aspect
        check_setting(width_px >= 1.5, "the width must be 2 px or more", "brick")
        size_px = width_px, self.height_px
        names = ("height_px", "aspect", "count") + (("halves",) if self.halves else ())
        check_room(self.count + self.halves, size_px, names, "brick")

    @property
    def width_px(self) -> int:
        """Width of a whole brick."""
        return math.floor(self.height_px * self.aspect + 0.5)


@typed
def brick_stones(settings: BrickSettings, rng: Generator) -> StoneSet:
    """Generate bricks lying on their bed faces, halves among them in random order.

    Parameters
    ----------
    settings : BrickSettings
        Size and numbers.
    rng : Generator
        Decides which ids are halves; equal states give equal stones.

    Examples
    --------
    >>> stones = brick_stones(BrickSettings(count=2, halves=1), np.random.default_rng(1))
    >>> sorted(stone.area_px for stone in stones)
    [216, 432, 432]
    """
    widths = [settings.width_px] * settings.count + [settings.width_px // 2] * settings.halves
    order = rng.permutation(np.array(widths)).tolist()
    return stones_of([np.ones((settings.height_px, width), bool) for width in order])
