"""Outlines of stones, turned, each made once."""

from dataclasses import dataclass

from drystone.kernels.polygons import Points
from drystone.kernels.profiles import StoneProfile, hanging
from drystone.model.placement import Side
from drystone.model.stone import Stone
from drystone.poses import RecentlyUsed
from drystone.settle.rest import Turned

BOOK_BYTES = 1 << 28
"""Turned outlines that a book remembers at most, about: a hundred thousand."""


@dataclass(frozen=True, eq=False)
class Hung:
    """A turned outline, ready to be dropped."""

    turned: Turned  # as a scene sees it
    profile: StoneProfile  # its lowest and highest points over columns of a working px


class OutlineBook:
    """Outlines of stones within a tolerance, turned to the angles of poses.

    `tolerance_px` is how far outlines may stay away from the contour of the pixels, `cell_px` a
    working px, both in source px.  Outlines not asked for for longest are made again.
    """

    def __init__(self, tolerance_px: float, cell_px: float) -> None:
        self.tolerance_px = tolerance_px
        self.cell_px = cell_px
        self._hung = RecentlyUsed[tuple[Stone, float, Side], Hung](BOOK_BYTES)

    def outline(self, stone: Stone) -> Points:
        """Return the outline of a stone, from its centroid, source px."""
        return stone.outline_within(self.tolerance_px)

    def hung(self, stone: Stone, angle_deg: float, side: Side) -> Hung:
        """Return the outline of a stone in a pose, as the scene of a side sees it."""
        key = (stone, angle_deg, side)
        found = self._hung.get(key)
        if found is None:
            turned = Turned.of(self.outline(stone), angle_deg, side, stone.area_px**0.5)
            found = Hung(turned, hanging(turned.corners, self.cell_px))
            size = 3000 + 2 * turned.corners.nbytes + turned.edges.nbytes
            found = self._hung.keep(key, found, size + 2 * found.profile.bottoms.nbytes)
        return found
