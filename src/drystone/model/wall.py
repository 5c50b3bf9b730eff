"""The wall as built so far: an image of labels and the placements that made it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from drystone.errors import LabelImageError
from drystone.kernels.raster import Mask
from drystone.model.outlines import Outlined, Outlines
from drystone.model.placement import Placement, Wedge
from drystone.model.site import Site

Labels = NDArray[np.uint32]


def picture_of_ids(labels: Labels) -> Labels:
    """Return a picture of ids as an array; refuse scaled values, colours and masks (E301).

    What a masked array masks is nothing.
    """
    ids = np.ma.filled(labels, 0)
    fits = ids.ndim == 2 and ids.dtype.kind in "iu"
    if not fits or (ids.size and (ids.min() < 0 or ids.max() >= 2**63)):
        what = f"an array of shape {ids.shape} and type {ids.dtype} is not a picture of ids."
        cure = "Give rows and columns of whole numbers below 2^63: 0 for nothing, ids above 0."
        raise LabelImageError("E301", what, where="labels", cure=cure)
    return ids


@dataclass(frozen=True, eq=False)
class Group:
    """One step of construction: a stone and the wedges under it, judged together."""

    placement: Placement
    wedges: tuple[Wedge, ...] = ()  # the wedges under it, in the order in which they are pushed in


@dataclass(frozen=True, eq=False)
class Wall:
    """An immutable wall; :meth:`add` returns the next one (Eq. 1)."""

    site: Site
    # (height_px, width_px): 0 where nothing is, otherwise the id of a stone or wedge; row 0
    # at the top
    labels: Labels
    groups: tuple[Group, ...] = ()
    # of what was placed; None when the stones of the wall are their pixels
    outlines: Outlines | None = None

    def __post_init__(self) -> None:
        self.labels.flags.writeable = False

    def __repr__(self) -> str:
        size = f"{self.site.width_px} x {self.site.height_px} px"
        return f"<Wall of {size}: {len(self.groups)} stones, {len(self.wedges)} wedges>"

    @classmethod
    def empty(cls, site: Site, *, exact: bool = False) -> "Wall":
        """Return the wall before the first stone; exact: stones are their outlines."""
        outlines = Outlines.empty(site) if exact else None
        return cls(site, np.zeros((site.height_px, site.width_px), np.uint32), outlines=outlines)

    def add(self, placement: Placement, wedges: tuple[Wedge, ...] = ()) -> "Wall":
        """Return the wall with one more stone and its wedges.

        With outlines, a pixel belongs to the stone or wedge that covers most of it, where all
        together cover at least half (DESIGN 4.9).  ValueError when pixels overlap or leave the
        site.
        """
        groups = (*self.groups, Group(placement, wedges))
        if self.outlines is not None:
            outlines = self.outlines.added(outlined(placement, wedges), self.site.scale)
            return Wall(self.site, outlines.shares.labels, groups, outlines)
        labels = self.labels.copy()
        _paint(labels, placement.window, placement.posed.mask, placement.stone_id)
        for wedge in wedges:
            _paint(labels, wedge.window, wedge.mask, wedge.id)
        return Wall(self.site, labels, groups)

    @property
    def exact(self) -> Outlines:
        """Its outlines; ValueError where the stones are their pixels."""
        if self.outlines is None:
            raise ValueError("the stones of this wall are their pixels")
        return self.outlines

    @property
    def placements(self) -> tuple[Placement, ...]:
        """The stones in the order of placement."""
        return tuple(group.placement for group in self.groups)

    @property
    def wedges(self) -> tuple[Wedge, ...]:
        """All wedges in the order of placement."""
        return tuple(wedge for group in self.groups for wedge in group.wedges)

    @cached_property
    def occupied(self) -> Mask:
        """True where a stone or wedge is."""
        occupied = self.labels > 0
        occupied.flags.writeable = False
        return occupied

    @cached_property
    def height_px(self) -> int:
        """Height of the placed stones over the ground, working px."""
        rows = np.flatnonzero(self.occupied.any(axis=1))
        return self.site.height_px - int(rows[0]) if rows.size else 0

    @property
    def filling(self) -> float:
        """Area of the placed stones (source resolution, no wedges) over the wall's area."""
        area = sum(p.posed.stone.area_px for p in self.placements) * self.site.scale**2
        return area / (self.site.width_px * self.site.height_px)


def outlined(placement: Placement, wedges: tuple[Wedge, ...]) -> list[Outlined]:
    """Return ids and outlines of a settled stone and its wedges."""
    blocks = [(placement.stone_id, placement.exact.corners)]
    return blocks + [(wedge.id, wedge.corners) for wedge in wedges if wedge.corners is not None]


def _paint(labels: Labels, window: tuple[slice, slice], mask: Mask, value: int) -> None:
    rows, cols = window
    height, width = labels.shape
    if min(rows.start, cols.start) < 0 or rows.stop > height or cols.stop > width:
        raise ValueError(f"{value} leaves the site")
    view = labels[window]
    if view[mask].any():
        raise ValueError(f"{value} overlaps what is there")
    view[mask] = value
