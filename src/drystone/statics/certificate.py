"""Certificates of answers, computed from the program and independent of what a solver claims."""

from dataclasses import replace

import numpy as np

from drystone.statics.program import EquilibriumProgram, Floats
from drystone.statics.result import Certificate, LimitStatus
from drystone.statics.solvers.solution import Solution


def certify(program: EquilibriumProgram, solution: Solution, sign: float) -> Certificate | None:
    """Check the forces and the mechanism of a solution for the extreme of alpha.

    Parameters
    ----------
    program : EquilibriumProgram
        The equations.
    solution : Solution
        For costs of 1 or -1 on alpha and 0 on all forces.
    sign : float
        1 when the greatest alpha was asked for, -1 for the least.  The mechanism of the other end
        is no proof.

    Returns
    -------
    Certificate or None
        None when the solver failed or brought no vectors.  Whether it holds is for the caller to
        ask.

    Notes
    -----
    With duals y, v = -y are the velocities of the blocks and g . v >= 0 for every edge g of a
    friction cone says that they open contacts at least as fast as the associated flow rule
    demands.  For any such v and any forces in equilibrium, alpha live . v <= -dead . v: the
    balance of work bounds alpha on the side to which v goes along with the live load.
    """
    if solution.status is LimitStatus.OPTIMAL:
        assert solution.columns is not None  # noqa: S101 - an optimal solution has both
        assert solution.duals is not None  # noqa: S101
        return _of_optimum(program, solution.columns, -solution.duals, sign)
    if solution.status is LimitStatus.UNSTABLE and solution.duals is not None:
        return _of_no_alpha(program, -solution.duals)
    if solution.status is LimitStatus.UNBOUNDED and solution.columns is not None:
        return _of_growth(program, solution.columns, sign)
    return None


def of_fall(program: EquilibriumProgram, velocity: Floats) -> Certificate:
    """Certify that the blocks do not stand under dead load: it does work on a mechanism.

    Parameters
    ----------
    program : EquilibriumProgram
        The equations.
    velocity : (rows,) float array
        The mechanism, one entry a row of the program.
    """
    largest = _largest(velocity)
    if largest == 0.0:
        return Certificate(fall_work=0.0)
    velocity = velocity / largest
    inadmissible = _inadmissible(program.matrix.T @ velocity)
    return Certificate(inadmissible=inadmissible, fall_work=-float(program.rhs @ velocity))


def _of_no_alpha(program: EquilibriumProgram, velocity: Floats) -> Certificate:
    """Certify that no alpha holds the blocks up: as a fall on which the live load does no work."""
    fall = of_fall(program, velocity)
    largest = _largest(velocity)
    live = abs(float((program.matrix[:, [0]].T @ velocity)[0])) / largest if largest else 0.0
    return replace(fall, inadmissible=max(fall.inadmissible, live))


def _of_optimum(
    program: EquilibriumProgram, columns: Floats, velocity: Floats, sign: float
) -> Certificate:
    powers = program.matrix.T @ velocity
    # Of the live load; along the end that was asked for.
    power = sign * float(powers[0])
    inadmissible = _inadmissible(powers)
    upper = slack = None
    if power > 0.0:
        upper = sign * float(program.rhs @ velocity) / power
        slack = inadmissible * float(np.abs(columns[1:]).sum()) / power
    return Certificate(
        residual=_largest(program.matrix @ columns - program.rhs),
        violation=max(0.0, -float(columns[1:].min(initial=0.0))),
        inadmissible=inadmissible / max(1.0, _largest(velocity)),
        lower=float(columns[0]),
        upper=upper,
        slack=slack,
    )


def _of_growth(program: EquilibriumProgram, ray: Floats, sign: float) -> Certificate | None:
    """Certify a state of self-stress that carries any live load."""
    if not sign * ray[0] > 0.0:
        return None
    ray = ray / abs(ray[0])
    return Certificate(
        residual=_largest(program.matrix @ ray),
        violation=max(0.0, -float(ray[1:].min(initial=0.0))),
        lower=sign * np.inf,
    )


def _largest(values: Floats) -> float:
    return float(np.abs(values).max(initial=0.0))


def _inadmissible(powers: Floats) -> float:
    return max(0.0, -float(powers[1:].min(initial=0.0)))
