"""What the real outlines say: how deep two stones of a plan lie in each other (DESIGN 4.9)."""

from collections.abc import Sequence

import numpy as np
import shapely

from drystone.kernels.raster import turn
from drystone.model.placement import Placement

SPACING_PX = 0.05
"""Distance of the points at which depth is measured; it is known to half of that."""

NO_AREA_PX = 1e-9
"""A common area below this, in square px, is rounding: the two only touch."""


def real_outline(placement: Placement, site_height_px: int) -> shapely.Polygon:
    """Return the outline of a placed stone in the wall frame, source px."""
    x, y = placement.centroid(site_height_px)
    scale = placement.posed.scale
    points = turn(placement.posed.stone.outline, placement.posed.angle_deg)
    outline = shapely.Polygon(points + np.array([x, y]) / scale)
    return outline if outline.is_valid else shapely.make_valid(outline)


def overlap_depth(first: shapely.Geometry, second: shapely.Geometry) -> float:
    """Return how deep two areas lie in each other.

    The depth is how far the surface of one reaches below the surface of the other: the largest
    distance of a point on the rim of the common area to the boundary of either area.  It is at
    least the radius of the largest circle in the common area, which counts when two areas are
    almost the same.  0 when they touch or stay apart.

    Parameters
    ----------
    first, second : shapely geometry
        Areas.

    Notes
    -----
    Measured at points `SPACING_PX` apart.

    Examples
    --------
    >>> overlap_depth(shapely.box(0, 0, 4, 2), shapely.box(0, 1.75, 4, 4))
    0.25
    """
    common = shapely.intersection(first, second)
    if common.area < NO_AREA_PX:
        return 0.0
    circles = [
        shapely.length(shapely.maximum_inscribed_circle(part, tolerance=SPACING_PX))
        for part in shapely.get_parts(common)
        if part.area > NO_AREA_PX
    ]
    rim = shapely.segmentize(shapely.boundary(common), SPACING_PX)
    points = shapely.points(shapely.get_coordinates(rim))
    reaches = [shapely.distance(points, shapely.boundary(area)).max() for area in (first, second)]
    return float(max(*circles, *reaches))


def deepest_overlap(
    placements: Sequence[Placement], site_height_px: int
) -> tuple[float, tuple[int, int] | None]:
    """Return the largest overlap depth of the real outlines of two placed stones.

    Parameters
    ----------
    placements : sequence of Placement
        The stones; wedges are left out, they are cut to fit.
    site_height_px : int
        Height of the site, working px.

    Returns
    -------
    depth : float
        Source px.
    at : (int, int) or None
        Ids of the two stones, the one placed first coming first; None when no two overlap.
    """
    outlines = [real_outline(placement, site_height_px) for placement in placements]
    if len(outlines) < 2:
        return 0.0, None
    tree = shapely.STRtree(outlines)
    deepest, at = 0.0, None
    first, second = tree.query(outlines, predicate="intersects")
    for a, b in sorted(zip(first.tolist(), second.tolist(), strict=True)):
        if a < b and (depth := overlap_depth(outlines[a], outlines[b])) > deepest:
            deepest, at = depth, (placements[a].stone_id, placements[b].stone_id)
    return deepest, at
