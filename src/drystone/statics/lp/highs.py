"""HiGHS: dual and primal simplex with warm starts, and interior point with crossover."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import highspy
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from drystone.statics.lp.program import EquilibriumProgram, Floats, Solution
from drystone.statics.result import LimitStatus

Algorithm = Literal["simplex", "ipm"]

INFINITY = highspy.kHighsInf

TOLERANCE = 1e-9
"""Primal and dual feasibility; the default of HiGHS costs two digits of alpha at 300 blocks."""

PIVOTS_PER_ROW = 10
"""HiGHS gives up after so many and a thousand more; walls take one to three, but it can cycle."""

PIVOTS_FOR_A_RAY = 100
"""Of a warm start; hardly any need one."""

RESIDUAL = 1e-11
"""Larger ones of a warm start are corrected."""

WARM = "HiGHS warm simplex"

_COMMON: Mapping[str, Any] = {
    # HiGHS keeps to the number of the first call of a process: every call with another one fails.
    "threads": 1,
    "primal_feasibility_tolerance": TOLERANCE,
    "dual_feasibility_tolerance": TOLERANCE,
}
# Measured on coursed and irregular walls of 30 and 60 stones: dual simplex first, then primal
# from its basis, without presolve and scaling, is the fastest of all pairs.
_SIMPLEX: Mapping[str, Any] = {
    "solver": "simplex",
    "presolve": "off",
    "simplex_scale_strategy": 0,
    "simplex_strategy": 1,
}
# A new block is out of balance, so neither method can start at once from the basis of the wall;
# the primal one then needs a fifth of the pivots at 60 blocks.
_DUAL: Mapping[str, Any] = {"simplex_strategy": 1}
_PRIMAL: Mapping[str, Any] = {"simplex_strategy": 4}
_OPTIONS: Mapping[Algorithm, Mapping[str, Any]] = {
    "simplex": _SIMPLEX,
    "ipm": {"solver": "ipm", "run_crossover": "on", "presolve": "on"},
}

_STATUS = {
    highspy.HighsModelStatus.kOptimal: LimitStatus.OPTIMAL,
    highspy.HighsModelStatus.kInfeasible: LimitStatus.UNSTABLE,
    highspy.HighsModelStatus.kUnbounded: LimitStatus.UNBOUNDED,
}

_BASIC = highspy.HighsBasisStatus.kBasic
_AT_ZERO = highspy.HighsBasisStatus.kLower
_FREE = highspy.HighsBasisStatus.kZero


class _SilentHighs(highspy.Highs):
    """HiGHS that prints nothing on standard output, where the JSON of `--json` goes.

    From 1.16 on its constructor, which enables callbacks, already prints who it is: that is too
    early for an option that is set afterwards.
    """

    def enableCallbacks(self) -> None:  # noqa: N802 - a name of highspy
        """Say no more, then do what highspy does."""
        self.setOptionValue("output_flag", False)
        super().enableCallbacks()  # type: ignore[no-untyped-call]  # it has no types


def loaded(
    options: Mapping[str, Any],
    matrix: csc_array,
    rows: tuple[Floats, Floats],
    lower: Floats,
    costs: Floats | None = None,
) -> highspy.Highs:
    """Return HiGHS, that prints nothing, with a program: low <= matrix . x <= high, lower <= x."""
    highs = _SilentHighs()  # type: ignore[no-untyped-call]  # nor has its constructor
    set_options(highs, {"output_flag": False, **_COMMON, **options})
    (count, columns), (low, high) = matrix.shape, rows
    by_column, minimise, offset = 1, 1, 0.0
    highs.passModel(
        columns, count, matrix.nnz, by_column, minimise, offset,
        np.zeros(columns) if costs is None else costs, lower, np.full(columns, INFINITY), low, high,
        matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32), matrix.data,
        np.zeros(columns, np.int32),
    )  # fmt: skip
    return highs


def solved(highs: highspy.Highs) -> Floats | None:
    """Solve what HiGHS has loaded; return its unknowns, or None when there is no optimum."""
    highs.run()
    if highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        return None
    return np.array(highs.getSolution().col_value)


def set_options(highs: highspy.Highs, options: Mapping[str, Any]) -> None:
    """Set options of HiGHS by name."""
    for name, value in options.items():
        highs.setOptionValue(name, value)


@dataclass(frozen=True)
class WarmBasis:
    """Which unknowns and equations are basic; it does not depend on the units of a program."""

    columns: tuple[highspy.HighsBasisStatus, ...] = (_FREE,)  # of the unknowns and of the equations
    rows: tuple[highspy.HighsBasisStatus, ...] = ()
    whole: bool = True  # False when unknowns that were basic are gone

    def given_to(self, highs: highspy.Highs) -> highspy.HighsStatus:
        """Let HiGHS start its next run from the basis; it fills its gaps."""
        given = highspy.HighsBasis()
        given.col_status, given.row_status = list(self.columns), list(self.rows)
        given.valid, given.alien = True, not self.whole
        return highs.setBasis(given)

    def carrying(self, forces: Floats | NDArray[np.bool_], rows: int) -> "WarmBasis":
        """Return the basis with more equations and unknowns, those with a force basic."""
        columns = tuple(np.array((_AT_ZERO, _BASIC), object)[(forces > 0.0).astype(np.intp)])
        return WarmBasis(self.columns + columns, self.rows + (_AT_ZERO,) * rows, whole=False)

    def appended(self, columns: int, rows: int) -> "WarmBasis":
        """Return the basis for so many unknowns, the new ones at 0, and so many equations.

        The slack of a new equation is basic, so the basis stays regular.
        """
        more_columns = (_AT_ZERO,) * (columns - len(self.columns))
        more_rows = (_BASIC,) * (rows - len(self.rows))
        return WarmBasis(self.columns + more_columns, self.rows + more_rows, self.whole)

    def without(self, closed: NDArray[np.integer]) -> "WarmBasis":
        """Return the basis without some edges of friction cones, by their numbers."""
        if not len(closed):
            return self
        stay = np.ones(len(self.columns), bool)
        stay[1 + closed] = False  # alpha comes first
        both = list(zip(self.columns, stay.tolist(), strict=True))
        columns = tuple(status for status, stays in both if stays)
        whole = self.whole and all(stays or status != _BASIC for status, stays in both)
        return WarmBasis(columns, self.rows, whole)


class HighsSession:
    """One program in HiGHS, solved for one objective after another, each from the last basis.

    "simplex" is dual for the first objective and primal from the last basis after it.
    """

    def __init__(self, program: EquilibriumProgram, algorithm: Algorithm = "simplex") -> None:
        self.limit = PIVOTS_PER_ROW * len(program.rhs) + 1000
        options = {"simplex_iteration_limit": self.limit, **_OPTIONS[algorithm]}
        lower = np.zeros(program.column_count)
        lower[0] = -INFINITY
        self.highs = loaded(options, program.matrix, (program.rhs, program.rhs), lower)
        self.name = f"HiGHS {algorithm}"
        self._warm: Mapping[str, Any] = _PRIMAL if algorithm == "simplex" else {}
        self._costs = np.zeros(program.column_count)

    def minimise(self, costs: Floats) -> Solution:
        """Minimise costs . x; the basis that it ends with starts the next call.

        The costs are of alpha, then of the two edges of the friction cone at every contact point.
        """
        changed = np.flatnonzero(costs != self._costs).astype(np.int32)
        self.highs.changeColsCost(len(changed), changed, costs[changed])
        self._costs = costs.copy()
        self.highs.run()
        found = self.highs.getModelStatus()
        name = self.name
        if found == highspy.HighsModelStatus.kInfeasible:
            _, ray = self.highs.getDualRayExist()  # type: ignore[attr-defined]  # not in its types
            if not ray:
                name = self._find_ray()
                found = self.highs.getModelStatus()
        status = _STATUS.get(found, LimitStatus.FAILED)
        said = self.highs.modelStatusToString(found)
        columns, duals = self._vectors(status)
        if status is LimitStatus.OPTIMAL:
            set_options(self.highs, self._warm)
        return Solution(status, columns, duals, said, name)

    def basis(self) -> WarmBasis | None:
        """Return a copy of the last basis; None when there is none."""
        found = self.highs.getBasis()
        return WarmBasis(tuple(found.col_status), tuple(found.row_status)) if found.valid else None

    def _find_ray(self) -> str:
        """Prove that there is no solution; return the name of what did.

        The interior point method proves nothing: the simplex method finds the ray.
        """
        set_options(self.highs, _SIMPLEX)
        self.highs.run()
        return f"{self.name}, then simplex"

    def _vectors(self, status: LimitStatus) -> tuple[Floats | None, Floats | None]:
        if status is LimitStatus.OPTIMAL:
            solution = self.highs.getSolution()
            return np.array(solution.col_value), np.array(solution.row_dual)
        if status is LimitStatus.UNSTABLE:
            _, there, ray = self.highs.getDualRay()  # type: ignore[attr-defined]  # missing in its types
            return None, np.array(ray) if there else None
        if status is LimitStatus.UNBOUNDED:
            _, there, ray = self.highs.getPrimalRay()  # type: ignore[attr-defined]  # as above
            return np.array(ray) if there else None, None
        return None, None


class WarmSession(HighsSession):
    """One program in HiGHS, solved from given bases; optima satisfy the equations to 1e-11 or so.

    The simplex method updates the unknowns from pivot to pivot, and HiGHS drops what is very small.
    With large forces or thousands of blocks that leaves residuals of 1e-7, too large for a
    certificate; one correction by the last basis leaves 1e-13.
    """

    def __init__(self, program: EquilibriumProgram) -> None:
        super().__init__(program)
        self.name = WARM
        self._program = program

    def minimise(self, costs: Floats) -> Solution:
        """Minimise costs . x."""
        solution = super().minimise(costs)
        if solution.status is not LimitStatus.OPTIMAL:
            return solution
        program = (costs, self._program.matrix, self._program.rhs)
        columns, duals = corrected(self.highs, program, *solution.optimum)
        return replace(solution, columns=columns, duals=duals)

    def start_from(self, basis: WarmBasis) -> None:
        """Start the next call from a basis, and from nothing else."""
        set_options(self.highs, _PRIMAL)
        taken = basis.given_to(self.highs)
        assert taken == highspy.HighsStatus.kOk  # noqa: S101 - it would go on from its last basis

    def _find_ray(self) -> str:
        """Find the ray that the primal simplex method leaves out.

        Without costs its last basis is dual feasible, and the dual simplex method has the ray
        without a pivot.  With them it may need seconds, and so may numerical trouble, in which
        HiGHS factors the basis again with every pivot: other solvers are quicker then.
        """
        columns = np.arange(len(self._costs), dtype=np.int32)
        self._costs = np.zeros(len(columns))
        self.highs.changeColsCost(len(columns), columns, self._costs)
        set_options(self.highs, {**_DUAL, "simplex_iteration_limit": PIVOTS_FOR_A_RAY})
        self.highs.run()
        set_options(self.highs, {"simplex_iteration_limit": self.limit})
        return self.name


def corrected(
    highs: highspy.Highs, program: tuple[Floats, csc_array, Floats], columns: Floats, duals: Floats
) -> tuple[Floats, Floats]:
    """Return the optimum that HiGHS has just found, columns and duals, with small residuals.

    The program is its costs, matrix and right-hand side.
    """
    costs, matrix, rhs = program
    left = rhs - matrix @ columns
    if not np.abs(left).max() > RESIDUAL:
        return columns, duals
    # Missing in the types of HiGHS, like the two calls below.
    _, basic_variables = highs.getBasicVariables()  # type: ignore[attr-defined]
    basic = basic_variables >= 0  # others are slacks, which are 0

    def reduced_costs_of(duals: Floats) -> Floats:
        """Return the reduced costs of what is basic; all of them should be 0."""
        reduced_costs = np.zeros(len(basic_variables))
        reduced_costs[basic] = (costs - matrix.T @ duals)[basic_variables[basic]]
        reduced_costs[~basic] = -duals[-1 - basic_variables[~basic]]
        return reduced_costs

    _, change = highs.getBasisSolve(left)  # type: ignore[attr-defined]
    columns = columns.copy()
    columns[basic_variables[basic]] += change[basic]
    reduced_costs = reduced_costs_of(duals)
    _, change = highs.getBasisTransposeSolve(reduced_costs)  # type: ignore[attr-defined]
    better = np.abs(reduced_costs_of(duals + change)).max() < np.abs(reduced_costs).max()
    return columns, duals + change if better else duals
