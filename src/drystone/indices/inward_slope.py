"""IS: how much the top of a stone at an end of the wall slopes inwards (Eq. 10)."""

import math

from drystone.model.landscape import Box, Landscape
from drystone.model.pose import PosedStone


def peak_columns(posed: PosedStone) -> tuple[int, int] | None:
    """Return the columns of the highest points of the left and the right half of a stone.

    The halves are split at the centroid; of equal heights the outermost is taken.  None when one
    half has no column.
    """
    top: list[int] = posed.top.tolist()
    x_c = posed.anchor[0]
    # Column k is centred at k + 1/2; one exactly at the centroid belongs to both halves, as x_c
    # does in Eq. 10.
    left_half = top[: max(0, math.floor(x_c + 0.5))]
    right_half = top[max(0, math.ceil(x_c - 0.5)) :]
    if not (left_half and right_half):
        return None
    left = left_half.index(min(left_half))
    return left, len(top) - 1 - right_half[::-1].index(min(right_half))


def inward_slope(landscape: Landscape, posed: PosedStone, col: int) -> float:
    """Return IS in [-1, 1], positive when the top falls towards the middle of the wall (Eq. 10).

    The slope is that between the highest points of the halves (:func:`peak_columns`).

    Parameters
    ----------
    landscape : Landscape
        Gives the width of the wall.
    posed : PosedStone
        In the landscape's view.
    col : int
        Column of the mask's left edge.
    """
    peaks = peak_columns(posed)
    if peaks is None or peaks[0] == peaks[1]:
        return 0.0
    left, right = peaks
    # Rows count downwards: a smaller row is higher.
    slope = int(posed.top[right] - posed.top[left]) / (left - right)
    centre = col + posed.anchor[0] - landscape.width_px / 2
    side = (centre > 0) - (centre < 0)
    return min(1.0, max(-1.0, slope * side))


def is_boundary(landscape: Landscape, box: Box, narrowest_px: float) -> bool:
    """Say whether a stone is nearer to an end of the wall than the narrowest stone is wide."""
    return min(box.left, landscape.width_px - box.right) < narrowest_px
