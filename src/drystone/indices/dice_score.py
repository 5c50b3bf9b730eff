"""GDS: how much a stone fills the part of the wall that is begun (Eq. 5)."""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.merits import dice_score
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone


def geometrical_dice_score(
    landscape: Landscape, posed: PosedStone, rows: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Return GDS of a stone at many rows, each in [0, 1] (Eq. 5).

    GDS = (|S n B| / A_S) (A_B / |S u B|), B the box over the full width of the wall up to the top
    of what is placed.  1: inside B; 0: outside, and before the first stone.

    Parameters
    ----------
    landscape : Landscape
        Before the stone is placed.
    posed : PosedStone
        The stone.
    rows : (n,) int array
        Row of the mask's top edge.
    """
    mask, box_area = posed.silhouette, float(landscape.width_px * landscape.built_height_px)
    # Pixels of the stone from its row k downwards lie in B when B's top row is k rows below its.
    box_top = landscape.height_px - landscape.built_height_px
    inside = mask.area_from[np.clip(box_top - rows, 0, mask.height)]
    return dice_score(inside, posed.area_px, box_area)


def geometrical_dice_score_at(landscape: Landscape, posed: PosedStone, row: int) -> float:
    """Return GDS at one row: the same number.

    Parameters
    ----------
    landscape, posed
        As for :func:`geometrical_dice_score`.
    row : int
        Row of the mask's top edge.
    """
    mask, box_area = posed.silhouette, float(landscape.width_px * landscape.built_height_px)
    if box_area == 0:
        return 0.0
    box_top = landscape.height_px - landscape.built_height_px
    inside = int(mask.area_from[min(max(box_top - row, 0), mask.height)])
    return (inside / posed.area_px) * (box_area / (box_area + posed.area_px - inside))
