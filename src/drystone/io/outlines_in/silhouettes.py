"""From planar shapes of shapely to areas."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely

from drystone.io.outlines_in.model import Area
from drystone.kernels.polygons import Points


def areas_of(shape: Any) -> tuple[Area, ...]:
    """Return the polygons of a planar shape; points and lines are nothing."""
    return tuple(
        Area(tuple(shapely.get_coordinates(line)[:-1] for line in (part.exterior, *part.interiors)))
        for part in shapely.get_parts(shapely.get_parts(shape))
        if part.geom_type == "Polygon" and part.area > 0.0
    )


def with_holes(rings: Sequence[Points]) -> list[tuple[int, Area]]:
    """Make holes of rings that lie in others, as drawings for cutting mean them.

    Parameters
    ----------
    rings : sequence of (n, 2) arrays
        Outlines and holes in any order.

    Returns
    -------
    list of (int, Area)
        Outlines with their holes, and the position of the outline; a ring in a hole is an
        outline again.
    """
    shapes = np.array([shapely.make_valid(shapely.Polygon(ring)) for ring in rings], dtype=object)
    tree = shapely.STRtree(shapes)
    inner, outer = tree.query(shapes, predicate="covered_by")
    size = shapely.area(shapes)
    around: dict[int, list[int]] = {i: [] for i in range(len(rings))}
    for i, j in zip(inner.tolist(), outer.tolist(), strict=True):
        if i != j and size[i] < size[j]:
            around[i].append(j)
    holes: dict[int, list[int]] = {i: [] for i, found in around.items() if len(found) % 2 == 0}
    for i, found in around.items():
        if i not in holes:
            holes[min(found, key=lambda j: (size[j], j))].append(i)
    return [(i, Area((rings[i], *(rings[j] for j in of)))) for i, of in holes.items()]


def shadow(polygons: Sequence[Points]) -> tuple[Area, ...]:
    """Return the union of the polygons of a body as it is seen.

    Parameters
    ----------
    polygons : sequence of (n, 2) arrays
        Its faces in the plane of the picture; those seen from the side have no area.
    """
    # Edges of neighbours are the same numbers, so the union leaves no slits.
    seen = shapely.polygons([np.asarray(p) for p in polygons]) if _alike(polygons) else [
        shapely.Polygon(p) for p in polygons
    ]  # fmt: skip
    shapes = np.asarray(seen, dtype=object)
    shapes = shapes[shapely.area(shapes) > 0.0]
    return areas_of(shapely.union_all(shapely.make_valid(shapes)))


def _alike(polygons: Sequence[Points]) -> bool:
    return len({len(polygon) for polygon in polygons}) == 1
