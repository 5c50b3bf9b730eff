"""Whether a polygon rests on rigid neighbours with friction, and how firmly (DESIGN 4.9).

Motions are velocities (x, y, turn).  At each contact the corner may move into the cone that
friction leaves; the polygon rests when no such motion goes down, and it is as firm as gravity may
lean until one does.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from drystone.kernels.gaps import END, Gap, gaps_python
from drystone.kernels.polygons import Points, Polygons
from drystone.kernels.seidel import Row, order_of, solve2_python, solve_python

GAINED = 1e-6
FASTEST = 1e3
FIRMEST = 10.0

HOLDS_DOWN = -0.1
"""A contact whose normal goes down further holds a stone down: where upright faces do not grip, it
does not count either."""


class Friction(NamedTuple):
    """What counts in the rest test.

    Parameters
    ----------
    mu : float
        Coefficient of friction.
    tolerance : float
        Gaps up to this one touch.
    corner : float
        Two corners nearer than this meet with a face.
    steep : float
        Contacts whose normal goes up by less than this have no friction, and those whose normal
        goes down by more than .1 do not count; -1: all count.  A stone that is held by friction on
        upright faces, or by what it is hooked under, stands only if it was pressed in before.
    """

    mu: float
    tolerance: float
    corner: float
    steep: float = -1.0


def rest_margin_python(
    corners: Points,
    edges: Points,
    centroid: tuple[float, float],
    around: Polygons,
    width: float,
    friction: Friction,
) -> float:
    """Twin of :func:`drystone.kernels.settling.rest_margin`, given the edges too."""
    gaps = gaps_python(corners, edges, around, width, friction.tolerance, friction.corner)
    arm = arm_of(corners, *centroid)
    return firmness_python(gaps, centroid, arm, friction)


def arm_of(corners: Points, x: float, y: float) -> float:
    """Return the distance of the furthest corner from a point."""
    dx, dy = corners[:, 0] - x, corners[:, 1] - y
    return math.sqrt((dx * dx + dy * dy).max())


def firmness_python(
    gaps: Sequence[Gap], centroid: tuple[float, float], arm: float, friction: Friction
) -> float:
    """Return how far gravity may lean, over mu, until a polygon moves; -1 when it does not rest.

    Parameters
    ----------
    gaps : list of Gap
        Those that touch count; the ends of the wall carry nothing.
    centroid : (float, float)
        Where its weight is.
    arm : float
        Turns are ways of a corner so far out.
    friction : Friction
        What counts.
    """
    rows = _cones(gaps, centroid, arm, friction)
    if len(rows) < 4:
        return -1.0
    found = solve_python(rows, (0.0, -1.0, 0.0), (1.0, 1.0, 1.0))
    if found is None or found[1] < -GAINED:
        return -1.0
    # With a speed of 1 aside: by how much must it rise at least?
    least = FIRMEST
    order = order_of(len(rows))
    for sign in (-1, 1):
        rows2 = [(rows[i][1], rows[i][2], -sign * rows[i][0]) for i in order]
        best = solve2_python(rows2, (-1.0, 0.0), (FASTEST, FASTEST))
        if best is not None:
            least = min(least, best[0] / friction.mu)
    return max(least, 0.0)


def _cones(
    gaps: Sequence[Gap], centroid: tuple[float, float], arm: float, friction: Friction
) -> list[Row]:
    """Return two rows for each contact, the edges of its cone of friction."""
    x, y = centroid
    rows = []
    for _, nx, ny, px, py, away, other in gaps:
        if away > friction.tolerance or other == END:
            continue
        if friction.steep >= 0.0 and ny < HOLDS_DOWN:
            continue
        mu = friction.mu if ny >= friction.steep else 0.0
        for sign in (-1, 1):
            gx = nx + sign * mu * ny
            gy = ny - sign * mu * nx
            turning = (px - x) * gy - (py - y) * gx
            rows.append((-gx, -gy, -turning / arm, 0.0))
    return rows
