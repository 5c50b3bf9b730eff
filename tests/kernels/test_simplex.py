"""The simplex kernel against programs that are solved whole, in fractions or by HiGHS."""

import zlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

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
    differing,
    grown,
    identical,
    needs_kernel,
    variants,
    with_columns,
)
from tests.naive import simplex as naive
from tests.statics.walls import coursed, irregular, stacked
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


def test_candidates_are_as_strong_as_walls_solved_whole():
    seen = {OPTIMAL: 0, UNSTABLE: 0}
    for step, (optima, choices) in enumerate(grown(irregular(5, 26, 110, 80), candidates=4)):
        for number, added in enumerate(choices):
            for sign in SIGNS:
                answer = optima[sign].solved_with(added)
                assert_right(optima[sign], added, answer, anew=(step + number) % 9 == 0)
                seen[answer.status] += 1
    assert seen[OPTIMAL] > 80
    assert len(optima[1].weights) > 15


def test_candidates_that_fall_are_proved_to():
    """Stones beside their supports, and stones that only later ones would hold."""
    falls = 0
    for optima, choices in grown(irregular(7, 30, 90, 90), candidates=9):
        for added in choices:
            answer = optima[1].solved_with(added)
            if answer.status == UNSTABLE:
                falls += 1
                assert_right(optima[1], added, answer, anew=falls % 6 == 0)
                assert optima[-1].solved_with(added).status == UNSTABLE
                assert np.isnan(answer.alpha)
                assert not answer.forces.size
    assert falls > 8


def test_several_bodies_at_once():
    """A stone and its wedges."""
    bodies = 0
    for optima, choices in grown(coursed(8, 4, 100), at_once=3):
        for sign in SIGNS:
            assert_right(optima[sign], choices[0], optima[sign].solved_with(choices[0]))
            assert len(optima[sign].velocity) == 3 * bodies
        bodies += 3
    assert bodies >= 15


def test_degenerate_candidates_and_contacts_that_go():
    seen = set()
    for step, (optima, choices) in enumerate(grown(irregular(4, 24, 100, 80))):
        if step % 4:
            continue
        for name, added in variants(optima[1], choices[0], step).items():
            for sign in SIGNS:
                answer = optima[sign].solved_with(added)
                assert_right(optima[sign], added, answer, anew=step % 8 == 0)
                seen.add((name, answer.status))
    assert len({name for name, _ in seen}) == 13
    assert {status for _, status in seen} == {OPTIMAL, UNSTABLE}


small = st.integers(-3, 3)


@st.composite
def programs(draw):
    """One or two bodies with any columns: a first stone with its wedge."""
    bodies = draw(st.integers(1, 2))
    body = st.integers(0, bodies - 1)
    edges = draw(
        st.lists(st.tuples(body, body, st.lists(small, min_size=6, max_size=6)), max_size=9)
    )
    first, second, entries = [], [], []
    for one, two, edge in edges:
        first.append(one)
        second.append(GROUND if one == two else two)
        entries.append([*edge[:3], 0, 0, 0] if one == two else edge)
    weights = draw(st.lists(st.integers(1, 3), min_size=bodies, max_size=bodies))
    return Added(np.array(weights, float), cones(first, second, entries), NOTHING)


@given(programs(), st.sampled_from(SIGNS))
@repeatable(250)
def test_programs_of_small_numbers_are_solved_exactly(added, sign):
    """All that can happen: optimal, infeasible, unbounded, with every kind of tie."""
    nothing = Optimum.of_nothing(sign)
    status, exact = naive.exactly_solved(naive.whole(nothing, added), sign)
    answer = nothing.solved_with(added)
    if status == naive.UNBOUNDED:
        assert answer.status == FAILED
        return
    assert answer.status == {naive.OPTIMAL: OPTIMAL, naive.UNSTABLE: UNSTABLE}[status]
    assert max(naive.errors(nothing, added, answer).values()) <= 1e-9
    if status == naive.OPTIMAL:
        assert answer.alpha == pytest.approx(float(exact), abs=1e-9)


def test_a_stone_on_its_edge_stands_and_carries_nothing():
    """Its centroid is right above the last point that bears it; further out it has to be held."""
    for shift, alpha in ((9, 0.1), (10, 0.0), (11, -0.1)):
        optima, choices = list(grown(stacked((20, 20, 0), (20, 20, shift))))[1]
        assert optima[1].solved_with(choices[0]).alpha == pytest.approx(alpha, abs=1e-12)
        assert optima[-1].solved_with(choices[0]).alpha < -0.4


