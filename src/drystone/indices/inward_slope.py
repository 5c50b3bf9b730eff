"""IS: how much the top of a stone at an end of the wall slopes inwards (Eq. 10)."""

import math

from drystone.model.landscape import Box, Landscape
from drystone.model.pose import PosedStone


def inward_slope(landscape: Landscape, posed: PosedStone, col: int) -> float:
    """Return IS in [-1, 1], positive when the top falls towards the middle of the wall (Eq. 10).

    The slope is that between the highest points of the left and the right half of the stone,
    split at its centroid; of equal heights the outermost.

    Parameters
    ----------
    landscape : Landscape
        Gives the width of the wall.
    posed : PosedStone
        In the landscape's view.
    col : int
        Column of the mask's left edge.
    """
    top: list[int] = posed.top.tolist()
    x_c = posed.anchor[0]
    # Column k is centred at k + 1/2; one exactly at the centroid belongs to both halves, as x_c
    # does in Eq. 10.
    left_half = top[: max(0, math.floor(x_c + 0.5))]
    right_half = top[max(0, math.ceil(x_c - 0.5)) :]
    if not (left_half and right_half):
        return 0.0
    left = left_half.index(min(left_half))
    right = len(top) - 1 - right_half[::-1].index(min(right_half))
    if left == right:
        return 0.0
    # Rows count downwards: a smaller row is higher.
    slope = (top[right] - top[left]) / (left - right)
    centre = col + posed.anchor[0] - landscape.width_px / 2
    side = (centre > 0) - (centre < 0)
    return min(1.0, max(-1.0, slope * side))


def is_boundary(landscape: Landscape, box: Box, narrowest_px: float) -> bool:
    """Say whether a stone is nearer to an end of the wall than the narrowest stone is wide."""
    return min(box.left, landscape.width_px - box.right) < narrowest_px
