"""What a call cannot do without: words, look-ups, samples that it has to touch."""

import math

import numpy as np

from benchmarks.scenes import Scene
from drystone.kernels.raster import Mask
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.placement.feasible import feasible_positions

WORD_BITS = 64
SAMPLES = 4
"""Sample points along a working px, at scales from a quarter on."""


def runs(mask: Mask) -> int:
    """Return the number of horizontal runs of set pixels.

    Examples
    --------
    >>> runs(np.array([[1, 0, 1], [0, 1, 1]], bool))
    3
    """
    before = np.pad(mask, ((0, 0), (1, 0)))[:, :-1]
    return int(np.count_nonzero(mask & ~before))


def swept(mask: Mask) -> Mask:
    """Return the pixels of the bounding box that the rays of a stone sweep (Eq. 4)."""
    left = np.logical_or.accumulate(mask[:, ::-1], axis=1)[:, ::-1]
    return np.asarray((left | np.logical_or.accumulate(mask, axis=0)) & ~mask)


def words(scene: Scene, posed: PosedStone) -> float:
    """Return the words of the image that are looked at, all of them for every run of the stone."""
    return runs(posed.mask) * scene.pixels / WORD_BITS


def look_ups(scene: Scene, posed: PosedStone) -> float:
    """Return the prefix sums that are looked up: six, and two a run, for every position."""
    positions = len(feasible_positions(scene.landscape(), posed))
    return positions * (6.0 + 2.0 * runs(swept(posed.mask)))


def samples(stone: Stone, scale: float) -> float:
    """Return the sample points of the box of a stone that is not turned."""
    height, width = stone.mask.shape
    return math.ceil(height * scale) * math.ceil(width * scale) * float(SAMPLES**2)
