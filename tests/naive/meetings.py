"""Slow, obvious twin of drystone.kernels.meetings: a contact wherever polygons are near."""

import numpy as np
import shapely


def touching(corners, other, tolerance, step):
    """Points of the boundary, one each step, within the tolerance of the other polygon.

    With the outward normal of that one's nearest edge.
    """
    ring, solid = shapely.LinearRing(corners), shapely.Polygon(other)
    edges = list(zip(np.roll(other, 1, axis=0), other, strict=True))
    found = []
    for point in ring.interpolate(np.arange(0.0, ring.length, step)):
        if point.distance(solid) <= tolerance:
            start, end = edges[shapely.distance(point, shapely.linestrings(edges)).argmin()]
            x, y = (end - start) / np.hypot(*(end - start))
            found.append((shapely.get_coordinates(point)[0], np.array([y, -x])))
    return found
