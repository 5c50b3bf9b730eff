"""How far a block that is not quite as planned is lifted, moved and let fall (DESIGN 4.10).

:mod:`drystone.kernels.putting` says how it is put down.
"""

import math

from drystone.kernels import putting
from drystone.kernels.polygons import Polygons, place_on_grid, polygon_edges
from drystone.kernels.raster import turn
from drystone.kernels.settling import SettlingRules
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
) -> tuple[Built | None, dict[int, float] | None]:
    """Return where a block comes to rest, and by how much which others are pushed along x.

    None, and the others stay, where it rests nowhere near; nor are there pushes without room.
    """
    size, corners = built.size, turn(built.outline, built.angle_deg)
    found, pushed = putting.put_down(
        corners,
        polygon_edges(corners),
        (built.x, built.y),
        around,
        settling_rules(size, mu, settle),
        lifts=[lift * size for lift in LIFTS],
        most=ASIDE * size,
        gap=2.0 * settle.clearance_px,
    )
    if found is None:
        return None, pushed
    x, y = place_on_grid(found.x, found.y)
    angle_deg = wrap_deg(built.angle_deg + math.degrees(found.angle))
    return Built(built.outline, x, y, angle_deg, size), pushed


def touching(size: float, settle: SettleSettings) -> float:
    """Return the gap up to which a block of a size touches what is near."""
    return max(TOUCHING * size, 2.0 * settle.clearance_px)


def settling_rules(size: float, mu: float, settle: SettleSettings) -> SettlingRules:
    """Return how a block of a size settles, on what it sticks to."""
    return SettlingRules(
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
        sticks=True,
        turns=True,
        steps=STEPS,
    )


def moved(around: Polygons, pushed: dict[int, float]) -> Polygons:
    """Return polygons of which some are moved along x."""
    corners, boxes = around.corners.copy(), around.boxes.copy()
    for i, x in pushed.items():
        corners[around.first[i] : around.first[i + 1], 0] += x
        boxes[i, ::2] += x
    return Polygons(corners, around.first, boxes, around.edges)


def fallen_share(x: float, y: float, turn_deg: float, size: float) -> float:
    """Return how near a block is to having fallen, from its way from the plan; from 1 on it has."""
    return max(math.hypot(x, y) / size / FALLEN_SHARE, abs(wrap_deg(turn_deg)) / FALLEN_DEG)


def astray(one: Built, other: Built) -> bool:
    """Say whether a block has fallen from one place to the other."""
    way = one.x - other.x, one.y - other.y, one.angle_deg - other.angle_deg
    return fallen_share(*way, one.size) > 1.0
