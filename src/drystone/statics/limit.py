"""Limit analysis of rigid blocks by linear programming (§4.1, Eq. 23-24; DESIGN 4.8).

Both directions are extremes of one program: alpha, positive towards +x, ranges over an interval
[-alpha_left, alpha_right] of loads that the blocks can carry.  The blocks stand under their own
weight exactly when 0 lies in it.  So one program is set up and solved upwards, and then
downwards from the basis that the first solution ended with.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import highspy
import numpy as np

from drystone.statics.model import (
    Direction,
    LateralResistance,
    LimitResult,
    LimitStatus,
    Mechanism,
    RigidBlockModel,
)
from drystone.statics.program import EquilibriumProgram, Floats, assemble

TOLERANCE = 1e-9
"""Of the solver, and for taking an alpha beside 0 as 0."""

_COMMON: Mapping[str, Any] = {
    "output_flag": False,
    "primal_feasibility_tolerance": TOLERANCE,
    "dual_feasibility_tolerance": TOLERANCE,
}
# Measured on coursed and irregular walls of 30 and 60 stones: dual simplex first, then primal
# from its basis, without presolve and scaling, is the fastest of all pairs.
_FIRST: Mapping[str, Any] = {
    "threads": 1,
    "solver": "simplex",
    "presolve": "off",
    "simplex_scale_strategy": 0,
    "simplex_strategy": 1,
}
_FROM_BASIS: Mapping[str, Any] = {"simplex_strategy": 4}
# Another algorithm for what the first one gives up on; it takes as many threads as there are.
_AGAIN: Mapping[str, Any] = {"solver": "ipm", "run_crossover": "on", "presolve": "on"}

_STATUS = {
    highspy.HighsModelStatus.kOptimal: LimitStatus.OPTIMAL,
    highspy.HighsModelStatus.kInfeasible: LimitStatus.UNSTABLE,
    highspy.HighsModelStatus.kUnbounded: LimitStatus.UNBOUNDED,
}

_MESSAGE = {
    LimitStatus.OPTIMAL: "The greatest load was found.",
    LimitStatus.UNSTABLE: "The blocks do not stand under their own weight.",
    LimitStatus.UNBOUNDED: "No load in this direction brings the blocks down.",
}


@dataclass(frozen=True, eq=False)
class _Extreme:
    """One end of the interval of alpha; `duals` are those of the rows."""

    status: LimitStatus
    alpha: float = 0.0
    duals: Floats | None = None
    message: str = ""


def limit_load(
    model: RigidBlockModel, direction: Direction, *, mechanism: bool = False
) -> LimitResult:
    """Find the greatest horizontal load that the blocks carry (Eq. 23).

    Maximise alpha subject to equilibrium of every free block under its weight w downwards and
    alpha w sideways, both at its centroid, with n >= 0 and |t| <= mu n at every contact point.

    Parameters
    ----------
    model : RigidBlockModel
        Blocks and interfaces.
    direction : {"left", "right"}
        The live load points to -x for "left".
    mechanism : bool
        Also return how the blocks move at that load.

    Returns
    -------
    LimitResult
        `status` "unstable" when the blocks do not stand under their own weight, even if some
        push would hold them up; "unbounded" when nothing limits the load, as for a model without
        free blocks; "failed" when two algorithms gave up.  Never raises for a valid model.

    Examples
    --------
    >>> from drystone.statics.blocks import model_from_labels
    >>> wall = model_from_labels(np.ones((40, 20), np.uint32)).model
    >>> round(limit_load(wall, "right").alpha, 6)
    0.5
    """
    both = lateral_resistance(model, mechanism=mechanism)
    return both.left if direction == "left" else both.right


def lateral_resistance(model: RigidBlockModel, *, mechanism: bool = False) -> LateralResistance:
    """Find the greatest loads in both directions (Eq. 28); see :func:`limit_load`.

    Parameters
    ----------
    model : RigidBlockModel
        Blocks and interfaces.
    mechanism : bool
        Also return how the blocks move at those loads.

    Returns
    -------
    LateralResistance
        Its `value` is F_LR: the lesser alpha over mu.
    """
    if all(block.fixed for block in model.blocks):
        left, right = (
            LimitResult(LimitStatus.UNBOUNDED, direction, message="There are no free blocks.")
            for direction in ("left", "right")
        )
        return LateralResistance(left, right, model.mu)
    program = assemble(model)
    upper, lower = _extremes(program)
    standing = _standing(upper, lower)
    wanted = program if mechanism else None
    return LateralResistance(
        _result("left", lower, standing, wanted),
        _result("right", upper, standing, wanted),
        model.mu,
    )


def _extremes(program: EquilibriumProgram) -> tuple[_Extreme, _Extreme]:
    """Find the greatest and the least alpha."""
    highs = _loaded(program, {**_COMMON, **_FIRST})
    upper = _solved(highs, program, -1.0)
    if upper.status is LimitStatus.UNSTABLE:
        return upper, upper
    _set_options(highs, _FROM_BASIS)
    return upper, _solved(highs, program, 1.0)


def _loaded(program: EquilibriumProgram, options: Mapping[str, Any]) -> highspy.Highs:
    columns, rows = program.column_count, len(program.rhs)
    lower = np.zeros(columns)
    lower[0] = -highspy.kHighsInf
    upper = np.full(columns, highspy.kHighsInf)
    by_column, minimise, offset = 1, 1, 0.0
    highs = highspy.Highs()  # type: ignore[no-untyped-call]  # its constructor has no types
    _set_options(highs, options)
    highs.passModel(
        columns, rows, len(program.value), by_column, minimise, offset, np.zeros(columns), lower,
        upper, program.rhs, program.rhs, program.start, program.index, program.value,
        np.zeros(columns, np.int32),
    )  # fmt: skip
    return highs


def _set_options(highs: highspy.Highs, options: Mapping[str, Any]) -> None:
    for name, value in options.items():
        highs.setOptionValue(name, value)


def _solved(highs: highspy.Highs, program: EquilibriumProgram, cost: float) -> _Extreme:
    """Minimise cost * alpha; when the solver gives up, once more with another algorithm."""
    extreme = _run(highs, cost)
    if extreme.status is LimitStatus.FAILED:
        extreme = _run(_loaded(program, {**_COMMON, **_AGAIN}), cost)
    return extreme


def _run(highs: highspy.Highs, cost: float) -> _Extreme:
    highs.changeColCost(0, cost)
    highs.run()
    found = highs.getModelStatus()
    status = _STATUS.get(found, LimitStatus.FAILED)
    if status is not LimitStatus.OPTIMAL:
        said = f"The solver gave up: {highs.modelStatusToString(found)}."
        return _Extreme(status, message=_MESSAGE.get(status, said))
    solution = highs.getSolution()
    return _Extreme(status, solution.col_value[0], np.array(solution.row_dual), _MESSAGE[status])


def _standing(upper: _Extreme, lower: _Extreme) -> bool | None:
    """Whether alpha = 0 lies between the extremes; None when that is not known."""
    for extreme, sign in ((upper, 1.0), (lower, -1.0)):
        if extreme.status is LimitStatus.UNSTABLE:
            return False
        if extreme.status is LimitStatus.OPTIMAL and sign * extreme.alpha < -TOLERANCE:
            return False
    return None if LimitStatus.FAILED in (upper.status, lower.status) else True


def _result(
    direction: Direction,
    extreme: _Extreme,
    standing: bool | None,
    program: EquilibriumProgram | None,
) -> LimitResult:
    """Tell one direction; a mechanism is made when the program is given.

    Without the other extreme it is not known that the blocks stand by themselves.
    """
    if standing is False:
        return LimitResult(LimitStatus.UNSTABLE, direction, message=_MESSAGE[LimitStatus.UNSTABLE])
    if standing is None:
        failed = extreme.status is LimitStatus.FAILED
        said = extreme.message if failed else "The solver gave up in the other direction."
        return LimitResult(LimitStatus.FAILED, direction, message=said)
    if extreme.duals is None:
        return LimitResult(extreme.status, direction, message=extreme.message)
    sign = -1.0 if direction == "left" else 1.0
    moves = _mechanism(program, extreme.duals) if program is not None else None
    return LimitResult(
        extreme.status, direction, max(0.0, sign * extreme.alpha), moves, extreme.message
    )


def _mechanism(program: EquilibriumProgram, duals: Floats) -> Mechanism:
    """Turn row duals into velocities (§4.1).

    At the least of cost * alpha the duals y satisfy y . live = cost and y . g <= 0 for every
    edge g of a friction cone.  So -y opens or slides every contact (associated flow) and moves
    the blocks with the live load.
    """
    velocity = -duals.reshape(-1, 3)
    velocity[:, 2] /= program.length
    return Mechanism(
        program.block_ids, velocity / float(np.hypot(velocity[:, 0], velocity[:, 1]).max())
    )
