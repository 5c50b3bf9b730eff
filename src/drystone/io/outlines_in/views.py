"""From which side things in space are seen: bodies, and drawings that do not lie in X and Y."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.io.read_settings import Up

Vector = NDArray[np.float64]

_AXES = np.eye(3)
_FLAT = 1.0 - 5e-7
"""Cosine of the angle between planes that are the same, about .001."""
_MOST = 0.9
"""Share of the area of all outlines that makes their plane that of the drawing."""


@dataclass(frozen=True, eq=False)
class Sight:
    """What is to the right and up, when one looks against the normal of a plane."""

    right: Vector  # (3,)
    up: Vector

    @property
    def said(self) -> str:
        """Say it as CAD programs do."""
        along = np.abs(np.cross(self.right, self.up))
        sides = f"with {_word(self.right)} to the right and {_word(self.up)} up"
        return f"along {_word(along)}, {sides}"

    def of(self, points: Vector) -> Vector:
        """Return points, (n, 3), as they are seen, (n, 2)."""
        return np.asarray(points @ np.column_stack([self.right, self.up]))


def view(normal: Vector, up: Up) -> Sight:
    """Return the view of what faces a normal, where an axis is up.

    What faces up is seen with X to the right.
    """
    above = _AXES["xyz".index(up[:1] or "z")]
    right = np.cross(above, normal)
    if np.abs(right).max() < 1e-3:
        right = _AXES[0]
    right = right / np.linalg.norm(right)
    return Sight(right + 0.0, np.cross(normal, right) + 0.0)


def usual_side(normal: Vector, up: Up) -> Vector:
    """Return a normal or its opposite: that of the view from the top, the front or the right."""
    axis = int(np.argmax(np.abs(normal)))
    side = -1.0 if axis == 1 and up[:1] != "y" else 1.0
    return normal if normal[axis] * side > 0.0 else -normal


def asked(normal: Vector, up: Up) -> Sight:
    """Return the view of a plane that a user asks for."""
    seen = view(usual_side(normal, up), up)
    return Sight(0.0 - seen.right, seen.up) if up.endswith("-back") else seen


def plane_of(rings: Sequence[Vector]) -> tuple[Vector, NDArray[np.float64]]:
    """Return the normal of the plane that outlines, (n, 3) each, lie in, and how they lean to it.

    That is the cosine of the angle between each and the plane.  Where most do not lie in one
    plane, the normal is the nearest axis.
    """
    vectors = np.array([_area(ring) for ring in rings]).reshape(-1, 3)
    sizes = np.linalg.norm(vectors, axis=1)
    if not sizes.sum() > 0.0:
        return _AXES[2], np.ones(len(rings))
    safe = np.where(sizes > 0.0, sizes, 1.0)[:, None]
    units = np.where(sizes[:, None] > 0.0, vectors / safe, _AXES[2])
    normal = units[int(np.argmax(sizes))]
    flat = np.abs(units @ normal) > _FLAT
    if sizes[flat].sum() < _MOST * sizes.sum():
        normal = np.linalg.eigh((units * sizes[:, None]).T @ units)[1][:, -1]
        normal = _AXES[int(np.argmax(np.abs(normal)))]
    elif np.abs(normal).max() > _FLAT:
        normal = _AXES[int(np.argmax(np.abs(normal)))]
    leaning = np.where(sizes > 0.0, np.abs(units @ normal), 1.0)
    return normal, np.where(leaning > _FLAT, 1.0, leaning)


def _area(ring: Vector) -> Vector:
    """Return the normal of a ring, as long as its area is large."""
    there = ring - ring[0]
    return np.asarray(np.cross(there, np.roll(there, -1, axis=0)).sum(axis=0) / 2.0)


def _word(vector: Vector) -> str:
    """Name an axis, or a direction by its numbers."""
    for axis, name in zip(_AXES, "XYZ", strict=True):
        if np.abs(vector - axis).max() < 1e-6:
            return name
        if np.abs(vector + axis).max() < 1e-6:
            return f"-{name}"
    return f"({', '.join(f'{number:.2f}' for number in vector)})"
