"""Parts of the simplex kernel in NumPy against plain loops and fractions."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.simplex_choice import added_up, blocking, entering, leaving, scattered
from drystone.kernels.simplex_inverse import BorderedInverse, inverted
from drystone.kernels.simplex_small import FOUND, NO_BOUND, NO_FORCES, solve_small
from drystone.kernels.simplex_types import Basis
from tests.naive import simplex as naive
from tests.strategies import repeatable

small = st.integers(-3, 3)
EXPECTED = {naive.OPTIMAL: FOUND, naive.UNSTABLE: NO_FORCES, naive.UNBOUNDED: NO_BOUND}


@st.composite
def programs(draw):
    rows, count = draw(st.integers(1, 4)), draw(st.integers(0, 7))
    columns = draw(st.lists(small, min_size=rows * count, max_size=rows * count))
    rhs = draw(st.lists(small, min_size=rows, max_size=rows))
    costs = draw(st.lists(small, min_size=count, max_size=count))
    return np.array(columns, float).reshape(rows, count), np.array(rhs, float), costs


@given(programs())
@repeatable(400)
def test_small_programs_are_solved(program):
    columns, rhs, costs = program
    status, value = naive.exact_minimum(columns, rhs, costs)
    answer = solve_small(columns, rhs, np.array(costs, float))
    assert answer.status == EXPECTED[status]
    if answer.status == NO_FORCES:
        assert (answer.fall @ columns >= -1e-12).all()
        assert answer.fall @ rhs < -1e-9
    if answer.status == FOUND:
        assert (answer.costs >= -1e-11).all()
        basic = answer.heads[answer.heads < columns.shape[1]]
        assert np.abs(answer.costs[basic]).max(initial=0.0) < 1e-12
        forces = np.linalg.lstsq(columns[:, basic], rhs, rcond=None)[0]
        assert (forces >= -1e-5).all()  # the program is lifted by a millionth
        assert np.array(costs)[basic] @ forces == pytest.approx(float(value), abs=1e-9)


def test_a_program_without_rows_has_a_solution():
    assert solve_small(np.empty((0, 2)), np.empty(0), np.ones(2)).status == FOUND
    assert solve_small(np.empty((0, 2)), np.empty(0), -np.ones(2)).status == NO_BOUND


def test_scattered_numbers_are_those_of_splitmix64():
    """First outputs for seed 0, as published with the generator."""
    expected = [0xE220A8397B1DCDAF, 0x6E789E6AA1B965F4, 0x06C45D188009454F]
    assert scattered(0, 3).tolist() == [(word >> 11) * 2.0**-53 for word in expected]
    assert scattered(1, 2).tolist() == scattered(0, 3)[1:].tolist()
    many = scattered(0, 20000)
    assert np.histogram(many, 10, (0, 1))[0] == pytest.approx(np.full(10, 2000), abs=150)


@given(st.integers(1, 6), st.integers(0, 9))
@repeatable(30)
def test_rows_are_added_one_after_the_other(width, count):
    terms = np.random.default_rng(count).standard_normal((count + 1, width)) * 1e3 ** np.arange(
        width
    )
    total = terms[0].copy()
    for row in terms[1:]:
        total += row
    assert added_up(terms).tolist() == total.tolist()


numbers = st.sampled_from([-2.0, -1.0, -1e-7, -1e-12, 0.0, 1e-12, 1e-7, 0.5, 1.0, 2.0, 3.0])
PIVOTS = st.sampled_from([1e-6, 1e-9])


def within(slopes, costs, places, slack):
    """Places whose ratio is not above the least one with slack."""
    costs = [max(cost, 0.0) for cost in costs]
    least = min(((costs[j] + slack) / slopes[j] for j in places), default=0.0)
    return [j for j in places if costs[j] <= least * slopes[j]]


def chosen(slopes, rates, ties, places):
    for costs, slack in ((rates, 1e-10), (ties, 0.1)):
        places = within(slopes, costs, places, slack)
    return max(places, key=lambda j: slopes[j], default=-1)


@given(st.lists(st.tuples(numbers, numbers, numbers), max_size=8), PIVOTS)
@repeatable(300)
def test_the_column_that_enters_is_that_of_a_loop(rows, pivot):
    slopes, rates, ties = np.array(rows).reshape(-1, 3).T
    able = [j for j, slope in enumerate(slopes) if slope > pivot]
    assert entering(slopes, rates, ties, pivot) == chosen(slopes, rates, ties, able)


@given(
    st.lists(st.tuples(numbers, numbers, numbers, st.booleans()), min_size=1, max_size=8), PIVOTS
)
@repeatable(300)
def test_the_place_that_is_emptied_is_that_of_a_loop(rows, pivot):
    column, levels, ties = np.array([row[:3] for row in rows]).T
    fixed = np.array([row[3] for row in rows])
    alpha_place = len(rows) // 2
    fixed[alpha_place] = False
    stuck = [i for i in range(len(rows)) if fixed[i] and abs(column[i]) > pivot]
    able = [i for i in range(len(rows)) if not fixed[i] and column[i] > pivot and i != alpha_place]
    expected = chosen(column, levels, ties, able)
    if stuck:
        expected = max(stuck, key=lambda i: abs(column[i]))
    assert blocking(column, levels, ties, fixed, alpha_place, pivot) == expected


@given(st.lists(st.tuples(numbers, numbers, st.booleans()), min_size=1, max_size=8))
@repeatable(300)
def test_the_place_that_leaves_is_that_of_a_loop(rows):
    levels, steps = np.array([row[:2] for row in rows]).T
    fixed = np.array([row[2] for row in rows])
    alpha_place = len(rows) // 2
    reach = {}
    for i, (level, step) in enumerate(zip(levels, steps, strict=True)):
        excess = abs(level) if fixed[i] else -level
        towards = -step if fixed[i] and level > 0 else step
        if i != alpha_place and excess > 1e-10:
            reach[i] = excess / towards if towards > 1e-14 else 1e30
    expected = max(reach, key=lambda i: reach[i], default=-1)
    assert leaving(levels, steps, fixed, alpha_place) == expected


def wall_and_border(rng, bodies, new):
    """An inverse with alpha basic somewhere, its matrix, and the live load on new bodies."""
    old = 3 * bodies
    matrix = rng.standard_normal((old, old)) + 3.0 * np.eye(old)
    place = int(rng.integers(old)) if old else -1
    live = np.zeros(3 * new)
    live[::3] = rng.random(new) + 0.5
    rows = np.linalg.inv(matrix)
    none = np.empty(0)
    basis = Basis(
        1.0, place, np.arange(old, dtype=np.int32), none, rows, np.ascontiguousarray(rows.T),
        none, none,
    )  # fmt: skip
    whole = np.zeros((old + 3 * new, old + 3 * new))
    whole[:old, :old] = matrix
    whole[old:, old:] = np.eye(3 * new)
    if old:
        whole[old:, place] = live
    return basis, whole, live


@pytest.mark.parametrize("bodies", [0, 1, 4])
@pytest.mark.parametrize("new", [0, 1, 3])
def test_the_inverse_follows_exchanges(bodies, new):
    """Rows, the whole table, and products, after exchanges of the same and of other places."""
    rng = np.random.default_rng(10 * bodies + new)
    basis, matrix, live = wall_and_border(rng, bodies, new)
    size = len(matrix)
    kept = basis.rows.copy()
    inverse = BorderedInverse(replace(basis), live)
    for step in range(4 * size):
        expected = np.linalg.inv(matrix)
        vector = rng.standard_normal(size)
        assert inverse.table() == pytest.approx(expected, abs=1e-9)
        assert inverse.row(step % size).tolist() == inverse.table()[step % size].tolist()
        assert inverse.times_all(vector) == pytest.approx(expected @ vector, abs=1e-9)
        rows = rng.choice(size, min(6, size), replace=False)
        entries = rng.standard_normal(len(rows))
        column = inverse.times(rows, entries)
        assert column == pytest.approx(expected[:, rows] @ entries, abs=1e-9)
        place = int(np.argmax(np.abs(column))) if step % 3 else int(rng.integers(size))
        if abs(column[place]) > 0.3:
            inverse.exchange(place, column)
            matrix[:, place] = 0.0
            matrix[rows, place] = entries
    assert np.array_equal(basis.rows, kept)


@pytest.mark.parametrize("size", [1, 2, 9, 30])
def test_matrices_are_inverted(size):
    rng = np.random.default_rng(size)
    matrix = rng.standard_normal((size, size))
    matrix[0, 0] = 0.0 if size > 1 else 2.0
    before = matrix.copy()
    assert inverted(matrix) @ matrix == pytest.approx(np.eye(size), abs=1e-11)
    assert np.array_equal(matrix, before)
    matrix[-1] = 2.0 * matrix[0] if size > 1 else 0.0
    assert inverted(matrix) is None
