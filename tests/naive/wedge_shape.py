"""A wedge measured along many upright and level lines, and what a mason would object to."""

import math

import numpy as np
import shapely

COLUMNS, ROWS = 400, 400
NEAR = 1e-7
"""So near to a corner a line is drawn beside it."""


def chords(corners):
    """Upright lines through a polygon: x, lowest and highest y, and the shortest piece of all."""
    polygon = shapely.Polygon(corners)
    left, low, right, high = polygon.bounds
    beside = np.concatenate([corners[:, 0] - NEAR, corners[:, 0] + NEAR])
    x = np.concatenate([np.linspace(left + NEAR, right - NEAR, COLUMNS), beside])
    x = np.sort(x[(x > left) & (x < right)])
    lines = shapely.linestrings([[(at, low - 1.0), (at, high + 1.0)] for at in x])
    inside = shapely.intersection(lines, polygon)
    pieces = shapely.length(shapely.get_parts(inside))
    return x, shapely.bounds(inside)[:, [1, 3]], pieces[pieces > 0.0].min()


def measures(corners):
    """Width, height, thickness, area, slopes and bend of a wedge."""
    x, ends, thickness = chords(corners)
    width = float(np.ptp(corners[:, 0]))
    found = {
        "width": width,
        "height": float(np.ptp(corners[:, 1])),
        "thickness": float(thickness),
        "area": float(shapely.Polygon(corners).area),
        "bend": 0.0,
    }
    for name, face in (("bed", ends[:, 0]), ("top", ends[:, 1])):
        found[name] = float(face[-1] - face[0]) / width
        chord = face[0] + found[name] * (x - x[0])
        found["bend"] = max(found["bend"], float(np.abs(face - chord).max()) / width)
    return found


def objections(corners, least_thickness, greatest_height, greatest_area, mu):
    """By how much a wedge misses each limit; below 0 where it keeps it."""
    one, friction = measures(corners), math.atan(mu)
    bed, top = math.atan(one["bed"]), math.atan(one["top"])
    return {
        "thin": least_thickness - one["thickness"],
        "narrow": 3.0 * least_thickness - one["width"],
        "high": one["height"] - greatest_height,
        "large": one["area"] - greatest_area,
        "upright": one["height"] - one["width"],
        "sliver": one["width"] - 5.0 * one["area"] / one["width"],
        "bent": one["bend"] - 0.1,
        "steep below": abs(bed) - friction,
        "steep above": abs(top) - friction,
        "opens": abs(top - bed) - friction,
    }


def covered(wedge, others):
    """Share of the rows of a wedge in which something lies to the left of it, and to the right."""
    shapes = shapely.union_all([shapely.Polygon(other) for other in others])
    left, low, right, high = shapely.Polygon(wedge).bounds
    heights = low + (np.arange(ROWS) + 0.5) / ROWS * (high - low)
    found = []
    for start, far in ((left - NEAR, -1e4), (right + NEAR, 1e4)):
        rays = shapely.linestrings([[(start, y), (far, y)] for y in heights])
        found.append(np.mean(shapely.length(shapely.intersection(rays, shapes)) > 0.0))
    return found
