"""HiGHS: dual and primal simplex with warm starts, and interior point with crossover."""

from collections.abc import Mapping
from typing import Any, Literal

import highspy
import numpy as np

from drystone.statics.program import EquilibriumProgram, Floats
from drystone.statics.result import LimitStatus
from drystone.statics.solvers.silent import set_options, silent_highs
from drystone.statics.solvers.solution import Solution

Algorithm = Literal["simplex", "ipm"]

TOLERANCE = 1e-9
"""Primal and dual feasibility; the default of HiGHS costs two digits of alpha at 300 blocks."""

PIVOTS_PER_ROW = 10
"""HiGHS gives up after so many and a thousand more; walls take one to three, but it can cycle."""

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
_FROM_BASIS: Mapping[str, Any] = {"simplex_strategy": 4}
_IPM: Mapping[str, Any] = {"solver": "ipm", "run_crossover": "on", "presolve": "on"}

_OPTIONS: Mapping[Algorithm, Mapping[str, Any]] = {"simplex": _SIMPLEX, "ipm": _IPM}

_STATUS = {
    highspy.HighsModelStatus.kOptimal: LimitStatus.OPTIMAL,
    highspy.HighsModelStatus.kInfeasible: LimitStatus.UNSTABLE,
    highspy.HighsModelStatus.kUnbounded: LimitStatus.UNBOUNDED,
}


class HighsSession:
    """One program in HiGHS, solved for one objective after another, each from the last basis.

    Parameters
    ----------
    program : EquilibriumProgram
        The equations.
    algorithm : {"simplex", "ipm"}
        "simplex" is dual for the first objective and primal from the last basis after it.
    """

    def __init__(self, program: EquilibriumProgram, algorithm: Algorithm = "simplex") -> None:
        self.limit = PIVOTS_PER_ROW * len(program.rhs) + 1000
        limit = {"simplex_iteration_limit": self.limit}
        self.highs = _loaded(program, {**_COMMON, **limit, **_OPTIONS[algorithm]})
        self.name = f"HiGHS {algorithm}"
        self._warm: Mapping[str, Any] = _FROM_BASIS if algorithm == "simplex" else {}
        self._costs = np.zeros(program.column_count)

    def minimise(self, costs: Floats) -> Solution:
        """Minimise costs . x; the basis that it ends with starts the next call.

        Parameters
        ----------
        costs : (columns,) float array
            Of alpha, then of the two edges of the friction cone at every contact point.
        """
        changed = np.flatnonzero(costs != self._costs).astype(np.int32)
        self.highs.changeColsCost(len(changed), changed, costs[changed])
        self._costs = costs.copy()
        self.highs.run()
        found = self.highs.getModelStatus()
        name = self.name
        if found == highspy.HighsModelStatus.kInfeasible and not self._has_ray():
            name = self._find_ray()
            found = self.highs.getModelStatus()
        status = _STATUS.get(found, LimitStatus.FAILED)
        said = self.highs.modelStatusToString(found)
        columns, duals = self._vectors(status)
        if status is LimitStatus.OPTIMAL:
            set_options(self.highs, self._warm)
        return Solution(status, columns, duals, said, name)

    def _find_ray(self) -> str:
        """Prove that there is no solution; return the name of what did.

        The interior point method proves nothing: the simplex method finds the ray.
        """
        set_options(self.highs, _SIMPLEX)
        self.highs.run()
        return f"{self.name}, then simplex"

    def _has_ray(self) -> bool:
        _, there = self.highs.getDualRayExist()  # type: ignore[attr-defined]  # missing in its types
        return bool(there)

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


def _loaded(program: EquilibriumProgram, options: Mapping[str, Any]) -> highspy.Highs:
    columns, rows = program.column_count, len(program.rhs)
    lower = np.zeros(columns)
    lower[0] = -highspy.kHighsInf
    upper = np.full(columns, highspy.kHighsInf)
    by_column, minimise, offset = 1, 1, 0.0
    highs = silent_highs(options)
    highs.passModel(
        columns, rows, len(program.value), by_column, minimise, offset, np.zeros(columns), lower,
        upper, program.rhs, program.rhs, program.start, program.index, program.value,
        np.zeros(columns, np.int32),
    )  # fmt: skip
    return highs
