"""What a rigid-body engine makes of a planned wall, against what the plan claims."""

from drystone.model.plan import Plan
from drystone.model.steps import piece_id, piece_name
from drystone.physics.building import BuildUp
from drystone.physics.scatter import TiltResult
from drystone.statics.model import Direction
from drystone.verify.report import Problem

CONFIRMED = 0.85
"""A wall must come down no earlier in the engine than at this share of what its plan claims."""


def check_engine(
    plan: Plan, built: BuildUp, tilts: tuple[TiltResult, TiltResult] | None
) -> list[Problem]:
    """Verify that the engine does not contradict a plan, whose wall it built and may have tilted.

    E241: blocks fall in the wall as it is drawn.  E242: tilted, the wall comes down below
    `CONFIRMED` of a load multiplier that the plan claims.
    """
    problems = []
    if built.first_fall is not None:
        names = {piece_id(step): piece_name(step) for step in plan.steps}
        fallen = ", ".join(names[block] for block in built.fallen)
        message = f"in the engine blocks fall, the first after this stone and its wedges: {fallen}."
        problems.append(Problem("E241", plan.stone_steps[built.first_fall - 1].step, message))
    for tilt in tilts or ():
        alpha = claimed_alpha(plan, tilt.direction)
        found = 0.0 if tilt.fell_at_rest else tilt.high
        if alpha is not None and found is not None and found < CONFIRMED * alpha:
            message = (
                f"tilted to the {tilt.direction} the wall comes down by alpha = {found:.3f} in the "
                f"engine, {found / alpha:.0%} of the {alpha:.3f} that the plan claims; "
                f"{CONFIRMED:.0%} are wanted."
            )
            problems.append(Problem("E242", None, message))
    return problems


def claimed_alpha(plan: Plan, direction: Direction) -> float | None:
    """Return the load multiplier that a plan claims of a side, the smaller of both flow rules."""
    metrics = plan.metrics
    claims = [getattr(metrics, f"alpha_{direction}{rule}") for rule in ("", "_coulomb")]
    if metrics.F_LR_coulomb == 0.0:  # it can fall by itself: nothing is claimed
        claims.append(0.0)
    return min((claim for claim in claims if claim is not None), default=None)
