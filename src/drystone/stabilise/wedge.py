"""Wedging: a small stone under the free side (§3.7, Fig. 9c)."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.columns import free_below
from drystone.kernels.raster import Mask
from drystone.model.placement import Wedge
from drystone.stabilise.rotate import Pose
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.support import support_polyline


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
    if support is None:
        return None
    margin = settings.margin * posed.width_px
    x_c = col + posed.anchor[0]
    side = support.falls(x_c, margin)
    if side == 0:
        return None
    x = col + np.arange(posed.width_px)
    useful = x + 1 >= x_c + margin if side > 0 else x <= x_c - margin
    gap = free_below(occupied, posed.bottom, row, col)
    largest = max(settings.min_wedge_px, settings.max_wedge_height * mean_height_px)
    fits = useful & (gap >= settings.min_wedge_px) & (gap <= largest)
    run = _touching_run(gap, fits, settings.min_wedge_px)
    if run is None:
        return None
    wedge = _fill(pose, gap, run, wedge_id)
    # Between sloping faces a wedge may be higher than each of its columns.
    return wedge if wedge is not None and wedge.mask.shape[0] <= largest else None


def _touching_run(gap: NDArray[np.intp], fits: Mask, min_width_px: int) -> tuple[int, int] | None:
    """Return the columns that touch first when the free side is lowered, at least the minimum.

    The run starts from the smallest gap and takes in neighbours whose gap is a pixel larger, or
    more as long as it is narrower than a wedge may be.
    """
    if not fits.any():
        return None
    for slack in range(1, int(gap[fits].max()) + 1):
        for at in np.flatnonzero(fits & (gap == gap[fits].min())):
            start = stop = int(at)
            touches = fits & (gap <= gap[at] + slack)
            while start > 0 and touches[start - 1]:
                start -= 1
            while stop + 1 < gap.size and touches[stop + 1]:
                stop += 1
            if stop + 1 - start >= min_width_px:
                return start, stop + 1
    return None


def _fill(pose: Pose, gap: NDArray[np.intp], run: tuple[int, int], wedge_id: int) -> Wedge | None:
    posed, row, col = pose
    columns = np.arange(*run)
    tops = row + posed.bottom[columns] + 1
    bottoms = tops + gap[columns]
    first, last = int(tops.min()), int(bottoms.max())
    rows = np.arange(first, last)[:, None]
    mask = (rows >= tops) & (rows < bottoms)
    if ndimage.label(mask)[1] != 1:
        return None
    return Wedge(wedge_id, posed.stone.id, mask, first, col + run[0])
