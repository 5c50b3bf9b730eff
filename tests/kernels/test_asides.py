"""How far polygons go aside, against shapely."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.asides import asides
from drystone.kernels.polygons import no_polygons
from tests.naive import asides as naive
from tests.polygons import box_of as box
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


@pytest.mark.parametrize(
    ("other", "way"),
    [
        (box(37.0, 0.0), 3.5),  # beside it
        (box(-37.0, 0.0), None),  # on the other side
        (box(37.0, 15.0), None),  # only a corner: they share less than .3 of the height
        (box(37.0, 13.0), 3.5),
        (box(10.0, 13.0), None),  # less is needed upwards: it lies on the other
        (box(10.0, -13.0), None),
        (box(40.5, 0.0), None),  # apart
    ],
)
def test_what_goes_aside(other, way):
    found = asides(box(0.0, 0.0), no_polygons().added([box(90.0, 0.0), other]), 0.5, 1.0)
    assert found == ([] if way is None else [(1, pytest.approx(way))])
