"""Edges of the cones of friction at contact points, as columns of the limit analysis (Eq. 23)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import doubles, doubles_out, ints_out

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

Body = tuple[int, float, float]
"""Place of a body, and where its centroid is; place -1 for the ground, wherever that is."""

GROUND_BODY: Body = (-1, 0.0, 0.0)


def cone_edges(
    bodies: Sequence[tuple[Body, Body]],
    normals: Sequence[tuple[float, float]],
    frictions: Sequence[float],
    points: Sequence[Floats],
    length: float,
) -> tuple[Ints, Ints, Floats]:
    """List the forces along the two edges of the cone at every contact point.

    Of each interface: the body that the normal points into (never the ground) and the other, the
    unit normal, mu, and contact points (n, 2).  A stone brings a handful of interfaces, and lists
    are read quicker than arrays of so few numbers.  Moments are divided by `length`.

    Returns the place of the body that each force acts on, that of the other (-1 for the ground),
    and entries (6, N): horizontal force, vertical force and moment about the centroid of the first,
    then those of the second, 0 for the ground.  The edges normal + mu tangent and normal - mu
    tangent of a point follow each other; the tangent of a normal (x, y) is (y, -x).
    """
    if not len(bodies) == len(normals) == len(frictions) == len(points):
        raise ValueError("lists that tell of different interfaces")
    counts = list(map(len, points))
    at = np.concatenate(points, dtype=np.float64) if points else np.empty((0, 2))
    if at.shape[1] != 2:
        raise ValueError("points have two coordinates")
    at = np.ascontiguousarray(at)
    size: cython.Py_ssize_t = 2 * len(at)
    first, second = np.empty(size, np.int32), np.empty(size, np.int32)
    entries = np.empty((6, size))
    ones: cython.p_int = ints_out(first)
    twos: cython.p_int = ints_out(second)
    out: cython.p_double = doubles_out(entries)
    where: cython.p_double = doubles(at)
    # The lock of the interpreter is kept: all of it takes less time than getting that back.
    arm: cython.double = length
    point: cython.Py_ssize_t = 0
    end: cython.Py_ssize_t
    edge: cython.Py_ssize_t
    one: cython.int
    two: cython.int
    one_x: cython.double
    one_y: cython.double
    two_x: cython.double
    two_y: cython.double
    normal_x: cython.double
    normal_y: cython.double
    along: cython.double
    x: cython.double
    y: cython.double
    for (body, other), normal, friction, count in zip(
        bodies, normals, frictions, counts, strict=True
    ):
        one, one_x, one_y = body
        two, two_x, two_y = other
        normal_x, normal_y = normal
        along = friction
        end = 2 * (point + count)
        for edge in range(2 * point, end):
            x, y = normal_x + along * normal_y, normal_y - along * normal_x
            along = -along
            ones[edge], twos[edge] = one, two
            point = 2 * (edge // 2)
            out[edge], out[size + edge] = x, y
            out[2 * size + edge] = moment(where[point] - one_x, where[point + 1] - one_y, arm, x, y)
            if two < 0:
                out[3 * size + edge] = out[4 * size + edge] = out[5 * size + edge] = 0.0
                continue
            out[3 * size + edge], out[4 * size + edge] = -x, -y
            out[5 * size + edge] = moment(
                where[point] - two_x, where[point + 1] - two_y, arm, -x, -y
            )
        point = end // 2
    return first, second, entries


def moment(x, y, length, force_x, force_y):
    """Return the moment of a force on an arm, over a length."""
    return x / length * force_y - y / length * force_x
