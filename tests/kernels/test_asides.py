"""How far polygons go aside, against shapely."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.asides import asides
from drystone.kernels.polygons import no_polygons
from tests.naive import asides as naive
from tests.strategies import repeatable


def test_polygons_go_as_far_aside_as_those_of_the_twin():
    listed = [0]

    @repeatable(60)
    @given(st.integers(0, 2**31))
    def check(seed):
        rng = np.random.default_rng(seed)

        def stone():
            angles = np.sort(rng.uniform(0, 2 * np.pi, 9))
            radii = rng.uniform(15, 25, (9, 1))
            return np.column_stack([np.cos(angles), np.sin(angles)]) * radii

        one = stone()
        others = [stone() + rng.uniform(-45, 45, 2) * (1.0, 0.5) for _ in range(4)]
        for sign in (-1.0, 1.0):
            found = dict(asides(one, no_polygons().added(others), 0.5, sign))
            assert found == pytest.approx(naive.asides(one, others, 0.5, sign), abs=1e-6)
            listed[0] += len(found)

    check()
    assert listed[0] > 30
