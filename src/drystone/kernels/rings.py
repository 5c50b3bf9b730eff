"""Corners of polygons with the edges that begin and end there, for kernels in NumPy."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.polygons import Points, Polygons

Ints = NDArray[np.intp]


class Ring(NamedTuple):
    """Corners and edges of one or several polygons.

    Parameters
    ----------
    corners : (n, 2) float array
        Where edges begin.
    ends : (n, 2) float array
        Where they end.
    edges : (n, 3) float array
        Unit vectors and lengths.
    before : (n,) int array
        The edge before each, past those without length.
    number : (n,) int array
        Of each corner in its polygon.
    first, size : (n,) int arrays
        First corner of its polygon, and how many that has.
    """

    corners: Points
    ends: Points
    edges: Points
    before: Ints
    number: Ints
    first: Ints
    size: Ints

    @classmethod
    def of(cls, corners: Points, edges: Points) -> "Ring":
        """Return one polygon."""
        count = len(corners)
        number = np.arange(count)
        before = edges_before(edges[:, 2])
        return cls(
            corners,
            np.roll(corners, -1, axis=0),
            edges,
            before,
            number,
            np.zeros(count, np.intp),
            np.full(count, count),
        )

    @classmethod
    def several(cls, polygons: Polygons, chosen: Ints) -> tuple["Ring", Ints]:
        """Return some polygons, and to which of them each corner belongs."""
        ends = np.cumsum(polygons.first[chosen + 1] - polygons.first[chosen])
        parts, owner = [], []
        for k, (i, end) in enumerate(zip(chosen.tolist(), ends.tolist(), strict=True)):
            a, b = int(polygons.first[i]), int(polygons.first[i + 1])
            ring = cls.of(polygons.corners[a:b], polygons.edges[a:b])
            first = end - (b - a)
            parts.append(ring._replace(before=ring.before + first, first=ring.first + first))
            owner.append(np.full(b - a, k))
        joined = [np.concatenate(columns) for columns in zip(*parts, strict=True)]
        return cls(*joined), np.concatenate(owner)

    def polygon(self, corner: int) -> Points:
        """Return the corners of the polygon that a corner belongs to."""
        first = int(self.first[corner])
        return self.corners[first : first + int(self.size[corner])]


def edges_before(lengths: Points) -> Ints:
    """Return the edge before each, past those without length."""
    count = len(lengths)
    before = np.roll(np.arange(count), 1)
    if not (lengths > 0.0).all():
        for e in range(count):
            for _ in range(count - 1):
                if lengths[before[e]] > 0.0:
                    break
                before[e] = before[e] - 1 if before[e] else count - 1
    return before
