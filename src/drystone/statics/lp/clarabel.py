"""Clarabel: an interior point method that grows slowly with the number of blocks."""

from dataclasses import replace
from typing import Any

import clarabel
import numpy as np
from scipy.sparse import csc_array, csc_matrix, diags_array, hstack, vstack

from drystone.statics.lp.program import EquilibriumProgram, Floats, Solution
from drystone.statics.result import LimitStatus

NAME = "Clarabel"

# At 1e-10 the last digits are off by 1e-7 for a thousand blocks; 1e-12 costs the same.
_LINEAR = 1e-12
# Near 1e-12 quadratic ones stop short, some far from the end.
_QUADRATIC = 1e-8

# "Almost" and "insufficient progress" stop near the last digits: the certificate decides.
_STATUS = {
    "Solved": LimitStatus.OPTIMAL,
    "AlmostSolved": LimitStatus.OPTIMAL,
    "InsufficientProgress": LimitStatus.OPTIMAL,
    "PrimalInfeasible": LimitStatus.UNSTABLE,
    "AlmostPrimalInfeasible": LimitStatus.UNSTABLE,
    "DualInfeasible": LimitStatus.UNBOUNDED,
    "AlmostDualInfeasible": LimitStatus.UNBOUNDED,
}

_STOPPED = ("InsufficientProgress", "MaxIterations", "NumericalError")
"""What it says when it gives up: often of a wall of which a chip falls, which no load holds up."""

HELD = 1e-9
"""Shares of the dead load that have to be held, in all: above 0 to the digits of an answer."""


def _settings(tolerance: float) -> Any:
    settings = clarabel.DefaultSettings()
    settings.verbose, settings.max_threads = False, 1
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = tolerance
    return settings


class ClarabelSession:
    """One program in Clarabel; every objective is solved from the start."""

    def __init__(self, program: EquilibriumProgram) -> None:
        self._program, self._bounded = program, _bounded(program.matrix)

    def minimise(self, costs: Floats) -> Solution:
        """Minimise costs . x; see :meth:`drystone.statics.lp.highs.HighsSession.minimise`.

        Where no end is in sight, it is asked how much of the dead load has to be held from outside.
        That has always an answer.  If some has to, the duals are a fall.
        """
        found = self._solved(self._bounded, costs)
        if found.said in _STOPPED:
            held = diags_array(self._program.rhs, format="csc")[:, self._program.rhs != 0.0]
            shares = np.append(0.0 * costs, np.ones(held.shape[1]))
            fall = self._solved(_bounded(hstack((self._program.matrix, held))), shares)
            if fall.columns is not None and fall.columns @ shares > HELD:
                return replace(fall, status=LimitStatus.UNSTABLE, columns=None)
        return found

    def _solved(self, matrix: csc_matrix, costs: Floats) -> Solution:
        rows, columns = len(self._program.rhs), len(costs)
        cones = [clarabel.ZeroConeT(rows)]
        if columns > 1:
            cones.append(clarabel.NonnegativeConeT(columns - 1))
        found = clarabel.DefaultSolver(
            csc_matrix((columns, columns)),
            costs,
            matrix,
            np.concatenate((self._program.rhs, np.zeros(columns - 1))),
            cones,
            _settings(_LINEAR),
        ).solve()
        said = str(found.status)
        status = _STATUS.get(said, LimitStatus.FAILED)
        return Solution(
            status,
            np.array(found.x) if status in (LimitStatus.OPTIMAL, LimitStatus.UNBOUNDED) else None,
            -np.array(found.z)[:rows]
            if status in (LimitStatus.OPTIMAL, LimitStatus.UNSTABLE)
            else None,
            said,
            NAME,
        )


def _bounded(matrix: csc_array) -> csc_matrix:
    """Add that x_0 = alpha is free, and all other unknowns are >= 0: -x + s = 0, s >= 0."""
    bounds = -diags_array(np.ones(matrix.shape[1]), format="csc")[1:]
    return csc_matrix(vstack((matrix, bounds), format="csc"))


def least_constraint(
    masses: Floats, forces: Floats, matrix: csc_array, least: Floats
) -> tuple[Floats, Floats] | None:
    """Minimise sum(masses x^2) / 2 - forces . x, subject to matrix' x >= least, which is <= 0.

    Gauss's principle: masses above 0 under given forces accelerate so, and the multipliers are what
    the constraints, the columns of the matrix, do to them.  Returned are x and the multipliers;
    None when Clarabel gives up.
    """
    quadratic, above = csc_matrix(diags_array(masses)), csc_matrix(-matrix.T)
    cones, settings = [clarabel.NonnegativeConeT(len(least))], _settings(_QUADRATIC)
    solver = clarabel.DefaultSolver(quadratic, -forces, above, -least, cones, settings)
    found = solver.solve()
    if _STATUS.get(str(found.status)) is not LimitStatus.OPTIMAL:
        return None
    return np.array(found.x), np.array(found.z)
