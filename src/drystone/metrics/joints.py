"""Where the joints of a wall are (DESIGN 5)."""

import numpy as np

from drystone.kernels.raster import Mask
from drystone.model.wall import Labels

PAD_TOP, PAD_BOTTOM, PAD_LEFT, PAD_RIGHT = 1, 2, 1, 2
"""Open rows and columns around the wall, px: paths may run along its outside."""


def joint_mask(labels: Labels) -> Mask:
    """Return where a path may run: everything that is not the inside of a stone.

    Every stone is eroded once by a 3 x 3 square, so stones that touch have a joint of 2 px.  The
    edge of the image erodes nothing.  The result, (h + 3, w + 3), is padded by :data:`PAD_TOP` and
    the other three with open joint: pixel (row, col) of the wall is pixel (row + 1, col + 1) of it.
    """
    height, width = labels.shape
    # Repeating the edge gives an outer pixel neighbours of its own stone.
    around = np.pad(labels, 1, mode="edge")
    inside = labels > 0
    for row in range(3):
        for col in range(3):
            inside &= around[row : row + height, col : col + width] == labels
    pad = ((PAD_TOP, PAD_BOTTOM), (PAD_LEFT, PAD_RIGHT))
    return np.pad(~inside, pad, constant_values=True)
