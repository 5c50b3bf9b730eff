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
from drystone.statics.lp.certificate import (
    certified_fall,
    certify,
    in_equilibrium,
    no_alpha_of,
    optimum_of,
)
from drystone.statics.lp.extremes import Extreme, certified_extreme
from drystone.statics.lp.highs import HighsSession
from drystone.statics.lp.program import Solution, assemble
from drystone.statics.result import CERTIFIED, Certificate, LimitStatus
from tests.statics.walls import boxes, coursed, stacked

MODEL = model_from_labels(coursed(5, 4, 90)).model
PROGRAM = assemble(MODEL)


def solution(sign=1.0, program=PROGRAM):
    return certified_extreme(program, HighsSession(program), sign).solution


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_other_end_is_no_proof(sign):
    """A warm solver that returns its last optimum is found out."""
    assert not certify(PROGRAM, solution(sign), -sign).holds


def test_the_other_end_is_no_proof_where_alpha_is_0():
    """A stack in balance carries nothing to the right and .75 to the left."""
    balanced = assemble(model_from_labels(stacked((20, 20, 0), (20, 20, 10)), 0.9).model)
    stale = solution(1.0, balanced)
    assert stale.columns[0] == pytest.approx(0, abs=1e-9)
    assert certify(balanced, stale, 1.0).holds
    assert not certify(balanced, stale, -1.0).holds


FLAT = assemble(model_from_labels(stacked((40, 20, 0))).model)


def test_forces_that_leave_their_cone():
    right = solution(1.0, FLAT)
    columns = right.columns.copy()
    null = np.linalg.svd(FLAT.matrix.toarray()[:, 1:])[2][-1]  # a state of self-stress
    columns[1:] -= 1e3 * null * np.sign(null[np.abs(null).argmax()])
    spoilt = certify(FLAT, replace(right, columns=columns), 1.0)
    assert spoilt.residual < CERTIFIED
    assert spoilt.violation > CERTIFIED
    assert not spoilt.holds


def test_forces_out_of_balance():
    right = solution()
    columns = right.columns.copy()
    columns[np.argmax(columns)] += 1e-5
    spoilt = certify(PROGRAM, replace(right, columns=columns), 1.0)
    assert spoilt.residual > CERTIFIED
    assert not spoilt.holds


def test_a_mechanism_that_closes_a_contact():
    right = solution(1.0, FLAT)
    duals = right.duals.copy()
    duals[2] += 1e-4  # it turns into the ground, and no load does work on that
    spoilt = certify(FLAT, replace(right, duals=duals), 1.0)
    assert spoilt.gap < CERTIFIED
    assert spoilt.inadmissible > CERTIFIED
    assert spoilt.slack > CERTIFIED
    assert not spoilt.holds


def test_forces_below_the_best():
    right = solution(1.0, FLAT)
    less = right.columns.copy()
    less[0] -= 0.1
    matrix = FLAT.matrix.toarray()
    less[1:], _ = nnls(matrix[:, 1:], FLAT.rhs - matrix[:, 0] * less[0])
    weak = certify(FLAT, replace(right, columns=less), 1.0)
    assert weak.residual < CERTIFIED
    assert weak.gap == pytest.approx(0.1)
    assert not weak.holds


@pytest.mark.parametrize("part", ["residual", "violation", "inadmissible"])
def test_no_number_is_no_proof(part):
    assert Certificate(lower=1.0, upper=1.0).holds
    assert not Certificate(lower=1.0, upper=1.0, **{part: float("nan")}).holds
    assert not Certificate(lower=1.0, upper=float("nan")).holds
    assert not Certificate(fall_work=float("nan")).holds


FALLING = model_from_labels(stacked((20, 20, 0), (20, 20, 12)), 0.9).model


def test_a_fall_needs_work_of_the_dead_load():
    assert Certificate(fall_work=0.1).holds
    assert not Certificate(fall_work=-0.1).holds
    assert not Certificate(fall_work=1e-12, inadmissible=1e-11).holds


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
    """A block that touches a fixed ceiling and a fixed wall to its right."""
    return boxes([0, 2, 3, 1], [2, 0.5, 1, 1.5], [1, 1, 1, 1], fixed=(1, 2), mu=mu)


class Claims:
    """A solver that says what it is told to say."""

    def __init__(self, growing, held):
        self.growing, self.held = growing, held

    def minimise(self, costs):
        return self.growing if costs[0] else self.held


def pressing(block, other):
    """Columns of the two edges at each contact point of a pair, in a model of `hanging`."""
    model = hanging()
    pairs = [(i.block, i.other) for i in model.interfaces for _ in i.points]
    return [1 + 2 * k + j for k, pair in enumerate(pairs) for j in (0, 1) if pair == (block, other)]


def test_forces_hold_a_wall_only_when_they_press():
    """A block that hangs from the ceiling by tension is in balance, and falls."""
    program = assemble(hanging())
    columns = np.zeros(program.column_count)
    columns[pressing(3, 1)] = -0.25
    tension = Solution(LimitStatus.OPTIMAL, columns, None, "", "")
    assert np.abs(program.matrix @ columns - program.rhs).max() < 1e-12
    assert not in_equilibrium(program, tension)
    for factor in (1.0, 0.9):
        pressed = replace(tension, columns=-factor * columns)
        turned = replace(program, rhs=-program.rhs)
        assert in_equilibrium(turned, pressed) == (factor == 1.0)


def test_no_load_is_called_without_limit_where_only_tension_carries_the_weight():
    program = assemble(hanging(mu=0.0))
    hung = np.zeros(program.column_count)
    hung[pressing(3, 1)] = -0.25
    ray = np.zeros(program.column_count)
    ray[0] = 1.0
    ray[pressing(3, 2)] = 0.25
    growing = Solution(LimitStatus.UNBOUNDED, ray, None, "", "")
    held = Solution(LimitStatus.OPTIMAL, hung, None, "", "")
    assert certify(program, growing, 1.0).holds
    assert certified_extreme(program, Claims(growing, held), 1.0).status is LimitStatus.FAILED
    rough = assemble(hanging())
    honest = HighsSession(rough).minimise(np.zeros(rough.column_count))
    assert certified_extreme(rough, Claims(growing, honest), 1.0).status is LimitStatus.UNBOUNDED


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
    assert no_alpha_of(found).inadmissible == 2.0
    assert no_alpha_of(found._replace(inadmissible=16.0)).inadmissible == 4.0


def test_nothing_that_moves_is_no_fall():
    still = figures(*one_stone(), 0.0, np.empty(0), np.zeros(3))
    assert certified_fall(still).fall_work == no_alpha_of(still).fall_work == 0.0
    assert not certified_fall(still).holds
    assert certified_bound(still, np.nan, 1, "some solver") is None
