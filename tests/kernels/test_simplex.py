"""The simplex kernel against programs that are solved whole, by HiGHS."""

import operator
import zlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.simplex import FAILED, OPTIMAL, UNSTABLE, Added, Optimum
from tests.kernels.simplex_walls import (
    NOTHING,
    SIGNS,
    assert_right,
    cones,
    grown,
    needs_kernel,
    variants,
)
from tests.naive import simplex as naive
from tests.naive.columns import program
from tests.statics.walls import coursed, irregular
from tests.strategies import repeatable

pytestmark = needs_kernel

GROUND = -1


def on_ground(*edges):
    """Columns of one body on the ground, from (horizontal, vertical, moment)."""
    return cones([0] * len(edges), [GROUND] * len(edges), [[*edge, 0, 0, 0] for edge in edges])


def stone(*edges, weight=1.0):
    return Added(np.array([weight]), on_ground(*edges), NOTHING)


SQUARE = ((1.0, 1, 0), (-1, 1, -1), (1, 1, 1), (-1, 1, 0))
"""A square stone of side 1 on the ground with a friction of 1; edges at its two lower corners."""


def on_square(sign=1):
    """The optimum of a wall of the square."""
    first, nothing = stone(*SQUARE), Optimum.of_nothing(sign)
    return nothing.extended(first, nothing.solved_with(first))


@pytest.mark.parametrize(
    ("labels", "candidates", "at_once", "optimal", "unstable"),
    [
        (irregular(5, 26, 110, 80), 4, 1, 80, 0),
        (irregular(7, 30, 90, 90), 9, 1, 80, 16),  # stones that only later ones would hold
        (coursed(8, 4, 100), 1, 3, 10, 0),  # a stone and its wedges
    ],
)
def test_candidates_are_as_strong_as_walls_solved_whole(
    labels, candidates, at_once, optimal, unstable
):
    seen = {OPTIMAL: 0, UNSTABLE: 0}
    for optima, choices in grown(labels, candidates, at_once):
        for added in choices:
            for sign in SIGNS:
                answer = optima[sign].solved_with(added)
                assert_right(optima[sign], added, answer)
                seen[answer.status] += 1
                stands = answer.status == OPTIMAL
                assert (answer.alpha == answer.alpha, answer.forces.size > 0) == (stands, stands)
    assert seen[OPTIMAL] > optimal
    assert seen[UNSTABLE] >= unstable


def test_degenerate_candidates_and_contacts_that_go():
    seen = set()
    for step, (optima, choices) in enumerate(grown(irregular(4, 24, 100, 80))):
        if step % 4:
            continue
        for name, added in variants(optima[1], choices[0], step).items():
            for sign in SIGNS:
                answer = optima[sign].solved_with(added)
                assert_right(optima[sign], added, answer)
                seen.add((name, answer.status))
    assert len({name for name, _ in seen}) == 13
    assert {status for _, status in seen} == {OPTIMAL, UNSTABLE}


small = st.integers(-3, 3)


@st.composite
def programs(draw, below=0):
    """One or two bodies with any columns: a stone with its wedge, on some bodies of a wall."""
    bodies = draw(st.integers(1, 2))
    new, any_body = st.integers(below, below + bodies - 1), st.integers(0, below + bodies - 1)
    up = st.integers(draw(st.sampled_from([-3, 0])), 3)
    entries = st.tuples(small, up, small, small, up.map(operator.neg), small)
    edges = draw(st.lists(st.tuples(new, any_body, entries), max_size=9))
    first = [one for one, _, _ in edges]
    second = [GROUND if one == two else two for one, two, _ in edges]
    table = [[*edge[:3], 0, 0, 0] if one == two else edge for one, two, edge in edges]
    weights = draw(st.lists(st.integers(1, 3), min_size=bodies, max_size=bodies))
    return Added(np.array(weights, float), cones(first, second, table), NOTHING)


on_nothing_or_the_square = st.sampled_from([0, 1]).flatmap(
    lambda below: st.tuples(st.just(below), programs(below))
)


@given(on_nothing_or_the_square, st.sampled_from(SIGNS))
@repeatable(120)
def test_programs_of_small_numbers_end_as_they_do_in_highs(stone_on, sign):
    """All that can happen: optimal, infeasible, unbounded, with every kind of tie."""
    below, added = stone_on
    optimum = on_square(sign) if below else Optimum.of_nothing(sign)
    status, best = naive.solved(*program(optimum.cones, optimum.weights, added), sign)
    answer = optimum.solved_with(added)
    if status == naive.UNBOUNDED:
        assert answer.status == FAILED
        return
    assert answer.status == {naive.OPTIMAL: OPTIMAL, naive.UNSTABLE: UNSTABLE}[status]
    assert_right(optimum, added, answer)
    if status == naive.OPTIMAL:
        assert answer.alpha == pytest.approx(best, abs=1e-9)


