"""Settling a polygon on polygons: down to the least energy, by small linear programs (DESIGN 4.9).

A stone is let go at a pose where it touches nothing, or overlaps by no more than is allowed.
Step by step it makes the move (shift and turn) that goes down most while no gap to what is around
it, linearised, falls below a clearance; then the true gaps are looked at.  Since turns are not
straight, a move may come too near to something: it is brought apart again at the least cost, or
halved where that gains nothing.
Gravity may lean towards the side from which the wall is built, which closes the joints beside the
stone.

At the end a friction test says whether the stone rests, and how far gravity may lean until it
moves.  Motions are velocities (x, y, turn).  At each contact the corner may move into the cone that
friction leaves; the polygon rests when no such motion goes down, and it is as firm as gravity may
lean until one does.

No step passes through anything.  A step moves no corner by more than (1 + sqrt 2) radii, and all
gaps within 2.5 radii keep their corners on the right side of a face, or of a line through a
corner, that parts the convex pieces there; what turns and notches add to that shows afterwards as
a depth, or as edges that cross, since a whole stone is larger than a step.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from drystone.kernels.polygons import Points, Polygons, polygon_edges

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from math import cos, isfinite, sin, sqrt

    from drystone.kernels.gaps import (
        Heap,
        MovingStone,
        crosses,
        find_gaps,
        heap_of,
        measure,
        stone_of,
    )
    from drystone.kernels.lists import doubles, kept_doubles
    from drystone.kernels.seidel import solve2, solve3

RESTS = cython.declare(cython.int, 0)
FALLS = cython.declare(cython.int, 1)
OVERLAPS = cython.declare(cython.int, 2)
FAR = cython.declare(cython.int, 3)
UNFINISHED = cython.declare(cython.int, 4)

END = cython.declare(cython.int, -2)
FARTHEST = cython.declare(cython.double, 1e300)

# Gaps up to so many radii are constraints of a step; it moves no corner further.
SPREAD = cython.declare(cython.double, 2.5)

# Settling ends when the radius has shrunk to this share of the first one.
SMALLEST = cython.declare(cython.double, 1e-6)

# An overlap that shrinks so slowly that it would last for more steps is given up.
APART = cython.declare(cython.double, 24.0)

# The `corner` of placed polygons, px.
CORNER = cython.declare(cython.double, 0.3)

# A contact with a normal steeper than this supports.
UPWARD = cython.declare(cython.double, 0.3)

GAINED = cython.declare(cython.double, 1e-6)
FASTEST = cython.declare(cython.double, 1e3)
FIRMEST = cython.declare(cython.double, 10.0)

# A contact whose normal goes down further holds a stone down: where upright faces do not grip, it
# does not count either.
HOLDS_DOWN = cython.declare(cython.double, -0.1)


class Status(IntEnum):
    """How settling ended."""

    RESTS = 0
    FALLS = 1
    """Nothing is to be gained without friction, but with it the stone would move."""
    OVERLAPS = 2
    FAR = 3
    """It turned or slid further than it may."""
    UNFINISHED = 4
    """It still moved after the last step."""


class SettlingRules(NamedTuple):
    """How a stone settles; lengths in the unit of the polygons."""

    lean: float  # gravity towards -x over gravity downwards
    # stop as soon as the stone rests with this margin; below 0: only where nothing is gained
    stop: float
    mu: float  # coefficient of friction of the rest test, above 0
    clearance: float  # gap that is left, above 0
    tolerance: float  # gaps up to this one touch, in the rest test
    corner: float  # two corners nearer than this meet with the face that parts them best
    near: float  # first and largest radius of a step
    far: float
    turn: float  # largest turn, radians
    shift: float  # largest shift aside
    gain: float  # settling ends where a step would go down by no more; not below 0
    overlap: float  # so deep a stone may overlap at the start; it is then brought apart first
    # contacts whose normal goes up by less than this have no friction in the rest test; -1:
    # all have
    steep: float
    beyond: float  # how far the stone may stand out over the ends of the wall
    # the supporting point nearest to the centroid does not slide: the stone rolls about it
    sticks: bool
    turns: bool  # whether the stone may turn
    steps: int  # most steps


class Settling(NamedTuple):
    """Outcome of settling."""

    status: Status
    x: float  # of the centroid
    y: float
    angle: float  # radians
    gap: float  # smallest gap there
    # how far gravity may lean until the stone moves, over mu; -1 when it does not rest
    margin: float
    steps: int


@cython.cclass
class Way:
    """What is let go, by which rules, and what became of it."""


@cython.cclass
class State(MovingStone):
    """A pose, and what is around the stone there; the turn in radians."""


def settle(
    outline: Points,
    edges: Points,
    pose: tuple[float, float, float],
    around: Polygons,
    width: float,
    rules: SettlingRules,
) -> Settling:
    """Settle one stone that is let go at a pose: x, y of the centroid, and the turn in radians.

    Corners of the outline are relative to the centroid, counter-clockwise.  The ends of the wall at
    x = 0 and `width` stop the stone, but carry nothing.
    """
    way: Way = way_of(outline, edges, rules)
    heap: Heap = heap_of(around, width)
    x: cython.double = pose[0]
    y: cython.double = pose[1]
    turn: cython.double = pose[2]
    heap.beyond = way.beyond
    status = Status(let_go(way, heap, x, y, turn))
    here: State = way.here
    return Settling(status, here.x, here.y, here.turn, here.least, way.margin, way.made)


def rest_margin(
    corners: Points,
    centroid: tuple[float, float],
    around: Polygons,
    width: float,
    mu: float,
    tolerance: float,
    steep: float = -1.0,
) -> float:
    """Return how far gravity may lean, over mu, until a placed polygon moves; at most 10.

    -1 when it does not rest.  Gaps up to the tolerance touch; the ends of the wall carry nothing.
    `steep` is that of :class:`SettlingRules`.
    """
    require_friction(mu)
    corners = np.ascontiguousarray(corners, np.float64)
    stone: MovingStone = stone_of(corners, polygon_edges(corners))
    stone.x, stone.y = centroid
    find_gaps(stone, heap_of(around, width), tolerance, CORNER)
    arm: cython.double = arm_of(stone.corners, stone.count, stone.x, stone.y)
    return firmness(stone, arm, mu, tolerance, steep)


def require_friction(mu: float) -> None:
    """Refuse a coefficient of friction that margins cannot be shares of."""
    if not mu > 0.0:
        raise ValueError(f"mu must be positive, not {mu}")


def way_of(outline, edges, rules):
    """Return what is let go, whose arrays it keeps."""
    require_friction(rules.mu)
    way: Way = Way()
    way.corners, way.edges, way.count = doubles(outline), doubles(edges), len(outline)
    way.arm = arm_of(way.corners, way.count, 0.0, 0.0)
    (
        way.lean, way.stop, way.mu, way.clearance, way.tolerance, way.corner, way.near, way.far,
        way.most_turn, way.most_shift, way.gain, way.overlap, way.steep, way.beyond, way.sticks,
        way.turns, way.steps,
    ) = rules  # fmt: skip
    way.room = [outline, edges]
    way.here, way.there = state_of(way), state_of(way)
    return way


def let_go(way, heap, x, y, turn):
    """Let a stone go at a pose, and return how that ended."""
    here: State = way.here
    there: State = way.there
    status: cython.int = OVERLAPS
    way.made, way.margin = 0, -1.0
    here.x, here.y, here.turn = x, y, turn
    with cython.nogil:
        look(here, way, heap)
        if here.least >= -way.overlap and isfinite(way.arm + x + y + turn):
            status = descend(way, heap, here, there)
            if status != FAR:
                if not here.least >= 0.5 * way.clearance or crosses(here, heap):
                    status = OVERLAPS
                else:
                    # Whatever stopped it: does the stone rest?
                    way.margin = margin_of(way, here)
                    if way.margin >= 0.0:
                        status = RESTS
    return status


def state_of(way):
    """Return a state, nowhere yet."""
    state: State = State()
    state.first, state.count = 0, way.count
    state.corners = kept_doubles(way.room, 2 * way.count)
    state.edges = kept_doubles(way.room, 3 * way.count)
    return state


def look(state, way, heap):
    """Turn and move the outline to the pose of a state, and find the gaps there."""
    c: cython.double = cos(state.turn)
    s: cython.double = sin(state.turn)
    for i in range(way.count):
        x, y = way.corners[2 * i], way.corners[2 * i + 1]
        state.corners[2 * i] = c * x - s * y + state.x
        state.corners[2 * i + 1] = s * x + c * y + state.y
        x, y = way.edges[3 * i], way.edges[3 * i + 1]
        state.edges[3 * i], state.edges[3 * i + 1] = c * x - s * y, s * x + c * y
        state.edges[3 * i + 2] = way.edges[3 * i + 2]
    measure(state)
    find_gaps(state, heap, SPREAD * way.far + way.corner, way.corner)
    state.least = FARTHEST
    for i in range(0, 7 * state.found, 7):
        state.least = min(state.least, state.gaps[i])
    return 0


def exchange(a, b):
    """Let each state be the other."""
    a.corners, b.corners = b.corners, a.corners
    a.edges, b.edges = b.edges, a.edges
    a.gaps, b.gaps = b.gaps, a.gaps
    a.rows, b.rows = b.rows, a.rows
    a.scratch, b.scratch = b.scratch, a.scratch
    a.found, b.found = b.found, a.found
    a.room, b.room = b.room, a.room
    a.left, a.low, b.left, b.low = b.left, b.low, a.left, a.low
    a.right, a.high, b.right, b.high = b.right, b.high, a.right, a.high
    a.x, a.y, b.x, b.y = b.x, b.y, a.x, a.y
    a.turn, a.least, b.turn, b.least = b.turn, b.least, a.turn, a.least


def margin_of(way, here):
    """Return how firmly a stone rests."""
    return firmness(here, way.arm, way.mu, way.tolerance, way.steep)


def descend(way, heap, here, there):
    """Go down step by step until nothing is gained; say why it stopped."""
    start_x: cython.double = here.x
    start_turn: cython.double = here.turn
    start_least: cython.double = here.least
    better: cython.bint
    radius: cython.double = way.near
    half: cython.double = 0.5 * way.clearance
    move: cython.double[3] = [0.0, 0.0, 0.0]
    while way.made < way.steps:
        if way.stop >= 0.0 and here.least >= half and margin_of(way, here) >= way.stop:
            return RESTS
        if here.least < half and here.least < start_least * (1.0 - way.made / APART):
            return UNFINISHED
        way.made += 1
        better = False
        if best_move(here, way, radius, move):
            gained = -way.lean * move[0] - move[1]
            if here.least >= half and not gained > way.gain:
                return FALLS
            better = tried(way, heap, here, there, move, radius, gained)
        if not better:
            radius *= 0.5
            if radius < SMALLEST * way.near:
                return FALLS
            continue
        exchange(here, there)
        if abs(here.turn - start_turn) > way.most_turn:
            return FAR
        if abs(here.x - start_x) > way.most_shift:
            return FAR
        if max(abs(move[0]), abs(move[1]), abs(move[2])) > 0.9 * radius:
            radius = min(way.far, 1.6 * radius)
    return UNFINISHED


def tried(way, heap, here, there, move, radius, gained):
    """Make a move; False when it leads nowhere."""
    half: cython.double = 0.5 * way.clearance
    back: cython.double[3] = [0.0, 0.0, 0.0]
    there.x, there.y = here.x + move[0], here.y + move[1]
    there.turn = here.turn + move[2] / way.arm
    look(there, way, heap)
    if here.least < half:
        # It was let go in an overlap: whatever brings it apart is welcome.
        return there.least >= half or there.least > here.least
    if there.least < half:
        # Turns are not straight: what came too near is brought apart, at the least cost.
        small = 4.0 * (way.clearance - there.least)
        if not small <= radius:
            return False
        if not best_move(there, way, small, back):
            return False
        there.x, there.y = there.x + back[0], there.y + back[1]
        there.turn = there.turn + back[2] / way.arm
        look(there, way, heap)
        gained = gained - way.lean * back[0] - back[1]
        if not (there.least >= half and gained > way.gain):
            return False
    return not crosses(there, heap)


def best_move(state, way, radius, move):
    """Find the move within a radius that goes down most while all gaps, linearised, stay open.

    The turn is given as the way of the furthest corner.
    """
    gain: cython.double[3] = [-way.lean, -1.0, 0.0]
    most: cython.double[3] = [radius, radius, radius if way.turns else 0.0]
    gaps: cython.p_double = state.gaps
    rows: cython.p_double = state.rows
    reach: cython.double = SPREAD * radius + way.clearance
    for attempt in range(2):
        i, pivot = 0, -1
        for k in range(0, 7 * state.found, 7):
            if gaps[k] > reach:
                continue
            room = gaps[k] - way.clearance
            lift = 0.0
            if room < 0.0:
                # First it is brought apart, by half a radius at most; then at least not nearer.
                lift = min(0.0, room + 0.5 * radius) if attempt == 0 else room
            nx, ny = gaps[k + 1], gaps[k + 2]
            rows[i], rows[i + 1] = -nx, -ny
            rows[i + 2] = -turning(state, k, nx, ny) / way.arm
            rows[i + 3] = room - lift
            i += 4
            if gaps[k + 5] <= way.tolerance and gaps[k + 6] != END and ny > UPWARD:
                if pivot < 0 or abs(gaps[k + 3] - state.x) < abs(gaps[pivot + 3] - state.x):
                    pivot = k
        if way.sticks and pivot >= 0:
            # The supporting point nearest to the centroid does not slide.
            for sign in range(1, -2, -2):
                nx, ny = sign * gaps[pivot + 2], sign * -gaps[pivot + 1]
                rows[i], rows[i + 1] = nx, ny
                rows[i + 2] = turning(state, pivot, nx, ny) / way.arm
                rows[i + 3] = 0.2 * way.clearance
                i += 4
        if solve3(rows, i // 4, gain, most, state.scratch, move):
            return True
    return False


def turning(stone, k, nx, ny):
    """Return how fast a turn about the centroid moves the point of a gap along a direction."""
    return (stone.gaps[k + 3] - stone.x) * ny - (stone.gaps[k + 4] - stone.y) * nx


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


def firmness(stone, arm, mu, tolerance, steep):
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
    rows: cython.p_double = stone.rows
    scratch: cython.p_double = stone.scratch
    count: cython.Py_ssize_t = 0
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
            rows[i + 2] = -turning(stone, k, gx, gy) / arm
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
