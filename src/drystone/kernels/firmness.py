"""Whether a polygon rests on rigid neighbours with friction, and how firmly (DESIGN 4.9).

Motions are velocities (x, y, turn).  At each contact the corner may move into the cone that
friction leaves; the polygon rests when no such motion goes down, and it is as firm as gravity may
lean until one does.
"""

from __future__ import annotations

import numpy as np

from drystone.kernels.polygons import Points, Polygons, polygon_edges

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from math import sqrt

    from drystone.kernels.gaps import MovingStone, find_gaps, heap_of, stone_of
    from drystone.kernels.lists import doubles, more_doubles, new_doubles, release
    from drystone.kernels.seidel import solve2, solve3

END = cython.declare(cython.int, -2)
GAINED = cython.declare(cython.double, 1e-6)
FASTEST = cython.declare(cython.double, 1e3)
FIRMEST = cython.declare(cython.double, 10.0)

# A contact whose normal goes down further holds a stone down: where upright faces do not grip, it
# does not count either.
HOLDS_DOWN = cython.declare(cython.double, -0.1)


def rest_margin(
    corners: Points,
    centroid: tuple[float, float],
    around: Polygons,
    width: float,
    mu: float,
    tolerance: float,
    corner: float = 0.3,
    steep: float = -1.0,
) -> float:
    """Return how far gravity may lean, over mu, until a placed polygon moves; at most 10.

    -1 when it does not rest.  Gaps up to the tolerance touch; the ends of the wall carry nothing.
    `corner` and `steep` are those of :class:`drystone.kernels.settling.SettlingRules`.
    """
    require_friction(mu)
    corners = np.ascontiguousarray(corners, np.float64)
    stone: MovingStone = stone_of(corners, polygon_edges(corners))
    x: cython.double = centroid[0]
    y: cython.double = centroid[1]
    find_gaps(stone, heap_of(around, width), tolerance, corner)
    arm: cython.double = arm_of(doubles(corners), stone.count, x, y)
    return firmness(stone, x, y, arm, mu, tolerance, steep, LpRows())


def require_friction(mu: float) -> None:
    """Refuse a coefficient of friction that margins cannot be shares of."""
    if not mu > 0.0:
        raise ValueError(f"mu must be positive, not {mu}")


@cython.cclass
class LpRows:
    """Room for the rows of linear programs, which grows."""

    def __init__(self) -> None:
        self.room = 32
        self.rows = new_doubles(4 * self.room)
        self.scratch = new_doubles(3 * (self.room + 2))

    def __dealloc__(self) -> None:
        release(self.rows)
        release(self.scratch)


def enough_rows(work, count):
    """Make room for so many rows of a linear program."""
    if count > work.room:
        work.room = 2 * count
        work.rows = more_doubles(work.rows, 4 * work.room)
        work.scratch = more_doubles(work.scratch, 3 * (work.room + 2))
    return 0


def arm_of(corners, count, x, y):
    """Return the distance of the furthest corner from a point."""
    most: cython.double = 0.0
    for i in range(count):
        dx, dy = corners[2 * i] - x, corners[2 * i + 1] - y
        dx = dx * dx + dy * dy
        # What is not a number stays.
        if dx > most or dx != dx:
            most = dx
    return sqrt(most)


def firmness(stone, x, y, arm, mu, tolerance, steep, work):
    """Return how far gravity may lean, over mu, until a stone moves; -1 when it does not rest.

    Gaps that touch count, but the ends of the wall carry nothing.  Turns are ways of a corner as
    far out as the arm.  Contacts whose normal goes up by less than `steep` have no friction, and
    those whose normal goes down by more than .1 do not count; with -1 all count.  A stone that is
    held by friction on upright faces, or by what it is hooked under, stands only if it was
    pressed in before.
    """
    gain: cython.double[3] = [0.0, -1.0, 0.0]
    most: cython.double[3] = [1.0, 1.0, 1.0]
    found: cython.double[3] = [0.0, 0.0, 0.0]
    least: cython.double = FIRMEST
    gaps: cython.p_double = stone.gaps
    rows: cython.p_double
    scratch: cython.p_double
    count: cython.Py_ssize_t = 0
    enough_rows(work, 2 * stone.found + 2)
    rows, scratch = work.rows, work.scratch
    for k in range(0, 7 * stone.found, 7):
        if gaps[k + 5] > tolerance or gaps[k + 6] == END:
            continue
        if steep >= 0.0 and gaps[k + 2] < HOLDS_DOWN:
            continue
        grip = mu if gaps[k + 2] >= steep else 0.0
        for sign in range(-1, 2, 2):
            gx = gaps[k + 1] + sign * grip * gaps[k + 2]
            gy = gaps[k + 2] - sign * grip * gaps[k + 1]
            i = 4 * count
            rows[i], rows[i + 1], rows[i + 3] = -gx, -gy, 0.0
            rows[i + 2] = -((gaps[k + 3] - x) * gy - (gaps[k + 4] - y) * gx) / arm
            count += 1
    if count < 4:
        return -1.0
    if not solve3(rows, count, gain, most, scratch, found) or found[1] < -GAINED:
        return -1.0
    # With a speed of 1 aside: by how much must it rise at least?
    gain[0], gain[1] = -1.0, 0.0
    most[0] = most[1] = FASTEST
    for sign in range(-1, 2, 2):
        for i in range(count):
            scratch[3 * i], scratch[3 * i + 1] = rows[4 * i + 1], rows[4 * i + 2]
            scratch[3 * i + 2] = -sign * rows[4 * i]
        if solve2(scratch, count, gain, most, found):
            least = min(least, found[0] / mu)
    return max(least, 0.0)
