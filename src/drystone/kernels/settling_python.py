"""Settling a polygon without compiled code: twin of :func:`drystone.kernels.settling.settle`."""

import math
from typing import NamedTuple

import numpy as np

from drystone.kernels.crossings import crosses_any_python
from drystone.kernels.firmness import Friction, arm_of, firmness_python
from drystone.kernels.gaps import END, Gap, gaps_python
from drystone.kernels.polygons import Points, Polygons
from drystone.kernels.seidel import Row, Solution, solve_python
from drystone.kernels.settling_types import Rules, Settling, Status

FARTHEST = 1e300
SPREAD = 2.5
"""Gaps up to so many radii are constraints of a step; it moves no corner further."""

SMALLEST = 1e-6
"""Settling ends when the radius has shrunk to this share of the first one."""

UPWARD = 0.3
"""A contact with a normal steeper than this supports."""

Pose = tuple[float, float, float]


class State(NamedTuple):
    """A pose, and what is around the stone there."""

    pose: Pose
    corners: Points
    gaps: list[Gap]
    least: float


class Scene(NamedTuple):
    """What is let go, and among what."""

    outline: Points
    edges: Points
    arm: float
    around: Polygons
    width: float
    rules: Rules

    def look(self, pose: Pose) -> State:
        """Turn and move the outline to a pose, and find the gaps there."""
        c, s = math.cos(pose[2]), math.sin(pose[2])
        x, y = self.outline.T
        corners = np.column_stack([c * x - s * y + pose[0], s * x + c * y + pose[1]])
        x, y, length = self.edges.T
        edges = np.column_stack([c * x - s * y, s * x + c * y, length])
        corner = self.rules.corner
        reach = SPREAD * self.rules.far + corner
        gaps = gaps_python(
            corners, edges, self.around, self.width, reach, corner, self.rules.beyond
        )
        return State(pose, corners, gaps, min((gap.gap for gap in gaps), default=FARTHEST))

    def margin(self, state: State) -> float:
        """Return how firmly the stone rests."""
        x, y, _ = state.pose
        rules = self.rules
        friction = Friction(rules.mu, rules.tolerance, rules.corner, rules.steep)
        return firmness_python(state.gaps, (x, y), self.arm, friction)

    def moved(self, pose: Pose, move: Solution) -> Pose:
        """Move a pose; a turn is given as the way of the furthest corner."""
        return pose[0] + move[0], pose[1] + move[1], pose[2] + move[2] / self.arm

    def gain(self, move: Solution) -> float:
        """Return by how much a move goes down."""
        return -self.rules.lean * move[0] - move[1]

    def crosses(self, state: State) -> bool:
        """Say whether the stone lies over others."""
        return crosses_any_python(state.corners, self.around)


def settle_python(
    outline: Points, edges: Points, pose: Pose, around: Polygons, width: float, rules: Rules
) -> Settling:
    """Twin of :func:`drystone.kernels.settling.settle`."""
    scene = Scene(outline, edges, arm_of(outline, 0.0, 0.0), around, width, rules)
    here = scene.look((float(pose[0]), float(pose[1]), float(pose[2])))
    if here.least < -rules.overlap or not math.isfinite(scene.arm + sum(here.pose)):
        return Settling(Status.OVERLAPS, *here.pose, here.least, -1.0, 0, 0)
    status, here, steps = _descend(scene, here)
    margin, touching = -1.0, 0
    if status != Status.FAR:
        if not here.least >= 0.5 * rules.clearance or scene.crosses(here):
            status = Status.OVERLAPS
        else:
            margin = scene.margin(here)
            touching = sum(g.away <= rules.tolerance and g.other != END for g in here.gaps)
            status = Status.RESTS if margin >= 0.0 else status
    return Settling(status, *here.pose, here.least, margin, steps, touching)


