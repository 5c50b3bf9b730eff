"""The outline of a placed stone is that of its pixels, whatever made it (DESIGN 4.9)."""

import numpy as np
from scipy import ndimage

from drystone.kernels.polygons import Points, area_and_centroid
from drystone.kernels.raster import Mask, turn
from drystone.model.outline import farthest_px, reach_px
from drystone.model.plan import StoneStep
from drystone.model.stone import Stone
from drystone.verify.report import Problem

SAME_AREA = 1e-6
"""Outlines have the area of the pixels but for rounding, as a share of it."""


def check_outline(
    step: StoneStep, stone: Stone, centroid_px: Points, corners: Points, tolerance_px: float
) -> list[Problem]:
    """Compare the outline of a stone where it lies, source px, with its pixels there (E240).

    The contour goes through the middles of pixel edges; holes count as stone.  Each middle of an
    edge between the stone and what is around it must be within
    :func:`drystone.model.outline.reach_px` of the outline, on either side, and the outline must
    have the area of the pixels.  The corner of a pixel may be √2/4 px further out than the middles
    of its edges.
    """
    pixels = ndimage.binary_fill_holes(stone.mask)
    rim = turn(rim_px(pixels) - np.array(stone.local_centroid), step.angle_deg) + centroid_px
    off, allowed = farthest_px(rim, corners), reach_px(tolerance_px)
    share = area_and_centroid(corners)[0] / int(pixels.sum())
    said = []
    if off > allowed:
        said.append(f"is {off:.3g} source px from the rim of its pixels; {allowed:.3g} are allowed")
    if abs(share - 1.0) > SAME_AREA:
        said.append(f"has {share:.6g} times the area of its pixels")
    return [Problem("E240", step.step, f"the outline of stone {stone.id} {why}.") for why in said]


def rim_px(mask: Mask) -> Points:
    """Return the middles of the pixel edges around a mask, from its bottom-left corner, y up."""
    padded = np.pad(mask, 1)
    row, left = np.nonzero(padded[1:-1, 1:] != padded[1:-1, :-1])
    top, col = np.nonzero(padded[1:, 1:-1] != padded[:-1, 1:-1])
    upright = np.column_stack([left, len(mask) - row - 0.5])
    level = np.column_stack([col + 0.5, len(mask) - top])
    return np.vstack([upright, level])
