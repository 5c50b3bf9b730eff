"""Where a stone or a wedge stands in the wall."""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from drystone.kernels.raster import Mask
from drystone.model.pose import PosedStone

Side = Literal["left", "right"]


@dataclass(frozen=True, eq=False)
class Placement:
    """A posed stone at a place in the wall.

    Parameters
    ----------
    posed : PosedStone
        The stone, turned.
    row, col : int
        Top-left corner of its mask in the wall image (row 0 at the top of the site).
    side : {"left", "right"}
        The end of the wall from which it was placed.
    rotation_moves : int
        How many pivots stabilisation turned it about.
    """

    posed: PosedStone
    row: int
    col: int
    side: Side = "left"
    rotation_moves: int = 0

    @property
    def stone_id(self) -> int:
        """Id of the stone in the source image."""
        return self.posed.stone.id

    @property
    def window(self) -> tuple[slice, slice]:
        """Rows and columns of the wall image that the mask covers."""
        return (
            slice(self.row, self.row + self.posed.height_px),
            slice(self.col, self.col + self.posed.width_px),
        )

    def centroid(self, site_height_px: int) -> tuple[float, float]:
        """Centroid (x, y) in the wall frame, working px, y up from the ground."""
        bottom = site_height_px - self.row - self.posed.height_px
        return self.col + self.posed.anchor[0], bottom + self.posed.anchor[1]


@dataclass(frozen=True, eq=False)
class Wedge:
    """A small stone cut to fill the gap under a stone's free side (§3.7).

    Parameters
    ----------
    id : int
        Its value in the wall image; larger than every stone's id.
    under : int
        Id of the stone that it supports.
    mask : (h, w) bool array
        Its pixels, cropped, row 0 at the top.
    row, col : int
        Top-left corner of the mask in the wall image.
    """

    id: int
    under: int
    mask: Mask
    row: int
    col: int

    def __post_init__(self) -> None:
        self.mask.flags.writeable = False

    @property
    def window(self) -> tuple[slice, slice]:
        """Rows and columns of the wall image that the mask covers."""
        height, width = self.mask.shape
        return slice(self.row, self.row + height), slice(self.col, self.col + width)

    @cached_property
    def area_px(self) -> int:
        """Area in working px."""
        return int(np.count_nonzero(self.mask))
