"""Masks that are lowered onto a landscape from above, for all columns at once (§3.6)."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.raster import Mask
from drystone.kernels.silhouette import Ints, Silhouette

Positions = NDArray[np.int64]


def skyline(occupied: Mask) -> Ints:
    """Return the row of the highest occupied pixel of each column; the height for none."""
    top = np.where(occupied.any(axis=0), np.argmax(occupied, axis=0), occupied.shape[0])
    return np.asarray(top, np.int32)


def lowered_positions(top: Ints, mask: Silhouette, height: int, clearance: int = 0) -> Positions:
    """Return where a mask comes to rest that is lowered from above, by row, then column.

    The landscape has a :func:`skyline` and so many rows; it is open at the top and ends on the
    ground.  Positions (n, 2) are row and column of the mask's top-left corner, none where it would
    stand out at the top; with a clearance only those where the mask, with so many px on both sides,
    can come down to one own height above.
    """
    rows = _drop_rows(top, mask.bottom)
    inside = rows >= 0
    if clearance and rows.size:
        # A wider mask meets what the mask meets that is lowered onto wider stones.
        wider = ndimage.minimum_filter1d(top, 2 * clearance + 1, mode="constant", cval=height)
        inside &= _drop_rows(wider, mask.bottom) >= rows - mask.height
    cols = np.flatnonzero(inside)
    order = np.argsort(rows[cols], kind="stable")
    return np.column_stack([rows[cols], cols])[order].astype(np.int64, order="C")


def _drop_rows(top: Ints, bottom: Ints) -> Ints:
    """Return the row at which a mask comes to rest, for every column; negative above the image."""
    if bottom.size > top.size:
        return np.zeros(0, np.int32)
    windows = np.lib.stride_tricks.sliding_window_view(top, bottom.size)
    return np.asarray((windows - bottom).min(axis=1) - 1)
