"""Clarabel: an interior point method that grows slowly with the number of blocks."""

from typing import Any

import clarabel
import numpy as np
from scipy.sparse import csc_array, csc_matrix, diags_array, vstack

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


def _settings(tolerance: float) -> Any:
    settings = clarabel.DefaultSettings()
    settings.verbose, settings.max_threads = False, 1
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = tolerance
    return settings


class ClarabelSession:
    """One program in Clarabel; every objective is solved from the start."""

    def __init__(self, program: EquilibriumProgram) -> None:
        rows, columns = program.matrix.shape
        # x_0 = alpha is free, all other unknowns are >= 0:  -x + s = 0, s >= 0.
        bounds = -diags_array(np.ones(columns), format="csc")[1:]
        self._matrix = csc_matrix(vstack((program.matrix, bounds), format="csc"))
        self._rhs = np.concatenate((program.rhs, np.zeros(columns - 1)))
        self._cones = [clarabel.ZeroConeT(rows)]
        if columns > 1:
            self._cones.append(clarabel.NonnegativeConeT(columns - 1))
        self._rows = rows

    def minimise(self, costs: Floats) -> Solution:
        """Minimise costs . x; see :meth:`drystone.statics.lp.highs.HighsSession.minimise`."""
        nothing = csc_matrix((len(costs), len(costs)))
        solver = clarabel.DefaultSolver(
            nothing, costs, self._matrix, self._rhs, self._cones, _settings(_LINEAR)
        )
        found = solver.solve()
        said = str(found.status)
        status = _STATUS.get(said, LimitStatus.FAILED)
        columns = np.array(found.x)
        duals = -np.array(found.z)[: self._rows]
        return Solution(
            status,
            columns if status in (LimitStatus.OPTIMAL, LimitStatus.UNBOUNDED) else None,
            duals if status in (LimitStatus.OPTIMAL, LimitStatus.UNSTABLE) else None,
            said,
            NAME,
        )


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
