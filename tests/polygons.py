"""Random simple polygons, convex and concave, as the outlines of stones are."""

import numpy as np
import shapely
from hypothesis import strategies as st

from drystone.kernels.polygons import area_and_centroid, turn


def random_polygon(rng, corners, size):
    """A star-shaped polygon of random radii: counter-clockwise, its centroid at the origin.

    Of more than 4 corners it is seldom convex; it is at most `size` wide in any direction.
    """
    # Never half a turn or more from one corner to the next, or it need not be simple.
    spread = min(0.9, 0.45 * (corners - 2))
    angle = (np.arange(corners) + rng.uniform(0.0, spread, corners)) * (2.0 * np.pi / corners)
    radius = rng.uniform(0.2, 1.0, corners) * size / 2.0
    return centred(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))


def centred(corners):
    """The same polygon with its centroid at the origin."""
    _, x, y = area_and_centroid(corners)
    return np.asarray(corners - np.array([x, y]))


def convex(corners):
    """The convex hull of some points, counter-clockwise."""
    hull = shapely.get_coordinates(shapely.convex_hull(shapely.multipoints(corners)))[:-1]
    return np.ascontiguousarray(hull if area_and_centroid(hull)[0] > 0.0 else hull[::-1])


def on_grid(corners, step):
    """The corners moved to a grid, without those that fall together; None when it is not simple."""
    moved = np.round(corners / step) * step
    moved = moved[(moved != np.roll(moved, 1, axis=0)).any(axis=1)]
    shape = shapely.Polygon(moved) if len(moved) > 2 else shapely.Polygon()
    return moved if shape.is_valid and shape.area > 0.0 else None


def outlines_along_a_line(rng):
    """Two outlines above the ground with a common line of several pieces, otherwise rounded."""
    x = np.array([0.0, *np.sort(rng.uniform(0.0, 50.0, rng.integers(0, 5))), 50.0])
    line = np.column_stack([x, rng.uniform(-3.0, 3.0, len(x)) * rng.integers(0, 2)])
    ends = np.array([[50.0, 30.0], [0.0, 30.0]])
    angle_deg, away = rng.uniform(-180.0, 180.0), rng.uniform((-100.0, 60.0), (100.0, 90.0))
    above = np.vstack([line, ends])
    below = np.vstack([line[::-1], ends[::-1] * (1.0, -1.0)])
    rounded = rng.uniform(-2e-15, 2e-15, 2)
    return turn(above, angle_deg) + away, turn(below, angle_deg) + away + rounded


@st.composite
def simple_polygons(draw, max_corners=12, max_size=20.0):
    """A simple polygon about the origin, counter-clockwise: concave, convex, a box, or on a grid.

    Those on a grid have corners at multiples of .5, with edges along the axes, corners in a row
    on one line and small whole slopes among them; their centroid is near the origin, that of the
    others at it.
    """
    kind = draw(st.sampled_from(["star", "convex", "box", "grid"]))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    size = draw(st.floats(0.5, max_size))
    if kind == "box":
        width, height = rng.uniform(0.05, 0.7, 2) * size / 2.0
        return np.array([[-width, -height], [width, -height], [width, height], [-width, height]])
    star = random_polygon(rng, draw(st.integers(3, max_corners)), size)
    if kind == "convex":
        return centred(convex(star))
    if kind == "grid" and (moved := on_grid(star, 0.5)) is not None:
        return moved
    return star


def box(left, low, right, high):
    """The corners of a rectangle."""
    return np.array([[left, low], [right, low], [right, high], [left, high]], float)


def box_of(left, bottom, width=40.0, height=20.0):
    """The corners of a rectangle of some size."""
    return box(left, bottom, left + width, bottom + height)


def box_about(width, height):
    """The corners of a rectangle about the origin."""
    return box(-width / 2.0, -height / 2.0, width / 2.0, height / 2.0)


def moved(polygon, x, y=0.0):
    """The same polygon somewhere else."""
    return np.asarray(polygon + np.array([x, y]))