def test_what_has_no_answer_fails():
    nothing = Added(np.empty(0), on_ground(), NOTHING)
    assert Optimum.of_nothing(1).solved_with(nothing).status == FAILED
    pit = stone(*SQUARE, (1, 0, 0), (-1, 0, 0))
    assert Optimum.of_nothing(1).solved_with(pit).status == FAILED
    one_sided = stone(*SQUARE, (1, 0, 0))
    assert Optimum.of_nothing(-1).solved_with(one_sided).status == FAILED
    assert Optimum.of_nothing(1).solved_with(one_sided).alpha == pytest.approx(1.0)
    hanging = stone((1, 0, 0), (-1, 0, 0))
    assert Optimum.of_nothing(1).solved_with(hanging).status == UNSTABLE
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


def test_the_wall_bears_what_the_stone_cannot():
    """A block on ice beside a wall: its own mechanism fixes alpha, and the wall rests."""
    optimum = Optimum.of_nothing(1)
    first = stone(*SQUARE)
    optimum = optimum.extended(first, optimum.solved_with(first))
    ice = cones([1, 1], [GROUND] * 2, [[0, 1, 0.5, 0, 0, 0], [0, 1, -0.5, 0, 0, 0]])
    answer = optimum.solved_with(Added(np.ones(1), ice, NOTHING))
    assert_right(optimum, Added(np.ones(1), ice, NOTHING), answer)
    assert answer.alpha == pytest.approx(0.0, abs=1e-15)
    assert np.abs(answer.velocity[:3]).max() < 1e-15


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
    first = stone(*SQUARE)
    optimum = Optimum.of_nothing(1).extended(first, Optimum.of_nothing(1).solved_with(first))
    for count in (2, 3000, 40, 6000):
        edges = cones([1] * count, [GROUND] * count, [[0, 1, i - 1, 0, 0, 0] for i in range(count)])
        answer = optimum.solved_with(Added(np.ones(1), edges, NOTHING))
        assert answer.alpha == pytest.approx(0.0, abs=1e-15)
        assert len(answer.forces) == 4 + count


def test_nothing_that_was_asked_changes_a_bit():
    """Neither the optimum, nor other answers, in any order and from several threads."""
    optima, choices = list(grown(irregular(2, 26, 100, 80), candidates=6))[9]
    basis = optima[1].basis
    arrays = [basis.inverse, basis.transposed, basis.values, basis.reduced_costs]
    arrays += [basis.secondary_costs, basis.basic, optima[1].cones.entries, optima[1].forces]
    before = [array.copy() for array in arrays]
    asked = [*choices, *variants(optima[1], choices[0], 0).values()]
    expected = [optima[1].solved_with(added) for added in asked]
    backwards = [optima[1].solved_with(added) for added in reversed(asked)]
    assert all(map(identical, expected, reversed(backwards)))
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(optima[1].solved_with, asked * 4))
    assert all(map(identical, found, expected * 4))
    grown_twice = [optima[1].extended(asked[0], expected[0]) for _ in range(2)]
    assert differing(*grown_twice) == []
    assert all(np.array_equal(a, b) for a, b in zip(arrays, before, strict=True))


def test_units_of_force_do_not_matter():
    """Exactly so for powers of two; closely for the rest, as small as they may be."""
    _, choices = next(grown(coursed(2, 2, 60)))
    plain = Optimum.of_nothing(1).solved_with(choices[0])
    for factor in (2.0**-30, 2.0**9, 1e-9, 1e7):
        scaled = replace(choices[0], weights=choices[0].weights * factor)
        answer = Optimum.of_nothing(1).solved_with(scaled)
        exact = factor in {2.0**-30, 2.0**9}
        tolerance = 0.0 if exact else 1e-13
        assert answer.alpha == pytest.approx(plain.alpha, abs=tolerance)
        assert answer.forces == pytest.approx(plain.forces * factor, rel=tolerance)
        assert answer.velocity == pytest.approx(plain.velocity / factor, rel=tolerance)


def test_arrays_that_do_not_fit_are_refused():
    good = stone(*SQUARE)
    optimum = Optimum.of_nothing(1).extended(good, Optimum.of_nothing(1).solved_with(good))
    edges = good.cones
    short = replace(edges, second=edges.second[:3])
    flat = replace(edges, entries=edges.entries[:5])
    for wrong in (short, flat):
        with pytest.raises(ValueError, match="different lengths"):
            optimum.solved_with(replace(good, cones=wrong))
    for closed in (-1, 4):
        with pytest.raises(ValueError, match=f"no column {closed} to close"):
            optimum.solved_with(replace(good, closed=np.array([closed], np.int32)))
    for both in ([1, 1], [2, 1]):
        with pytest.raises(ValueError, match="ascending"):
            optimum.solved_with(replace(good, closed=np.array(both, np.int32)))
    for first, second in ((2, -1), (-1, 0), (0, 2), (0, -2)):
        lost = cones([0, first], [-1, second], np.zeros((2, 6)))
        with pytest.raises(ValueError, match="column 1 is between bodies that are not there"):
            optimum.solved_with(replace(good, cones=lost))


