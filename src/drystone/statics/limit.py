"""Limit analysis of rigid blocks by linear programming (§4.1, Eq. 23-24; DESIGN 4.8).

Both directions are extremes of one program: alpha, positive along the live load, ranges over an
interval of loads that the blocks can carry, [-alpha_left, alpha_right] on the tilting table.  The
blocks stand under their dead load exactly when 0 lies in it.  So one program is set up and
solved upwards, and then downwards from the basis that the first solution ended with.

An answer counts only with a certificate that holds (:mod:`drystone.statics.lp.certificate`); if it
does not, the program is solved again from the start and by other algorithms.
"""

from dataclasses import replace

import numpy as np

from drystone.statics.loads import Loads
from drystone.statics.lp.certificate import of_fall
from drystone.statics.lp.extremes import Extreme, Solver, extremes
from drystone.statics.lp.highs import TOLERANCE
from drystone.statics.lp.program import EquilibriumProgram, Floats, assemble
from drystone.statics.lp.solution import Solution
from drystone.statics.model import Direction, RigidBlockModel
from drystone.statics.result import (
    LateralResistance,
    LimitResult,
    LimitStatus,
    LoadRange,
    Mechanism,
)

MESSAGES = {
    LimitStatus.OPTIMAL: "The greatest load was found.",
    LimitStatus.UNSTABLE: "The blocks do not stand under dead load, their own weight.",
    LimitStatus.UNBOUNDED: "No load in this direction brings the blocks down.",
}


def limit_load(
    model: RigidBlockModel,
    direction: Direction,
    loads: Loads | None = None,
    *,
    mechanism: bool = False,
    solver: Solver = "auto",
) -> LimitResult:
    """Find the greatest load in one direction that the blocks carry (Eq. 23).

    Maximise alpha subject to equilibrium of every free block under its weight w downwards and
    alpha w sideways, both at its centroid, with n >= 0 and |t| <= mu n at every contact point.

    Parameters
    ----------
    model : RigidBlockModel
        Blocks and interfaces.
    direction : {"left", "right"}
        The live load points to -x for "left"; for other loads "left" is against the live load.
    loads : Loads, optional
        Dead and live loads; the tilting table unless given.
    mechanism : bool
        Also return how the blocks move at that load, and the forces between them.
    solver : {"auto", "highs", "highs-ipm", "clarabel"}
        "auto" chooses by the number of blocks and asks others when a certificate fails; any
        other is asked alone.

    Returns
    -------
    LimitResult
        `status` "unstable" when the blocks do not stand under their own weight, even if some
        push would hold them up; "unbounded" when nothing limits the load, as for a model without
        free blocks; "failed" when no solver has an answer that can be certified.  Never raises
        for a valid model.

    Examples
    --------
    >>> from drystone.contacts.blocks import model_from_labels
    >>> wall = model_from_labels(np.ones((40, 20), np.uint32)).model
    >>> result = limit_load(wall, "right")
    >>> round(result.alpha, 6), result.certificate.holds
    (0.5, True)
    """
    both = lateral_resistance(model, loads, mechanism=mechanism, solver=solver)
    return both.left if direction == "left" else both.right


def lateral_resistance(
    model: RigidBlockModel,
    loads: Loads | None = None,
    *,
    mechanism: bool = False,
    solver: Solver = "auto",
) -> LateralResistance:
    """Find the greatest loads in both directions (Eq. 28); see :func:`limit_load`.

    Returns
    -------
    LateralResistance
        Its `value` is F_LR: the lesser alpha over mu.
    """
    if all(block.fixed for block in model.blocks):
        return LateralResistance(_no_blocks("left"), _no_blocks("right"), model.mu)
    program = assemble(model, loads)
    least, greatest = extremes(model, program, solver, mechanism=mechanism)
    return resistance_between(program, least, greatest, model.mu, mechanism=mechanism)


def load_range(
    model: RigidBlockModel,
    loads: Loads,
    *,
    mechanism: bool = False,
    solver: Solver = "auto",
) -> LoadRange:
    """Find all alpha for which the blocks carry dead + alpha live; 0 need not be one of them.

    Arguments are those of :func:`lateral_resistance`.
    """
    if all(block.fixed for block in model.blocks):
        return LoadRange(_no_blocks("left"), _no_blocks("right"))
    program = assemble(model, loads)
    least, greatest = extremes(model, program, solver, mechanism=mechanism)
    ends = zip(("left", "right"), (least, greatest), strict=True)
    return LoadRange(*(_range_end(d, answer, program, mechanism) for d, answer in ends))  # type: ignore[arg-type]


def resistance_between(
    program: EquilibriumProgram,
    least: Extreme,
    greatest: Extreme,
    mu: float,
    *,
    mechanism: bool = False,
) -> LateralResistance:
    """Tell both directions from the two ends of the interval of alpha."""
    fall = _fall(program, least, greatest)
    return LateralResistance(
        _direction("left", least, greatest, fall, program if mechanism else None),
        _direction("right", greatest, least, fall, program if mechanism else None),
        mu,
    )


