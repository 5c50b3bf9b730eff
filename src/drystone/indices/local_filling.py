"""LFR: how densely the wall is filled on the building side of a stone and below it (Eq. 4)."""

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
