"""Cut an image of labels down to the wall that is measured (DESIGN 5)."""

import math
from dataclasses import dataclass

import numpy as np

from drystone.errors import LabelImageError
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
        raise LabelImageError(
            "E104",
            f"no stones: all {labels.shape[1]}x{labels.shape[0]} px are 0 (background).",
            cure="Give an image of labels in which stones have positive ids.",
        )
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
