"""The load multiplier over the coefficient of friction, which nobody knows exactly."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads
from drystone.statics.model import RigidBlockModel

USUAL = (0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8)
"""From smooth and wet to rough and dry stone."""


@dataclass(frozen=True)
class AtFriction:
    """What a wall carries at one coefficient of friction."""

    mu: float  # of the interfaces that have none of their own
    alpha_left: float | None
    """Load multipliers; None unless there is an optimum, as for a wall that does not stand."""
    alpha_right: float | None


def friction_curve(
    model: RigidBlockModel, loads: Loads | None = None, mus: Sequence[float] = USUAL
) -> tuple[AtFriction, ...]:
    """Analyse a wall at several coefficients of friction; interfaces with their own keep it."""
    found = []
    for mu in mus:
        both = lateral_resistance(replace(model, mu=mu), loads)
        found.append(AtFriction(mu, both.left.alpha, both.right.alpha))
    return tuple(found)
