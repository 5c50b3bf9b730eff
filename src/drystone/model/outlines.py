"""The outlines of everything that is placed, for walls that stand on them (DESIGN 4.9)."""

from collections.abc import Sequence
from dataclasses import dataclass

from drystone.kernels.coverage import coverage
from drystone.kernels.polygons import Points, Polygons, no_polygons
from drystone.model.shares import Shares
from drystone.model.site import Site

Outlined = tuple[int, Points]
"""Id and corners of a stone or wedge."""


@dataclass(frozen=True, eq=False)
class Outlines:
    """Outlines in the wall frame, source px; immutable."""

    polygons: Polygons  # of stones and wedges, in the order of placement
    ids: tuple[int, ...]
    shares: Shares  # how much of each working px they cover

    @classmethod
    def empty(cls, site: Site) -> "Outlines":
        """Return the outlines of nothing."""
        return cls(no_polygons(), (), Shares.empty(site.height_px, site.width_px))

    @property
    def blocks(self) -> list[Outlined]:
        """Ids and corners, in the order of placement."""
        return [(block, self.polygons.polygon(i)) for i, block in enumerate(self.ids)]

    def added(self, blocks: Sequence[Outlined], scale: float) -> "Outlines":
        """Return these outlines with a stone and its wedges; scale: working over source px."""
        shares = self.shares
        for block_id, corners in blocks:
            shares = shares.added(block_id, *coverage(corners * scale))
        polygons = self.polygons.added(corners for _, corners in blocks)
        return Outlines(polygons, (*self.ids, *(block_id for block_id, _ in blocks)), shares)
