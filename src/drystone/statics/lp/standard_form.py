"""Small linear programs in standard form, by HiGHS: minimise c . x with A x = b, x >= 0."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import highspy
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from drystone.statics.lp.highs import TOLERANCE, corrected, silent_highs
from drystone.statics.lp.program import Floats

# Dual simplex without perturbed costs takes half the time of the primal method where only feasible
# unknowns are sought, from a basis with gaps.
_DUAL, _DEVEX = 1, 1
_OPTIONS: Mapping[str, Any] = {
    "threads": 1,
    "solver": "simplex",
    "presolve": "off",
    "simplex_scale_strategy": 0,
    "simplex_strategy": _DUAL,
    "simplex_dual_edge_weight_strategy": _DEVEX,
    "dual_simplex_cost_perturbation_multiplier": 0.0,
    "simplex_initial_condition_check": False,
    "primal_feasibility_tolerance": TOLERANCE,
    "dual_feasibility_tolerance": TOLERANCE,
    "simplex_iteration_limit": 10_000,  # it may cycle; what it gives up on is asked of the whole
}
_BASIC = highspy.HighsBasisStatus.kBasic
_AT_ZERO = highspy.HighsBasisStatus.kLower


class Vertex(NamedTuple):
    """An optimum.

    Parameters
    ----------
    unknowns : (columns,) float array
        x.
    duals : (rows,) float array
        y with c - y . A >= 0.
    """

    unknowns: Floats
    duals: Floats


def least(
    costs: Floats, matrix: csc_array, rhs: Floats, basic: NDArray[np.bool_] | None = None
) -> Vertex | None:
    """Return an optimum; None when there is none, whatever the reason.

    Parameters
    ----------
    costs : (columns,) float array
        c.
    matrix : csc_array
        A.
    rhs : (rows,) float array
        b.
    basic : (columns,) bool array, optional
        Unknowns that are basic at the start, at most as many as there are rows; they need not
        be independent.  HiGHS fills the gaps.
    """
    count, rows = len(costs), len(rhs)
    by_column, minimise, offset = 1, 1, 0.0
    highs = silent_highs(_OPTIONS)
    highs.passModel(
        count, rows, len(matrix.data), by_column, minimise, offset, costs, np.zeros(count),
        np.full(count, highspy.kHighsInf), rhs, rhs, matrix.indptr, matrix.indices, matrix.data,
        np.zeros(count, np.int32),
    )  # fmt: skip
    if basic is not None:
        basis = highspy.HighsBasis()
        basis.col_status = [_BASIC if is_basic else _AT_ZERO for is_basic in basic.tolist()]
        basis.row_status = [_AT_ZERO] * rows
        basis.valid = True
        basis.alien = True
        highs.setBasis(basis)
    highs.run()
    if highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        return None
    solution = highs.getSolution()
    unknowns, duals = np.array(solution.col_value), np.array(solution.row_dual)
    return Vertex(*corrected(highs, (costs, matrix, rhs), unknowns, duals))
