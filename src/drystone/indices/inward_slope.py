"""IS: how much the top of a stone at an end of the wall slopes inwards (Eq. 10)."""

import numpy as np

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
    x = np.arange(posed.width_px) + 0.5
    top, x_c = posed.top, posed.anchor[0]
    # A column exactly at the centroid belongs to both halves, as x_c does in Eq. 10.
    left_half, right_half = top[x <= x_c], top[x >= x_c]
    if not (left_half.size and right_half.size):
        return 0.0
    left = int(np.argmin(left_half))
    right = posed.width_px - 1 - int(np.argmin(right_half[::-1]))
    if left == right:
        return 0.0
    # Rows count downwards: a smaller row is higher.
    slope = (top[right] - top[left]) / (left - right)
    centre = col + posed.anchor[0] - landscape.width_px / 2
    return float(np.clip(slope * np.sign(centre), -1.0, 1.0))


def is_boundary(landscape: Landscape, box: Box, narrowest_px: float) -> bool:
    """Say whether a stone is nearer to an end of the wall than the narrowest stone is wide."""
    return min(box.left, landscape.width_px - box.right) < narrowest_px
