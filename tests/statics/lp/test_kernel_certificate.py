"""Certificates by the kernel mean what certificates of a sparse program mean."""

import numpy as np

from drystone.kernels.cones import Figures, figures
from drystone.kernels.simplex import Added, Cones
from drystone.statics.incremental import certified_bound
from drystone.statics.lp.certificate import certified_fall, no_alpha_of, optimum_of


def one_stone():
    """A stone of weight 2 on two points without friction: columns push straight up."""
    first, second = np.zeros(2, np.int32), np.full(2, -1, np.int32)
    entries = np.zeros((6, 2))
    entries[1], entries[2] = 1.0, (-1.0, 1.0)
    none = np.empty(0, np.int32)
    nothing = Added(np.empty(0), Cones(none, none, np.empty((6, 0))), none)
    return Cones(first, second, entries), np.array([2.0]), nothing


def test_figures_in_closed_form():
    found = figures(*one_stone(), 0.25, np.array([2.0, -1.0]), np.array([4.0, 1.0, 2.0]))
    assert found == Figures(3.0, 1.0, 3.0, 4.0, 1.0, 8.0, 2.0)
    certificate = optimum_of(found, 0.25, 1)
    assert (certificate.residual, certificate.violation, certificate.inadmissible) == (3, 1, 0.25)
    assert (certificate.lower, certificate.upper, certificate.slack) == (0.25, 0.25, 0.375)
    other_end = optimum_of(found, 0.25, -1)
    assert (other_end.upper, other_end.slack, other_end.holds) == (None, None, False)
    falls = certified_fall(found)
    assert (falls.inadmissible, falls.fall_work) == (0.25, -0.5)
    assert no_alpha_of(found).inadmissible == 2.0
    assert no_alpha_of(found._replace(inadmissible=16.0)).inadmissible == 4.0


def test_nothing_that_moves_is_no_fall():
    still = figures(*one_stone(), 0.0, np.empty(0), np.zeros(3))
    assert certified_fall(still).fall_work == no_alpha_of(still).fall_work == 0.0
    assert not certified_fall(still).holds
    assert certified_bound(still, np.nan, 1, "some solver") is None