def test_what_has_no_answer_fails():
    nothing = Added(np.empty(0), on_ground(), NOTHING)
    assert Optimum.of_nothing(1).solved_with(nothing).status == FAILED
    pit = stone(*SQUARE, (1, 0, 0), (-1, 0, 0))
    with pytest.raises(ValueError, match="optimal"):
        Optimum.of_nothing(1).extended(pit, Optimum.of_nothing(1).solved_with(pit))


def test_a_limit_of_pivots_is_kept():
    spent = 0
    for optima, choices in grown(coursed(6, 4, 80), candidates=4):
        for added in choices:
            answer = optima[1].solved_with(added)
            if answer.pivots > 4:
                spent += 1
                assert optima[1].solved_with(added, answer.pivots).alpha == answer.alpha
                short = optima[1].solved_with(added, answer.pivots - 1)
                assert short.status == FAILED
                assert short.pivots == answer.pivots - 1
                assert not short.velocity.size
    assert spent > 10


@pytest.mark.parametrize(
    ("held", "restarts"),
    [(((-1, 0, 0.3),), 0), (((-1, 1, 1), (-1, -1, 0), (-1, 1, 0), (-1, -1, -1)), 1)],
)
def test_a_stone_in_a_pit_props_the_wall(held, restarts):
    """The mechanism of the wall does not extend to a stone that cannot move to the right.

    One that may still tip begins with its own mechanism.  For one that is stuck costs are
    shifted.  The wall, a square of weight 1 with a friction of 0.2, then tips over the point that
    holds it, 0.3 above its middle: alpha is (0.5 + 0.8 x 0.2) / 0.3.
    """
    optimum = Optimum.of_nothing(1)
    first = stone((0.2, 1, -0.4), (-0.2, 1, -0.6), (0.2, 1, 0.6), (-0.2, 1, 0.4))
    optimum = optimum.extended(first, optimum.solved_with(first))
    ground = [[*edge, 0, 0, 0] for edge in (*SQUARE, *held)]
    pit = cones(
        [1] * (len(ground) + 1), [GROUND] * len(ground) + [0], [*ground, [1, 0, -0.3, -1, 0, 0.3]]
    )
    added = Added(np.ones(1), pit, NOTHING)
    answer = optimum.solved_with(added)
    assert_right(optimum, added, answer)
    assert optimum.alpha == pytest.approx(0.2)
    assert answer.alpha == pytest.approx(2.2)
    assert answer.restarts == restarts


def test_large_candidates_may_follow_small_ones():
    for count in (2, 3000, 40, 6000):
        edges = cones([1] * count, [GROUND] * count, [[0, 1, i - 1, 0, 0, 0] for i in range(count)])
        answer = on_square().solved_with(Added(np.ones(1), edges, NOTHING))
        assert answer.alpha == pytest.approx(0.0, abs=1e-15)
        assert len(answer.forces) == 4 + count


def test_nothing_that_was_asked_changes_a_bit():
    """Neither the optimum, nor other answers, in any order and from several threads."""
    optima, choices = list(grown(irregular(2, 26, 100, 80), candidates=6))[9]
    optimum, asked = optima[1], [*choices, *variants(optima[1], choices[0], 0).values()]
    before = [asdict(part) for part in (optimum.basis, optimum.cones)]
    expected = [asdict(optimum.solved_with(added)) for added in asked]
    backwards = [asdict(optimum.solved_with(added)) for added in reversed(asked)]
    np.testing.assert_equal(backwards[::-1], expected)
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(optimum.solved_with, asked * 4))
    np.testing.assert_equal(list(map(asdict, found)), expected * 4)
    one, other = (optimum.extended(asked[0], found[0]) for _ in range(2))
    np.testing.assert_equal(asdict(one.basis), asdict(other.basis))
    np.testing.assert_equal([asdict(part) for part in (optimum.basis, optimum.cones)], before)


def test_units_of_force_do_not_matter():
    """Exactly so for powers of two; closely for the rest, as small as they may be."""
    _, choices = next(grown(coursed(2, 2, 60)))
    plain = Optimum.of_nothing(1).solved_with(choices[0])
    for factor, tolerance in ((2.0**-30, 0.0), (2.0**9, 0.0), (1e-9, 1e-13), (1e7, 1e-13)):
        scaled = replace(choices[0], weights=choices[0].weights * factor)
        answer = Optimum.of_nothing(1).solved_with(scaled)
        assert answer.alpha == pytest.approx(plain.alpha, abs=tolerance)
        assert answer.forces == pytest.approx(plain.forces * factor, rel=tolerance)
        assert answer.velocity == pytest.approx(plain.velocity / factor, rel=tolerance)


def test_arrays_that_do_not_fit_are_refused():
    good = stone(*SQUARE)
    edges, some = good.cones, np.zeros((2, 6))
    wrong = {
        "different lengths": [
            {"cones": replace(edges, second=edges.second[:3])},
            {"cones": replace(edges, entries=edges.entries[:5])},
        ],
        "no column .* to close": [{"closed": np.array([k], np.int32)} for k in (-1, 4)],
        "ascending": [{"closed": np.array(both, np.int32)} for both in ([1, 1], [2, 1])],
        "column 1 is between bodies that are not there": [
            {"cones": cones([0, first], [-1, second], some)}
            for first, second in ((2, -1), (-1, 0), (0, 2), (0, -2))
        ],
    }
    for message, cases in wrong.items():
        for case in cases:
            with pytest.raises(ValueError, match=message):
                on_square().solved_with(replace(good, **case))


