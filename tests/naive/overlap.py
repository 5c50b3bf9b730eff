"""Slow, obvious twins of overlap and of lowering: loops over pixels."""

import numpy as np

from drystone.kernels.raster import Mask


def overlaps(occupied: Mask, mask: Mask, row: int, col: int) -> bool:
    """Whether some pixel of the mask meets an occupied one, or leaves the image (§3.6)."""
    height, width = occupied.shape
    for i, j in zip(*np.nonzero(mask), strict=True):
        r, c = row + i, col + j
        if not (0 <= r < height and 0 <= c < width) or occupied[r, c]:
            return True
    return False


def lowered(occupied: Mask, mask: Mask, col: int) -> int | None:
    """Row at which a mask comes to rest that is lowered from far above, row by row.

    The site is open at the top; None when the mask comes to rest above it.
    """
    height = mask.shape[0]
    sky = np.zeros((height + 1, occupied.shape[1]), bool)
    scene = np.vstack([sky, occupied])
    row = 0
    while not overlaps(scene, mask, row + 1, col):
        row += 1
    row -= height + 1
    return row if row >= 0 else None
