"""How deep two stones of a plan lie in each other, by their real outlines (DESIGN 4.9)."""

from collections.abc import Sequence

import numpy as np
import shapely

from drystone.kernels.polygons import Points
from drystone.kernels.raster import turn
from drystone.model.placement import Placement

SPACING_PX = 0.02
"""Distance of the points at which depth is measured: it falls short by half of that at most."""

NO_AREA_PX = 1e-9
"""A common area below this, in square px, is rounding: the two only touch."""


def real_outline(placement: Placement, site_height_px: int) -> shapely.Geometry:
    """Return the outline of a placed stone in the wall frame, source px."""
    if placement.settled is not None:
        return shape_of(placement.settled.corners)
    x, y = placement.centroid(site_height_px)
    scale = placement.posed.scale
    points = turn(placement.posed.stone.outline, placement.posed.angle_deg)
    return shape_of(points + np.array([x, y]) / scale)


def shape_of(corners: Points) -> shapely.Geometry:
    """Return the area of a polygon; rounding may have made a very fine corner cross itself."""
    outline = shapely.Polygon(corners)
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
    outlines: Sequence[tuple[int, shapely.Geometry]],
) -> tuple[float, tuple[int, int] | None]:
    """Return the largest overlap depth of two of many outlines.

    Parameters
    ----------
    outlines : sequence of (int, shapely geometry)
        Id and area of each, in the order of placement.

    Returns
    -------
    depth : float
        In the unit of the outlines.
    at : (int, int) or None
        Ids of the two, the one placed first coming first; None when no two overlap.
    """
    if len(outlines) < 2:
        return 0.0, None
    shapes = [shape for _, shape in outlines]
    deepest, at = 0.0, None
    first, second = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    for a, b in sorted(zip(first.tolist(), second.tolist(), strict=True)):
        if a < b and (depth := overlap_depth(shapes[a], shapes[b])) > deepest:
            deepest, at = depth, (outlines[a][0], outlines[b][0])
    return deepest, at
