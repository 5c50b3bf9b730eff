"""Letting a stone go above others until it rests (§3.7 without pixels; DESIGN 4.9)."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from drystone.kernels.polygons import (
    Points,
    Polygons,
    mirrored_polygon,
    place_on_grid,
    polygon_edges,
    turn,
)
from drystone.kernels.raster import wrap_deg
from drystone.kernels.settling import Settling, SettlingRules, Status, settle
from drystone.model.placement import Settled, Side
from drystone.settle.settings import SettleSettings

NEAR, FAR = 0.04, 0.08
"""First and largest radius of a step, over the size of the stone."""

CORNER = 30.0
"""Corners nearer than this meet with a face, in clearances."""

GAIN = 4e-6
"""Settling ends where a step would go down by less, over the size of the stone."""

OVERLAP_PX = 0.5
"""So deep, source px, a stone may overlap where it is let go; it is brought apart first."""

CLEAR_PX = 1.0
"""A stone that is no farther from the end of the wall, source px, has no neighbour there."""

Start = tuple[float, float]
"""Where the centroid of a stone is let go, in the view."""

LIFT, LEVEL, OPEN = 0.02, 0.06, 0.3
"""To open a joint a stone is let go so much higher, over its size; it may rest higher than before
by so much at most, and so much of the joint stays open at least."""


@dataclass(frozen=True, eq=False)
class SettlingScene:
    """What a stone meets, seen so that the building side is on the left."""

    polygons: Polygons  # outlines of stones and wedges in the view, source px
    width_px: float  # of the wall, source px; its ends block but carry nothing
    side: Side  # which end of the wall is on the left of the view
    mu: float

    @classmethod
    def of(cls, polygons: Polygons, width_px: float, side: Side, mu: float) -> "SettlingScene":
        """Return the scene of outlines in the wall frame."""
        seen = polygons if side == "left" else polygons.mirrored(width_px)
        return cls(seen, width_px, side, mu)


@dataclass(frozen=True, eq=False)
class Turned:
    """The outline of a stone in a pose, as a scene sees it; the pose itself is the stone's."""

    outline: Points  # (n, 2): of the stone, not turned, relative to its centroid, source px
    angle_deg: float  # by which it is turned in the wall frame
    side: Side
    corners: Points  # (n, 2): turned, and mirrored where the scene is
    edges: Points  # (n, 3): of the corners
    size_px: float  # root of the stone's area

    @classmethod
    def of(cls, outline: Points, angle_deg: float, side: Side, size_px: float) -> "Turned":
        """Turn an outline."""
        corners = turn(outline, angle_deg)
        if side == "right":
            corners = mirrored_polygon(corners, 0.0)
        return cls(outline, angle_deg, side, corners, polygon_edges(corners), size_px)


@dataclass(frozen=True, eq=False)
class Repose:
    """Where a stone came to rest."""

    settled: Settled  # where, in the wall frame
    angle_deg: float  # turned by so much from the source image
    turned: bool  # whether it turned while it settled
    # how far gravity may lean until it moves, over mu; below the least margin of the settings
    # it does not rest
    margin: float


def come_to_rest(
    stone: Turned,
    scene: SettlingScene,
    start: Start,
    settings: SettleSettings,
    *,
    turns: bool = True,
) -> Repose | None:
    """Let a stone go; None where it does not rest."""
    for found in rests(stone, scene, start, settings, turns=turns):
        return repose(stone, scene, found)
    return None


def rests(
    stone: Turned, scene: SettlingScene, start: Start, settings: SettleSettings, *, turns: bool
) -> Iterator[Settling]:
    """List where a stone rests that is let go in all ways (:func:`ways`), in their order.

    It keeps a joint to its neighbour where it also rests so.
    """
    aside = settings.joint_px
    for found in _touching(stone, scene, start, settings, turns=turns):
        rest = found
        if aside and found.x + stone.corners[:, 0].min() > CLEAR_PX:
            beside = found.x + aside, found.y + LIFT * stone.size_px
            # It may slide back, but then it is held where it is put.
            for rules in ways(stone, scene, settings, turns=turns)[1:]:
                apart = let_go(stone, scene, beside, rules)
                level = apart.y - found.y <= LEVEL * stone.size_px
                if _rests(apart, settings) and level and apart.x - found.x >= OPEN * aside:
                    rest = apart
                    break
        yield rest


