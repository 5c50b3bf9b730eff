"""Edges of the cones of friction at contact points, as columns of the limit analysis (Eq. 23)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

Body = tuple[int, float, float]
"""Place of a body, and where its centroid is; place -1 for the ground, wherever that is."""

GROUND_BODY: Body = (-1, 0.0, 0.0)

_fast = compiled("cones")


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
    if _fast is None:
        return cone_edges_numpy(bodies, normals, frictions, counts, at, length)
    first = np.empty(2 * len(at), np.int32)
    second = np.empty(2 * len(at), np.int32)
    entries = np.empty((6, 2 * len(at)))
    _fast.cone_edges(bodies, normals, frictions, counts, at, length, first, second, entries)
    return first, second, entries


def cone_edges_numpy(
    bodies: Sequence[tuple[Body, Body]],
    normals: Sequence[tuple[float, float]],
    frictions: Sequence[float],
    counts: Sequence[int],
    points: Floats,
    length: float,
) -> tuple[Ints, Ints, Floats]:
    """Twin of :func:`cone_edges`, with the number of points of each interface, and all points."""
    repeats = 2 * np.array(counts, np.intp)
    body = np.array(bodies, float).reshape(-1, 2, 3).repeat(repeats, axis=0)
    normal = np.array(normals, float).reshape(-1, 2).repeat(repeats, axis=0)
    along = np.array(frictions, float).repeat(repeats)
    along[1::2] *= -1.0
    arm = (points.repeat(2, axis=0)[:, None] - body[:, :, 1:]) / length
    entries = np.empty((6, len(along)))
    entries[0] = normal[:, 0] + along * normal[:, 1]
    entries[1] = normal[:, 1] - along * normal[:, 0]
    entries[3:5] = -entries[:2]
    entries[2] = arm[:, 0, 0] * entries[1] - arm[:, 0, 1] * entries[0]
    entries[5] = arm[:, 1, 0] * entries[4] - arm[:, 1, 1] * entries[3]
    first, second = body[:, :, 0].T.astype(np.int32, order="C")
    entries[3:, second < 0] = 0.0
    return first, second, entries
