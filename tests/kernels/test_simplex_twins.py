"""The compiled simplex kernel against the one in NumPy, bit by bit."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.backend import compiled
from drystone.kernels.simplex import OPTIMAL
from tests.kernels.simplex_walls import (
    COMPILED,
    NUMPY,
    SIGNS,
    differing,
    grown,
    identical,
    variants,
)
from tests.statics.walls import coursed, irregular
from tests.strategies import label_images, repeatable

pytestmark = pytest.mark.skipif(compiled("simplex") is None, reason="kernels are not compiled here")


@pytest.mark.parametrize("labels", [coursed(11, 5, 130, 2), irregular(12, 30, 110, 90)])
def test_both_kernels_go_the_same_way(labels):
    """Answers, pivots and inverses, to the last bit."""
    count = 0
    for step, (tilts, choices) in enumerate(grown(labels, COMPILED, candidates=3)):
        asked = [
            *choices,
            *(variants(tilts[1], choices[0], step) if step % 4 == 1 else {}).values(),
        ]
        for added in asked:
            for sign in SIGNS:
                one, other = COMPILED.solve(tilts[sign], added), NUMPY.solve(tilts[sign], added)
                assert identical(one, other)
                count += 1
                if one.status == OPTIMAL and count % 6 == 0:
                    trees = (k.grow(tilts[sign], added, one) for k in (COMPILED, NUMPY))
                    assert differing(*trees) == []
    assert count > 90


@given(label_images(), st.integers(1, 3))
@repeatable(40)
def test_both_kernels_go_the_same_way_for_any_stones(labels, at_once):
    if labels.any():
        for tilts, choices in grown(labels, COMPILED, candidates=3, at_once=at_once):
            for added in choices:
                for sign in SIGNS:
                    one = COMPILED.solve(tilts[sign], added)
                    assert identical(one, NUMPY.solve(tilts[sign], added))
