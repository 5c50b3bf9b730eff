"""Certificates find out every single thing that can be wrong with an answer."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import nnls

from drystone.contacts.blocks import model_from_labels
from drystone.kernels.cones import Figures, figures
from drystone.kernels.simplex import Added, Cones
from drystone.statics.incremental import certified_bound
from drystone.statics.limit import resistance_between
from drystone.statics.lp.certificate import certified_fall, certify, optimum_of
from drystone.statics.lp.extremes import Extreme, certified_extreme
from drystone.statics.lp.highs import HighsSession
from drystone.statics.lp.program import Solution, assemble
from drystone.statics.result import CERTIFIED, Certificate, LimitStatus
from tests.statics.walls import boxes, coursed, stacked

MODEL = model_from_labels(coursed(5, 4, 90)).model
PROGRAM = assemble(MODEL)


def solution(sign=1.0, program=PROGRAM):
    return certified_extreme(program, HighsSession(program), sign).solution


def test_the_other_end_is_no_proof():
    """A stack in balance carries nothing to the right and .75 to the left."""
    assert not certify(PROGRAM, solution(1.0), -1.0).holds
    balanced = assemble(model_from_labels(stacked((20, 20, 0), (20, 20, 10)), 0.9).model)
    stale = solution(1.0, balanced)
    assert stale.columns[0] == pytest.approx(0, abs=1e-9)
    assert certify(balanced, stale, 1.0).holds
    assert not certify(balanced, stale, -1.0).holds


FLAT = assemble(model_from_labels(stacked((40, 20, 0))).model)


def test_everything_that_can_be_wrong_alone_is_found_out():
    right, matrix = solution(1.0, FLAT), FLAT.matrix.toarray()

    def spoilt(**changed):
        found = certify(FLAT, replace(right, **changed), 1.0)
        assert not found.holds
        return found

    outside, unbalanced, less = (right.columns.copy() for _ in range(3))
    null = np.linalg.svd(matrix[:, 1:])[2][-1]  # a state of self-stress
    outside[1:] -= 1e3 * null * np.sign(null[np.abs(null).argmax()])
    assert spoilt(columns=outside).residual < CERTIFIED < spoilt(columns=outside).violation
    unbalanced[np.argmax(unbalanced)] += 1e-5
    assert spoilt(columns=unbalanced).residual > CERTIFIED
    less[0] -= 0.1  # forces below the best
    less[1:], _ = nnls(matrix[:, 1:], FLAT.rhs - matrix[:, 0] * less[0])
    assert spoilt(columns=less).residual < CERTIFIED
    assert spoilt(columns=less).gap == pytest.approx(0.1)
    closing = right.duals.copy()
    closing[2] += 1e-4  # it turns into the ground, and no load does work on that
    assert spoilt(duals=closing).gap < CERTIFIED < spoilt(duals=closing).inadmissible
    assert spoilt(duals=closing).slack > CERTIFIED


@pytest.mark.parametrize("part", ["residual", "violation", "inadmissible"])
def test_no_number_is_no_proof_and_no_fall_without_work(part):
    assert Certificate(lower=1.0, upper=1.0).holds
    assert not Certificate(lower=1.0, upper=1.0, **{part: float("nan")}).holds
    assert not Certificate(lower=1.0, upper=float("nan")).holds
    for work, error in ((float("nan"), 0.0), (-0.1, 0.0), (1e-12, 1e-11)):
        assert not Certificate(fall_work=work, inadmissible=error).holds
    assert Certificate(fall_work=0.1).holds


FALLING = model_from_labels(stacked((20, 20, 0), (20, 20, 12)), 0.9).model


def test_a_wall_is_not_called_unstable_on_a_false_proof():
    """The end asked for comes back with the mechanism of the other end."""
    stands = model_from_labels(stacked((20, 40, 0))).model
    program = assemble(stands)
    least, greatest = (
        certified_extreme(program, HighsSession(program), sign) for sign in (-1.0, 1.0)
    )
    stale = replace(greatest.solution, columns=-greatest.solution.columns)
    false = Extreme(stale, replace(greatest.certificate, lower=-0.5, upper=-0.5))
    both = resistance_between(program, least, false, 0.58)
    assert both.right.status is LimitStatus.FAILED
    assert both.left.status is LimitStatus.FAILED


def test_no_alpha_needs_a_mechanism_that_no_live_load_holds():
    """A stone in the air falls whatever the push; an overhanging one does not."""
    floating = assemble(boxes([0, 0, 1, 1], [3, 5, 1, 1]))
    found = solution(1.0, floating)
    assert found.status is LimitStatus.UNSTABLE
    assert certify(floating, found, 1.0).holds
    overhanging = assemble(FALLING)
    end = certified_extreme(overhanging, HighsSession(overhanging), 1.0)
    assert end.alpha < 0
    claimed = replace(end.solution, status=LimitStatus.UNSTABLE)
    assert not certify(overhanging, claimed, 1.0).holds


def test_self_stress_must_balance_press_and_grow_to_the_right_side():
    program = assemble(boxes([0, 0, 1, 2], [1, 0, 1, 1], fixed=(1,)))
    found = solution(-1.0, program)
    assert found.status is LimitStatus.UNBOUNDED
    assert certify(program, found, -1.0).holds
    assert certify(program, found, -1.0).lower == -np.inf
    assert certify(program, found, 1.0) is None
    ray = found.columns.copy()
    ray[1:] += 0.1
    assert not certify(program, replace(found, columns=ray), -1.0).holds
    ray = found.columns.copy()
    ray[1] = -1.0
    assert certify(program, replace(found, columns=ray), -1.0).violation > 0.1


def hanging(mu=0.58):
    """The program of a block that touches a fixed ceiling and a fixed wall to its right.

    With it come the columns of the two edges at each contact point with ceiling and wall.
    """
    model = boxes([0, 2, 3, 1], [2, 0.5, 1, 1.5], [1, 1, 1, 1], fixed=(1, 2), mu=mu)
    pairs = [(i.block, i.other) for i in model.interfaces for _ in i.points for _ in range(2)]
    found = ([k for k, pair in enumerate(pairs, 1) if pair == (3, other)] for other in (1, 2))
    return assemble(model), *found


class Claims:
    """A solver that says what it is told to say."""

    def __init__(self, growing, held):
        self.growing, self.held = growing, held

    def minimise(self, costs):
        return self.growing if costs[0] else self.held


def test_no_load_is_called_without_limit_where_only_tension_carries_the_weight():
    """A block that hangs from the ceiling by tension is in balance, and falls."""
    program, ceiling, wall = hanging(mu=0.0)
    hung, ray = np.zeros((2, program.column_count))
    hung[ceiling] = -0.25
    ray[0], ray[wall] = 1.0, 0.25
    assert np.abs(program.matrix @ hung - program.rhs).max() < 1e-12
    growing = Solution(LimitStatus.UNBOUNDED, ray, None, "", "")
    held = Solution(LimitStatus.OPTIMAL, hung, np.zeros(3), "", "")
    assert certify(program, growing, 1.0).holds
    assert certified_extreme(program, Claims(growing, held), 1.0).status is LimitStatus.FAILED
    rough, *_ = hanging()
    honest = HighsSession(rough).minimise(np.zeros(rough.column_count))
    assert certified_extreme(rough, Claims(growing, honest), 1.0).status is LimitStatus.UNBOUNDED
    weak = Claims(growing, replace(honest, columns=0.9 * honest.columns))
    assert certified_extreme(rough, weak, 1.0).status is LimitStatus.FAILED


# Those of the kernel mean what those of a sparse program mean.


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
    assert certified_fall(found, found.live).inadmissible == 2.0
    assert certified_fall(found._replace(inadmissible=16.0), found.live).inadmissible == 4.0


def test_nothing_that_moves_is_no_fall():
    still = figures(*one_stone(), 0.0, np.empty(0), np.zeros(3))
    assert certified_fall(still).fall_work == 0.0
    assert not certified_fall(still).holds
    assert certified_bound(still, np.nan, 1, "some solver") is None
