"""The wall as built so far: an image of labels and the placements that made it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask
from drystone.model.placement import Placement, Wedge
from drystone.model.site import Site

Labels = NDArray[np.uint32]


@dataclass(frozen=True, eq=False)
class Group:
    """One step of construction: a stone and the wedges under it, judged together.

    Parameters
    ----------
    placement : Placement
        The stone.
    wedges : tuple of Wedge
        The wedges under it, in the order in which they are pushed in.
    """

    placement: Placement
    wedges: tuple[Wedge, ...] = ()


@dataclass(frozen=True, eq=False)
class Wall:
    """An immutable wall; :meth:`add` returns the next one (Eq. 1).

    Parameters
    ----------
    site : Site
        Its place.
    labels : (height_px, width_px) uint32 array
        0 where nothing is, otherwise the id of a stone or wedge; row 0 at the top.
    groups : tuple of Group
        What was placed, in order.
    """

    site: Site
    labels: Labels
    groups: tuple[Group, ...] = ()

    def __post_init__(self) -> None:
        self.labels.flags.writeable = False

    @classmethod
    def empty(cls, site: Site) -> "Wall":
        """Return the wall before the first stone."""
        return cls(site, np.zeros((site.height_px, site.width_px), np.uint32))

    def add(self, placement: Placement, wedges: tuple[Wedge, ...] = ()) -> "Wall":
        """Return the wall with one more stone and its wedges.

        Raises
        ------
        ValueError
            When something overlaps or leaves the site.
        """
        labels = self.labels.copy()
        _paint(labels, placement.window, placement.posed.mask, placement.stone_id)
        for wedge in wedges:
            _paint(labels, wedge.window, wedge.mask, wedge.id)
        return Wall(self.site, labels, (*self.groups, Group(placement, wedges)))

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


def _paint(labels: Labels, window: tuple[slice, slice], mask: Mask, value: int) -> None:
    rows, cols = window
    inside = 0 <= rows.start and rows.stop <= labels.shape[0]
    inside = inside and 0 <= cols.start and cols.stop <= labels.shape[1]
    if not inside:
        raise ValueError(f"{value} leaves the site")
    view = labels[window]
    if view[mask].any():
        raise ValueError(f"{value} overlaps what is there")
    view[mask] = value
