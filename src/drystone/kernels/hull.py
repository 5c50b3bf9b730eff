"""Convex hull of the pixels of a mask."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import flags, longs_out


def pixel_hull(mask: Mask) -> NDArray[np.int64]:
    """Return the corners of the convex hull of the pixel squares of a mask.

    x to the right and y up, px from the mask's bottom-left corner; counter-clockwise from the right
    end of the lowest edge, no three of them on one line.
    """
    mask = np.ascontiguousarray(mask)
    height: cython.Py_ssize_t = mask.shape[0]
    width: cython.Py_ssize_t = mask.shape[1]
    # As many as there could ever be on the way: two a row on one side, then on the other.
    corners = np.empty((2 * height + 2, 2), np.int64)
    pixels: cython.p_uchar = flags(mask)
    chain: cython.p_longlong = longs_out(corners)
    count: cython.Py_ssize_t = 0
    for row in range(height - 1, -1, -1):
        col = width
        while col > 0 and not pixels[row * width + col - 1]:
            col -= 1
        if col:
            count = put(chain, count, col, height - row - 1)
            count = put(chain, count, col, height - row)
    for row in range(height):
        col = 0
        while col < width and not pixels[row * width + col]:
            col += 1
        if col < width:
            count = put(chain, count, col, height - row)
            count = put(chain, count, col, height - row - 1)
    return corners[:count].copy()


def put(at, count, x, y):
    """Add a point to the chain of corners (Andrew's); return how many there are then."""
    x1: cython.longlong
    y1: cython.longlong
    while count > 1:
        k = 2 * count - 4
        x1, y1 = at[k + 2], at[k + 3]
        # Corners at which the way around does not turn left are left out.
        if (x1 - at[k]) * (y - y1) > (y1 - at[k + 1]) * (x - x1):
            break
        count -= 1
    at[2 * count], at[2 * count + 1] = x, y
    return count + 1
