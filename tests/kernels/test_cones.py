"""Columns of the limit analysis, and figures of its answers: against loops and linear algebra."""

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.cones import GROUND_BODY, cone_edges, figures
from drystone.kernels.simplex import Added, Cones
from tests.naive import columns as naive
from tests.strategies import repeatable


def test_points_may_be_slices_of_one_array():
    everything = np.arange(24.0).reshape(4, 6)
    wrenches = [((1, 2.0, 3.0), (0, 5.0, 1.0)), ((2, 0.0, 1.0), GROUND_BODY)]
    slices = [everything[:2, 1:3], everything[1::2, ::3]]
    found, whole = (
        cone_edges(wrenches, [(0.6, 0.8), (1.0, 0.0)], [0.5, 0.7], points, 3.0)
        for points in (slices, [part.copy() for part in slices])
    )
    for fast, slow in zip(found, whole, strict=True):
        assert np.array_equal(fast, slow)


def some_cones(rng, count, bodies):
    first = rng.integers(0, bodies, count).astype(np.int32)
    second = rng.integers(-1, bodies, count).astype(np.int32)
    entries = rng.normal(size=(6, count)).round(2)  # what acts on the ground is of no interest
    return Cones(first, second, np.ascontiguousarray(entries))


def some_answer(seed, built, new):
    """A program and anything that might be an answer; a third of the forces are 0."""
    rng = np.random.default_rng(seed)
    wall = some_cones(rng, int(rng.integers(0, 20)) if built else 0, max(built, 1))
    gone = rng.random(len(wall.first)) < 0.2
    closed = np.flatnonzero(gone).astype(np.int32)
    extra = some_cones(rng, int(rng.integers(0, 9)), max(built + new, 1))
    if not built + new:
        extra = some_cones(rng, 0, 1)
    added = Added(rng.random(new) + 0.5, extra, closed)
    forces = rng.normal(size=len(wall.first) - len(closed) + len(extra.first))
    forces[rng.random(len(forces)) < 1 / 3] = 0.0
    velocity = rng.normal(size=3 * (built + new)).round(1)
    return wall, rng.random(built) + 0.5, added, float(rng.normal()), forces, velocity


answers = st.builds(some_answer, st.integers(0, 10**6), st.integers(0, 4), st.integers(0, 3))


@repeatable(200)
@given(answers)
def test_figures_are_those_of_linear_algebra(answer):
    *program, forces, velocity = answer
    for carried in (forces, forces[:0]):
        found = figures(*program, carried, velocity)
        assert found == pytest.approx(naive.figures(*program, carried, velocity), abs=1e-12)
        assert all(type(figure) is float for figure in found)


def test_what_is_no_number_is_found_out_wherever_it_is():
    """By one of the figures that a certificate looks at."""
    wall, weights, added, alpha, forces, velocity = some_answer(3, 4, 2)
    touched = set(naive.program(wall, weights, added)[0].any(axis=1).nonzero()[0].tolist())
    nan = float("nan")
    for k, wrong in product(range(len(forces)), (nan, math.inf, -math.inf)):
        spoilt = forces.copy()
        spoilt[k] = wrong
        found = figures(wall, weights, added, alpha, spoilt, velocity)
        assert not found.residual < math.inf
        assert not found.total < math.inf
        assert math.isnan(found.residual) or not math.isnan(wrong)
    for k in touched:
        spoilt = velocity.copy()
        spoilt[k] = nan
        found = figures(wall, weights, added, alpha, forces, spoilt)
        assert math.isnan(found.inadmissible)
        assert math.isnan(found.largest)
    found = figures(wall, weights, added, nan, forces, velocity)
    assert math.isnan(found.residual)


def test_what_does_not_fit_together_is_refused():
    one = (((0, 0.0, 0.0), GROUND_BODY), (0.0, 1.0), 0.5, np.zeros((1, 2)))
    parts = [[part] for part in one]
    for k in range(4):
        with pytest.raises(ValueError, match="argument"):
            cone_edges(*parts[:k], parts[k] * 2, *parts[k + 1 :], 1.0)
    with pytest.raises(ValueError, match="points"):
        cone_edges(*parts[:3], [np.zeros((2, 3))], 1.0)
    *program, forces, velocity = some_answer(3, 4, 2)
    for others in ((forces[1:], velocity), ([*forces, 0.0], velocity), (forces, velocity[3:])):
        with pytest.raises(ValueError, match="another program"):
            figures(*program, *map(np.array, others))
