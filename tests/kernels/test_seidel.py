"""Small linear programs against scipy's."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

from drystone.kernels.seidel import solve
from tests.strategies import repeatable


@st.composite
def programs(draw):
    """Rows of unit normals; tight, loose, doubled, opposite, or through one point."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    count = draw(st.integers(0, 24))
    rows = rng.normal(size=(count, 4))
    rows[:, :3] /= np.linalg.norm(rows[:, :3], axis=1, keepdims=True)
    kind = draw(st.sampled_from(["any", "feasible", "through 0", "slabs", "flat"]))
    if kind in ("feasible", "flat"):
        rows[:, 3] = np.abs(rows[:, 3])
    if kind == "through 0":
        rows[:, 3] = 0.0
    if kind == "slabs":
        other = -rows * [1, 1, 1, rng.choice([1.0, -1.0, 0.5])]
        rows = np.vstack([rows, other, rows])
    if kind == "flat":
        rows[:, 2] = 0.0
    gain = rng.normal(size=3) if draw(st.booleans()) else np.array([-0.3, -1.0, 0.0])
    return np.ascontiguousarray(rows), gain, rng.uniform(0.0, 3.0, 3) * rng.integers(0, 2, 3) + 0.1


def test_gains_what_scipy_gains():
    seen = set()

    @repeatable(200)
    @given(programs())
    def check(program):
        rows, gain, most = program
        found = solve(rows, gain, most)
        expected = linprog(
            -gain, rows[:, :3], rows[:, 3], bounds=list(zip(-most, most, strict=True))
        )
        feasible = expected.status == 0
        seen.add(feasible)
        assert feasible == (found is not None)
        if found is not None:
            x = np.array(found)
            assert (rows[:, :3] @ x <= rows[:, 3] + 1e-7).all()
            assert (np.abs(x) <= most + 1e-7).all()
            assert gain @ x == pytest.approx(-expected.fun, abs=1e-6)

    check()
    assert seen == {True, False}


def test_where_nothing_is_gained_nothing_moves():
    down, box = np.array([0.0, -1.0, 0.0]), np.full(3, 5.0)
    assert solve(np.zeros((0, 4)), down, box) == (0.0, -5.0, 0.0)
    assert solve(np.zeros((0, 4)), np.array([1e-13, -1.0, -1e-13]), box) == (0.0, -5.0, 0.0)
    # A flat support, and rounding in what is gained along it.
    flat = np.array([[0.0, -1.0, 0.5, 1.0], [0.0, -1.0, -0.5, 1.0], [1e-17, -1.0, 0.2, 1.0]])
    assert solve(flat, down, box) == pytest.approx((0.0, -1.0, 0.0), abs=1e-12)
    # The smallest move that keeps off from a side.
    aside = np.vstack([flat, [-1.0, 0.0, 0.0, -2.0]])
    assert solve(aside, down, box) == pytest.approx((2.0, -1.0, 0.0), abs=1e-12)
    for sign in (1.0, -1.0):
        both = np.array([[0.0, -1.0, 0.0, 1.0], [-sign, 0.0, 0.0, -2.0], [0.0, 0.0, -sign, -1.0]])
        assert solve(both, down, box) == pytest.approx((2.0 * sign, -1.0, sign), abs=1e-12)


def test_rows_without_coefficients_only_say_whether_there_is_a_solution():
    gain, box = np.array([1.0, 1.0, 1.0]), np.ones(3)
    assert solve(np.array([[0.0, 0.0, 0.0, 0.0]]), gain, box) == (1.0, 1.0, 1.0)
    assert solve(np.array([[0.0, 0.0, 0.0, -1.0]]), gain, box) is None


def test_arrays_of_other_shapes_are_refused():
    with pytest.raises(ValueError, match="three numbers"):
        solve(np.zeros((2, 3)), np.zeros(3), np.zeros(3))
    with pytest.raises(ValueError, match="three numbers"):
        solve(np.zeros((2, 4)), np.zeros(2), np.zeros(3))
