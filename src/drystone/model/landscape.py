"""The landscape L_i: the wall as the next stone sees it, from one end or the other (§3.2)."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.bits import BitLandscape, bit_landscape
from drystone.kernels.lowering import skyline
from drystone.kernels.raster import Mask, mirrored
from drystone.kernels.rays import RaySums
from drystone.kernels.silhouette import Ints
from drystone.model.placement import Placement, Side
from drystone.model.pose import PosedStone
from drystone.model.wall import Wall


class Box(NamedTuple):
    """Bounding box of a placed stone in view columns, y up from the ground, working px."""

    left: int
    right: int
    bottom: int
    top: int

    @property
    def width(self) -> int:
        """Horizontal extent."""
        return self.right - self.left

    @property
    def height(self) -> int:
        """Vertical extent."""
        return self.top - self.bottom


@dataclass(frozen=True, eq=False)
class Landscape:
    """What is built, seen so that the building side is on the left.

    Placing from the right is placing from the left in a mirror: the view is mirrored, and so are
    the masks that are tried in it; the positions that come out are mirrored back.  No stone is.
    """

    occupied: Mask  # (height_px, width_px): stones and wedges, row 0 at the top, in view columns
    boxes: tuple[Box, ...]  # of the stones (not the wedges), in order of placement
    side: Side = "left"  # building side: which end of the wall is on the left of the view

    @classmethod
    def of(cls, wall: Wall, side: Side = "left") -> "Landscape":
        """Return the landscape of a wall."""
        view = cls(wall.occupied if side == "left" else mirrored(wall.occupied), (), side)
        return replace(view, boxes=tuple(map(view.box, wall.placements)))

    @property
    def height_px(self) -> int:
        """Height of the site."""
        return int(self.occupied.shape[0])

    @property
    def width_px(self) -> int:
        """Width of the site."""
        return int(self.occupied.shape[1])

    @cached_property
    def built_height_px(self) -> int:
        """Height of what is placed over the ground; that of the box B of Eq. 5."""
        return self.height_px - int(self.skyline.min())

    @cached_property
    def skyline(self) -> Ints:
        """Row of the highest occupied pixel of each column; height_px where there is none."""
        return skyline(self.occupied)

    @cached_property
    def box_table(self) -> NDArray[np.int64]:
        """Left, right, bottom and top (4, n) of the boxes."""
        return np.array(self.boxes, np.int64).reshape(-1, 4).T.copy()

    @cached_property
    def bits(self) -> BitLandscape:
        """Packed form, for all positions at which a stone rests."""
        return bit_landscape(self.occupied, self.skyline)

    @cached_property
    def rays(self) -> RaySums:
        """What rays to the building side and downwards meet."""
        return RaySums(self.occupied)

    def view(self, posed: PosedStone) -> PosedStone:
        """Return a posed stone as it appears in this view."""
        return posed if self.side == "left" else posed.mirrored

    def view_col(self, posed: PosedStone, col: int) -> int:
        """Turn a column of the wall image into one of this view, or back."""
        return col if self.side == "left" else self.width_px - col - posed.width_px

    def box(self, placement: Placement) -> Box:
        """Return the box of a placed stone in this view."""
        col = self.view_col(placement.posed, placement.col)
        return view_box(placement.posed, placement.row, col, self.height_px)


def view_box(posed: PosedStone, row: int, col: int, height_px: int) -> Box:
    """Return the box of a mask at a position of an image of a given height."""
    top = height_px - row
    return Box(col, col + posed.width_px, top - posed.height_px, top)
