"""HiGHS: warm starts, answers corrected by their last basis, and programs in standard form."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog
from scipy.sparse import csc_array

from drystone.contacts.blocks import model_from_labels
from drystone.statics.local_update import least
from drystone.statics.lp.highs import HighsSession, WarmBasis, WarmSession, corrected
from drystone.statics.lp.program import assemble
from drystone.statics.result import LimitStatus
from tests.statics.walls import coursed, stacked
from tests.strategies import repeatable

WALL = assemble(model_from_labels(coursed(5, 4, 90)).model)
PILE = assemble(model_from_labels(stacked((20, 20, 0), (20, 20, 0)), 0.0).model)
"""Without friction alpha is 0, and the rows of the horizontal forces depend on each other: there
are slacks in its basis."""


def ask(program, sign=1.0):
    session = WarmSession(program)
    session.start_from(WarmBasis().appended(program.column_count, len(program.rhs)))
    costs = np.zeros(program.column_count)
    costs[0] = -sign
    solution = session.minimise(costs)
    return solution, costs, session


def errors(program, solution, costs):
    left = program.rhs - program.matrix @ solution.columns
    reduced_costs = costs - program.matrix.T @ solution.duals
    carry = solution.columns > 1e-6
    return np.abs(left).max(), np.abs(reduced_costs[carry]).max(), -reduced_costs[1:].min()


@pytest.mark.parametrize("program", [WALL, PILE], ids=["wall", "pile"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_drifted_is_put_right(program, sign, monkeypatch):
    exact, costs, _ = ask(program, sign)
    honest = HighsSession.minimise

    def drifted(session, costs):
        solution = honest(session, costs)
        rng = np.random.default_rng(0)
        basic = solution.columns > 0
        noise = 1e-6 * rng.normal(size=len(basic)) * basic
        return replace(
            solution,
            columns=solution.columns + noise,
            duals=solution.duals + 1e-6 * rng.normal(size=len(solution.duals)),
        )

    monkeypatch.setattr(HighsSession, "minimise", drifted)
    refined, costs, _ = ask(program, sign)
    assert max(errors(program, refined, costs)) < 1e-12
    assert refined.columns == pytest.approx(exact.columns, abs=1e-10)
    assert refined.duals == pytest.approx(exact.duals, abs=1e-10)
    monkeypatch.setattr("drystone.statics.lp.highs.RESIDUAL", 1.0)
    assert errors(program, ask(program, sign)[0], costs)[0] > 1e-7


def test_duals_are_not_made_worse(monkeypatch):
    """As factors without their last digits would."""
    exact, costs, session = ask(WALL)
    monkeypatch.setattr("drystone.statics.lp.highs.RESIDUAL", -1.0)
    highs = SimpleNamespace(
        getBasicVariables=session.highs.getBasicVariables,
        getBasisSolve=session.highs.getBasisSolve,
        getBasisTransposeSolve=lambda reduced_costs: (None, np.full(len(reduced_costs), 1e-3)),
    )
    columns, duals = corrected(highs, (costs, WALL.matrix, WALL.rhs), exact.columns, exact.duals)
    assert duals is exact.duals
    assert columns == pytest.approx(exact.columns, abs=1e-12)


def test_what_has_no_optimum_is_left_alone():
    floating = np.zeros((30, 20), np.uint32)
    floating[:10], floating[20:] = 1, 2
    solution, *_ = ask(assemble(model_from_labels(floating).model))
    assert solution.status is LimitStatus.UNSTABLE
    assert solution.duals is not None


def standard(seed, rows, columns):
    rng = np.random.default_rng(seed)
    matrix = rng.integers(-2, 3, (rows, columns)).astype(float)
    rhs = matrix @ rng.integers(0, 3, columns) if rng.random() < 0.7 else rng.normal(size=rows)
    basic = np.zeros(columns, bool)
    basic[rng.permutation(columns)[: int(rng.integers(0, rows + 1))]] = True
    return rng.integers(-1, 4, columns).astype(float), matrix, rhs, basic


@given(st.integers(0, 10**6), st.integers(1, 5), st.integers(1, 9))
@repeatable(60)
def test_small_programs_have_the_optimum_of_another_solver(seed, rows, columns):
    """From any start, also from columns that depend on each other."""
    costs, matrix, rhs, basic = standard(seed, rows, columns)
    expected = linprog(costs, A_eq=matrix, b_eq=rhs)
    for start in (None, basic):
        found = least(costs, csc_array(matrix), rhs, start)
        assert (found is None) == (expected.status != 0)
        if found is not None:
            assert costs @ found[0] == pytest.approx(expected.fun, abs=1e-9)
            assert found[1] @ rhs == pytest.approx(expected.fun, abs=1e-9)
            assert np.abs(matrix @ found[0] - rhs).max() < 1e-9
            assert found[0].min() > -1e-9
            assert (costs - found[1] @ matrix).min() > -1e-9
