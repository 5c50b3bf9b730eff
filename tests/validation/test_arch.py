"""Least thickness of the semicircular arch under its own weight.

Mean radius 1, n equal voussoirs with radial joints, the springings radial too.  The classical
answer for many voussoirs without sliding is t/R = .1075; the values by n and those with friction
were computed independently of this project.  The thickness is given to five digits: one unit less
must fall, one more stand.
"""

import pytest

from drystone_lab.statics_cases import stands


@pytest.mark.parametrize(
    ("count", "least"),
    [(9, 0.10213), (11, 0.10491), (16, 0.10724), (20, 0.10746), (27, 0.10678), (40, 0.10746)],
)
def test_without_sliding(count, least):
    assert not stands(count, least - 1e-5, mu=50.0)
    assert stands(count, least + 1e-5, mu=50.0)


@pytest.mark.parametrize(
    ("mu", "least"), [(0.5, 0.10746), (0.4, 0.10746), (0.35, 0.15182), (0.32, 0.18544)]
)
def test_with_friction(mu, least):
    assert not stands(40, least - 1e-5, mu)
    assert stands(40, least + 1e-5, mu)


def test_too_little_friction_for_any_thickness():
    assert not stands(40, 0.4, mu=0.3)