def spoilt(optimum, **arrays):
    """The same with other arrays in its basis."""
    return replace(optimum, basis=replace(optimum.basis, **arrays))


def test_columns_that_nearly_repeat_do_not_go_in_circles():
    """Pairs with pivots of 1e-11 to 1e-6 between them."""
    optima, choices = list(grown(coursed(0, 6, 150)))[11]
    rng = np.random.default_rng(5)
    new = choices[0].cones
    for amount in 10.0 ** rng.uniform(-11, -6, 70):
        noise = 1.0 + amount * rng.standard_normal(new.entries.shape)
        again = replace(new, entries=new.entries * noise)
        for sign in SIGNS:
            answer = optima[sign].solved_with(with_columns(choices[0], again))
            assert answer.status == OPTIMAL
            assert answer.alpha == pytest.approx(optima[sign].alpha, abs=1e-5)


def test_columns_that_contradict_rows_are_noticed():
    """Before an exchange that would spoil the basis."""
    *_, (optima, choices) = grown(coursed(9, 4, 90), candidates=6)
    renewed = pivots = 0
    for sign in SIGNS:
        transposed = optima[sign].basis.transposed
        noise = 1.0 + 1e-3 * np.random.default_rng(3).standard_normal(transposed.shape)
        optimum = spoilt(optima[sign], transposed=transposed * noise)
        for added in choices:
            answer = optimum.solved_with(added)
            assert_right(optimum, added, answer)
            renewed += answer.restarts
            pivots += answer.pivots
    assert (renewed, pivots) == (2, 10)


def test_lost_digits_are_noticed_and_made_good():
    """With a spoilt inverse the basis is inverted anew; forces and falls stay right."""
    statuses = []
    for step, (optima, choices) in enumerate(grown(irregular(7, 30, 90, 90), candidates=9)):
        if step % 4 != 3:
            continue
        noise = np.random.default_rng(step).standard_normal(optima[1].basis.inverse.shape)
        inverse = optima[1].basis.inverse * (1.0 + 1e-7 * noise)
        optimum = spoilt(optima[1], inverse=inverse, transposed=np.ascontiguousarray(inverse.T))
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


@pytest.mark.parametrize("name", ["values", "reduced_costs", "secondary_costs"])
def test_a_wrong_start_costs_pivots_and_nothing_else(name):
    *_, (optima, choices) = grown(coursed(9, 4, 90), candidates=3)
    rng = np.random.default_rng(2)
    others = 0
    for sign in SIGNS:
        right = getattr(optima[sign].basis, name)
        wrong = rng.permutation(right) + rng.uniform(0.0, 0.5, right.shape)
        optimum = spoilt(optima[sign], **{name: wrong})
        for added in choices:
            answer = optimum.solved_with(added)
            assert_right(optimum, added, answer)
            others += answer.pivots != optima[sign].solved_with(added).pivots
    assert others > 0 or name == "secondary_costs"


def error_of(optimum):
    """How far the inverse of an optimum is from being one."""
    columns = []
    program = naive.whole(optimum, Added(np.empty(0), cones([], [], []), NOTHING))
    for variable in optimum.basis.basic.tolist():
        if variable >= 0:
            columns.append(program.matrix[:, variable])
        elif variable == -1:
            columns.append(optimum.sign * program.live / optimum.basis.unit)
        else:
            columns.append(np.eye(len(program.rhs))[-2 - variable])
    matrix = np.array(columns).T
    return np.abs(optimum.basis.inverse @ matrix - np.eye(len(matrix))).max()


def test_walls_that_grow_long_stay_accurate():
    *_, (optima, choices) = grown(coursed(21, 7, 170, 2))
    assert len(optima[1].weights) > 50
    for sign in SIGNS:
        answer = optima[sign].solved_with(choices[0])
        assert_right(optima[sign], choices[0], answer)
        assert error_of(optima[sign]) < 1e-11
        assert np.array_equal(optima[sign].basis.inverse.T, optima[sign].basis.transposed)


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
        drifted = spoilt(
            optima[sign],
            inverse=inverse * noise,
            transposed=np.ascontiguousarray((inverse * noise).T),
        )
        answer = drifted.solved_with(choices[0])
        assert (answer.status, answer.restarts) == (OPTIMAL, 0)
        assert error_of(drifted) > 1e-11
        assert error_of(drifted.extended(choices[0], answer)) < 1e-11
