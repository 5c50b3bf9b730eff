"""The outlines of everything that is placed, for walls that stand on them (DESIGN 4.9)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.coverage import FILLED, ROUNDING, Grid, coverage, newly_filled, windows
from drystone.kernels.polygons import Points, Polygons, no_polygons
from drystone.kernels.raster import Mask
from drystone.model.site import Site

Outlined = tuple[int, Points]
"""Id and corners of a stone or wedge."""


@dataclass(frozen=True, eq=False)
class Shares:
    """What exact outlines cover of the cells of a site, immutable; :meth:`added` gives the next."""

    # (height_px, width_px): share of each cell that all blocks together cover, row 0 at the top
    total: Grid
    largest: Grid  # (height_px, width_px): the largest share that one block covers
    # (height_px, width_px): the id of that block, of equals the one placed first; 0 where
    # there is none
    owners: NDArray[np.uint32]

    def __post_init__(self) -> None:
        for array in (self.total, self.largest, self.owners):
            array.flags.writeable = False

    @classmethod
    def empty(cls, height_px: int, width_px: int) -> "Shares":
        """Return the shares of a site where nothing is placed yet."""
        shape = height_px, width_px
        return cls(np.zeros(shape), np.zeros(shape), np.zeros(shape, np.uint32))

    def added(self, block_id: int, shares: Grid, left: int, bottom: int) -> "Shares":
        """Return the shares with one more block.

        What it covers is of :func:`drystone.kernels.coverage.coverage`: cells outside of the site
        do not count; `left` and `bottom` are its bottom-left corner, in cells from the site's own.
        """
        inside, part = windows(self.total.shape, shares.shape, self._row(shares, bottom), left)
        total, largest, owners = self.total.copy(), self.largest.copy(), self.owners.copy()
        new = shares[part]
        total[inside] += new
        more = new > largest[inside] + ROUNDING
        largest[inside][more] = new[more]
        owners[inside][more] = block_id
        return Shares(total, largest, owners)

    @cached_property
    def labels(self) -> NDArray[np.uint32]:
        """The site as an image: where at least half is covered, the id of who covers most."""
        labels = np.where(self.total >= FILLED, self.owners, np.uint32(0))
        labels.flags.writeable = False
        return labels

    def fresh(self, shares: Grid, left: int, bottom: int) -> tuple[Mask, int, int] | None:
        """Return the cells that a new block would fill in the image; None where there are none.

        A cropped mask of the cells of which less than half was covered, and now at least half is,
        with the row and column of its top-left corner in the site image; arguments as for
        :meth:`added`.
        """
        # A site that is no whole number of cells may lack one that a stone at its end half fills.
        inside, part = windows(self.total.shape, shares.shape, self._row(shares, bottom), left)
        found = newly_filled(self.total[inside], shares[part])
        if found is None:
            return None
        mask, row, col = found
        return mask, inside[0].start + row, inside[1].start + col

    def _row(self, shares: Grid, bottom: int) -> int:
        """Return the row of the site image in which the top of some shares is."""
        return len(self.total) - bottom - len(shares)


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
