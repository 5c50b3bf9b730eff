"""HiGHS with a last correction of its answers.

The simplex method updates the unknowns from pivot to pivot, and HiGHS drops what is very small.
With large forces or thousands of blocks that leaves residuals of 1e-7, too large for a certificate;
one correction by the last basis leaves 1e-13.
"""

from dataclasses import replace

import highspy
import numpy as np
from scipy.sparse import csc_array

from drystone.statics.program import EquilibriumProgram, Floats
from drystone.statics.result import LimitStatus
from drystone.statics.solvers.solution import Solution
from drystone.statics.solvers.warm import WarmSession

RESIDUAL = 1e-11
"""Larger ones are corrected."""


class RefinedSession(WarmSession):
    """One program in HiGHS, solved from given bases; optima satisfy the equations to 1e-11 or so.

    Parameters
    ----------
    program : EquilibriumProgram
        The equations.
    """

    def __init__(self, program: EquilibriumProgram) -> None:
        super().__init__(program)
        self._program = program

    def minimise(self, costs: Floats) -> Solution:
        """Minimise costs . x."""
        solution = super().minimise(costs)
        if solution.status is not LimitStatus.OPTIMAL:
            return solution
        assert solution.columns is not None  # noqa: S101 - an optimal solution has both
        assert solution.duals is not None  # noqa: S101
        program = (costs, self._program.matrix, self._program.rhs)
        columns, duals = corrected(self.highs, program, solution.columns, solution.duals)
        return replace(solution, columns=columns, duals=duals)


def corrected(
    highs: highspy.Highs, program: tuple[Floats, csc_array, Floats], columns: Floats, duals: Floats
) -> tuple[Floats, Floats]:
    """Return the optimum that HiGHS has just found, with small residuals.

    Parameters
    ----------
    highs : Highs
        With the basis of the optimum.
    program : tuple
        Costs, matrix and right-hand side.
    columns, duals : float arrays
        Of the optimum.
    """
    costs, matrix, rhs = program
    left = rhs - matrix @ columns
    if not np.abs(left).max() > RESIDUAL:
        return columns, duals
    # Missing in the types of HiGHS, like the two calls below.
    _, heads = highs.getBasicVariables()  # type: ignore[attr-defined]
    basic = heads >= 0  # others are slacks, which are 0

    def rates_of(duals: Floats) -> Floats:
        """Return the reduced costs of what is basic; all of them should be 0."""
        rates = np.zeros(len(heads))
        rates[basic] = (costs - matrix.T @ duals)[heads[basic]]
        rates[~basic] = -duals[-1 - heads[~basic]]
        return rates

    _, change = highs.getBasisSolve(left)  # type: ignore[attr-defined]
    columns = columns.copy()
    columns[heads[basic]] += change[basic]
    rates = rates_of(duals)
    _, change = highs.getBasisTransposeSolve(rates)  # type: ignore[attr-defined]
    better = np.abs(rates_of(duals + change)).max() < np.abs(rates).max()
    return columns, duals + change if better else duals
