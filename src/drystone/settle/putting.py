"""Putting a block down where it is not quite as planned, and letting it go (DESIGN 4.10).

It is lifted until it overlaps nothing below.  There it is pressed in between its neighbours: moved
aside where there is room, else these are pushed apart along their beds.  Then it goes down as
friction lets it: it rolls about what carries it, and slides only where it does not come to rest so.
"""

import math
from dataclasses import replace

import numpy as np

from drystone.kernels import settling
from drystone.kernels.asides import asides
from drystone.kernels.polygons import Points, Polygons, on_grid, polygon_edges
from drystone.kernels.raster import turn
from drystone.kernels.settling import Settling, SettlingRules, Status
from drystone.model.builder import Built
from drystone.poses import wrap_deg
from drystone.settle.rest import CORNER, GAIN
from drystone.settle.settings import SettleSettings

FALLEN_SHARE, FALLEN_DEG = 0.25, 12.0
"""A stone has fallen when it ends farther from the plan, over its size, or turned by more."""

ASIDE = 0.3
"""So far, over its size, a block is moved aside or pushed at most."""

LIFTS = (0.0, 0.01, 0.02, 0.04, 0.06, 0.08, 0.1, 0.13, 0.16, 0.2)
"""So much higher, over its size, a block is let go where it overlaps others."""

STEP, TOUCHING, OVERLAP = 0.01, 0.003, 0.05
"""Over the size: first steps of settling, the gap up to which a contact holds, and how deep a
block may overlap where it is let go.  What is built with errors touches at few points."""

STEPS = 60
"""Most steps; what rests took 10 to 30, what overlaps goes on in vain."""


def put_down(
    built: Built, around: Polygons, mu: float, settle: SettleSettings
) -> tuple[Built | None, dict[int, float]]:
    """Return where a block comes to rest, and by how much which others are pushed along x.

    None, and the others stay, where it rests nowhere near.
    """
    size, corners = built.size, turn(built.outline, built.angle_deg)
    edges = polygon_edges(corners)
    pressed: dict[float, tuple[Built, Polygons, dict[int, float]]] = {}  # by lift
    for sticks in (True, False):
        steps, least = 0, 0.0
        for lift in LIFTS:
            if lift < least:
                continue
            if lift not in pressed:
                raised = replace(built, y=built.y + lift * size)
                pressed[lift] = _squeezed_in(raised, around, 2.0 * settle.clearance_px)
            held, others, pushed = pressed[lift]
            at = held.x, held.y
            found = let_go(corners, edges, at, size, others, mu, settle, sticks=sticks)
            steps += found.steps
            if found.status is Status.RESTS:
                x, y = on_grid(np.array([found.x, found.y])).tolist()
                angle_deg = wrap_deg(built.angle_deg + math.degrees(found.angle))
                return Built(built.outline, x, y, angle_deg, size), pushed
            if not found.steps:
                # A lift takes off no more than itself; that it gives other room aside is rare.
                least = lift - found.gap / size - OVERLAP
        if not steps:
            break  # it overlaps wherever it is let go
    return None, {}


def touching(size: float, settle: SettleSettings) -> float:
    """Return the gap up to which a block of a size touches what is near."""
    return max(TOUCHING * size, 2.0 * settle.clearance_px)


def let_go(
    corners: Points,
    edges: Points,
    at: tuple[float, float],
    size: float,
    around: Polygons,
    mu: float,
    settle: SettleSettings,
    *,
    sticks: bool,
) -> Settling:
    """Let a block go of which the corners are given from the point where gravity acts."""
    rules = SettlingRules(
        lean=0.0,
        stop=0.0,
        mu=mu,
        clearance=settle.clearance_px,
        tolerance=touching(size, settle),
        corner=CORNER * settle.clearance_px,
        near=STEP * size,
        far=2.0 * STEP * size,
        turn=math.radians(FALLEN_DEG),
        shift=FALLEN_SHARE * size,
        gain=GAIN * size,
        overlap=OVERLAP * size,
        steep=-1.0,  # what is pressed in is held by upright faces too
        beyond=math.inf,  # the ends of a wall are lines on the ground
        sticks=sticks,
        turns=True,
        steps=STEPS,
    )
    return settling.settle(corners, edges, (*at, 0.0), around, 0.0, rules)


def moved(around: Polygons, pushed: dict[int, float]) -> Polygons:
    """Return polygons of which some are moved along x."""
    if not pushed:
        return around
    corners, boxes = around.corners.copy(), around.boxes.copy()
    for i, x in pushed.items():
        corners[around.first[i] : around.first[i + 1], 0] += x
        boxes[i, ::2] += x
    return Polygons(corners, around.first, boxes, around.edges)


def _squeezed_in(
    built: Built, around: Polygons, gap: float
) -> tuple[Built, Polygons, dict[int, float]]:
    """Move a block aside to where it has room between its neighbours, or push these apart.

    What did overlap keeps a gap.  Returned are the block, all others, and who was pushed how far.
    """
    corners = built.corners
    bottom, top = corners[:, 1].min(), corners[:, 1].max()

    def neighbours(corners: Points, sign: float) -> list[tuple[int, float]]:
        """List who overlaps it on one side, and by how much; the gap is part of it."""
        boxes = around.boxes
        found = asides(corners, around, gap, sign)
        return [(i, way) for i, way in found if boxes[i, 1] < top and boxes[i, 3] > bottom]

    def aside(shift: float) -> Points:
        return np.asarray(corners + np.array((shift, 0.0)))

    def most(shift: float, sign: float) -> float:
        ways = neighbours(aside(shift), sign)
        return max((way for _, way in ways), default=0.0)

    left, right = most(0.0, -1.0), most(0.0, 1.0)
    shift = 0.5 * (left - right)
    if bool(left) != bool(right):
        # All the way where there is room, else half of what is missing.
        sign = math.copysign(1.0, shift)
        shift = 2.0 * shift - 0.5 * sign * most(2.0 * shift, sign)
    pushed: dict[int, float] = {}
    if not left + right or abs(shift) > ASIDE * built.size:
        return built, around, pushed
    for sign in (-1.0, 1.0):
        todo = [aside(shift)]
        while todo:
            for i, over in neighbours(todo.pop(), sign):
                if over < ASIDE * built.size:
                    around = moved(around, {i: sign * over})
                    pushed[i] = pushed.get(i, 0.0) + sign * over
                    todo.append(around.polygon(i))
    return replace(built, x=built.x + shift), around, pushed


def fallen_share(x: float, y: float, turn_deg: float, size: float) -> float:
    """Return how near a block is to having fallen, from its way from the plan; from 1 on it has."""
    return max(math.hypot(x, y) / size / FALLEN_SHARE, abs(wrap_deg(turn_deg)) / FALLEN_DEG)


def astray(one: Built, other: Built) -> bool:
    """Say whether a block has fallen from one place to the other."""
    way = one.x - other.x, one.y - other.y, one.angle_deg - other.angle_deg
    return fallen_share(*way, one.size) > 1.0