def spoilt(optimum, **arrays):
    """The same with other arrays in its basis."""
    return replace(optimum, basis=replace(optimum.basis, **arrays))


def with_inverse(optimum, inverse):
    return spoilt(optimum, inverse=inverse, transposed=np.ascontiguousarray(inverse.T))


def test_lost_digits_are_noticed_and_made_good():
    """With a spoilt inverse the basis is inverted anew; forces and falls stay right."""
    statuses = []
    for step, (optima, choices) in enumerate(grown(irregular(7, 30, 90, 90), candidates=9)):
        if step % 4 != 3:
            continue
        noise = np.random.default_rng(step).standard_normal(optima[1].basis.inverse.shape)
        inverse = optima[1].basis.inverse * (1.0 + 1e-7 * noise)
        optimum = with_inverse(optima[1], inverse)
        for added in choices:
            answer = optimum.solved_with(added)
            if answer.status != FAILED:
                assert_right(optimum, added, answer)
            if answer.restarts:
                statuses.append(answer.status)
        if answer.restarts and answer.status == OPTIMAL:
            assert error_of(optimum.extended(added, answer)) < 1e-11
    assert statuses.count(OPTIMAL) > 15
    assert statuses.count(UNSTABLE) > 5
    assert statuses.count(FAILED) < 3


def error_of(optimum):
    """How far the inverse of an optimum is from being one."""
    columns, nothing = [], Added(np.empty(0), cones([], [], []), NOTHING)
    matrix, live, rhs = program(optimum.cones, optimum.weights, nothing)
    for variable in optimum.basis.basic.tolist():
        if variable >= 0:
            columns.append(matrix[:, variable])
        elif variable == -1:
            columns.append(optimum.sign * live / optimum.basis.unit)
        else:
            columns.append(np.eye(len(rhs))[-2 - variable])
    matrix = np.array(columns).T
    return np.abs(optimum.basis.inverse @ matrix - np.eye(len(matrix))).max()


def asked_of(labels):
    """Many questions about one wall: candidates, degenerate ones, and bases that are spoilt."""
    for step, (optima, choices) in enumerate(grown(labels, candidates=3)):
        asked = list(choices)
        if step % 4 == 1:
            # Random ones are left out: their numbers are not promised for ever.
            named = variants(optima[1], choices[0], step)
            names = ("twice", "nothing", "a point", "heavy", "light", "closed, basic")
            asked += [named[name] for name in (*names, "only closed")]
        for sign in SIGNS:
            yield from ((optima[sign], added) for added in asked)
            transposed = optima[sign].basis.transposed
            wave = (np.arange(transposed.size) * 7919 % 101 - 50.0).reshape(transposed.shape)
            if step % 4 == 3:
                wrong = spoilt(optima[sign], transposed=transposed * (1.0 + 2e-5 * wave))
                yield from ((wrong, added) for added in asked)


@pytest.mark.parametrize(
    ("labels", "pivots", "restarts", "checksum"),
    [
        (coursed(11, 5, 130, 2), 1645, 38, 3240589044),
        (irregular(12, 30, 110, 90), 2183, 42, 1189705956),
    ],
)
def test_the_way_and_the_bits_are_as_they_were(labels, pivots, restarts, checksum):
    """The same on every machine, or plans would not be; whoever changes the method changes them.

    A wrong rule may still end at the optimum, by a longer way.
    """
    told, ways = 0, np.zeros(2, int)
    for optimum, added in asked_of(labels):
        answer = optimum.solved_with(added)
        arrays = [np.array([answer.alpha]), answer.forces, answer.velocity]
        if answer.status == OPTIMAL and answer.pivots % 6 == 0:
            basis = optimum.extended(added, answer).basis
            arrays += [basis.inverse, basis.values, basis.reduced_costs, basis.secondary_costs]
        for array in arrays:
            told = zlib.crc32((array + 0.0).tobytes(), told)
        ways += (answer.pivots, answer.restarts)
    assert ways.tolist() == [pivots, restarts]
    assert told == checksum


def test_a_wall_does_not_inherit_errors_of_its_inverse():
    """Too small to be noticed in an answer, they would grow from stone to stone."""
    *_, (optima, choices) = grown(coursed(9, 4, 90))
    for sign in SIGNS:
        inverse = optima[sign].basis.inverse
        noise = 1.0 + 1e-10 * np.random.default_rng(4).standard_normal(inverse.shape)
        drifted = with_inverse(optima[sign], inverse * noise)
        answer = drifted.solved_with(choices[0])
        assert (answer.status, answer.restarts) == (OPTIMAL, 0)
        assert error_of(drifted) > 1e-11
        renewed = drifted.extended(choices[0], answer)
        assert error_of(renewed) < 1e-11
        assert np.array_equal(renewed.basis.inverse.T, renewed.basis.transposed)
