"""How level the top of a wall is, how straight its ends, and how large its stones (DESIGN 5)."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import LabelImageError
from drystone.kernels.ids import counted, numbered
from drystone.metrics.frame import WallFrame
from drystone.model.wall import Labels


@dataclass(frozen=True)
class StoneSizes:
    """What the stones of a wall measure, wedges left out."""

    count: int  # number of stones
    area_px: int  # pixels of all stones together
    mean_height_px: float  # of their upright bounding boxes
    mean_width_px: float


def stone_sizes(labels: Labels, wedge_ids: Collection[int] = frozenset()) -> StoneSizes:
    """Measure the stones of a wall."""
    index, ids = numbered(labels)
    boxes = ndimage.find_objects(index)
    areas = counted(index, len(ids))[1:]
    stones = [i for i, stone in enumerate(ids.tolist()) if stone and stone not in wedge_ids]
    if not stones:
        what = f"no stones: all {labels.shape[1]}x{labels.shape[0]} px are background or wedges."
        cure = "Give an image of labels in which stones have positive ids."
        raise LabelImageError("E104", what, cure=cure)
    heights = [boxes[i][0].stop - boxes[i][0].start for i in stones]
    widths = [boxes[i][1].stop - boxes[i][1].start for i in stones]
    count, area_px = len(stones), int(areas[stones].sum())
    return StoneSizes(count, area_px, sum(heights) / count, sum(widths) / count)


def top_profile(labels: Labels) -> NDArray[np.intp]:
    """Return the height of the highest stone or wedge pixel over the last row, per column.

    0 where there is none, be it a joint from top to bottom or an end that the wall does not reach.
    """
    filled = labels > 0
    return np.where(filled.any(axis=0), labels.shape[0] - filled.argmax(axis=0), 0)


def level_deviation(labels: Labels, mean_stone_height_px: float) -> float:
    """Return T_LEVEL, how far the top is from level in units of a stone's height.

    The mean over all columns of |top profile - mean of the top profile|, over the mean height of
    the stones' bounding boxes as they lie in the wall.  0 is a level top; a wall of which one
    half is a whole stone higher than the other has 0.5.  Lower is better.  It exposes walls whose
    F_AV is high because of towers.

    The profile is the plain one: in a head joint that is open at the top it drops to what lies
    below, so walls traced with wide joints read higher (the masons' level wall R: 0.12).
    """
    profile = top_profile(labels)
    return float(np.abs(profile - profile.mean()).mean()) / mean_stone_height_px


def flush_deviation(frame: WallFrame, mean_stone_width_px: float) -> float:
    """Return E_FLUSH, how ragged the ends are in units of a stone's width.

    The mean over both ends and all rows, from the wall's top to its foot, of the gap between the
    outermost stone pixel and the end line, over the mean width of the stones' bounding boxes as
    they lie in the wall.  Rows without any stone, open bed joints, have no end and are left out.
    0 is two straight ends; a wall that lacks half a stone at one end of every other course has
    0.125.  Lower is better.  It exposes walls whose F_AV is high because of ragged ends.
    """
    filled = frame.labels > 0
    filled = filled[filled.any(axis=1)]
    left_end = filled.argmax(axis=1)
    right_end = filled.shape[1] - filled[:, ::-1].argmax(axis=1)
    gaps = np.column_stack([left_end - frame.left_px, frame.right_px - right_end])
    return float(np.abs(gaps).mean()) / mean_stone_width_px
