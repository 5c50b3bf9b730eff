"""Small walls for the tests of this room."""

import numpy as np

from drystone.generate import BrickSettings, brick_stones
from drystone.model.site import Site
from drystone_lab.rl.draw import DrawSettings

SMALL = DrawSettings(kinds=("brick", "polygon"), stones=7, size_px=12.0)


def bricks(count=6):
    """Return bricks of 20 x 10 and a wall that the first four of them fill."""
    settings = BrickSettings(count=count, height_px=10, aspect=2)
    return brick_stones(settings, np.random.default_rng(1)), Site(40, 20)
