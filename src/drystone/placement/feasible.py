"""Feasible positions of a stone on a landscape (§3.6, Fig. 8, Eq. 12c)."""

from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from drystone.kernels.lowering import Positions, lowered_positions
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone

Reach = Literal["any", "above"]


def feasible_positions(
    landscape: Landscape, posed: PosedStone, reach: Reach = "any", clearance_px: int = 0
) -> Positions:
    """Return all positions where a stone overlaps nothing and rests on something.

    Row and column, (n, 2), of the mask's top-left corner, by row, then column; landscape and
    stone are in one view.  Reach ``"any"``: every position of the image, closed cavities too, as in
    the paper; ``"above"``: only where the stone can be lowered in from above, with `clearance_px`
    free on both sides of it on its way down to one own height above its place; the last part may
    slide along a neighbour.

    The paper convolves the landscape and the landscape dilated by one pixel with the stone: no
    overlap with the first, overlap with the second.  Resting from below (DESIGN 4.4) is narrower:
    no overlap here, overlap one pixel lower, or the ground.  The same map answers both.
    """
    if reach == "above":
        top, height = landscape.skyline, landscape.height_px
        return lowered_positions(top, posed.silhouette, height, clearance_px)
    return landscape.bits.resting(posed.silhouette)


def can_be_lowered(
    landscape: Landscape, posed: PosedStone, row: int, col: int, clearance_px: int = 0
) -> bool:
    """Say whether nothing stands above a place, so that the stone can be lowered in from above.

    Row and column are those of its mask's top-left corner; `clearance_px` as for
    :func:`feasible_positions`.
    """
    tops = landscape.skyline[col : col + posed.width_px]
    free = bool(np.all(tops > row + posed.bottom))
    if clearance_px == 0 or not free:
        return free
    # It comes down to one own height above its place with room on both sides.  Beyond its ends the
    # landscape is free down to the ground.
    tops = np.pad(landscape.skyline, clearance_px, constant_values=landscape.height_px)
    tops = tops[col : col + posed.width_px + 2 * clearance_px]
    near = sliding_window_view(tops, 2 * clearance_px + 1).min(axis=1)
    return bool(np.all(near > row - posed.height_px + posed.bottom))
