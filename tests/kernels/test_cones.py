"""Columns of the limit analysis: against plain loops."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.cones import GROUND_BODY, cone_edges
from tests.naive import columns as naive
from tests.strategies import repeatable

numbers = st.floats(-50.0, 50.0).map(lambda x: round(x, 3))
bodies = st.tuples(st.integers(0, 5), numbers, numbers)
angles = st.floats(0.0, 6.3)
normals = st.one_of(
    st.sampled_from([(0.0, 1.0), (-1.0, 0.0)]),
    angles.map(lambda a: (float(np.cos(a)), float(np.sin(a)))),
)
points = st.lists(st.tuples(numbers, numbers), min_size=1, max_size=3).map(np.array)
interfaces = st.lists(
    st.tuples(
        st.tuples(bodies, st.one_of(bodies, st.just(GROUND_BODY))),
        normals,
        st.one_of(st.just(0.0), st.floats(0.0, 2.0)),
        points,
    ),
    max_size=6,
)
lengths = st.floats(0.1, 40.0)


def columns(found, length):
    parts = [list(part) for part in zip(*found, strict=True)] or [[], [], [], []]
    return cone_edges(*parts, length)


@repeatable(100)
@given(interfaces, lengths)
def test_columns_are_those_of_a_loop(found, length):
    first, second, entries = columns(found, length)
    parts = [list(part) for part in zip(*found, strict=True)] or [[], [], [], []]
    expected = naive.cone_edges(*parts, length)
    assert first.tolist() == [column[0] for column in expected]
    assert second.tolist() == [column[1] for column in expected]
    assert entries.shape == (6, len(expected))
    if expected:
        sought = np.array([column[2] for column in expected]).T
        np.testing.assert_allclose(entries, sought, rtol=1e-12, atol=1e-9)


def test_points_may_be_slices_of_one_array():
    everything = np.arange(24.0).reshape(4, 6)
    wrench = [((1, 2.0, 3.0), (0, 5.0, 1.0)), ((2, 0.0, 1.0), GROUND_BODY)]
    slices = [everything[:2, 1:3], everything[1::2, ::3]]
    found = list(zip(wrench, [(0.6, 0.8), (1.0, 0.0)], [0.5, 0.7], slices, strict=True))
    whole = [(*part[:3], part[3].copy()) for part in found]
    for fast, slow in zip(columns(found, 3.0), columns(whole, 3.0), strict=True):
        assert np.array_equal(fast, slow)


def test_what_does_not_fit_together_is_refused():
    one = (((0, 0.0, 0.0), GROUND_BODY), (0.0, 1.0), 0.5, np.zeros((1, 2)))
    parts = [[part] for part in one]
    for k in range(4):
        with pytest.raises(ValueError, match="interfaces"):
            cone_edges(*parts[:k], parts[k] * 2, *parts[k + 1 :], 1.0)
    with pytest.raises(ValueError, match="points"):
        cone_edges(*parts[:3], [np.zeros((2, 3))], 1.0)
