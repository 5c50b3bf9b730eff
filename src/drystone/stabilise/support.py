"""The support polyline AB of a stone over all its supporters (§3.7, Fig. 9a)."""

from dataclasses import dataclass

import numpy as np

from drystone.kernels.raster import Mask
from drystone.model.pose import PosedStone


@dataclass(frozen=True)
class Support:
    """The ends of the support polyline, in image coordinates (x right, rows downwards).

    Parameters
    ----------
    left_x, right_x : float
        x of A and B: the outer edges of the outermost supporting pixels.
    left_row, right_row : int
        Rows of the edges on which they stand.
    """

    left_x: int
    right_x: int
    left_row: int
    right_row: int

    def falls(self, x_c: float, margin_px: float = 0.0) -> int:
        """Say to which side the stone falls: -1 left, +1 right, 0 when it is stable.

        Stable: the centre of mass projects inside AB, at least `margin_px` from both ends; of a
        support too short for both margins the nearer end decides.

        Parameters
        ----------
        x_c : float
            x of the centre of mass.
        margin_px : float
            Distance wanted from the ends; 0 in the paper.
        """
        from_left, from_right = x_c - self.left_x, self.right_x - x_c
        if min(from_left, from_right) >= margin_px:
            return 0
        return -1 if from_left < from_right else 1


def support_polyline(occupied: Mask, posed: PosedStone, row: int, col: int) -> Support | None:
    """Return the support polyline of a stone at a position; None when nothing supports it.

    A pixel supports where the stone moved down by one would overlap a stone, a wedge or the
    ground; a touch at the side carries nothing (DESIGN 4.6).  The ends of the wall carry nothing.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape without the stone.
    posed : PosedStone
        The stone.
    row, col : int
        Top-left corner of its mask; it overlaps nothing there.
    """
    height, width = posed.mask.shape
    below = occupied[row + 1 : row + height + 1, col : col + width]
    hit = np.zeros_like(posed.mask)
    hit[: below.shape[0]] = posed.mask[: below.shape[0]] & below
    if row + height == occupied.shape[0]:
        hit[-1] = posed.mask[-1]
    columns = np.flatnonzero(hit.any(axis=0))
    if columns.size == 0:
        return None
    first, last = int(columns[0]), int(columns[-1])
    lowest = height - np.argmax(hit[::-1, [first, last]], axis=0)
    return Support(col + first, col + last + 1, row + int(lowest[0]), row + int(lowest[1]))
