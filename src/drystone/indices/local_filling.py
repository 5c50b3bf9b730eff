"""LFR: how densely the wall is filled on the building side of a stone and below it (Eq. 4)."""

import numpy as np
from numpy.typing import NDArray

from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone


def local_filling_ratio(
    landscape: Landscape, posed: PosedStone, positions: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Return LFR at many positions of one stone, each in [0, 1] (Eq. 4).

    Counted are the pixels of the site outside the stone that lie left of it in one of its rows or
    below it in one of its columns; rays pass through stones; wedges count as filled.

    Parameters
    ----------
    landscape : Landscape
        Before the stone is placed.
    posed : PosedStone
        In the landscape's view.
    positions : (n, 2) int array
        Row and column of the mask's top-left corner.

    Returns
    -------
    ratio : (n,) float array
        1 where the rays sweep nothing.
    """
    return landscape.rays.filled_share(posed.silhouette, positions)


def local_filling_ratio_at(landscape: Landscape, posed: PosedStone, row: int, col: int) -> float:
    """Return LFR at one position: the same number without prefix sums.

    Parameters
    ----------
    landscape, posed
        As for :func:`local_filling_ratio`.
    row, col : int
        Top-left corner of the mask.
    """
    return landscape.rays.filled_share_at(posed.silhouette, row, col)
