"""Columns of the limit analysis: edges of cones of friction, and checks of answers (Eq. 23).

The program is that of :mod:`drystone.kernels.simplex`, its columns a_j in two parts: those of a
wall, and those that a stone adds.  Nothing that a solver says of its answer is used.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.simplex import Added, Cones

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import doubles, doubles_out, ints, ints_out, kept_doubles

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
    edge: cython.Py_ssize_t
    for (body, other), normal, friction, count in zip(
        bodies, normals, frictions, counts, strict=True
    ):
        one: cython.int = body[0]
        one_x: cython.double = body[1]
        one_y: cython.double = body[2]
        two: cython.int = other[0]
        two_x: cython.double = other[1]
        two_y: cython.double = other[2]
        normal_x: cython.double = normal[0]
        normal_y: cython.double = normal[1]
        along: cython.double = friction
        end: cython.Py_ssize_t = 2 * (point + count)
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


class Figures(NamedTuple):
    """How far an answer is from one; NaN wherever anything that counts is not a number."""

    residual: float  # largest entry of sum x_j a_j + alpha live - rhs
    violation: float  # by how much a force x_j is below 0 at most
    total: float  # sum of abs(x_j)
    largest: float  # largest entry of the velocity v
    inadmissible: float  # by how much some a_j . v is below 0 at most
    live: float  # live . v
    rhs: float  # rhs . v


def figures(
    wall: Cones, weights: Floats, added: Added, alpha: float, forces: Floats, velocity: Floats
) -> Figures:
    """Measure the forces and the mechanism of one answer.

    Forces are those of the columns of the wall that are left, then of the new ones; without any the
    first three figures are 0.  Velocities, (3 (n + k),), are those of all bodies.
    """
    new = added.cones
    columns = len(wall.first) - len(added.closed) + len(new.first)
    if len(forces) not in (0, columns) or len(velocity) != 3 * (len(weights) + len(added.weights)):
        raise ValueError("forces or velocities of another program")
    # The lock of the interpreter is kept: all of it takes less time than getting that back.
    n: cython.Py_ssize_t = len(weights)
    rows: cython.Py_ssize_t = len(velocity)
    room: list = []
    check: Check = Check()
    check.forces, check.loaded, check.force = doubles(forces), len(forces) > 0, 0
    check.velocity, check.left = doubles(velocity), kept_doubles(room, rows)
    check.violation = check.total = check.inadmissible = 0.0
    heavy: cython.p_double = doubles(weights)
    new_heavy: cython.p_double = doubles(added.weights)
    closed: cython.p_int = ints(added.closed)
    column: cython.Py_ssize_t = 0
    entries: cython.p_double = doubles(wall.entries)
    first: cython.p_int = ints(wall.first)
    second: cython.p_int = ints(wall.second)
    size: cython.Py_ssize_t = len(wall.first)
    for gone in range(len(added.closed) + 1):
        stop = closed[gone] if gone < len(added.closed) else size
        check_columns(check, first, second, entries, size, column, stop)
        column = stop + 1
    size = len(new.first)
    check_columns(check, ints(new.first), ints(new.second), doubles(new.entries), size, 0, size)
    residual: cython.double = 0.0
    largest: cython.double = 0.0
    live: cython.double = 0.0
    rhs: cython.double = 0.0
    load: cython.double = alpha
    for i in range(rows // 3):
        weight = heavy[i] if i < n else new_heavy[i - n]
        live += weight * check.velocity[3 * i]
        rhs += weight * check.velocity[3 * i + 1]
        if check.loaded:
            residual = larger(residual, abs(check.left[3 * i] + load * weight))
            residual = larger(residual, abs(check.left[3 * i + 1] - weight))
            residual = larger(residual, abs(check.left[3 * i + 2]))
    for i in range(rows):
        largest = larger(largest, abs(check.velocity[i]))
    return Figures(residual, check.violation, check.total, largest, check.inadmissible, live, rhs)


@cython.cclass
class Check:
    """Forces and velocities, and what was found of all columns so far."""


def check_columns(check, first, second, entries, size, start, stop):
    """Go through some of so many columns; their forces come next."""
    velocity: cython.p_double = check.velocity
    left: cython.p_double = check.left
    for column in range(start, stop):
        one, two = 3 * first[column], 3 * second[column]
        power = entries[column] * velocity[one]
        power = power + entries[size + column] * velocity[one + 1]
        power = power + entries[2 * size + column] * velocity[one + 2]
        if two >= 0:
            x = entries[3 * size + column] * velocity[two]
            x = x + entries[4 * size + column] * velocity[two + 1]
            power = power + (x + entries[5 * size + column] * velocity[two + 2])
        check.inadmissible = larger(check.inadmissible, -power)
        if not check.loaded:
            continue
        x = check.forces[check.force]
        check.force += 1
        if x == 0.0:
            continue
        check.total += abs(x)
        check.violation = larger(check.violation, -x)
        for k in range(3):
            left[one + k] += x * entries[k * size + column]
        if two >= 0:
            for k in range(3):
                left[two + k] += x * entries[(3 + k) * size + column]


def larger(one, two):
    """Return the larger one; what is no number counts as the largest."""
    return two if two > one or two != two else one
