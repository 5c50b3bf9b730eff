"""Slow, obvious twin of drystone.kernels.meetings: a contact wherever polygons are near."""

import numpy as np
import shapely


def edges(corners):
    """Both ends of every edge."""
    return [(corners[i - 1], corners[i]) for i in range(len(corners))]


def samples(corners, other, step):
    """Points on the boundary: the corners, what is nearest to corners of the other, and between."""
    ring = shapely.LinearRing(corners)
    places = [ring.project(shapely.Point(corner)) for corner in (*corners, *other)]
    places += np.arange(0.0, ring.length, step).tolist()
    return shapely.get_coordinates([ring.interpolate(place) for place in sorted(set(places))])


def touching(corners, other, tolerance, step):
    """Samples within the tolerance of the other polygon, with the normal there.

    The normal is that of the other one's edge where the nearest point lies inside it, otherwise
    that of the edge the sample lies inside; a corner near a corner has none.
    """
    solid = shapely.Polygon(other)
    found = []
    for point in samples(corners, other, step):
        if shapely.Point(point).distance(solid) > tolerance:
            continue
        away = shapely.Point(point).distance
        nearest = min(edges(other), key=lambda edge: away(shapely.LineString(edge)))
        normal = outward(nearest) if is_inside(point, nearest) else None
        if normal is None:
            own = min(edges(corners), key=lambda edge: away(shapely.LineString(edge)))
            normal = -outward(own) if is_inside(point, own) else None
        if normal is not None:
            found.append((point, normal))
    return found


def outward(edge):
    """The outward unit normal of an edge of a counter-clockwise polygon."""
    x, y = edge[1] - edge[0]
    return np.array([y, -x]) / np.hypot(x, y)


def is_inside(point, edge):
    """Whether a point projects into an edge, away from its ends."""
    step = edge[1] - edge[0]
    share = float((point - edge[0]) @ step / (step @ step))
    return 1e-6 < share < 1 - 1e-6