def _touching(
    stone: Turned, scene: SettlingScene, start: Start, settings: SettleSettings, *, turns: bool
) -> Iterator[Settling]:
    *earlier, last = ways(stone, scene, settings, turns=turns)
    stopped = None
    for rules in earlier:
        if stopped is None and rules._replace(stop=last.stop) == last:
            # Where the last way, which stops where the stone rests, never stops, the same way
            # without stops ends in the same place, and does not rest either.
            stopped = let_go(stone, scene, start, last)
            if stopped.status != Status.OVERLAPS and not _rests(stopped, settings):
                return
        found = let_go(stone, scene, start, rules)
        if _rests(found, settings):
            yield found
    stopped = stopped or let_go(stone, scene, start, last)
    if _rests(stopped, settings):
        yield stopped


def _rests(found: Settling, settings: SettleSettings) -> bool:
    return found.status == Status.RESTS and found.margin >= settings.margin


def touch_down(
    stone: Turned, scene: SettlingScene, start: Start, settings: SettleSettings
) -> Repose | None:
    """Lower a stone without turning it until nothing is gained; None when it slides away.

    Whether it rests there, its margin says.
    """
    rules = ways(stone, scene, settings, turns=False)[-1]._replace(stop=-1.0)
    found = let_go(stone, scene, start, rules)
    if found.status not in (Status.RESTS, Status.FALLS):
        return None
    return repose(stone, scene, found)


def lay(
    stone: Turned, scene: SettlingScene, start: Start, settings: SettleSettings
) -> Repose | None:
    """Lay a stone where it is planned, and move it no further than until it rests.

    What it overlaps a little there it is brought apart from.  None when it does not rest nearby.
    """
    rules = ways(stone, scene, replace(settings, method="energy"))[-1]._replace(stop=0.0)
    found = let_go(stone, scene, start, rules)
    return repose(stone, scene, found) if found.status == Status.RESTS else None


def let_go(stone: Turned, scene: SettlingScene, start: Start, rules: SettlingRules) -> Settling:
    """Settle a stone in one way; one that may not turn has not turned, not even by rounding."""
    found = settle(stone.corners, stone.edges, (*start, 0.0), scene.polygons, scene.width_px, rules)
    return found if rules.turns else found._replace(angle=0.0)


def ways(
    stone: Turned, scene: SettlingScene, settings: SettleSettings, *, turns: bool = True
) -> tuple[SettlingRules, ...]:
    """Return the ways of settling that are tried; in the last nothing pushes to a side."""
    size = stone.size_px
    plain = SettlingRules(
        lean=settings.lean,
        stop=-1.0,
        mu=scene.mu,
        clearance=settings.clearance_px,
        # What carries a stone must do so at half the contact tolerance as well.
        tolerance=0.5 * settings.contact_px,
        corner=CORNER * settings.clearance_px,
        near=NEAR * size,
        far=FAR * size,
        turn=math.radians(settings.max_turn_deg),
        shift=settings.max_shift * size,
        gain=GAIN * size,
        overlap=OVERLAP_PX,
        steep=settings.steep,
        beyond=settings.beyond_px,
        sticks=False,
        turns=turns,
        steps=settings.max_steps,
    )
    if settings.method == "pivot":
        return (plain._replace(lean=0.0, stop=settings.margin, sticks=True),)
    # What slides away when it is pushed may rest where it is let go.
    return plain, plain._replace(lean=0.0), plain._replace(lean=0.0, stop=settings.margin)


def repose(stone: Turned, scene: SettlingScene, found: Settling) -> Repose:
    """Return where a settling ended, in the wall frame."""
    sign = 1.0 if scene.side == "left" else -1.0
    x = found.x if scene.side == "left" else scene.width_px - found.x
    angle_deg = wrap_deg(stone.angle_deg + sign * math.degrees(found.angle))
    x, y = place_on_grid(x, found.y)
    settled = settled_at(stone.outline, angle_deg, x, y)
    return Repose(settled, angle_deg, found.angle != 0.0, found.margin)


def settled_at(outline: Points, angle_deg: float, x_px: float, y_px: float) -> Settled:
    """Turn an outline by an angle, and put its centroid at a place of the wall frame."""
    return Settled(x_px, y_px, turn(outline, angle_deg) + np.array((x_px, y_px)))
