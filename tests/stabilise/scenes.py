"""Unstable stones for the tests of stabilisation."""

import numpy as np

from drystone.kernels.raster import Mask
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.poses import PoseBook

Pose = tuple[PosedStone, int, int]


def ledge(height: int = 4, width: int = 14, site: tuple[int, int] = (24, 50)) -> Mask:
    """Ground with a step at the left."""
    occupied = np.zeros(site, bool)
    occupied[site[0] - height :, :width] = True
    return occupied


def bar_on_the_ledge(occupied: Mask, book: PoseBook, col: int = 2, length: int = 30) -> Pose:
    """A bar that lies on the ledge and overhangs to the right."""
    posed = book.pose(Stone(7, np.ones((6, length), bool)), 0.0)
    top = int(np.flatnonzero(occupied[:, col])[0])
    return posed, top - 6, col


def mirrored(occupied: Mask, pose: Pose, book: PoseBook) -> tuple[Mask, Pose]:
    """The same scene with the stone's own mirror image, as another stone."""
    posed, row, col = pose
    other = book.pose(Stone(posed.stone.id + 1, posed.stone.mask[:, ::-1]), 0.0)
    return occupied[:, ::-1].copy(), (other, row, occupied.shape[1] - col - posed.width_px)
