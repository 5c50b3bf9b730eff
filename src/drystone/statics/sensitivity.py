"""How the load multiplier changes with friction, which nobody knows exactly."""

from dataclasses import dataclass, replace

import numpy as np

from drystone.statics.failing.mechanism import kinematics
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads, tilting_table
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitResult

USUAL = (0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8)
"""From smooth and wet to rough and dry stone."""


def friction_sensitivity(
    model: RigidBlockModel, result: LimitResult, loads: Loads | None = None
) -> float:
    """Find d alpha / d mu of an associative load multiplier, without another analysis.

    It is by the model's coefficient, that of all interfaces that have none of their own.  The
    result is "optimal", with mechanism and forces, of the same loads, or else it is a ValueError.
    Never below 0 but by rounding; 0 for pure rocking, 1 for all blocks sliding on the ground.

    Friction enters the program only in the edges of the cones, normal +- mu tangent.  By the
    envelope theorem the optimum changes by the work of the duals (the velocities of the blocks) on
    the change of these columns, weighed by the forces along them.  A contact point that slips at
    u_t carries a force along one edge only, so its share is n |u_t|, and d alpha / d mu = sum n
    |u_t| / power of the live load: the power lost in sliding, for a coefficient of friction of 1,
    over that of a unit load.

    Where the optimum is degenerate, the derivative is one-sided.  When two mechanisms need the same
    load, as where sliding gives way to rocking, alpha has a kink: the value is that of the
    mechanism of `result`, the derivative to one side (or, for a mechanism that blends two, between
    both).  When several states of forces carry the load, as under several blocks that slide
    together, the shares of single interfaces depend on which one was found.
    """
    if result.mechanism is None or result.forces is None:
        raise ValueError("the sensitivity needs an optimal result with mechanism and forces")
    motion = kinematics(model, result.mechanism)
    lost = result.forces[:, 0] * np.abs(motion.relative[:, 1])
    per_interface = np.bincount(model.contact_interfaces, lost, len(model.interfaces))
    live = (tilting_table(model) if loads is None else loads).live
    free = [not block.fixed for block in model.blocks]
    power = float((live * motion.velocity[:-1])[free].sum())
    common = [interface.mu is None for interface in model.interfaces]
    return float((per_interface / abs(power))[common].sum())


@dataclass(frozen=True)
class AtFriction:
    """What a wall carries at one coefficient of friction."""

    mu: float  # of the interfaces that have none of their own
    alpha_left: float | None
    """Load multipliers; None unless there is an optimum, as for a wall that does not stand."""
    alpha_right: float | None


def friction_curve(model: RigidBlockModel, loads: Loads | None = None) -> tuple[AtFriction, ...]:
    """Analyse a wall at usual coefficients of friction; interfaces with their own keep it."""
    found = []
    for mu in USUAL:
        both = lateral_resistance(replace(model, mu=mu), loads)
        found.append(AtFriction(mu, both.left.alpha, both.right.alpha))
    return tuple(found)
