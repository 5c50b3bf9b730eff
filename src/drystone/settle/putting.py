"""How far a block that is not quite as planned is lifted, moved and let fall (DESIGN 4.10).

:mod:`drystone.kernels.putting` says how it is put down.
"""

import math
from functools import lru_cache

from drystone.kernels.as_built import Built, BuiltWall, WayDown
from drystone.kernels.raster import wrap_deg
from drystone.kernels.settling import SettlingRules
from drystone.settle.rest import CORNER, GAIN
from drystone.settle.settings import SettleSettings

FALLEN_SHARE, FALLEN_DEG = 0.25, 12.0
"""A stone has fallen when it ends farther from the plan, over its size, or turned by more."""

ASIDE = 0.3
"""So far, over its size, a block is moved aside or pushed at most."""

LIFTS = (0.0, 0.01, 0.02, 0.04, 0.06, 0.08, 0.1, 0.13, 0.16, 0.2)
"""So much higher, over its size, a block is let go where it overlaps others."""

LAST_LIFTS = (*LIFTS, 0.25, 0.3)
"""The same for what rests with none of these, and may go twice as far, or end less high."""

STEP, TOUCHING, OVERLAP = 0.01, 0.003, 0.05
"""Over the size: first steps of settling, the gap up to which a contact holds, and how deep a
block may overlap where it is let go.  What is built with errors touches at few points."""

STEPS = 60
"""Most steps; what rests took 10 to 30, what overlaps goes on in vain."""


def bare_wall(mu: float, settle: SettleSettings) -> BuiltWall:
    """Return a wall of which nothing is built."""

    @lru_cache(maxsize=4096)
    def how(size: float) -> WayDown:
        lifts, last = ([lift * size for lift in some] for some in (LIFTS, LAST_LIFTS))
        rules = settling_rules(size, mu, settle)
        return WayDown(rules, lifts, last, ASIDE * size, 2.0 * settle.clearance_px)

    return BuiltWall(mu, how)


def settling_rules(size: float, mu: float, settle: SettleSettings) -> SettlingRules:
    """Return how a block of a size settles, on what it sticks to."""
    return SettlingRules(
        lean=0.0,
        stop=0.0,
        mu=mu,
        clearance=settle.clearance_px,
        tolerance=max(TOUCHING * size, 2.0 * settle.clearance_px),
        corner=CORNER * settle.clearance_px,
        near=STEP * size,
        far=2.0 * STEP * size,
        turn=math.radians(FALLEN_DEG),
        shift=FALLEN_SHARE * size,
        gain=GAIN * size,
        overlap=OVERLAP * size,
        steep=-1.0,  # what is pressed in is held by upright faces too, unless a bed is near
        beyond=math.inf,  # the ends of a wall are lines on the ground
        sticks=True,
        turns=True,
        steps=STEPS,
    )


def fallen_share(x: float, y: float, turn_deg: float, size: float) -> float:
    """Return how near a block is to having fallen, from its way from the plan; from 1 on it has."""
    return max(math.hypot(x, y) / size / FALLEN_SHARE, abs(wrap_deg(turn_deg)) / FALLEN_DEG)


def astray(one: Built, other: Built) -> bool:
    """Say whether a block has fallen from one place to the other."""
    way = one.x - other.x, one.y - other.y, one.angle_deg - other.angle_deg
    return fallen_share(*way, one.size) > 1.0


def lost(before: BuiltWall, after: BuiltWall) -> list[int]:
    """List the blocks of a wall that have fallen since."""
    return [i for i, was, now in after.changed(before) if now is None or astray(now, was)]
