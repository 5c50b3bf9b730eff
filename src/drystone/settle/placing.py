"""Settled stones and wedges in the wall: the pixels that they fill there (DESIGN 4.9)."""

from collections.abc import Iterable

import numpy as np
from scipy import ndimage

from drystone.kernels.coverage import coverage
from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask
from drystone.model.outlines import Outlines
from drystone.model.placement import Placement, Settled, Side, Wedge
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Group, Wall, outlined
from drystone.settle.rest import Repose

NOTHING = np.zeros((0, 0), bool)


def settled_placement(
    outlines: Outlines,
    site: Site,
    stone: Stone,
    angle_deg: float,
    settled: Settled,
    side: Side,
    rotation_moves: int,
) -> Placement | None:
    """Return the placement of a settled stone; None when it fills no pixel of the wall.

    `outlines` are those of the wall without it; `rotation_moves` is 1 when it turned while it
    settled.  Its pixels are those that become half full by it (DESIGN 4.9): they depend on what is
    there.  Whether it leaves the wall is not asked: where it stands out, it has no pixels.
    """
    fresh = outlines.shares.fresh(*coverage(settled.corners * site.scale))
    if fresh is None:
        return None
    mask, row, col = _in_one_piece(*fresh)
    bottom = site.height_px - row - mask.shape[0]
    anchor = (settled.x_px * site.scale - col, settled.y_px * site.scale - bottom)
    posed = PosedStone(stone, angle_deg, site.scale, mask, anchor)
    return Placement(posed, row, col, side, rotation_moves, settled)


def _in_one_piece(mask: Mask, row: int, col: int) -> tuple[Mask, int, int]:
    """Keep the largest piece of a mask that has rows or columns without pixels.

    Arms that are thinner than a pixel fill none: what is beyond them is not seen either.
    """
    if mask.any(axis=0).all() and mask.any(axis=1).all():
        return mask, row, col
    pieces, _ = ndimage.label(mask, np.ones((3, 3)))
    sizes = np.bincount(pieces.ravel())
    sizes[0] = 0
    piece = int(sizes.argmax())
    rows, cols = ndimage.find_objects(pieces, piece)[-1]
    return pieces[rows, cols] == piece, row + rows.start, col + cols.start


def settled_wedge(
    outlines: Outlines, site: Site, wedge_id: int, under: int, corners: Points
) -> Wedge:
    """Return a wedge with the pixels that it fills, which may be none.

    `outlines` are those of the wall with what was placed before it; `corners` are in source px,
    counter-clockwise.
    """
    fresh = outlines.shares.fresh(*coverage(corners * site.scale))
    mask, row, col = (NOTHING.copy(), site.height_px, 0) if fresh is None else fresh
    return Wedge(wedge_id, under, mask, row, col, corners)


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

    None when the stone fills no pixel.  Whether it leaves the wall is not asked.
    """
    at = repose.angle_deg, repose.settled, side, int(repose.turned)
    placement = settled_placement(wall.exact, wall.site, stone, *at)
    return _with_wedges(wall, placement, [] if wedge is None else [(wedge_id, wedge)])


def settled_again(wall: Wall, group: Group) -> Group | None:
    """Return a settled step with the pixels that it fills in another wall."""
    old = group.placement
    at = old.posed.angle_deg, old.exact, old.side, old.rotation_moves
    placement = settled_placement(wall.exact, wall.site, old.posed.stone, *at)
    wedges = ((wedge.id, wedge.corners) for wedge in group.wedges)
    return _with_wedges(wall, placement, ((i, c) for i, c in wedges if c is not None))


def _with_wedges(
    wall: Wall, placement: Placement | None, wedges: Iterable[tuple[int, Points]]
) -> Group | None:
    if placement is None:
        return None
    outlines, new = outlined(placement, ()), list[Wedge]()
    for number, corners in wedges:
        below = wall.exact.added(outlines, wall.site.scale)
        new.append(settled_wedge(below, wall.site, number, placement.stone_id, corners))
        outlines.append((number, corners))
    return Group(placement, tuple(new))
