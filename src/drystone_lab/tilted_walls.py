"""Walls of tilted joints as exact polygons, and their pictures at any resolution."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from numpy.random import Generator
from numpy.typing import NDArray
from shapely.geometry.polygon import orient
from shapely.ops import split

from drystone.contacts.given import model_from_json
from drystone.kernels.outline import rasterise_polygon
from drystone.model.wall import Labels
from drystone.statics.model import RigidBlockModel

Points = NDArray[np.float64]

BED_SLOPES_DEG = (4.0, 7.0, 11.0)
"""Slopes of the pieces of a bed joint; their signs alternate."""

HEAD_SLOPES_DEG = (7.0, 11.0, 17.0)
"""How far a head joint leans from the vertical, to either side."""

BATTER_DEG = (3.0, 5.0)
"""How far the ends of the wall lean inwards."""

STONE_LENGTH = 1.5
"""Mean length of a stone over the height of its course."""

ATTEMPTS = 200
"""How often a joint is drawn anew before the whole wall is, and how often the wall."""

SHORTEST = 0.04
"""Bends and ends of joints are at least this far apart along a bed; the wall is 1 high."""


@dataclass(frozen=True, eq=False)
class TiltedWall:
    """A wall of height 1 on flat ground whose joints follow no grid.

    Parameters
    ----------
    polygons : tuple of (n, 2) float array
        Corners of stone 1, 2, ...; counter-clockwise, not closed, x to the right and y up;
        without gaps between them.
    """

    polygons: tuple[Points, ...]

    def model(self, mu: float = 0.58) -> RigidBlockModel:
        """Return its exact rigid block model."""
        blocks = [
            {"id": number, "polygon": polygon.tolist()}
            for number, polygon in enumerate(self.polygons, start=1)
        ]
        return model_from_json({"blocks": blocks, "mu": mu})

    def picture(self, height_px: int, offset_px: tuple[float, float] = (0.0, 0.0)) -> Labels:
        """Return its label image: a pixel belongs to the stone that its centre lies in.

        Parameters
        ----------
        height_px : int
            Height of the wall.
        offset_px : (float, float)
            Where the wall's lower left corner lies right of and above a pixel corner, 0 to 1.

        Returns
        -------
        (h, w) uint32 array
            Row 0 at the top, the lowest pixels of the wall in the last row.
        """
        scaled = [polygon * height_px + offset_px for polygon in self.polygons]
        width, height = np.ceil(np.max([p.max(axis=0) for p in scaled], axis=0)).astype(int)
        labels = np.zeros((int(height), int(width)), np.uint32)
        for number, polygon in enumerate(scaled, start=1):
            mask, left, bottom = rasterise_polygon(polygon)
            last, right = int(height) - bottom, left + mask.shape[1]
            labels[last - mask.shape[0] : last, left:right][mask] = number
        filled = np.flatnonzero(labels.any(axis=1))
        return labels[: filled[-1] + 1]


def tilted_wall(rng: Generator, courses: int = 4, length: float = 0.9) -> TiltedWall:
    """Draw a wall whose bed joints zigzag, whose head joints lean and whose ends have a batter.

    Raises
    ------
    ValueError
        When no such wall was found.

    Notes
    -----
    Bends and ends of joints are at least `SHORTEST` apart along a bed.  A facet smaller than a
    pixel cannot be seen in a picture, but may carry a good part of the load.

    Examples
    --------
    >>> wall = tilted_wall(np.random.default_rng(1), courses=3)
    >>> len(wall.polygons), wall.picture(40).shape
    (7, (40, 36))
    """
    for _ in range(ATTEMPTS):
        polygons = _attempt(rng, courses, length)
        if polygons:
            return TiltedWall(polygons)
    raise ValueError(f"no wall of {courses} courses, {length} long, has joints far enough apart")


def _attempt(rng: Generator, courses: int, length: float) -> tuple[Points, ...]:
    """Draw course after course; give up, without stones, where joints come too close."""
    left, right = np.tan(np.radians(rng.permutation(BATTER_DEG)))
    outline = shapely.Polygon([(0, 0), (length, 0), (length - right, 1), (left, 1)])
    lower = np.array([[-1.0, 0.0], [length + 1.0, 0.0]])
    polygons: list[Points] = []
    below: list[Points] = []
    for course in range(courses):
        draws = (_heads(rng, course, length, courses) for _ in range(ATTEMPTS))
        heads = next((h for h in draws if _are_apart(lower, [*below, *h], outline)), None)
        if heads is None:
            return ()
        beds = (_bed(rng, course + 1, length, courses) for _ in range(ATTEMPTS))
        upper = next((bed for bed in beds if _are_apart(bed, heads, outline)), None)
        if upper is None:
            return ()
        polygons += _stones(shapely.Polygon([*lower, *upper[::-1]]) & outline, heads)
        lower, below = upper, heads
    return tuple(polygons)


def _heads(rng: Generator, course: int, length: float, courses: int) -> list[Points]:
    """Draw the lines of the head joints, half a stone further on in every other course."""
    count = max(2, round(length * courses / STONE_LENGTH))
    steps = np.cumsum(rng.uniform(0.85, 1.15, count + 1))
    places = (steps - 0.5 * (course % 2) * steps[0]) / steps[-2] * length
    middle = (course + 0.5) / courses
    lines = []
    for place in places[: count - 1 + course % 2].tolist():
        lean = math.tan(math.radians(float(rng.choice(HEAD_SLOPES_DEG) * rng.choice([-1, 1]))))
        lines.append(np.array([[place + lean * t, middle + t] for t in (-1.0, 1.0)]))
    return lines


def _bed(rng: Generator, course: int, length: float, courses: int) -> Points:
    """Draw the bed below a course, a zigzag with pieces about as long as a stone; flat at the top.

    It reaches beyond the wall on both sides.
    """
    if course == courses:
        return np.array([[-1.0, 1.0], [length + 1.0, 1.0]])
    x, y = [float(rng.uniform(-1.0, -0.5))], [0.0]
    sign = float(rng.choice([-1.0, 1.0]))
    while x[-1] < length + 0.5:
        slope = sign * math.tan(math.radians(float(rng.choice(BED_SLOPES_DEG))))
        run = float(rng.uniform(0.7, 1.3)) * STONE_LENGTH / courses
        x.append(x[-1] + run)
        y.append(y[-1] + slope * run)
        sign = -sign
    points = np.column_stack([x, y])
    points[:, 1] += course / courses - points[:, 1].mean()
    return points


def _are_apart(bed: Points, heads: list[Points], outline: shapely.Polygon) -> bool:
    """Tell whether the ends and bends of a bed and its joints are at least SHORTEST apart."""
    line = shapely.LineString(bed)
    inside = shapely.get_coordinates(line & outline)[:, 0]
    joints = shapely.get_coordinates([line & shapely.LineString(head) for head in heads])[:, 0]
    places = np.sort(np.concatenate([inside, joints]))
    return all(after - before >= SHORTEST for before, after in pairwise(places.tolist()))


def _stones(band: shapely.Polygon, heads: list[Points]) -> list[Points]:
    """Cut a course into its stones, from left to right."""
    pieces = [band]
    for head in heads:
        pieces = [part for piece in pieces for part in split(piece, shapely.LineString(head)).geoms]
    pieces.sort(key=lambda piece: float(piece.centroid.x))
    return [shapely.get_coordinates(orient(piece))[:-1] for piece in pieces]
