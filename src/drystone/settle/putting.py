"""Putting a block down where it is not quite as planned, and letting it go (DESIGN 4.10).

It is pressed in between its neighbours: moved aside where there is room, else these are pushed
apart along their beds.  Then it goes down as friction lets it: it rolls about what carries it, and
slides only where it does not come to rest so.
"""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from drystone.kernels.gaps import crosses_any
from drystone.kernels.polygons import Points, Polygons
from drystone.kernels.profiles import extremes
from drystone.kernels.settling import SettlingRules, Status
from drystone.model.builder import Built
from drystone.poses import wrap_deg
from drystone.settle.rest import SettlingScene, Turned, let_go, repose, straight_down
from drystone.settle.settings import SettleSettings

FALLEN_SHARE, FALLEN_DEG = 0.25, 12.0
"""A stone has fallen when it ends farther from the plan, over its size, or turned by more."""

ASIDE = 0.3
"""So far, over its size, a block is moved aside or pushed at most."""

BESIDE = 0.3
"""Two blocks lie beside each other when they share so much of the height of the lower one."""

LINES = 32
"""Along so many lines it is looked how far two blocks overlap."""

LIFTS = (0.0, 0.01, 0.02, 0.04, 0.06, 0.08, 0.1, 0.13, 0.16, 0.2)
"""So much higher, over its size, a block is let go where it overlaps others."""

STEP, TOUCHING, OVERLAP = 0.01, 0.003, 0.02
"""Over the size: first steps of settling, the gap up to which a contact holds, and how deep a
block may overlap where it is let go.  What is built with errors touches at few points."""

STEPS = 300
"""Most steps."""


def put_down(
    built: Built, around: Polygons, mu: float, settle: SettleSettings
) -> tuple[Built | None, dict[int, float]]:
    """Return where a block comes to rest, and by how much which others are pushed along x.

    None, and the others stay, where it rests nowhere near.
    """
    pushed: dict[int, float] = {}
    if crosses_any(built.corners, around):
        built, pushed = _squeezed_in(built, around, 2.0 * settle.clearance_px)
        around = moved(around, pushed)
    turned = Turned.of(built.outline, built.angle_deg, "left", built.size)
    scene = SettlingScene(around, 0.0, "left", mu)
    for sticks in (True, False):
        rules = _rules(turned, scene, settle)._replace(sticks=sticks)
        steps = 0
        for lift in LIFTS:
            found = let_go(turned, scene, (built.x, built.y + lift * built.size), rules)
            steps += found.steps
            if found.status is Status.RESTS:
                rest = repose(turned, scene, found)
                at = rest.settled
                return replace(built, x=at.x_px, y=at.y_px, angle_deg=rest.angle_deg), pushed
        if not steps:
            break  # it overlaps wherever it is let go
    return None, {}


def _rules(turned: Turned, scene: SettlingScene, settle: SettleSettings) -> SettlingRules:
    size = turned.size_px
    return straight_down(turned, scene, settle)._replace(
        stop=0.0,
        near=STEP * size,
        far=2.0 * STEP * size,
        tolerance=max(TOUCHING * size, 2.0 * settle.clearance_px),
        overlap=OVERLAP * size,
        steep=-1.0,  # what is pressed in is held by upright faces too
        beyond=math.inf,  # the ends of a wall are lines on the ground
        shift=FALLEN_SHARE * size,
        turn=math.radians(FALLEN_DEG),
        steps=STEPS,
    )


def moved(around: Polygons, pushed: dict[int, float]) -> Polygons:
    """Return polygons of which some are moved along x."""
    if not pushed:
        return around
    corners, boxes = around.corners.copy(), around.boxes.copy()
    for i, x in pushed.items():
        corners[around.first[i] : around.first[i + 1], 0] += x
        boxes[i, ::2] += x
    return Polygons(corners, around.first, boxes, around.edges)


