"""Edges of the cones of friction at contact points, as columns of the limit analysis (Eq. 23)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if cython.compiled:
    from cython.cimports.drystone.kernels.memory import doubles, doubles_out, ints_out
else:
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

    A stone brings a handful of interfaces: what is told of each comes in lists, which are made
    and read quicker than arrays of so few numbers.

    Parameters
    ----------
    bodies : (i,) list of (Body, Body)
        Of each interface the body that the normal points into, never the ground, and the other.
    normals : (i,) list of (float, float)
        Unit vectors.
    frictions : (i,) list of float
        Coefficient of friction of each interface.
    points : (i,) list of (n, 2) float arrays
        Contact points of each interface.
    length : float
        What moments are divided by.

    Returns
    -------
    first, second : (N,) int32 arrays
        Places of the body that the force acts on and of the one that takes the opposite force;
        -1 for the ground.  The edges normal + mu tangent and normal - mu tangent of each contact
        point follow each other; the tangent of a normal (x, y) is (y, -x).
    entries : (6, N) float array
        Horizontal force, vertical force and moment about the centroid of `first`, then those of
        `second`, all 0 for the ground.

    Raises
    ------
    ValueError
        When lists are not of one length, or points have not two coordinates.

    Examples
    --------
    >>> ends = np.array([[0.0, 0.0], [2.0, 0.0]])
    >>> _, _, entries = cone_edges([((0, 1.0, 1.0), GROUND_BODY)], [(0.0, 1.0)], [0.5], [ends], 1.0)
    >>> entries[:3, 0].tolist()
    [0.5, 1.0, -0.5]
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
