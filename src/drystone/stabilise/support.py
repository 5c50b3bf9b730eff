"""The support polyline AB of a stone over all its supporters (§3.7, Fig. 9a)."""

from dataclasses import dataclass

from drystone.kernels.raster import Mask
from drystone.kernels.support import support_ends
from drystone.model.pose import PosedStone
from drystone.stabilise.settings import StabiliseSettings

Pose = tuple[PosedStone, int, int]
"""A turned stone, and the row and column of its mask's top-left corner."""


@dataclass(frozen=True)
class Support:
    """The ends of the support polyline, in image coordinates (x right, rows downwards)."""

    # x of A and B: the outer edges of the outermost supporting pixels
    left_x: int
    right_x: int
    # rows of the edges on which they stand
    left_row: int
    right_row: int

    def falls(self, x_c: float, margin_px: float = 0.0) -> int:
        """Say to which side the stone falls: -1 left, +1 right, 0 when it is stable.

        Stable: the centre of mass projects inside AB, at least `margin_px` (0 in the paper) from
        both ends; of a support too short for both margins the nearer end decides.
        """
        from_left, from_right = x_c - self.left_x, self.right_x - x_c
        if min(from_left, from_right) >= margin_px:
            return 0
        return -1 if from_left < from_right else 1


def support_polyline(occupied: Mask, posed: PosedStone, row: int, col: int) -> Support | None:
    """Return the support polyline of a stone at a position; None when nothing supports it.

    A pixel supports where the stone moved down by one would overlap a stone, a wedge or the
    ground; a touch at the side carries nothing (DESIGN 4.6).  The ends of the wall carry nothing.
    `occupied` is the landscape without the stone.
    """
    ends = support_ends(occupied, posed.mask, row, col)
    return None if ends is None else Support(*ends)


def falling_side(support: Support, pose: Pose, settings: StabiliseSettings) -> int:
    """Say to which side a stone on its support falls: -1 left, +1 right, 0 when it is stable."""
    posed, _, col = pose
    return support.falls(col + posed.anchor[0], settings.margin * posed.width_px)
