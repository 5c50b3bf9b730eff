"""Wedging: a small stone under the free side (§3.7, Fig. 9c)."""

import math

from drystone.kernels.columns import gap_filling
from drystone.kernels.raster import Mask
from drystone.model.placement import Wedge
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.support import Pose, falling_side, support_polyline


def wedge_sizes_px(mean_height_px: float, settings: StabiliseSettings) -> tuple[int, int]:
    """Return the smallest height and width, and the largest height, of a wedge in whole px."""
    smallest = settings.min_wedge_px
    return smallest, math.floor(max(smallest, settings.max_wedge_height * mean_height_px))


def wedge_under(
    occupied: Mask,
    pose: Pose,
    wedge_id: int,
    mean_height_px: float,
    settings: StabiliseSettings,
) -> Wedge | None:
    """Cut the wedge that keeps an unstable stone where it is (§3.7, Fig. 9c).

    The free side is the part of the stone beyond the end of its support to which it falls.  It is
    lowered in thought until it touches; how far gives the wedge's height, the columns that touch
    then give its width.  Only columns far enough out to bring the centre of mass inside the new
    support count.  The wedge is the gap itself in those columns, so it touches the stone above
    and what is below all along.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape without the stone.
    pose : (PosedStone, int, int)
        The stone and the row and column of its mask.
    wedge_id : int
        Id to give to the wedge.
    mean_height_px : float
        Mean height of the stones, which limits the wedge's.
    settings : StabiliseSettings
        Smallest and largest size, margin.

    Returns
    -------
    wedge : Wedge or None
        None when no wedge within the limits holds the stone.
    """
    posed, row, col = pose
    support = support_polyline(occupied, posed, row, col)
    side = 0 if support is None else falling_side(support, pose, settings)
    if side == 0:
        return None
    sizes = wedge_sizes_px(mean_height_px, settings)
    columns = _useful_columns(pose, side, settings)
    filling = gap_filling(occupied, posed.mask, row, col, columns, sizes)
    # Between sloping faces a wedge may be higher than each of its columns.
    if filling is None or filling[0].shape[0] > sizes[1]:
        return None
    return Wedge(wedge_id, posed.stone.id, *filling)


def _useful_columns(pose: Pose, side: int, settings: StabiliseSettings) -> tuple[int, int]:
    """Return the columns whose support would bring the centre of mass inside, first and end."""
    posed, _, col = pose
    x_c, margin = col + posed.anchor[0], settings.margin * posed.width_px
    if side > 0:  # the right edge of a column at the centre of mass, or beyond it by the margin
        return max(0, math.ceil(x_c + margin) - 1 - col), posed.width_px
    # A narrow stone may have none: its centre of mass is nearer to the end than the margin.
    return 0, max(0, min(posed.width_px, math.floor(x_c - margin) + 1 - col))
