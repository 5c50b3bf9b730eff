"""Convex hull of the pixels of a mask."""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.raster import Mask

_fast = compiled("hull")


def pixel_hull(mask: Mask) -> NDArray[np.int64]:
    """Return the corners of the convex hull of the pixel squares of a mask.

    Parameters
    ----------
    mask : (h, w) bool array
        At least one pixel, row 0 at the top.

    Returns
    -------
    corners : (n, 2) int array
        x to the right and y up, px from the mask's bottom-left corner; counter-clockwise from the
        right end of the lowest edge, no three of them on one line.

    Examples
    --------
    >>> pixel_hull(np.array([[1, 0], [1, 1]], bool)).tolist()
    [[2, 0], [2, 1], [1, 2], [0, 2], [0, 0]]
    """
    if _fast is None:
        return pixel_hull_numpy(mask)
    corners = np.empty((2 * mask.shape[0] + 2, 2), np.int64)
    count = _fast.pixel_hull(np.ascontiguousarray(mask).view(np.uint8), corners)
    return corners[:count].copy()


def pixel_hull_numpy(mask: Mask) -> NDArray[np.int64]:
    """Twin of :func:`pixel_hull`."""
    rows = np.flatnonzero(mask.any(axis=1))[::-1]
    used, below = mask[rows], mask.shape[0] - rows - 1
    height = np.column_stack([below, below + 1]).ravel().tolist()
    left = np.repeat(used.argmax(axis=1), 2).tolist()
    right = np.repeat(mask.shape[1] - used[:, ::-1].argmax(axis=1), 2).tolist()
    up, down = zip(right, height, strict=True), zip(left[::-1], height[::-1], strict=True)
    # Andrew's monotone chain: corners at which the way around does not turn left are left out.
    chain: list[tuple[int, int]] = []
    for x, y in (*up, *down):
        while len(chain) > 1:
            (x0, y0), (x1, y1) = chain[-2:]
            if (x1 - x0) * (y - y1) > (y1 - y0) * (x - x1):
                break
            chain.pop()
        chain.append((x, y))
    return np.array(chain, np.int64)
