"""The simplex kernel, both versions, against programs that are solved whole."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from drystone.kernels import simplex
from drystone.kernels.simplex import FAILED, OPTIMAL, UNSTABLE, Added, empty_tilt
from tests.kernels.simplex_walls import (
    KERNELS,
    NOTHING,
    SIGNS,
    assert_right,
    cones,
    differing,
    grown,
    identical,
    some_columns,
    variants,
)
from tests.naive import simplex as naive
from tests.statics.walls import coursed, irregular, stacked
from tests.strategies import label_images, repeatable

GROUND = -1


def on_ground(*edges):
    """Columns of one body on the ground, from (horizontal, vertical, moment)."""
    return cones([0] * len(edges), [GROUND] * len(edges), [[*edge, 0, 0, 0] for edge in edges])


def stone(*edges, weight=1.0):
    return Added(np.array([weight]), on_ground(*edges), NOTHING)


SQUARE = ((1.0, 1, 0), (-1, 1, -1), (1, 1, 1), (-1, 1, 0))
"""A square stone of side 1 on the ground with a friction of 1; edges at its two lower corners."""


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("labels", [coursed(3, 4, 110, 2), irregular(5, 26, 110, 80)])
def test_candidates_are_as_strong_as_walls_solved_whole(kernel, labels):
    seen = {OPTIMAL: 0, UNSTABLE: 0}
    for step, (tilts, choices) in enumerate(grown(labels, kernel, candidates=4)):
        for number, added in enumerate(choices):
            for sign in SIGNS:
                answer = kernel.solve(tilts[sign], added)
                assert_right(tilts[sign], added, answer, anew=(step + number) % 9 == 0)
                seen[answer.status] += 1
    assert seen[OPTIMAL] > 120
    assert len(tilts[1].weights) > 15


@pytest.mark.parametrize("kernel", KERNELS)
def test_candidates_that_fall_are_proved_to(kernel):
    """Stones beside their supports, and stones that only later ones would hold."""
    falls = 0
    for tilts, choices in grown(irregular(7, 30, 90, 90), kernel, candidates=9):
        for added in choices:
            answer = kernel.solve(tilts[1], added)
            if answer.status == UNSTABLE:
                falls += 1
                assert_right(tilts[1], added, answer, anew=falls % 6 == 0)
                assert kernel.solve(tilts[-1], added).status == UNSTABLE
                assert np.isnan(answer.alpha)
                assert not answer.forces.size
    assert falls > 8


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("at_once", [2, 3])
def test_several_bodies_at_once(kernel, at_once):
    """A stone and its wedges."""
    bodies = 0
    for tilts, choices in grown(coursed(8, 4, 100), kernel, at_once=at_once):
        for sign in SIGNS:
            assert_right(tilts[sign], choices[0], kernel.solve(tilts[sign], choices[0]))
            assert len(tilts[sign].velocity) == 3 * bodies
        bodies += at_once
    assert bodies >= 15


@pytest.mark.parametrize("kernel", KERNELS)
def test_degenerate_candidates_and_contacts_that_go(kernel):
    seen = set()
    for step, (tilts, choices) in enumerate(grown(irregular(4, 24, 100, 80), kernel)):
        if step % 4:
            continue
        for name, added in variants(tilts[1], choices[0], step).items():
            for sign in SIGNS:
                answer = kernel.solve(tilts[sign], added)
                assert_right(tilts[sign], added, answer, anew=step % 8 == 0)
                seen.add((name, answer.status))
    assert len({name for name, _ in seen}) == 13
    assert {status for _, status in seen} == {OPTIMAL, UNSTABLE}


@pytest.mark.parametrize("kernel", KERNELS)
def test_stones_of_any_shape_on_each_other(kernel):
    statuses = set()

    @given(label_images())
    @repeatable(25)
    def check(labels):
        if not labels.any():
            return
        for tilts, choices in grown(labels, kernel, candidates=2):
            for added in choices:
                for sign in SIGNS:
                    answer = kernel.solve(tilts[sign], added)
                    statuses.add(answer.status)
                    assert_right(tilts[sign], added, answer, anew=len(tilts[1].weights) == 2)

    check()
    assert statuses == {OPTIMAL, UNSTABLE}


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize(
    ("edges", "alpha"),
    [
        (SQUARE, 1),
        (((0.5, 1, -0.25), (-0.5, 1, -0.75), (0.5, 1, 0.75), (-0.5, 1, 0.25)), 0.5),
        (((1, 1, 0.5), (-1, 1, -0.5)), 0),
        (((2, 2, 0), (-1, 1, -1), (3, 3, 3)), 0),
    ],
)
def test_first_stones_are_solved_exactly(kernel, edges, alpha):
    """Against fractions: sliding, tipping, a point below the centroid, edges of any length."""
    for sign in SIGNS:
        added = stone(*edges)
        answer = kernel.solve(empty_tilt(sign), added)
        assert_right(empty_tilt(sign), added, answer)
        status, exact = naive.exactly_solved(naive.whole(empty_tilt(sign), added), sign)
        assert status == answer.status == OPTIMAL
        assert answer.alpha == pytest.approx(float(exact), abs=1e-15)
        if sign == 1:
            assert exact == alpha


@pytest.mark.parametrize("kernel", KERNELS)
def test_two_stones_are_solved_exactly(kernel):
    tilts, choices = list(grown(stacked((20, 30, 0), (18, 12, 5)), kernel))[1]
    for sign in SIGNS:
        _, exact = naive.exactly_solved(naive.whole(tilts[sign], choices[0]), sign)
        answer = kernel.solve(tilts[sign], choices[0])
        assert answer.alpha == pytest.approx(float(exact), abs=1e-14)


@pytest.mark.parametrize("kernel", KERNELS)
def test_a_stone_on_its_edge_stands_and_carries_nothing(kernel):
    """Its centroid is right above the last point that bears it; further out it has to be held."""
    for shift, alpha in ((9, 0.1), (10, 0.0), (11, -0.1)):
        tilts, choices = list(grown(stacked((20, 20, 0), (20, 20, shift)), kernel))[1]
        assert kernel.solve(tilts[1], choices[0]).alpha == pytest.approx(alpha, abs=1e-12)
        assert kernel.solve(tilts[-1], choices[0]).alpha < -0.4


@pytest.mark.parametrize("kernel", KERNELS)
def test_what_has_no_answer_fails(kernel):
    nothing = Added(np.empty(0), on_ground(), NOTHING)
    assert kernel.solve(empty_tilt(1), nothing).status == FAILED
    pit = stone(*SQUARE, (1, 0, 0), (-1, 0, 0))
    assert kernel.solve(empty_tilt(1), pit).status == FAILED
    one_sided = stone(*SQUARE, (1, 0, 0))
    assert kernel.solve(empty_tilt(-1), one_sided).status == FAILED
    assert kernel.solve(empty_tilt(1), one_sided).alpha == pytest.approx(1.0)
    hanging = stone((1, 0, 0), (-1, 0, 0))
    assert kernel.solve(empty_tilt(1), hanging).status == UNSTABLE
    with pytest.raises(ValueError, match="optimal"):
        simplex.grown_tilt(empty_tilt(1), pit, kernel.solve(empty_tilt(1), pit))


@pytest.mark.parametrize("kernel", KERNELS)
def test_a_limit_of_pivots_is_kept(kernel):
    spent = 0
    for tilts, choices in grown(coursed(6, 4, 80), kernel, candidates=4):
        for added in choices:
            answer = kernel.solve(tilts[1], added)
            if answer.pivots > 4:
                spent += 1
                assert kernel.solve(tilts[1], added, answer.pivots).alpha == answer.alpha
                short = kernel.solve(tilts[1], added, answer.pivots - 1)
                assert short.status == FAILED
                assert short.pivots == answer.pivots - 1
                assert not short.velocity.size
    assert spent > 10


@pytest.mark.parametrize("kernel", KERNELS)
def test_the_wall_bears_what_the_stone_cannot(kernel):
    """A block on ice beside a wall: its own mechanism fixes alpha, and the wall rests."""
    tilt = empty_tilt(1)
    first = stone(*SQUARE)
    tilt = kernel.grow(tilt, first, kernel.solve(tilt, first))
    ice = cones([1, 1], [GROUND] * 2, [[0, 1, 0.5, 0, 0, 0], [0, 1, -0.5, 0, 0, 0]])
    answer = kernel.solve(tilt, Added(np.ones(1), ice, NOTHING))
    assert_right(tilt, Added(np.ones(1), ice, NOTHING), answer)
    assert answer.alpha == pytest.approx(0.0, abs=1e-15)
    assert np.abs(answer.velocity[:3]).max() < 1e-15


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize(
    ("held", "restarts"),
    [
        (((-1, 0, 0.3),), 0),
        (((-1, 1, 1), (-1, -1, 0), (-1, 1, 0), (-1, -1, -1)), 1),
    ],
)
def test_a_stone_in_a_pit_props_the_wall(kernel, held, restarts):
    """The mechanism of the wall does not extend to a stone that cannot move to the right.

    One that may still tip begins with its own mechanism.  For one that is stuck costs are
    shifted.  The wall, a square of weight 1 with a friction of 0.2, then tips over the point that
    holds it, 0.3 above its middle: alpha is (0.5 + 0.8 x 0.2) / 0.3.
    """
    tilt = empty_tilt(1)
    first = stone((0.2, 1, -0.4), (-0.2, 1, -0.6), (0.2, 1, 0.6), (-0.2, 1, 0.4))
    tilt = kernel.grow(tilt, first, kernel.solve(tilt, first))
    ground = [[*edge, 0, 0, 0] for edge in (*SQUARE, *held)]
    pit = cones(
        [1] * (len(ground) + 1),
        [GROUND] * len(ground) + [0],
        [*ground, [1, 0, -0.3, -1, 0, 0.3]],
    )
    added = Added(np.ones(1), pit, NOTHING)
    answer = kernel.solve(tilt, added)
    assert_right(tilt, added, answer)
    assert tilt.alpha == pytest.approx(0.2)
    assert answer.alpha == pytest.approx(2.2)
    assert answer.restarts == restarts


@pytest.mark.parametrize("kernel", KERNELS)
def test_large_candidates_may_follow_small_ones(kernel):
    first = stone(*SQUARE)
    tilt = kernel.grow(empty_tilt(1), first, kernel.solve(empty_tilt(1), first))
    for count in (2, 3000, 40, 6000):
        edges = cones([1] * count, [GROUND] * count, [[0, 1, i - 1, 0, 0, 0] for i in range(count)])
        answer = kernel.solve(tilt, Added(np.ones(1), edges, NOTHING))
        assert answer.alpha == pytest.approx(0.0, abs=1e-15)
        assert len(answer.forces) == 4 + count


@pytest.mark.parametrize("kernel", KERNELS)
def test_a_tilt_says_what_its_answer_said(kernel):
    tilts, choices = list(grown(coursed(13, 3, 80), kernel))[8]
    for sign in SIGNS:
        base = tilts[sign]
        closing = replace(choices[0], closed=np.array([0, 3], np.int32))
        answer = kernel.solve(base, closing)
        tilt = kernel.grow(base, closing, answer)
        assert tilt.sign == sign
        assert tilt.alpha == answer.alpha
        assert tilt.forces is answer.forces
        assert tilt.velocity is answer.velocity
        assert tilt.weights.tolist() == [*base.weights, *closing.weights]
        left = np.delete(np.arange(len(base.cones.first)), [0, 3])
        kept = some_columns(base.cones, left)
        assert tilt.cones.first.tolist() == [*kept.first, *closing.cones.first]
        assert tilt.cones.second.tolist() == [*kept.second, *closing.cones.second]
        entries = np.concatenate((kept.entries, closing.cones.entries), axis=1)
        assert np.array_equal(tilt.cones.entries, entries)
        assert len(tilt.forces) == len(tilt.cones.first)


@pytest.mark.parametrize("kernel", KERNELS)
def test_nothing_that_was_asked_changes_a_bit(kernel):
    """Neither the tilt, nor other answers, in any order and from several threads."""
    tilts, choices = list(grown(irregular(2, 26, 100, 80), kernel, candidates=6))[9]
    arrays = [
        tilts[1].basis.rows, tilts[1].basis.cols, tilts[1].basis.levels, tilts[1].basis.rates,
        tilts[1].basis.ties, tilts[1].basis.heads, tilts[1].cones.entries, tilts[1].forces,
    ]  # fmt: skip
    before = [array.copy() for array in arrays]
    asked = [*choices, *variants(tilts[1], choices[0], 0).values()]
    expected = [kernel.solve(tilts[1], added) for added in asked]
    backwards = [kernel.solve(tilts[1], added) for added in reversed(asked)]
    assert all(map(identical, expected, reversed(backwards)))
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(lambda added: kernel.solve(tilts[1], added), asked * 4))
    assert all(map(identical, found, expected * 4))
    grown_twice = [kernel.grow(tilts[1], asked[0], expected[0]) for _ in range(2)]
    assert differing(*grown_twice) == []
    assert all(np.array_equal(a, b) for a, b in zip(arrays, before, strict=True))


@pytest.mark.parametrize("kernel", KERNELS)
def test_units_of_force_do_not_matter(kernel):
    """Exactly so for powers of two; closely for the rest, as small as they may be."""
    _, choices = next(grown(coursed(2, 2, 60), kernel))
    plain = kernel.solve(empty_tilt(1), choices[0])
    for factor in (2.0**-30, 2.0**9, 1e-9, 1e7):
        answer = kernel.solve(
            empty_tilt(1), replace(choices[0], weights=choices[0].weights * factor)
        )
        exact = factor in {2.0**-30, 2.0**9}
        tolerance = 0.0 if exact else 1e-13
        assert answer.alpha == pytest.approx(plain.alpha, abs=tolerance)
        assert answer.forces == pytest.approx(plain.forces * factor, rel=tolerance)
        assert answer.velocity == pytest.approx(plain.velocity / factor, rel=tolerance)


@pytest.mark.parametrize("kernel", KERNELS)
def test_arrays_that_do_not_fit_are_refused(kernel):
    good = stone(*SQUARE)
    tilt = kernel.grow(empty_tilt(1), good, kernel.solve(empty_tilt(1), good))
    edges = good.cones
    short = replace(edges, second=edges.second[:3])
    flat = replace(edges, entries=edges.entries[:5])
    for wrong in (short, flat):
        with pytest.raises(ValueError, match="different lengths"):
            kernel.solve(tilt, replace(good, cones=wrong))
    for closed in (-1, 4):
        with pytest.raises(ValueError, match=f"no column {closed} to close"):
            kernel.solve(tilt, replace(good, closed=np.array([closed], np.int32)))
    for both in ([1, 1], [2, 1]):
        with pytest.raises(ValueError, match="ascending"):
            kernel.solve(tilt, replace(good, closed=np.array(both, np.int32)))
    for first, second in ((2, -1), (-1, 0), (0, 2), (0, -2)):
        lost = cones([0, first], [-1, second], np.zeros((2, 6)))
        with pytest.raises(ValueError, match="column 1 is between bodies that are not there"):
            kernel.solve(tilt, replace(good, cones=lost))
