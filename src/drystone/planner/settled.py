"""A stone where it came to rest on outlines, as the wall takes it in (DESIGN 4.9)."""

from collections.abc import Iterable

from drystone.kernels.polygons import Points
from drystone.model.placement import Placement, Side, Wedge
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Group, Wall, outlined
from drystone.settle.placing import settled_placement, settled_wedge
from drystone.settle.rest import Repose


def settled_in(
    wall: Wall,
    stone: Stone,
    side: Side,
    repose: Repose,
    wedge: Points | None = None,
    *,
    wedge_id: int,
) -> Group | None:
    """Return a stone and its wedge, (n, 2) corners in the wall frame, with what they fill.

    None when the stone fills no pixel.  Whether it leaves the wall :func:`stands_out_px` says.
    """
    at = repose.angle_deg, repose.settled, side, int(repose.turned)
    placement = settled_placement(wall.exact, wall.site, stone, *at)
    return _with_wedges(wall, placement, [] if wedge is None else [wedge], wedge_id)


def settled_again(wall: Wall, group: Group, wedge_id: int) -> Group | None:
    """Return a settled step with the pixels that it fills in another wall, wedges renumbered."""
    old, corners = group.placement, (wedge.corners for wedge in group.wedges)
    at = old.posed.angle_deg, old.exact, old.side, old.rotation_moves
    placement = settled_placement(wall.exact, wall.site, old.posed.stone, *at)
    return _with_wedges(wall, placement, (c for c in corners if c is not None), wedge_id)


def _with_wedges(
    wall: Wall, placement: Placement | None, wedges: Iterable[Points], wedge_id: int
) -> Group | None:
    if placement is None:
        return None
    outlines, new = outlined(placement, ()), list[Wedge]()
    for number, corners in enumerate(wedges, wedge_id):
        below = wall.exact.added(outlines, wall.site.scale)
        new.append(settled_wedge(below, wall.site, number, placement.stone_id, corners))
        outlines.append((number, corners))
    return Group(placement, tuple(new))


def stands_out_px(corners: Points, site: Site) -> float:
    """Return how far an outline stands out over the ends or the top of a wall, source px.

    Below 0 where it stays within them.
    """
    (left, _), (right, top) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    width, height = site.extent_px
    return float(max(-left, right - width, top - height))
