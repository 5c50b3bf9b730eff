"""Check forces and a motion against Coulomb's law without dilatancy, from the blocks themselves."""

from dataclasses import astuple, dataclass

import numpy as np

from drystone.statics.loads import Loads, tilting_table
from drystone.statics.lp.program import Floats
from drystone.statics.model import FREEDOMS, GROUND, Direction, RigidBlockModel
from drystone.statics.result import Mechanism

HOLDS = 1e-7
"""Largest error of a check that holds."""


@dataclass(frozen=True)
class FlowCheck:
    """How far an answer is from all conditions of the non-associative problem."""

    equilibrium: float
    """Largest force or moment on a block that is not balanced, over the mean weight of a block (and
    the root of the mean area)."""
    friction: float  # largest tension, or tangential force above mu n, over the mean weight
    closing: float  # largest rate at which a contact closes, over the largest velocity
    held: float  # largest velocity of what is fixed or held, over the largest velocity
    dilatancy: float
    """Power of the normal forces, the sum of |n u_n|, over the power of the live load: contacts
    open that carry a force, or dilate as they slide."""
    dissipation: float
    """Sum of |t u_t + mu n |u_t||, over the power of the live load: contacts that slide without all
    their friction, or along with it."""

    @property
    def largest(self) -> float:
        """The largest error."""
        return float(max(astuple(self)))

    @property
    def holds(self) -> bool:
        """True when every error is at most `HOLDS`; never for what is no number.

        The last two are errors of alpha.
        """
        return all(error <= HOLDS for error in astuple(self))


def check_flow(
    model: RigidBlockModel,
    loads: Loads | None,
    direction: Direction,
    alpha: float,
    mechanism: Mechanism,
    forces: Floats,
) -> FlowCheck:
    """Check forces and a mechanism at alpha in a direction; at least one block is free.

    The load multiplier is alpha for "right" and -alpha for "left", and the live load must do work
    of that sign.  `forces` is (m, 2): normal and tangential force at every contact point on the
    block that the normal points into; the tangent of a normal (x, y) is (y, -x).
    """
    loads = tilting_table(model) if loads is None else loads
    free = [block for block in model.blocks if not block.fixed]
    weight = float(np.mean([block.weight for block in free]))
    length = float(np.sqrt(np.mean([block.area for block in free])))
    velocity = dict(zip(mechanism.block_ids, mechanism.velocity, strict=True))
    still = np.zeros(3)
    place = {block.id: i for i, block in enumerate(model.blocks)}
    sign = -1.0 if direction == "left" else 1.0
    balance = loads.dead + sign * alpha * loads.live
    closing = friction = dilatancy = dissipation = 0.0
    acting = iter(forces)
    for interface in model.interfaces:
        mu = model.friction(interface)
        normal = np.array(interface.normal)
        tangent = np.array((normal[1], -normal[0]))
        for point in interface.points:
            n, t = next(acting)
            rate = np.zeros(2)
            for block_id, side in ((interface.block, 1.0), (interface.other, -1.0)):
                if block_id == GROUND:
                    continue
                arm_x, arm_y = point - model.blocks[place[block_id]].centroid
                vx, vy, turn = velocity.get(block_id, still)
                rate += side * np.array((vx - turn * arm_y, vy + turn * arm_x))
                fx, fy = side * (n * normal + t * tangent)
                balance[place[block_id]] += (fx, fy, arm_x * fy - arm_y * fx)
            opening, slip = rate @ normal, rate @ tangent
            friction = max(friction, -n, abs(t) - mu * n)
            closing = max(closing, -opening)
            dilatancy += abs(n * opening)
            dissipation += abs(t * slip + mu * n * abs(slip))
    residual = max(
        abs(balance[place[block.id], k]) / (length if freedom == "turn" else 1.0)
        for block in free
        for k, freedom in enumerate(FREEDOMS)
        if freedom not in block.held
    )
    power = sign * sum(loads.live[place[block.id]] @ velocity[block.id] for block in free)
    fastest = float(np.abs(mechanism.velocity * (1.0, 1.0, length)).max())
    return FlowCheck(
        equilibrium=float(residual / weight),
        friction=float(friction / weight),
        closing=float(closing / fastest),
        held=float(_held_velocity(model, velocity, length) / fastest),
        dilatancy=float(dilatancy / power) if power > 0 else np.inf,
        dissipation=float(dissipation / power) if power > 0 else np.inf,
    )


def _held_velocity(model: RigidBlockModel, velocity: dict[int, Floats], length: float) -> float:
    units = (1.0, 1.0, length)
    moving = [
        abs(velocity[block.id][k]) * units[k]
        for block in model.blocks
        if block.id in velocity
        for k, freedom in enumerate(FREEDOMS)
        if block.fixed or freedom in block.held
    ]
    return float(max(moving, default=0.0))
