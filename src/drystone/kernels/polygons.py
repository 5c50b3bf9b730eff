"""Simple polygons in one array: the outlines of placed stones, ready for kernels."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]

GRID = 1 << 20
"""Settled stones and wedges have their coordinates on a grid of so many points in a source px."""


class Polygons(NamedTuple):
    """Simple polygons, counter-clockwise and not closed, one after the other; y up."""

    corners: Points  # (n, 2)
    # (k + 1,) polygon i has the corners from first[i] to before first[i + 1]
    first: NDArray[np.int32]
    boxes: Points  # (k, 4) left, bottom, right and top
    edges: Points  # (n, 3) unit vector (x, y) from each corner to the next one, and their distance

    def __len__(self) -> int:
        """Return how many polygons there are."""
        return len(self.first) - 1

    def polygon(self, index: int) -> Points:
        """Return the corners of one polygon."""
        return self.corners[self.first[index] : self.first[index + 1]]

    def added(self, polygons: Iterable[Points]) -> "Polygons":
        """Return these polygons with more after them."""
        new = [np.ascontiguousarray(polygon, np.float64) for polygon in polygons]
        sizes = np.array([len(polygon) for polygon in new], np.int64)
        ends = self.first[-1] + np.cumsum(sizes)
        boxes = [np.concatenate([polygon.min(axis=0), polygon.max(axis=0)]) for polygon in new]
        return Polygons(
            np.concatenate([self.corners, *new]),
            np.concatenate([self.first, ends.astype(np.int32)]),
            np.vstack([self.boxes, *boxes]),
            np.concatenate([self.edges, *map(polygon_edges, new)]),
        )

    def leading(self, count: int) -> "Polygons":
        """Return the first so many polygons, without a copy."""
        end = int(self.first[count])
        return Polygons(
            self.corners[:end], self.first[: count + 1], self.boxes[:count], self.edges[:end]
        )

    def mirrored(self, width: float) -> "Polygons":
        """Return the mirror images about the middle of a wall of a given width.

        Corners are given in reverse, so that polygons are counter-clockwise again.
        """
        return no_polygons().added(
            mirrored_polygon(self.polygon(i), width) for i in range(len(self))
        )


def on_grid(points: Points) -> Points:
    """Return the nearest points whose coordinates are multiples of 2^-20.

    Those are the same again after they were written in another unit and read back, so that walls
    can be rebuilt bit by bit.

    Examples
    --------
    >>> metres = on_grid(np.array([[0.1, 700.7]])) / 437.3
    >>> bool((on_grid(metres * 437.3) == on_grid(np.array([[0.1, 700.7]]))).all())
    True
    """
    return np.asarray(np.floor(points * GRID + 0.5) / GRID)


def no_polygons() -> Polygons:
    """Return an empty collection."""
    return Polygons(np.zeros((0, 2)), np.zeros(1, np.int32), np.zeros((0, 4)), np.zeros((0, 3)))


def polygon_edges(corners: Points) -> Points:
    """Return the edges of a polygon as rows (unit vector x, y, length), from each corner on."""
    edges = np.empty((len(corners), 3))
    x, y, length = edges.T
    x[:-1], y[:-1] = (corners[1:] - corners[:-1]).T
    x[-1], y[-1] = corners[0] - corners[-1]
    np.sqrt(x * x + y * y, out=length)
    edges[:, :2] /= edges[:, 2:]
    return edges


def mirrored_polygon(corners: Points, width: float) -> Points:
    """Return the mirror image of one polygon about the middle of a wall of a given width."""
    return np.column_stack([width - corners[::-1, 0], corners[::-1, 1]])


def area_and_centroid(corners: Points) -> tuple[float, float, float]:
    """Return the area and the centroid (x, y) of a counter-clockwise polygon.

    Examples
    --------
    >>> area_and_centroid(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]))
    (2.0, 1.0, 0.5)
    """
    # From the first corner, so that polygons far from the origin keep their digits; in plain
    # floats, which for some dozen corners are quicker than arrays.
    points = (corners - corners[0]).tolist()
    twice = sum_x = sum_y = 0.0
    before_x, before_y = points[-1]
    for x, y in points:
        cross = before_x * y - x * before_y
        twice += cross
        sum_x += (before_x + x) * cross
        sum_y += (before_y + y) * cross
        before_x, before_y = x, y
    scale = 3.0 * twice
    return twice / 2.0, float(corners[0, 0]) + sum_x / scale, float(corners[0, 1]) + sum_y / scale
