"""Free space around a mask, column by column and row by row."""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask


def free_below(occupied: Mask, bottom: NDArray[np.intp], row: int, col: int) -> NDArray[np.intp]:
    """Return the free height under each column of a mask, down to what is below or the ground.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape without the mask.
    bottom : (w',) int array
        Row of the lowest pixel of each column of the mask.
    row, col : int
        Top-left corner of the mask.
    """
    height = occupied.shape[0]
    start = row + bottom + 1
    columns = occupied[:, col : col + bottom.size]
    below = columns & (np.arange(height)[:, None] >= start)
    first = np.where(below.any(axis=0), np.argmax(below, axis=0), height)
    return np.asarray(first - start)


def free_beside(occupied: Mask, mask: Mask, row: int, col: int) -> tuple[int, int]:
    """Return the free pixels left of a mask, and the narrowest free width right of it.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape without the mask.
    mask : (h', w') bool array
        Every row has a pixel.
    row, col : int
        Its top-left corner.

    Returns
    -------
    left_area : int
        Free pixels in the mask's rows between it and the next occupied pixel or the end.
    right_width : int
        The smallest number of free pixels in a row to the right.
    """
    height, width = mask.shape
    band = occupied[row : row + height]
    x = np.arange(occupied.shape[1])
    first = col + np.argmax(mask, axis=1)
    last = col + width - np.argmax(mask[:, ::-1], axis=1)
    before = np.where(band & (x < first[:, None]), x + 1, 0).max(axis=1)
    after = np.where(band & (x >= last[:, None]), x, occupied.shape[1]).min(axis=1)
    return int((first - before).sum()), int((after - last).min())
