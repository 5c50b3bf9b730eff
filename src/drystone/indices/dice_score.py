"""GDS: how much a stone fills the part of the wall that is begun (Eq. 5)."""

import numpy as np
from numpy.typing import NDArray

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
    box_area = float(landscape.width_px * landscape.built_height_px)
    if box_area == 0:
        return np.zeros(len(rows))
    # Pixels of the stone from its row k downwards lie in B when B's top row is k rows below its.
    from_row = np.append(np.cumsum(posed.mask.sum(axis=1)[::-1])[::-1], 0)
    box_top = landscape.height_px - landscape.built_height_px
    inside = from_row[np.clip(box_top - rows, 0, posed.height_px)]
    area = posed.area_px
    return np.asarray((inside / area) * (box_area / (box_area + area - inside)))
