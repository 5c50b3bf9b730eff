"""Certificates by the kernel mean what certificates of a sparse program mean."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.kernels.certificate import Figures, figures
from drystone.kernels.simplex import Added, Cones
from drystone.statics.incremental import certified_bound
from drystone.statics.lp.certificate import (
    certify,
    fall_of,
    no_alpha_of,
    of_fall,
    optimum_of,
)
from drystone.statics.lp.cone_program import ConeProgram
from drystone.statics.lp.extremes import certified_extreme
from drystone.statics.lp.highs import HighsSession
from drystone.statics.lp.program import Units, assemble
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitStatus
from tests.statics.growth import upwards, with_block
from tests.statics.walls import coursed, irregular

UNITS = Units(14.0, 200.0)
PARTS = ("residual", "violation", "inadmissible", "lower", "upper", "slack", "fall_work")


def programs(labels):
    """Walls with their last block on top, for the kernel and for HiGHS."""
    whole, blocks = upwards(labels)
    mu = whole.mu
    model, cones = RigidBlockModel((), (), mu), ConeProgram.empty(UNITS)
    for block in blocks:
        model = with_block(model, block, whole=whole)
        added = cones.columns_of(model.added, mu)
        yield cones, added, assemble(model, units=UNITS)
        cones = cones.appended(model.added, added)


def by_kernel(cones, added, solution):
    if solution.columns is None:
        return figures(cones.cones, cones.weights, added, np.nan, np.empty(0), -solution.duals)
    alpha = float(solution.columns[0])
    return figures(cones.cones, cones.weights, added, alpha, solution.columns[1:], -solution.duals)


def assert_equal(one, other):
    for part in PARTS:
        first, second = getattr(one, part), getattr(other, part)
        assert (first is None) == (second is None)
        assert first is None or first == pytest.approx(second, rel=1e-9, abs=1e-12)
    assert one.holds == other.holds


def in_the_air(labels):
    """The same wall with a block above it that touches nothing."""
    above = np.zeros((12, labels.shape[1]), np.uint32)
    above[2:8, 4:20] = labels.max() + 1
    return np.concatenate((above, labels))


@pytest.mark.parametrize("labels", [in_the_air(coursed(1, 4, 90, 2)), irregular(2, 20, 90, 70)])
@pytest.mark.parametrize("sign", [1, -1])
def test_both_certificates_agree_of_right_answers_and_of_wrong_ones(labels, sign):
    rng = np.random.default_rng(0)
    held = broken = 0
    for cones, added, program in programs(labels):
        right = certified_extreme(program, HighsSession(program), float(sign)).solution
        if right.status is LimitStatus.UNSTABLE:
            found = by_kernel(cones, added, right)
            assert_equal(no_alpha_of(found), certify(program, right, sign))
            assert certified_bound(found, np.nan, sign, "some solver").fall.holds
            continue
        for part in ("columns", "duals", None):
            wrong = right
            if part is not None:
                vector = getattr(right, part).copy()
                vector[rng.integers(len(vector))] += rng.choice([-1e-5, 1e-5])
                wrong = replace(right, **{part: vector})
            found = by_kernel(cones, added, wrong)
            alpha = float(wrong.columns[0])
            certificate = certify(program, wrong, float(sign))
            assert_equal(optimum_of(found, alpha, sign), certificate)
            assert_equal(fall_of(found), of_fall(program, -wrong.duals))
            held += part is None and certificate.holds
            broken += part is not None and not certificate.holds
    assert held > 10
    assert broken > 1.5 * held


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
    falls = fall_of(found)
    assert (falls.inadmissible, falls.fall_work) == (0.25, -0.5)
    assert no_alpha_of(found).inadmissible == 2.0
    assert no_alpha_of(found._replace(inadmissible=16.0)).inadmissible == 4.0


def test_nothing_that_moves_is_no_fall():
    still = figures(*one_stone(), 0.0, np.empty(0), np.zeros(3))
    assert fall_of(still).fall_work == no_alpha_of(still).fall_work == 0.0
    assert not fall_of(still).holds
    assert certified_bound(still, np.nan, 1, "some solver") is None
