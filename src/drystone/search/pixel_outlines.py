"""Outlines of stones that are pixels, as height profiles see them."""

import numpy as np

from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask
from drystone.model.placement import Placement
from drystone.model.pose import PosedStone


def column_outline(mask: Mask) -> Points:
    """Return the polygon from the lowest to the highest pixel of each column of a mask.

    What is hollow at the sides is filled: no stone that is lowered from above gets in there.

    Parameters
    ----------
    mask : (h, w) bool array
        Cropped, row 0 at the top; every column has a pixel.

    Returns
    -------
    corners : (4 w, 2) float array
        Counter-clockwise; x to the right and y up, px from the mask's bottom-left corner.

    Examples
    --------
    >>> column_outline(np.array([[1, 0], [1, 1]], bool)).tolist()
    [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]
    """
    height, width = mask.shape
    lows = np.argmax(mask[::-1], axis=0)
    highs = height - np.argmax(mask, axis=0)
    ends = np.repeat(np.arange(width + 1), 2)[1:-1]
    below = np.column_stack([ends, np.repeat(lows, 2)])
    above = np.column_stack([ends, np.repeat(highs, 2)])
    return np.concatenate([below, above[::-1]]).astype(np.float64)


def posed_outline(posed: PosedStone) -> Points:
    """Return the outline of a turned stone, relative to its centroid, source px."""
    return np.asarray((column_outline(posed.mask) - np.array(posed.anchor)) / posed.scale)


def placed_outline(placement: Placement, site_height_px: int) -> Points:
    """Return the outline of a stone in the wall frame, source px.

    Parameters
    ----------
    placement : Placement
        Of pixels.
    site_height_px : int
        Of the wall, working px.
    """
    posed = placement.posed
    bottom = site_height_px - placement.row - posed.height_px
    return np.asarray(
        (column_outline(posed.mask) + np.array([placement.col, bottom])) / posed.scale
    )
