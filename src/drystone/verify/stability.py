"""Every wall on the way stands, and carries what the plan says (§4; DESIGN 4.8)."""

from collections.abc import Sequence
from dataclasses import dataclass

from drystone.model.plan import StoneStep, WedgeStep
from drystone.model.wall import Labels
from drystone.statics.contacts.blocks import model_from_labels
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance
from drystone.verify.replay import Stage
from drystone.verify.report import PrefixAlpha, Problem

ALPHA_TOLERANCE = 1e-7
"""Between load multipliers claimed and found: two solvers' optima of one program."""


@dataclass(frozen=True, eq=False)
class Standing:
    """What the walls on the way carry.

    Parameters
    ----------
    resistances : tuple of LateralResistance or None
        After each stage; None where the wall hangs in the air.
    model : RigidBlockModel
        Of the last wall.
    problems : tuple of Problem
        E230: it does not stand; E231: another load multiplier is claimed.
    """

    resistances: tuple[LateralResistance | None, ...]
    model: RigidBlockModel
    problems: tuple[Problem, ...]


def check_stability(stages: Sequence[Stage], mu: float) -> Standing:
    """Analyse every prefix of the plan from its image alone.

    Parameters
    ----------
    stages : sequence of Stage
        A stone and its wedges are one stage: only the wall with all of them must stand.
    mu : float
        Coefficient of friction.
    """
    found: list[LateralResistance | None] = []
    problems: list[Problem] = []
    model = RigidBlockModel((), (), mu)
    for stage in stages:
        resistance = None
        if stands_on_ground(stage.after.labels):
            model = model_from_labels(stage.after.labels, mu).model
            resistance = lateral_resistance(model)
        found.append(resistance)
        problems += _judge(stage, resistance)
    return Standing(tuple(found), model, tuple(problems))


def prefix_alphas(
    stages: Sequence[Stage], resistances: Sequence[LateralResistance | None]
) -> tuple[PrefixAlpha, ...]:
    """Return the load multipliers found after every stage."""
    return tuple(
        PrefixAlpha(stage.last.step, *(alphas(resistance)))
        for stage, resistance in zip(stages, resistances, strict=True)
    )


def alphas(resistance: LateralResistance | None) -> tuple[float | None, float | None]:
    """Return both load multipliers; None where there is none."""
    if resistance is None:
        return None, None
    return resistance.left.alpha, resistance.right.alpha


def stands_on_ground(labels: Labels) -> bool:
    """Say whether something stands on the ground: the lower edge of the image."""
    return bool((labels[-1] > 0).any())


def differs(claimed: float | None, found: float | None, tolerance: float) -> bool:
    """Say whether two values are not the same, None being a value of its own."""
    if claimed is None or found is None:
        return claimed is not found
    return not abs(claimed - found) <= tolerance * max(1.0, abs(found))


def _judge(stage: Stage, resistance: LateralResistance | None) -> list[Problem]:
    last: StoneStep | WedgeStep = stage.last
    if resistance is None:
        return [Problem("E230", last.step, "nothing of the wall stands on the ground.")]
    problems = [
        Problem("E230", last.step, f"the wall does not stand: {r.direction} {r.status.value}.")
        for r in (resistance.left, resistance.right)
        if not r.success
    ]
    if problems:
        return problems
    claims = zip(("alpha_left", "alpha_right"), (last.alpha_left, last.alpha_right),
                 alphas(resistance), strict=True)  # fmt: skip
    return [
        Problem("E231", last.step, f"{name} is {claimed} by the plan, {found} was found.")
        for name, claimed, found in claims
        if differs(claimed, found, ALPHA_TOLERANCE)
    ]
