"""The simplex kernel where digits are lost: inverses that drift, columns that nearly repeat."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.kernels.simplex import FAILED, OPTIMAL, UNSTABLE, Added
from tests.kernels.simplex_walls import (
    KERNELS,
    NOTHING,
    NUMPY,
    SIGNS,
    assert_right,
    cones,
    grown,
    identical,
    settled,
    with_columns,
)
from tests.naive import simplex as naive
from tests.statics.walls import coursed, irregular


def spoilt(tilt, **arrays):
    """The tilt with other arrays in its basis."""
    return settled(replace(tilt, basis=replace(tilt.basis, **arrays)))


@pytest.mark.parametrize("kernel", KERNELS)
def test_columns_that_nearly_repeat_do_not_go_in_circles(kernel):
    """Pairs with pivots of 1e-11 to 1e-6 between them."""
    tilts, choices = list(grown(coursed(0, 6, 150), kernel))[11]
    rng = np.random.default_rng(5)
    new = choices[0].cones
    for amount in 10.0 ** rng.uniform(-11, -6, 70):
        noise = 1.0 + amount * rng.standard_normal(new.entries.shape)
        again = replace(new, entries=new.entries * noise)
        for sign in SIGNS:
            answer = kernel.solve(tilts[sign], with_columns(choices[0], again))
            assert answer.status == OPTIMAL
            assert answer.alpha == pytest.approx(tilts[sign].alpha, abs=1e-5)


@pytest.mark.parametrize("kernel", KERNELS)
def test_columns_that_contradict_rows_are_noticed(kernel):
    """Before an exchange that would spoil the basis."""
    *_, (tilts, choices) = grown(coursed(9, 4, 90), kernel, candidates=6)
    renewed = 0
    for sign in SIGNS:
        cols = tilts[sign].basis.cols
        noise = 1.0 + 1e-3 * np.random.default_rng(3).standard_normal(cols.shape)
        tilt = spoilt(tilts[sign], cols=cols * noise)
        for added in choices:
            answer = kernel.solve(tilt, added)
            assert identical(answer, NUMPY.solve(tilt, added))
            assert_right(tilt, added, answer)
            renewed += answer.restarts
    assert renewed > 1


@pytest.mark.parametrize("kernel", KERNELS)
def test_lost_digits_are_noticed_and_made_good(kernel):
    """With a spoilt inverse the basis is inverted anew; forces and falls stay right."""
    statuses = []
    for step, (tilts, choices) in enumerate(grown(irregular(7, 30, 90, 90), kernel, candidates=9)):
        if step % 4 != 3:
            continue
        noise = np.random.default_rng(step).standard_normal(tilts[1].basis.rows.shape)
        rows = tilts[1].basis.rows * (1.0 + 1e-7 * noise)
        tilt = spoilt(tilts[1], rows=rows, cols=np.ascontiguousarray(rows.T))
        for added in choices:
            answer = kernel.solve(tilt, added)
            assert identical(answer, NUMPY.solve(tilt, added))
            if answer.status != FAILED:
                assert_right(tilt, added, answer)
            if answer.restarts:
                statuses.append(answer.status)
        if answer.restarts and answer.status == OPTIMAL:
            assert error_of(kernel.grow(tilt, added, answer)) < 1e-11
    assert statuses.count(OPTIMAL) > 15
    assert statuses.count(UNSTABLE) > 5
    assert statuses.count(FAILED) < 3


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("name", ["levels", "rates", "ties"])
def test_a_wrong_start_costs_pivots_and_nothing_else(kernel, name):
    *_, (tilts, choices) = grown(coursed(9, 4, 90), kernel, candidates=3)
    rng = np.random.default_rng(2)
    others = 0
    for sign in SIGNS:
        right = getattr(tilts[sign].basis, name)
        wrong = rng.permutation(right) + rng.uniform(0.0, 0.5, right.shape)
        tilt = spoilt(tilts[sign], **{name: wrong})
        for added in choices:
            answer = kernel.solve(tilt, added)
            assert_right(tilt, added, answer)
            assert identical(answer, NUMPY.solve(tilt, added))
            others += answer.pivots != kernel.solve(tilts[sign], added).pivots
    assert others > 0 or name == "ties"


def error_of(tilt):
    """How far the inverse of a tilt is from being one."""
    columns = []
    program = naive.whole(tilt, Added(np.empty(0), cones([], [], []), NOTHING))
    for head in tilt.basis.heads.tolist():
        if head >= 0:
            columns.append(program.matrix[:, head])
        elif head == -1:
            columns.append(tilt.sign * program.live / tilt.basis.unit)
        else:
            columns.append(np.eye(len(program.rhs))[-2 - head])
    matrix = np.array(columns).T
    return np.abs(tilt.basis.rows @ matrix - np.eye(len(matrix))).max()


@pytest.mark.parametrize("kernel", KERNELS)
def test_walls_that_grow_long_stay_accurate(kernel):
    labels = coursed(21, 7, 170, 2) if kernel.name == "compiled" else coursed(21, 4, 100, 2)
    *_, (tilts, choices) = grown(labels, kernel)
    assert len(tilts[1].weights) > (50 if kernel.name == "compiled" else 15)
    for sign in SIGNS:
        answer = kernel.solve(tilts[sign], choices[0])
        assert_right(tilts[sign], choices[0], answer)
        assert error_of(tilts[sign]) < 1e-11
        assert np.array_equal(tilts[sign].basis.rows.T, tilts[sign].basis.cols)
