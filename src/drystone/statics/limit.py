"""Limit analysis of rigid blocks by linear programming (§4.1, Eq. 23-24; DESIGN 4.8).

Both directions are extremes of one program: alpha, positive along the live load, ranges over an
interval of loads that the blocks can carry, [-alpha_left, alpha_right] on the tilting table.  The
blocks stand under their dead load exactly when 0 lies in it.  So one program is set up and
solved upwards, and then downwards from the basis that the first solution ended with.

An answer counts only with a certificate that holds (:mod:`drystone.statics.lp.certificate`); if it
does not, the program is solved again from the start and by other algorithms.
"""

from typing import get_args

from drystone.statics.loads import Loads
from drystone.statics.lp.certificate import fall_certificate
from drystone.statics.lp.extremes import Extreme, Solver, extremes
from drystone.statics.lp.highs import TOLERANCE
from drystone.statics.lp.program import EquilibriumProgram, assemble
from drystone.statics.model import Direction, RigidBlockModel
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus, LoadRange

DIRECTIONS: tuple[Direction, ...] = get_args(Direction)

MESSAGES = {
    LimitStatus.OPTIMAL: "The greatest load was found.",
    LimitStatus.UNSTABLE: "The blocks do not stand under dead load, their own weight.",
    LimitStatus.UNBOUNDED: "No load in this direction brings the blocks down.",
}


def lateral_resistance(
    model: RigidBlockModel,
    loads: Loads | None = None,
    *,
    mechanism: bool = False,
    solver: Solver = "auto",
) -> LateralResistance:
    """Find the greatest loads that the blocks carry in both directions (Eq. 23, Eq. 28).

    Maximise alpha subject to equilibrium of every free block under its weight w downwards and
    alpha w sideways, both at its centroid, with ``n >= 0`` and ``|t| <= mu n`` at every contact
    point.

    Parameters
    ----------
    model : RigidBlockModel
        Blocks and interfaces.
    loads : Loads, optional
        Dead and live loads; the tilting table unless given, where "left" is a live load to -x.
        For others "left" is against the live load.
    mechanism : bool
        Also return how the blocks move at that load, and the forces between them.
    solver : {"auto", "highs", "highs-ipm", "clarabel"}
        "auto" chooses by the number of blocks and asks others when a certificate fails; any
        other is asked alone.

    Returns
    -------
    LateralResistance
        Its `value` is F_LR: the lesser alpha over mu.  The `status` of a direction is "unstable"
        when the blocks do not stand under their own weight, even if some push would hold them up;
        "unbounded" when nothing limits the load, as for a model without free blocks; "failed"
        when no solver has an answer that can be certified.  Never raises for a valid model.

    Raises
    ------
    ValueError
        There is no such solver.

    Examples
    --------
    >>> import numpy as np
    >>> from drystone.contacts.blocks import model_from_labels
    >>> wall = model_from_labels(np.ones((40, 20), np.uint32)).model
    >>> result = lateral_resistance(wall).right
    >>> round(result.alpha, 6), result.certificate.holds
    (0.5, True)
    """
    if all(block.fixed for block in model.blocks):
        return LateralResistance(_no_blocks("left"), _no_blocks("right"), model.mu)
    program = assemble(model, loads)
    least, greatest = extremes(model, program, solver, mechanism=mechanism)
    mu = 0.0 if model.mu_idle else model.mu
    return resistance_between(program, least, greatest, mu, mechanism=mechanism)


def load_range(model: RigidBlockModel, loads: Loads, *, solver: Solver = "auto") -> LoadRange:
    """Find all alpha for which the blocks carry dead + alpha live; 0 need not be one of them.

    Mechanisms and forces at both ends come with them.
    """
    if all(block.fixed for block in model.blocks):
        return LoadRange(_no_blocks("left"), _no_blocks("right"))
    program = assemble(model, loads)

    def end(direction: Direction, answer: Extreme) -> LimitResult:
        alpha = answer.alpha if answer.status is LimitStatus.OPTIMAL else None
        message = "No alpha holds the blocks up." if answer.status is LimitStatus.UNSTABLE else ""
        return _result(direction, answer, answer.status, program, alpha, message)

    least, greatest = extremes(model, program, solver, mechanism=True)
    return LoadRange(end("left", least), end("right", greatest))


def resistance_between(
    program: EquilibriumProgram,
    least: Extreme,
    greatest: Extreme,
    mu: float,
    *,
    mechanism: bool = False,
) -> LateralResistance:
    """Return both directions from the two ends of the interval of alpha."""
    wanted = program if mechanism else None
    fall = _fall(program, least, greatest)
    if fall is not None:
        holds = fall.certificate is not None and fall.certificate.holds
        status = LimitStatus.UNSTABLE if holds else LimitStatus.FAILED
        left, right = (_result(d, fall, status, wanted) for d in DIRECTIONS)
    else:
        left = _direction("left", least, greatest, wanted)
        right = _direction("right", greatest, least, wanted)
    return LateralResistance(left, right, mu)


def _no_blocks(direction: Direction) -> LimitResult:
    return LimitResult(LimitStatus.UNBOUNDED, direction, message="There are no free blocks.")


def _fall(program: EquilibriumProgram, least: Extreme, greatest: Extreme) -> Extreme | None:
    for answer, sign in ((greatest, 1.0), (least, -1.0)):
        if answer.status is LimitStatus.UNSTABLE:
            return answer
        if answer.status is LimitStatus.OPTIMAL and sign * answer.alpha < -TOLERANCE:
            return Extreme(answer.solution, fall_certificate(program, -answer.solution.optimum[1]))
    return None


def _direction(
    direction: Direction, answer: Extreme, other: Extreme, wanted: EquilibriumProgram | None
) -> LimitResult:
    """Without the other extreme it is not known that the blocks stand by themselves."""
    if answer.status is not LimitStatus.FAILED and other.status is LimitStatus.FAILED:
        message = "The solver gave up in the other direction."
        return LimitResult(LimitStatus.FAILED, direction, message=message)
    sign = -1.0 if direction == "left" else 1.0
    alpha = max(0.0, sign * answer.alpha) if answer.status is LimitStatus.OPTIMAL else None
    return _result(direction, answer, answer.status, wanted, alpha)


def _result(
    direction: Direction,
    answer: Extreme,
    status: LimitStatus,
    wanted: EquilibriumProgram | None,
    alpha: float | None = None,
    message: str = "",
) -> LimitResult:
    """Mechanism and forces are made when the program is wanted.

    At the least of cost * alpha the duals y satisfy y . live = cost and y . g <= 0 for every edge
    g of a friction cone.  So -y opens or slides every contact (associated flow) and moves the
    blocks with the live load.
    """
    solution, mechanism, forces = answer.solution, None, None
    if status is LimitStatus.FAILED:
        claimed = solution.status is not LimitStatus.FAILED
        doubt = ", but that could not be certified" if claimed else ""
        message = f"The solver gave up: {solution.solver} says {solution.said}{doubt}."
    elif wanted is not None and solution.duals is not None:
        mechanism = wanted.mechanism(-solution.duals)
    if status is LimitStatus.OPTIMAL and wanted is not None:
        forces = wanted.forces(solution.optimum[0][1:].reshape(-1, 2))
    return LimitResult(
        status,
        direction,
        alpha,
        mechanism,
        forces,
        answer.certificate,
        message or MESSAGES[status],
        solution.solver,
    )
