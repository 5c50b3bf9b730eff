"""A stone where it came to rest on outlines, as the wall takes it in (DESIGN 4.9)."""

from drystone.kernels.polygons import Points
from drystone.model.placement import Side
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall, outlined
from drystone.settle.placing import settled_placement, settled_wedge
from drystone.settle.rest import Repose
from drystone.stabilise.stabilise import Stabilised


def settled_in(
    wall: Wall,
    stone: Stone,
    side: Side,
    repose: Repose,
    wedge: Points | None = None,
    *,
    wedge_id: int,
) -> Stabilised | None:
    """Return a stone and its wedge with the pixels that they fill; None when it fills none.

    Whether it leaves the wall is not asked: :func:`stands_out_px` says it.

    Parameters
    ----------
    wall : Wall
        Of outlines, without it.
    stone : Stone
        The stone.
    side : {"left", "right"}
        The end of the wall from which it was placed.
    repose : Repose
        Where it came to rest.
    wedge : (n, 2) float array, optional
        Corners of the wedge that holds it, in the wall frame, source px.
    wedge_id : int
        Of the wedge, if there is one.
    """
    assert wall.outlines is not None  # noqa: S101 - it settled on outlines
    placement = settled_placement(
        wall.outlines,
        wall.site,
        stone,
        repose.angle_deg,
        repose.settled,
        side,
        int(repose.turned),
    )
    if placement is None or wedge is None:
        return None if placement is None else Stabilised(placement)
    with_stone = wall.outlines.added(outlined(placement, ()), wall.site.scale)
    under = settled_wedge(with_stone, wall.site, wedge_id, stone.id, wedge)
    return Stabilised(placement, (under,))


def stands_out_px(corners: Points, site: Site) -> float:
    """Return how far an outline stands out over the ends or the top of a wall, source px.

    Parameters
    ----------
    corners : (n, 2) float array
        In the wall frame, source px.
    site : Site
        Of the wall.

    Returns
    -------
    out_px : float
        Below 0 where it stays within them.

    Examples
    --------
    >>> import numpy as np
    >>> stands_out_px(np.array([[1.0, 0.0], [8.5, 0.0], [8.5, 3.0]]), Site(8, 4))
    0.5
    """
    (left, _), (right, top) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    width, height = site.extent_px
    return float(max(-left, right - width, top - height))
