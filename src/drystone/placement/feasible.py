"""Feasible positions of a stone on a landscape (§3.6, Fig. 8, Eq. 12c)."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.bits import drop_rows
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone

Reach = Literal["any", "above"]
Positions = NDArray[np.int64]


def feasible_positions(
    landscape: Landscape, posed: PosedStone, reach: Reach = "any", clearance_px: int = 0
) -> Positions:
    """Return all positions where a stone overlaps nothing and rests on something.

    Parameters
    ----------
    landscape : Landscape
        What is built, in its view.
    posed : PosedStone
        The stone, in the same view.
    reach : {"any", "above"}
        ``"any"``: every position of the image, closed cavities too, as in the paper; ``"above"``:
        only where the stone can be lowered in from above.
    clearance_px : int
        For ``"above"``: free working px on both sides of the stone on its way down to one own
        height above its place; the last part may slide along a neighbour.

    Returns
    -------
    positions : (n, 2) int array
        Row and column of the mask's top-left corner, by row, then column.

    Notes
    -----
    The paper convolves the landscape and the landscape dilated by one pixel with the stone: no
    overlap with the first, overlap with the second.  Resting from below (DESIGN 4.4) is narrower:
    no overlap here, overlap one pixel lower, or the ground.  The same map answers both.
    """
    if reach == "above":
        return _lowered(landscape, posed, clearance_px)
    free = ~landscape.bits.overlap(posed.mask)
    rests = np.ones_like(free)
    rests[:-1] = ~free[1:]
    return np.argwhere(free & rests)


def can_be_lowered(landscape: Landscape, posed: PosedStone, row: int, col: int) -> bool:
    """Say whether nothing stands above a place, so that the stone can be lowered in from above."""
    tops = landscape.skyline[col : col + posed.width_px]
    return bool(np.all(tops > row + posed.bottom))


def _lowered(landscape: Landscape, posed: PosedStone, clearance_px: int) -> Positions:
    skyline = landscape.skyline
    rows = drop_rows(skyline, posed.bottom)
    cols = np.arange(rows.size)
    inside = rows >= 0
    if clearance_px:
        # Widened by the clearance, the stone must come down to one own height above its place.
        wider = np.pad(posed.bottom, clearance_px, mode="edge")
        wider = ndimage.maximum_filter1d(wider, 2 * clearance_px + 1)
        ends = np.pad(skyline, clearance_px, constant_values=landscape.height_px)
        inside &= drop_rows(ends, wider) >= rows - posed.height_px
    positions = np.column_stack([rows[inside], cols[inside]]).astype(np.int64)
    return positions[np.lexsort((positions[:, 1], positions[:, 0]))]
