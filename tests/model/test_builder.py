"""What a builder misses by."""

import math

import numpy as np
import pytest
import scipy.stats
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.polygons import area_and_centroid
from drystone.model.builder import HAND, LONGEST_EDGE, ROBOT, BuilderErrors, misjudged, stratified
from tests.naive import builder as naive
from tests.strategies import repeatable

BRICK = np.array([[-20.0, -10.0], [20.0, -10.0], [20.0, 10.0], [-20.0, 10.0]])
HOOK = np.array([[0.0, 0], [40, 0], [40, 8], [8, 8], [8, 40], [0, 40]]) - 13.0


def test_errors_of_a_precision():
    """DESIGN 4.10: p of the mean size along the wall, 2p/3 degrees for p in percent, p/2."""
    for precision, angle_deg in ((ROBOT, 1.0), (HAND, 2.0)):
        errors = BuilderErrors.of_precision(precision, 200.0)
        found = errors.placement, errors.angle_deg, errors.outline
        assert found == pytest.approx((200 * precision, angle_deg, 100 * precision))


@repeatable()
@given(st.integers(0, 2**31), st.floats(0.1, 4.0))
def test_a_misjudged_outline_is_that_of_its_twin(seed, sigma):
    all_waves = np.random.default_rng(seed).standard_normal((3, 2, 5))
    for found, waves in zip(misjudged(BRICK, sigma, all_waves), all_waves, strict=True):
        deep = waves * sigma / math.sqrt(5)
        plain = np.array(naive.misjudged(BRICK, deep, LONGEST_EDGE * math.sqrt(800)))
        _, x, y = area_and_centroid(plain)
        assert found == pytest.approx(plain - (x, y))


def test_outlines_stay_simple_and_twice_the_errors_move_a_block_twice_as_far():
    waves = np.random.default_rng(0).standard_normal((20, 2, 5))
    found = misjudged(HOOK, 6.0, waves)
    assert all(shapely.Polygon(one).is_valid for one in found)
    assert (misjudged(HOOK, 6.0, waves[7:8])[0] == found[7]).all()
    errors = BuilderErrors(placement=2.0, angle_deg=1.0, outline=0.0)
    corners = BRICK + np.array((100.0, 10.0))
    drawn = stratified(np.random.default_rng(5), 1, 1)[0]
    once, twice = (e.all_built(corners, drawn)[0] for e in (errors, errors.times(2.0)))
    assert twice.x - 100.0 == pytest.approx(2 * (once.x - 100.0))
    assert twice.angle_deg == pytest.approx(2 * once.angle_deg)
    assert once.x != 100.0
    assert once.y == pytest.approx(10.0)
    assert twice.size == pytest.approx(math.sqrt(800))


def test_few_runs_have_every_size_of_error_once():
    drawn = stratified(np.random.default_rng(1), 8, 25).reshape(8, -1)
    ranges = np.floor(8 * scipy.stats.norm.cdf(drawn)).astype(int)
    assert (np.sort(ranges, axis=0) == np.arange(8)[:, None]).all()
    # Numbers do not go together, nor do runs: each is free within its range.
    assert len(set(map(tuple, ranges.T.tolist()))) > 290
    assert abs(np.corrcoef(drawn.T)[0, 1:]).mean() < 0.45
    assert drawn.std() == pytest.approx(1.0, abs=0.05)
    # A run alone is drawn freely.
    alone = np.concatenate([stratified(np.random.default_rng(k), 1, 4).ravel() for k in range(40)])
    assert scipy.stats.kstest(alone, "norm").pvalue > 0.01
