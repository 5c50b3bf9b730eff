"""Stones that look like two touching stones under one id (W110)."""

import math

import numpy as np
from scipy import ndimage

from drystone.errors import Notice
from drystone.io.patches import Patch
from drystone.io.summits import Summits
from drystone.kernels.raster import Mask

LARGE = 1.5
"""Times the median area: smaller stones are not suspected."""

_WAIST = 1.6
"""Both parts must be this many times as thick as the neck between them."""

_MOST_HILLS = 2**16
"""No stone has as many: more are noise."""

_PART_SHARE = 0.15
"""Each part must have this share of the stone."""


def neck_width_px(mask: Mask, most_px: int = 2**22) -> int | None:
    """Return the width of the neck between two thick parts of a mask; None without one.

    A width of 0 means that the parts meet at a corner of pixels only.

    The neck is the smallest erosion that leaves two parts, each thicker than the neck by a
    factor 1.6 and with at least 15 % of what the erosion leaves.
    """
    step = math.ceil(math.sqrt(mask.size / most_px))
    depth = ndimage.distance_transform_edt(np.pad(mask[::step, ::step], 1))
    if depth.max() < 2 * _WAIST:
        return None
    summits = Summits(depth)
    if len(summits.starts) > _MOST_HILLS:
        return neck_width_px(mask, depth.size // 4)
    erosions = np.arange(int(depth.max() / _WAIST) + 1)
    wide_px = _WAIST * np.maximum(erosions, 1)
    least_px = _PART_SHARE * summits.left[: len(erosions)]
    # Most summits are reached by a deeper part before an erosion leaves them thick enough.
    apart = np.flatnonzero(summits.thickness >= _WAIST * np.maximum(summits.ends + 1, 1))
    found = np.zeros(len(erosions), int)
    for part in apart.tolist() if len(apart) > 1 else ():
        areas = summits.areas(part)[: len(erosions)]
        thick = summits.thickness[part] >= wide_px
        found += (erosions > summits.ends[part]) & thick & (areas >= least_px)
    if not (found > 1).any():
        return None
    return max(2 * step * int(np.argmax(found > 1)), step if step > 1 else 0)


def suspect_necks(patches: list[Patch]) -> list[Notice]:
    """Report large stones with a neck; of one or two stones every one, as no size is usual."""
    if not patches:
        return []
    median = float(np.median([patch.area_px for patch in patches]))
    notices = []
    for patch in patches:
        ratio = patch.area_px / median
        if len(patches) > 2 and ratio < LARGE:
            continue
        width = neck_width_px(patch.mask)
        if width is not None:
            size = f"has {ratio:.1f} times the median area and " if len(patches) > 2 else "has "
            neck = f"a neck of about {width} px" if width else "parts that meet at a corner only"
            message = f"stone {patch} {size}{neck}: maybe 2 stones."
            cure = "If so, separate them by a line of background or give each its own id."
            notices.append(Notice("W110", message, cure))
    return notices
