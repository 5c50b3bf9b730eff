"""Certificates of answers, computed from the program and independent of what a solver claims."""

import numpy as np

from drystone.kernels.cones import Figures
from drystone.statics.lp.program import EquilibriumProgram, Floats, Solution
from drystone.statics.result import Certificate, LimitStatus


def certify(program: EquilibriumProgram, solution: Solution, sign: float) -> Certificate | None:
    """Check the forces and the mechanism of a solution for the extreme of alpha.

    The sign is 1 when the greatest alpha was asked for, -1 for the least: the mechanism of the
    other end is not a proof.  None when the solver failed or brought no vectors; whether the
    certificate holds is for the caller to ask.

    With duals y, v = -y are the velocities of the blocks and g . v >= 0 for every edge g of a
    friction cone says that they open contacts at least as fast as the associated flow rule demands.
    For any such v and any forces in equilibrium, alpha live . v <= -dead . v: the balance of work
    bounds alpha on the side to which v goes along with the live load.
    """
    if solution.status is LimitStatus.OPTIMAL:
        columns, duals = solution.optimum
        return optimum_of(_figures(program, columns, -duals), float(columns[0]), sign)
    if solution.status is LimitStatus.UNSTABLE and solution.duals is not None:
        found = _figures(program, None, -solution.duals)
        return certified_fall(found, found.live)
    if solution.status is not LimitStatus.UNBOUNDED or solution.columns is None:
        return None
    # A state of self-stress that grows carries any live load.
    ray = solution.columns
    if not sign * ray[0] > 0.0:
        return None
    ray = ray / abs(ray[0])
    residual, violation = _largest(np.abs(program.matrix @ ray)), _largest(-ray[1:])
    return Certificate(residual, violation, lower=sign * np.inf)


def fall_certificate(program: EquilibriumProgram, velocity: Floats) -> Certificate:
    """Certify that the dead load does work on a mechanism, one velocity a row of the program."""
    return certified_fall(_figures(program, None, velocity))


def optimum_of(found: Figures, alpha: float, sign: float) -> Certificate:
    """Certify that alpha is the greatest (sign 1) or the least (-1)."""
    # Of the live load; along the end that was asked for.
    power = sign * found.live
    upper = slack = None
    if power > 0.0:
        upper = sign * found.rhs / power
        slack = found.inadmissible * found.total / power
    inadmissible = found.inadmissible / max(1.0, found.largest)
    return Certificate(found.residual, found.violation, inadmissible, alpha, upper, slack)


def certified_fall(found: Figures, live: float = 0.0) -> Certificate:
    """Certify that the dead load does work on a mechanism.

    That no alpha holds the blocks up is a fall on which `live`, the work of the live load, is 0.
    """
    if found.largest == 0.0:
        return Certificate(fall_work=0.0)
    return Certificate(
        inadmissible=max(found.inadmissible, abs(live)) / found.largest,
        fall_work=-found.rhs / found.largest,
    )


def _figures(program: EquilibriumProgram, columns: Floats | None, velocity: Floats) -> Figures:
    """Measure forces, if there are any, and a mechanism."""
    residual = violation = total = 0.0
    if columns is not None:
        residual = _largest(np.abs(program.matrix @ columns - program.rhs))
        violation = _largest(-columns[1:])
        total = float(np.abs(columns[1:]).sum())
    powers = program.matrix.T @ velocity
    largest, inadmissible = _largest(np.abs(velocity)), _largest(-powers[1:])
    live, rhs = float(powers[0]), float(program.rhs @ velocity)
    return Figures(residual, violation, total, largest, inadmissible, live, rhs)


def _largest(values: Floats) -> float:
    """Return the largest value above 0; NaN when there is one."""
    return float(values.max(initial=0.0)) + 0.0  # never -0.0
