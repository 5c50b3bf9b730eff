"""What is built on outlines, as each side sees it: it grows with the wall (DESIGN 4.9)."""

from typing import NamedTuple

from drystone.kernels.polygons import Polygons, mirrored_polygon, no_polygons
from drystone.kernels.profiles import HeightProfile, bare, raised
from drystone.model.placement import Side
from drystone.model.site import Site


class OutlineView(NamedTuple):
    """What is built, seen so that the building side is on the left."""

    built: Polygons  # in the wall frame
    seen: Polygons  # in the view
    profile: HeightProfile  # their height in the view


class Views:
    """The last view from each side; only what is new is added to it.

    A view depends on what is built alone, not on what was asked for before.
    """

    def __init__(self, site: Site) -> None:
        self._site = site
        self._last: dict[Side, OutlineView] = {}

    def of(self, built: Polygons, side: Side) -> OutlineView:
        """Return the view of outlines from a side."""
        last = self._last.get(side)
        if last is None or not _begins_with(built, last.built):
            last = OutlineView(no_polygons(), no_polygons(), bare(self._site.width_px))
        view = self._grown(last, built, side)
        self._last[side] = view
        return view

    def _grown(self, last: OutlineView, built: Polygons, side: Side) -> OutlineView:
        count, width, cell = len(last.built), self._site.extent_px[0], 1.0 / self._site.scale
        new = [built.polygon(index) for index in range(count, len(built))]
        if side == "right":
            new = [mirrored_polygon(corners, width) for corners in new]
        profile = last.profile
        for index, corners in enumerate(new, count):
            profile = raised(profile, corners, index, cell)
        return OutlineView(built, built if side == "left" else last.seen.added(new), profile)


def _begins_with(polygons: Polygons, others: Polygons) -> bool:
    """Say whether polygons are others, bit by bit, and more after them."""
    if len(others) > len(polygons):
        return False
    first = polygons.leading(len(others))
    return (
        first.first.tobytes() == others.first.tobytes()
        and first.corners.tobytes() == others.corners.tobytes()
    )