class _Block(NamedTuple):
    """A polygon and its box: left, bottom, right, top."""

    corners: Points
    box: tuple[float, float, float, float]

    def shifted(self, x: float) -> "_Block":
        """Return it moved along x."""
        left, bottom, right, top = self.box
        return _Block(self.corners + np.array((x, 0.0)), (left + x, bottom, right + x, top))


def _squeezed_in(built: Built, around: Polygons, gap: float) -> tuple[Built, dict[int, float]]:
    """Move a block aside to where it has room between its neighbours, or push these apart.

    What did overlap keeps a gap.
    """
    (left, bottom), (right, top) = built.corners.min(axis=0), built.corners.max(axis=0)
    block = _Block(built.corners, (float(left), float(bottom), float(right), float(top)))
    others = {
        i: _Block(around.polygon(i), (x0, y0, x1, y1))
        for i, (x0, y0, x1, y1) in enumerate(around.boxes.tolist())
        if y0 < top and y1 > bottom
    }
    left, right = (_most_into(block, others, gap, sign) for sign in (-1.0, 1.0))
    shift = 0.5 * (left - right)
    if bool(left) != bool(right):
        # All the way where there is room, else half of what is missing.
        sign = math.copysign(1.0, shift)
        missing = _most_into(block.shifted(2.0 * shift), others, gap, sign)
        shift = 2.0 * shift - 0.5 * sign * missing
    if not left + right or abs(shift) > ASIDE * built.size:
        return built, {}
    pushed: dict[int, float] = {}
    for sign in (-1.0, 1.0):
        todo = [block.shifted(shift)]
        while todo:
            by = todo.pop()
            for i, other in others.items():
                over = _into(by, other, gap, sign)
                if 0.0 < over < ASIDE * built.size:
                    others[i] = other.shifted(sign * over)
                    pushed[i] = pushed.get(i, 0.0) + sign * over
                    todo.append(others[i])
    return replace(built, x=built.x + shift), pushed


def _most_into(block: _Block, others: dict[int, _Block], gap: float, sign: float) -> float:
    return max((_into(block, other, gap, sign) for other in others.values()), default=0.0)


def _into(one: _Block, other: _Block, gap: float, sign: float) -> float:
    """Return how far along x another block beside this one must go, to a side, to clear it.

    0 where it does not overlap, or where less is needed upwards: then one lies on the other.
    """
    (x0, y0, x1, y1), (u0, v0, u1, v1) = one.box, other.box
    if u0 >= x1 or x0 >= u1 or sign * (u0 + u1 - x0 - x1) <= 0.0:
        return 0.0
    low, high = max(y0, v0), min(y1, v1)
    if high - low < BESIDE * min(y1 - y0, v1 - v0):
        return 0.0
    alone = np.array([0, len(other.corners)], np.int32), np.array([other.box])
    if not crosses_any(one.corners, Polygons(other.corners, *alone, other.corners)):
        return 0.0
    across = _depth(one.corners[:, ::-1], other.corners[:, ::-1], low, high, sign)
    above = math.copysign(1.0, v0 + v1 - y0 - y1)
    up = _depth(one.corners, other.corners, max(x0, u0), min(x1, u1), above)
    return across + gap if across < up else 0.0


def _depth(one: Points, other: Points, low: float, high: float, sign: float) -> float:
    """Return how far up (sign 1) or down another polygon must go to clear one, between two x."""
    cell = (high - low) / LINES
    bottom, top = extremes(one, low, cell, LINES)
    other_bottom, other_top = extremes(other, low, cell, LINES)
    return float((top - other_bottom if sign > 0 else other_top - bottom).max())


def fallen_share(x: float, y: float, turn_deg: float, size: float) -> float:
    """Return how near a block is to having fallen, from its way from the plan; from 1 on it has."""
    return max(math.hypot(x, y) / size / FALLEN_SHARE, abs(wrap_deg(turn_deg)) / FALLEN_DEG)
