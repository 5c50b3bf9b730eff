"""Every wall on the way stands, and carries what the plan says (§4; DESIGN 4.8)."""

from collections.abc import Sequence
from dataclasses import dataclass

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.settled import model_of_outlines
from drystone.model.wall import Wall
from drystone.planner.settings import PlannerSettings
from drystone.planner.sturdy import sturdy_model_of
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.result import LateralResistance, LimitStatus
from drystone.verify.replay import Stage
from drystone.verify.report import PrefixAlpha, Problem, contradicted

UNKNOWN = "the solver gave up, and it is not known whether the wall stands"

ALPHA_TOLERANCE = 1e-7
"""Between load multipliers claimed and found: two solvers' optima of one program."""


@dataclass(frozen=True, eq=False)
class Stability:
    """What the walls on the way carry."""

    resistances: tuple[LateralResistance | None, ...]
    """After each stage; None where the wall hangs in the air."""
    models: tuple[RigidBlockModel | None, ...]
    prefixes: tuple[PrefixAlpha, ...]
    problems: tuple[Problem, ...]
    """E230: it does not stand, or the solver gave up; E231: another load multiplier is claimed;
    E237: a wall of outlines stands by friction that it should not need."""


def check_stability(stages: Sequence[Stage], settings: PlannerSettings) -> Stability:
    """Analyse every prefix of the plan; only the wall with all wedges of a stone must stand."""
    models = [wall_model(stage.after, settings) for stage in stages]
    found = [None if model is None else lateral_resistance(model) for model in models]
    problems: list[Problem] = []
    prefixes = []
    for stage, both in zip(stages, found, strict=True):
        alphas = (None, None) if both is None else (both.left.alpha, both.right.alpha)
        prefixes.append(PrefixAlpha(stage.last.step, *alphas))
        problems += _judge(stage, both) or _not_sturdy(stage, settings)
    return Stability(tuple(found), tuple(models), tuple(prefixes), tuple(problems))


def wall_model(wall: Wall, settings: PlannerSettings) -> RigidBlockModel | None:
    """Return the model of a wall on its geometry; None when nothing stands on the ground."""
    if wall.outlines is None:
        if not (wall.labels[-1] > 0).any():
            return None
        return model_from_labels(wall.labels, settings.mu).model
    settle = settings.settle
    model = model_of_outlines(wall.outlines, settings.mu, settle.contact_px, settle.setback)
    grounded = any(interface.other == GROUND for interface in model.interfaces)
    return model if grounded else None


def differs(claimed: float | None, found: float | None, tolerance: float) -> bool:
    """Say whether two values are not the same, None being a value of its own."""
    if claimed is None or found is None:
        return claimed is not found
    return not abs(claimed - found) <= tolerance * max(1.0, abs(found))


def _not_sturdy(stage: Stage, settings: PlannerSettings) -> list[Problem]:
    """Say that a wall of outlines does not stand in its sturdy model (E237)."""
    outlines = stage.after.outlines
    if outlines is None:
        return []
    found = lateral_resistance(sturdy_model_of(outlines, settings.mu, settings.settle))
    if found.stable:
        return []
    if found.failed:
        return [Problem("E230", stage.last.step, f"{UNKNOWN} with less friction and contact.")]
    message = (
        "the wall needs friction of upright faces, or friction or gaps at their limit, to stand."
    )
    return [Problem("E237", stage.last.step, message)]


def _judge(stage: Stage, resistance: LateralResistance | None) -> list[Problem]:
    last = stage.last
    if resistance is None:
        return [Problem("E230", last.step, "nothing of the wall stands on the ground.")]
    said = {LimitStatus.UNSTABLE: "the wall does not stand", LimitStatus.FAILED: UNKNOWN}
    problems = [
        Problem(
            "E230", last.step, f"{said[result.status]}: {result.direction} {result.status.value}."
        )
        for result in (resistance.left, resistance.right)
        if result.status in said
    ]
    if problems:
        return problems
    claims = (
        ("alpha_left", last.alpha_left, resistance.left.alpha),
        ("alpha_right", last.alpha_right, resistance.right.alpha),
    )
    return [
        Problem("E231", last.step, contradicted(name, claimed, found))
        for name, claimed, found in claims
        if differs(claimed, found, ALPHA_TOLERANCE)
    ]
