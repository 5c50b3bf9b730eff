"""Least thickness of the semicircular arch under its own weight.

Mean radius 1, n equal voussoirs with radial joints, the springings radial too.  The classical
answer for many voussoirs without sliding is t/R = .1075; the values by n and those with friction
were computed independently of this project.  The thickness is given to five digits: one unit less
must fall, one more stand.
"""

import pytest

from drystone_lab.statics_cases import WITH_FRICTION, WITHOUT_SLIDING, stands


@pytest.mark.parametrize(
    "case", [*WITHOUT_SLIDING[:5:2], *WITH_FRICTION], ids=lambda case: f"{case.count}, mu {case.mu}"
)
def test_least_thickness(case):
    if case.least is None:
        assert not stands(case.count, 0.4, case.mu)
        return
    assert not stands(case.count, case.least - 1e-5, case.mu)
    assert stands(case.count, case.least + 1e-5, case.mu)
