"""Bring an image of labels down to the wall and the resolution that are measured (DESIGN 5)."""

import math
from dataclasses import dataclass

import numpy as np

from drystone.errors import LabelImageError
from drystone.model.site import working_px
from drystone.model.wall import Labels


@dataclass(frozen=True, eq=False)
class WallFrame:
    """A wall cut out of its image, and where it should end."""

    # (h, w), first row: the highest stone pixel; last row: the lowest, on which the wall stands.
    labels: Labels
    # The two end lines of the wall, as columns of `labels` measured from its left edge.
    left_px: float
    right_px: float


def frame_wall(labels: Labels, width_px: float | None = None) -> WallFrame:
    """Cut the wall out of an image of labels.

    Empty rows above and below the stones are always left out.  Without a width the empty columns
    at both ends go as well, and the end lines are the ends of the stones.  With a width, an image
    that is exactly as wide keeps its columns, as plans do; in any other image the stones are
    taken to stand in the middle between the end lines.  No stone is ever cut off.
    E104 when there is no stone in the image.
    """
    filled = labels > 0
    rows = np.flatnonzero(filled.any(axis=1))
    if not rows.size:
        what = f"no stones: all {labels.shape[1]}x{labels.shape[0]} px are 0 (background)."
        cure = "Give an image of labels in which stones have positive ids."
        raise LabelImageError("E104", what, cure=cure)
    wall = labels[rows[0] : rows[-1] + 1]
    ends = np.flatnonzero((wall > 0).any(axis=0))
    stones = wall[:, ends[0] : ends[-1] + 1]
    if width_px is None:
        return WallFrame(stones, 0.0, float(stones.shape[1]))
    columns = math.floor(width_px + 0.5)
    if columns == labels.shape[1]:
        return WallFrame(wall, 0.0, float(columns))
    # Those that stick out stay.
    room = columns - stones.shape[1]
    before = max(0, room) // 2
    padded = np.pad(stones, ((0, 0), (before, max(0, room) - before)))
    overhang = max(0, -room) / 2
    return WallFrame(padded, overhang, padded.shape[1] - overhang)


def reduce_labels(labels: Labels, scale: float) -> Labels:
    """Reduce an image of labels by nearest sampling.

    Pixel i of the result takes source pixel floor(i * source size / size), so the first row and
    column stay what they are.  This is the sampling with which the published figures of the
    masons' walls were measured; other choices of the sample point move F_AV by up to two points.
    Each side becomes floor(size * scale + 0.5) px, at least one; the result is a copy.
    """
    if not scale > 0:
        raise ValueError(f"scale must be positive, not {scale}")
    height, width = labels.shape
    rows, cols = (max(1, working_px(size, scale)) for size in (height, width))
    # Whole numbers: a product with a float would miss the source pixel on some sizes.
    source_rows = np.arange(rows) * height // rows
    source_cols = np.arange(cols) * width // cols
    return labels[np.ix_(source_rows, source_cols)]
