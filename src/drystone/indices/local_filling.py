"""LFR: how densely the wall is filled on the building side of a stone and below it (Eq. 4)."""

import numpy as np

from drystone.kernels.raster import Mask
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone


def local_filling_ratio_at(landscape: Landscape, posed: PosedStone, row: int, col: int) -> float:
    """Return LFR of a stone at a position, in [0, 1]; 1 where the rays sweep nothing (Eq. 4).

    Counted are the pixels of the site outside the stone that lie left of it in one of its rows or
    below it in one of its columns; rays pass through stones; wedges count as filled.

    Parameters
    ----------
    landscape : Landscape
        Before the stone is placed.
    posed : PosedStone
        In the landscape's view.
    row, col : int
        Top-left corner of the mask.
    """
    return landscape.rays.filled_share_at(posed.silhouette, row, col)


def swept_pixels(landscape: Landscape, posed: PosedStone, row: int, col: int) -> Mask:
    """Return the pixels that the rays of :func:`local_filling_ratio_at` sweep (Fig. 7).

    Parameters
    ----------
    landscape, posed, row, col
        As there.

    Returns
    -------
    swept : (h, w) bool array
        As large as the landscape.
    """
    stone = np.zeros(landscape.occupied.shape, bool)
    stone[row : row + posed.height_px, col : col + posed.width_px] = posed.mask
    left_of_it = np.logical_or.accumulate(stone[:, ::-1], axis=1)[:, ::-1]
    below_it = np.logical_or.accumulate(stone, axis=0)
    return np.asarray((left_of_it | below_it) & ~stone)
