"""Simple polygons in one array: the outlines of placed stones, ready for kernels."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import accumulate
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import rotation

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from math import floor, sqrt

    from drystone.kernels.lists import doubles, doubles_out

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
        return len(self.first) - 1

    def polygon(self, index: int) -> Points:
        """Return the corners of one polygon."""
        return self.corners[self.first[index] : self.first[index + 1]]

    def added(self, polygons: Iterable[Points]) -> Polygons:
        """Return these polygons with more after them."""
        new = [np.ascontiguousarray(polygon, np.float64) for polygon in polygons]
        if not new:
            return self
        corners = np.concatenate(new)
        *starts, end = accumulate(map(len, new), initial=0)
        least, most = np.minimum.reduceat(corners, starts), np.maximum.reduceat(corners, starts)
        return Polygons(
            np.concatenate([self.corners, corners]),
            np.concatenate([self.first, self.first[-1] + np.array([*starts[1:], end], np.int32)]),
            np.concatenate([self.boxes, np.concatenate([least, most], axis=1)]),
            np.concatenate([self.edges, *map(polygon_edges, new)]),
        )

    def leading(self, count: int) -> Polygons:
        """Return the first so many polygons, without a copy."""
        end = int(self.first[count])
        return Polygons(
            self.corners[:end], self.first[: count + 1], self.boxes[:count], self.edges[:end]
        )

    def mirrored(self, width: float) -> Polygons:
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


def place_on_grid(x: float, y: float) -> tuple[float, float]:
    """Return the nearest place whose coordinates are multiples of 2^-20."""
    return floor(x * GRID + 0.5) / GRID, floor(y * GRID + 0.5) / GRID


def turn(points: Points, angle_deg: float) -> Points:
    """Turn points (n, 2), y up, counter-clockwise about the origin."""
    points = np.ascontiguousarray(points, np.float64)
    turned = np.empty_like(points)
    count: cython.Py_ssize_t = len(points)
    at: cython.p_double = doubles(points)
    to: cython.p_double = doubles_out(turned)
    c: cython.double
    s: cython.double
    c, s = rotation(angle_deg)
    for i in range(0, 2 * count, 2):
        to[i], to[i + 1] = at[i] * c - at[i + 1] * s, at[i + 1] * c + at[i] * s
    return turned


def no_polygons() -> Polygons:
    """Return an empty collection."""
    return Polygons(np.zeros((0, 2)), np.zeros(1, np.int32), np.zeros((0, 4)), np.zeros((0, 3)))


def polygon_edges(corners: Points) -> Points:
    """Return the edges of a polygon as rows (unit vector x, y, length), from each corner on.

    An edge without length has no direction: NaN, whether or not this is compiled.
    """
    count: cython.Py_ssize_t = len(corners)
    edges = np.empty((count, 3))
    corners = np.ascontiguousarray(corners, np.float64)
    at: cython.p_double = doubles(corners)
    to: cython.p_double = doubles_out(edges)
    nowhere: cython.double = math.nan
    for i in range(count):
        k = 2 * (i + 1) if i + 1 < count else 0
        x, y = at[k] - at[2 * i], at[k + 1] - at[2 * i + 1]
        length = sqrt(x * x + y * y)
        to[3 * i], to[3 * i + 1], to[3 * i + 2] = nowhere, nowhere, length
        if length > 0.0:
            to[3 * i], to[3 * i + 1] = x / length, y / length
    return edges


def mirrored_polygon(corners: Points, width: float) -> Points:
    """Return the mirror image of one polygon about the middle of a wall of a given width."""
    return np.column_stack([width - corners[::-1, 0], corners[::-1, 1]])


def area_and_centroid(corners: Points) -> tuple[float, float, float]:
    """Return the area and the centroid (x, y) of a counter-clockwise polygon; NaN without area.

    Examples
    --------
    >>> area_and_centroid(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]))
    (2.0, 1.0, 0.5)
    """
    count: cython.Py_ssize_t = len(corners)
    corners = np.ascontiguousarray(corners, np.float64)
    at: cython.p_double = doubles(corners)
    # From the first corner, so that polygons far from the origin keep their digits.
    first_x: cython.double = at[0]
    first_y: cython.double = at[1]
    before_x: cython.double = at[2 * count - 2] - first_x
    before_y: cython.double = at[2 * count - 1] - first_y
    twice: cython.double = 0.0
    sum_x: cython.double = 0.0
    sum_y: cython.double = 0.0
    for i in range(count):
        x, y = at[2 * i] - first_x, at[2 * i + 1] - first_y
        cross = before_x * y - x * before_y
        twice += cross
        sum_x += (before_x + x) * cross
        sum_y += (before_y + y) * cross
        before_x, before_y = x, y
    scale: cython.double = 3.0 * twice if twice != 0.0 else math.nan
    return twice / 2.0, first_x + sum_x / scale, first_y + sum_y / scale