def _descend(scene: Scene, here: State) -> tuple[Status, State, int]:
    """Go down step by step until nothing is gained; say why it stopped."""
    rules, start, radius, step = scene.rules, here.pose, scene.rules.near, 0
    half = 0.5 * rules.clearance
    while step < rules.steps:
        if rules.stop >= 0.0 and here.least >= half and scene.margin(here) >= rules.stop:
            return Status.RESTS, here, step
        step += 1
        move = best_move(scene, here, radius)
        if move is not None and here.least >= half and not scene.gain(move) > rules.gain:
            return Status.FALLS, here, step
        there = None if move is None else _tried(scene, here, move, radius)
        if move is None or there is None:
            radius *= 0.5
            if radius < SMALLEST * rules.near:
                return Status.FALLS, here, step
            continue
        here = there
        if _is_far(here.pose, start, rules):
            return Status.FAR, here, step
        if max(map(abs, move)) > 0.9 * radius:
            radius = min(rules.far, 1.6 * radius)
    return Status.UNFINISHED, here, step


def _is_far(pose: Pose, start: Pose, rules: Rules) -> bool:
    """Say whether the stone went further than it may."""
    return abs(pose[2] - start[2]) > rules.turn or abs(pose[0] - start[0]) > rules.shift


def _tried(scene: Scene, here: State, move: Solution, radius: float) -> State | None:
    """Make a move; None when it leads nowhere."""
    half = 0.5 * scene.rules.clearance
    there = scene.look(scene.moved(here.pose, move))
    if here.least < half:
        # It was let go in an overlap: whatever brings it apart is welcome.
        return there if there.least >= half or there.least > here.least else None
    if there.least < half:
        # Turns are not straight: what came too near is brought apart, at the least cost.
        small = 4.0 * (scene.rules.clearance - there.least)
        back = best_move(scene, there, small) if small <= radius else None
        if back is None:
            return None
        there = scene.look(scene.moved(there.pose, back))
        gained = scene.gain(move) - scene.rules.lean * back[0] - back[1]
        if not (there.least >= half and gained > scene.rules.gain):
            return None
    return None if scene.crosses(there) else there


def best_move(scene: Scene, state: State, radius: float) -> Solution | None:
    """Find the move within a radius that goes down most while all gaps, linearised, stay open.

    The turn is given as the way of the furthest corner.
    """
    rules = scene.rules
    reach = SPREAD * radius + rules.clearance
    near = [gap for gap in state.gaps if not gap.gap > reach]
    ways = [_way(gap, state.pose, scene.arm) for gap in near]
    sticking = _sticking(scene, near, state.pose) if rules.sticks else []
    gain = -rules.lean, -1.0, 0.0
    most = radius, radius, radius if rules.turns else 0.0
    for attempt in (0, 1):
        rows = []
        for gap, way in zip(near, ways, strict=True):
            room = gap.gap - rules.clearance
            if room < 0.0:
                # First it is brought apart, by half a radius at most; then at least not nearer.
                room -= min(0.0, room + 0.5 * radius) if attempt == 0 else room
            rows.append((*way, room))
        move = solve_python(rows + sticking, gain, most)
        if move is not None:
            return move
    return None


def _way(gap: Gap, pose: Pose, arm: float) -> Solution:
    """Return by how much each part of a move closes a gap."""
    return -gap.normal_x, -gap.normal_y, -_cross(gap, pose, gap.normal_x, gap.normal_y) / arm


def _cross(gap: Gap, pose: Pose, nx: float, ny: float) -> float:
    """Return how fast a turn about a pose moves the point of a gap along a direction."""
    return (gap.x - pose[0]) * ny - (gap.y - pose[1]) * nx


def _sticking(scene: Scene, gaps: list[Gap], pose: Pose) -> list[Row]:
    """Return rows that keep the supporting point nearest to the centroid from sliding."""
    clearance = scene.rules.clearance
    pivots = [
        gap
        for gap in gaps
        if gap.away <= scene.rules.tolerance and gap.other != END and gap.normal_y > UPWARD
    ]
    if not pivots:
        return []
    pivot = min(pivots, key=lambda gap: abs(gap.x - pose[0]))
    nx, ny = pivot.normal_y, -pivot.normal_x
    turning = _cross(pivot, pose, nx, ny) / scene.arm
    return [(nx, ny, turning, 0.2 * clearance), (-nx, -ny, -turning, 0.2 * clearance)]
