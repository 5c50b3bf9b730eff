"""What two outlines have in common, and how deep they lie in each other (DESIGN 4.9).

The one test of overlap outside the loops of settling, which keep a clearance.
"""

import math
from collections.abc import Sequence

import numpy as np
import shapely

from drystone.kernels.polygons import Points

GRID = 2.0**-42
"""Pitch of the grid on which common areas are computed, over the extent of both shapes.

Without a grid GEOS computes in floats: of outlines that touch along an edge its answer is now and
then inside out, and they "overlap by 52.9".  On a grid it is right whatever is put in (snap
rounding).  This one is coarse beside rounding and fine beside any stone."""

EXACT = 1e-8
"""Of a depth, over the extent of the common area."""

CIRCLE = 1e-3
"""Of the radius of the largest circle, over the extent of the common area."""

Segments = tuple[Points, Points]
"""Starts and ends, (n, 2) each."""


def shape_of(corners: Points) -> shapely.Geometry:
    """Return the area of a polygon, empty where it has none.

    Rounding may have made a very fine corner cross itself.
    """
    outline = shapely.Polygon(corners)
    if outline.is_valid:
        return outline
    # Where it crossed itself, lines without an area may be left as well.
    pieces = shapely.get_parts(shapely.get_parts(shapely.make_valid(outline)))
    return shapely.MultiPolygon([piece for piece in pieces if piece.area > 0.0])


def common_parts(first: shapely.Geometry, second: shapely.Geometry) -> tuple[shapely.Polygon, ...]:
    """Return the areas that two shapes have in common; none when they only touch."""
    one, other, origin = _near(first, second)
    return tuple(shapely.transform(part, lambda xy: xy + origin) for part in _common(one, other))


def overlap_depth(first: shapely.Geometry, second: shapely.Geometry) -> float:
    """Return how deep two areas lie in each other; 0 when they touch or stay apart.

    The depth is how far the surface of one reaches below the surface of the other: the largest
    distance of a point on the rim of the common area to the boundary of either area.  It is at
    least the radius of the largest circle in the common area, which counts when two areas are
    almost the same.
    """
    one, other, _ = _near(first, second)
    parts = _common(one, other)
    if not parts:
        return 0.0
    extent = float(np.ptp(shapely.total_bounds(parts).reshape(2, 2), axis=0).max())
    exact = max(EXACT * extent, _pitch(one, other))
    circles = shapely.maximum_inscribed_circle(parts, tolerance=CIRCLE * extent)
    rim = _segments(shapely.MultiPolygon(parts))
    reaches = [_furthest(rim, _segments(area), exact) for area in (one, other)]
    return max(float(shapely.length(circles).max()), *reaches)


def deepest_overlap(
    outlines: Sequence[tuple[int, shapely.Geometry]],
) -> tuple[float, tuple[int, int] | None]:
    """Return the largest overlap depth of two of many outlines, and the ids of the two, if any do.

    Outlines are ids and areas in the order of placement; the one placed first comes first.
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


def _near(
    first: shapely.Geometry, second: shapely.Geometry
) -> tuple[shapely.Geometry, shapely.Geometry, Points]:
    """Return two shapes moved to the origin, and where they were: far away there are few digits."""
    origin = np.nan_to_num(shapely.bounds([first, second])[:, :2].max(axis=0))  # of nothing: NaN
    one, other = shapely.transform([first, second], lambda xy: xy - origin)
    return one, other, origin


def _common(first: shapely.Geometry, second: shapely.Geometry) -> tuple[shapely.Polygon, ...]:
    """Return the areas that two shapes near the origin have in common."""
    common = shapely.intersection(first, second, grid_size=_pitch(first, second))
    return tuple(part for part in shapely.get_parts(common) if part.area > 0.0)


def _pitch(first: shapely.Geometry, second: shapely.Geometry) -> float:
    """Return the pitch of the grid: a power of two, which leaves whole numbers as they are."""
    largest = float(np.abs(shapely.total_bounds([first, second])).max())
    return GRID * 2.0 ** math.frexp(largest)[1]


def _segments(area: shapely.Geometry) -> Segments:
    """Return the edges of an area that have a length."""
    points, line = shapely.get_coordinates(
        shapely.get_parts(shapely.boundary(area)), return_index=True
    )
    edges = (line[1:] == line[:-1]) & (points[1:] != points[:-1]).any(axis=1)
    return points[:-1][edges], points[1:][edges]


def _furthest(rim: Segments, edges: Segments, tolerance: float) -> float:
    """Return the largest distance of a point on some segments to the nearest of some edges.

    The distance to one edge is a convex function along a segment, largest at one of its ends; of
    all edges the least of these is a bound.  Segments are halved while it promises more.
    """
    starts, ends = rim
    furthest = 0.0
    while len(starts):
        at_starts, at_ends = _distances(starts, edges), _distances(ends, edges)
        nearest = np.maximum(at_starts.min(axis=1), at_ends.min(axis=1))
        furthest = max(furthest, float(nearest.max()))
        more = np.maximum(at_starts, at_ends).min(axis=1) > furthest + tolerance
        middles = (starts[more] + ends[more]) / 2.0
        starts, ends = np.vstack([starts[more], middles]), np.vstack([middles, ends[more]])
    return furthest


def _distances(points: Points, edges: Segments) -> Points:
    """Return the distance of each point to each edge."""
    start, along = edges[0], edges[1] - edges[0]
    away = points[:, None] - start
    share = (away * along).sum(axis=2) / (along * along).sum(axis=1)
    gap = away - np.clip(share, 0.0, 1.0)[..., None] * along
    return np.asarray(np.hypot(gap[..., 0], gap[..., 1]))
