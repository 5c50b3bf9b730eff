"""Where a stone or a wedge stands in the wall."""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask
from drystone.model.pose import PosedStone

Side = Literal["left", "right"]


@dataclass(frozen=True, eq=False)
class Settled:
    """Where a stone lies exactly, on its outline (DESIGN 4.9)."""

    # its centroid in the wall frame, *source* px
    x_px: float
    y_px: float
    corners: Points  # (n, 2): its outline there, counter-clockwise, source px

    def __post_init__(self) -> None:
        self.corners.flags.writeable = False


@dataclass(frozen=True, eq=False)
class Placement:
    """A posed stone at a place in the wall."""

    # the stone, turned.  Of a settled stone its pixels are those of the wall that it fills.
    posed: PosedStone
    # top-left corner of its mask in the wall image (row 0 at the top of the site)
    row: int
    col: int
    side: Side = "left"  # the end of the wall from which it was placed
    # how many pivots stabilisation turned it about; 1 for a stone that turned as it settled
    rotation_moves: int = 0
    # where it lies exactly; None when the stones of the wall are their pixels
    settled: Settled | None = None

    @property
    def stone_id(self) -> int:
        """Id of the stone in the source image."""
        return self.posed.stone.id

    @property
    def exact(self) -> Settled:
        """Where it lies exactly; ValueError for a stone that is its pixels."""
        if self.settled is None:
            raise ValueError(f"stone {self.stone_id} is its pixels")
        return self.settled

    @property
    def window(self) -> tuple[slice, slice]:
        """Rows and columns of the wall image that the mask covers."""
        return (
            slice(self.row, self.row + self.posed.height_px),
            slice(self.col, self.col + self.posed.width_px),
        )

    def centroid(self, site_height_px: int) -> tuple[float, float]:
        """Centroid (x, y) in the wall frame, working px, y up from the ground."""
        if self.settled is not None:
            scale = self.posed.scale
            return self.settled.x_px * scale, self.settled.y_px * scale
        bottom = site_height_px - self.row - self.posed.height_px
        return self.col + self.posed.anchor[0], bottom + self.posed.anchor[1]


@dataclass(frozen=True, eq=False)
class Wedge:
    """A small stone cut to fill the gap under a stone's free side (§3.7)."""

    id: int  # its value in the wall image; larger than every stone's id
    under: int  # id of the stone that it supports
    mask: Mask  # (h, w): its pixels, cropped, row 0 at the top
    # top-left corner of the mask in the wall image
    row: int
    col: int
    # (n, 2): its outline in the wall frame, counter-clockwise, *source* px, when stones are
    # outlines; it may then fill no pixel
    corners: Points | None = None

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
