"""Masks that are lowered onto a landscape from above, for all columns at once (§3.6)."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.backend import compiled
from drystone.kernels.raster import Mask
from drystone.kernels.silhouette import Ints, Silhouette

Positions = NDArray[np.int64]

_fast = compiled("lowering")


def skyline(occupied: Mask) -> Ints:
    """Return the row of the highest occupied pixel of each column; the height where there is none.

    Examples
    --------
    >>> skyline(np.array([[0, 0, 1], [1, 0, 1]], bool)).tolist()
    [1, 2, 0]
    """
    if _fast is None:
        return skyline_numpy(occupied)
    tops: Ints = _fast.skyline(occupied)
    return tops


def skyline_numpy(occupied: Mask) -> Ints:
    """Twin of :func:`skyline`."""
    tops = np.where(occupied.any(axis=0), np.argmax(occupied, axis=0), occupied.shape[0])
    return np.asarray(tops, np.int32)


def lowered_positions(top: Ints, mask: Silhouette, height: int, clearance: int = 0) -> Positions:
    """Return where a mask comes to rest that is lowered from above, by row, then column.

    Parameters
    ----------
    top : (w,) int array
        From :func:`skyline`.
    mask : Silhouette
        Of the mask.
    height : int
        Number of rows of the landscape, which is open at the top and ends on the ground.
    clearance : int
        Only where the mask, with so many px on both sides, can come down to one own height above.

    Returns
    -------
    positions : (n, 2) int array
        Row and column of the mask's top-left corner; none where it would stand out at the top.

    Examples
    --------
    >>> from drystone.kernels.silhouette import silhouette
    >>> block = silhouette(np.ones((1, 2), bool))
    >>> lowered_positions(np.array([5, 3, 5, 5], np.int32), block, 5).tolist()
    [[2, 0], [2, 1], [4, 2]]
    """
    if _fast is None:
        return lowered_positions_numpy(top, mask, height, clearance)
    found: Positions = _fast.lowered_positions(top, mask.bottom, mask.height, height, clearance)
    return found


def lowered_positions_numpy(
    top: Ints, mask: Silhouette, height: int, clearance: int = 0
) -> Positions:
    """Twin of :func:`lowered_positions`."""
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