def _no_blocks(direction: Direction) -> LimitResult:
    said = "There are no free blocks."
    return LimitResult(LimitStatus.UNBOUNDED, direction, message=said)


def _fall(program: EquilibriumProgram, least: Extreme, greatest: Extreme) -> Extreme | None:
    for answer, sign in ((greatest, 1.0), (least, -1.0)):
        if answer.status is LimitStatus.UNSTABLE:
            return answer
        if answer.status is LimitStatus.OPTIMAL and sign * answer.alpha < -TOLERANCE:
            assert answer.solution.duals is not None  # noqa: S101 - an optimal solution has them
            return Extreme(answer.solution, of_fall(program, -answer.solution.duals))
    return None


def _direction(
    direction: Direction,
    answer: Extreme,
    other: Extreme,
    fall: Extreme | None,
    wanted: EquilibriumProgram | None,
) -> LimitResult:
    """Tell one direction; mechanism and forces are made when the program is given.

    Without the other extreme it is not known that the blocks stand by themselves.
    """
    if fall is not None and not (fall.certificate and fall.certificate.holds):
        return _failed(direction, fall)
    if fall is not None:
        return LimitResult(
            LimitStatus.UNSTABLE,
            direction,
            mechanism=_mechanism(wanted, fall.solution) if wanted else None,
            certificate=fall.certificate,
            message=MESSAGES[LimitStatus.UNSTABLE],
            solver=fall.solution.solver,
        )
    if answer.status is LimitStatus.FAILED:
        return _failed(direction, answer)
    if other.status is LimitStatus.FAILED:
        said = "The solver gave up in the other direction."
        return LimitResult(LimitStatus.FAILED, direction, message=said)
    sign = -1.0 if direction == "left" else 1.0
    alpha = max(0.0, sign * answer.alpha) if answer.status is LimitStatus.OPTIMAL else None
    return _result(direction, answer, alpha, wanted)


def _range_end(
    direction: Direction, answer: Extreme, program: EquilibriumProgram, mechanism: bool
) -> LimitResult:
    """Tell one end of the range of alpha."""
    if answer.status is LimitStatus.FAILED:
        return _failed(direction, answer)
    if answer.status is LimitStatus.UNSTABLE:
        result = _result(direction, answer, None, program if mechanism else None)
        return replace(result, message="No alpha holds the blocks up.")
    alpha = answer.alpha if answer.status is LimitStatus.OPTIMAL else None
    return _result(direction, answer, alpha, program if mechanism else None)


def _failed(direction: Direction, answer: Extreme) -> LimitResult:
    solution = answer.solution
    claimed = solution.status is not LimitStatus.FAILED
    doubt = ", but that could not be certified" if claimed else ""
    said = f"The solver gave up: {solution.solver} says {solution.said}{doubt}."
    return LimitResult(
        LimitStatus.FAILED,
        direction,
        certificate=answer.certificate,
        message=said,
        solver=solution.solver,
    )


def _result(
    direction: Direction, answer: Extreme, alpha: float | None, wanted: EquilibriumProgram | None
) -> LimitResult:
    solution = answer.solution
    optimal = answer.status is LimitStatus.OPTIMAL
    return LimitResult(
        answer.status,
        direction,
        alpha,
        _mechanism(wanted, solution) if wanted else None,
        _forces(wanted, solution) if wanted and optimal else None,
        answer.certificate,
        MESSAGES[answer.status],
        solution.solver,
    )


def _mechanism(program: EquilibriumProgram, solution: Solution) -> Mechanism | None:
    """Turn row duals into velocities (§4.1).

    At the least of cost * alpha the duals y satisfy y . live = cost and y . g <= 0 for every
    edge g of a friction cone.  So -y opens or slides every contact (associated flow) and moves
    the blocks with the live load.
    """
    if solution.duals is None:
        return None
    velocity = np.zeros((len(program.rows), 3))
    velocity[program.rows >= 0] = -solution.duals
    velocity[:, 2] /= program.length
    fastest = float(np.hypot(velocity[:, 0], velocity[:, 1]).max())
    # Blocks that only turn about their centroids are told by their rate of turning.
    largest = fastest or float(np.abs(velocity).max())
    return Mechanism(program.block_ids, velocity / largest)


def _forces(program: EquilibriumProgram, solution: Solution) -> Floats:
    """Add up the two edges of the cone at every contact point: normal part, and part along mu t."""
    assert solution.columns is not None  # noqa: S101 - asked for only when optimal
    edges = program.weight * solution.columns[1:].reshape(-1, 2)
    normal = edges.sum(axis=1)
    return np.column_stack((normal, program.friction * (edges[:, 0] - edges[:, 1])))
