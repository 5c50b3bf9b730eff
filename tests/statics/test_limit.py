import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.statics.incremental import SIMPLEX, incremental_analysis
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads, point_load, weight
from drystone.statics.lp import clarabel, extremes, highs
from drystone.statics.lp.highs import HighsSession
from drystone.statics.lp.program import units_of
from drystone.statics.model import NO_SLIP
from drystone.statics.result import LimitStatus
from tests.statics.walls import boxes, coursed, irregular, limit_load, stacked
from tests.strategies import repeatable


def alphas(labels, mu=0.58):
    both = lateral_resistance(model_from_labels(labels, mu).model)
    return both.left.alpha, both.right.alpha


def statuses(both):
    return both.left.status, both.right.status


def test_four_blocks_at_a_crossing_of_joints_have_the_strength_of_their_columns():
    labels = np.kron([[1, 2], [3, 4]], np.ones((20, 20))).astype(np.uint32)
    rectangles = [[x, y, 20, 20] for y in (0, 20) for x in (0, 20)]
    expected = lateral_resistance(boxes(*rectangles))
    assert alphas(labels) == pytest.approx((expected.left.alpha, expected.right.alpha))
    assert expected.left.alpha <= 0.58


def test_a_course_across_a_narrow_gap_slides_at_the_friction():
    """A corner on a corner across the gap must not lock the bed joint."""
    labels = np.zeros((40, 42), np.uint32)
    labels[20:, :20], labels[20:, 21:] = 1, 2
    labels[:20, :21] = 3
    assert alphas(labels, mu=0.3) == pytest.approx((0.3, 0.3))


def test_what_overhangs_too_far_is_unstable_in_both_directions():
    """A push to the left would hold it up; by itself it falls."""
    both = lateral_resistance(model_from_labels(stacked((20, 20, 0), (20, 20, 12)), 0.9).model)
    assert statuses(both) == (LimitStatus.UNSTABLE, LimitStatus.UNSTABLE)
    assert (both.left.alpha, both.right.alpha, both.value, both.stable) == (None, None, None, False)
    assert "own weight" in both.right.message


def test_what_balances_carries_nothing_on_one_side_and_no_less():
    both = lateral_resistance(model_from_labels(stacked((20, 20, 0), (20, 20, 10)), 0.9).model)
    assert (both.left.alpha, both.right.alpha) == pytest.approx((0.75, 0.0), abs=1e-9)
    assert both.right.alpha >= 0


def test_a_block_between_fixed_ones_carries_any_load():
    both = lateral_resistance(boxes([0, 0, 1, 2], [1, 0, 1, 1], fixed=(1,)), mechanism=True)
    assert statuses(both) == (LimitStatus.UNBOUNDED, LimitStatus.OPTIMAL)
    assert both.left.alpha is None
    assert both.right.alpha == pytest.approx(0.58)
    assert both.right.mechanism.block_ids == (2,)


def test_what_all_algorithms_give_up_on_is_failed_and_no_number(monkeypatch):
    model = model_from_labels(coursed(5, 4, 90)).model
    brief = {**highs._SIMPLEX, "simplex_iteration_limit": 1}
    monkeypatch.setattr(highs, "_OPTIONS", {**highs._OPTIONS, "simplex": brief, "ipm": brief})
    settings = clarabel._settings(1e-12)
    settings.max_iter = 1
    monkeypatch.setattr(clarabel, "_settings", lambda _: settings)
    both = lateral_resistance(model, mechanism=True)
    assert statuses(both) == (LimitStatus.FAILED, LimitStatus.FAILED)
    assert (both.value, both.left.alpha, both.left.mechanism) == (None, None, None)
    assert "gave up" in both.left.message


def test_one_failed_direction_leaves_the_other_unknown(monkeypatch):
    """That the wall stands by itself follows only from both."""
    model = model_from_labels(coursed(5, 4, 90)).model
    monkeypatch.setattr(highs, "_PRIMAL", {"simplex_iteration_limit": 0})
    both = lateral_resistance(model, solver="highs")
    assert both.left.status is LimitStatus.OPTIMAL  # a cold solve came to help
    only_upwards = extremes.certified_extreme

    def stuck(program, session, sign):
        answer = only_upwards(program, session, sign)
        return answer if sign > 0 else replace(answer, certificate=None)

    monkeypatch.setattr(extremes, "certified_extreme", stuck)
    both = lateral_resistance(model)
    assert statuses(both) == (LimitStatus.FAILED, LimitStatus.FAILED)
    assert "other direction" in both.right.message
    assert "could not be certified" in both.left.message


def test_where_clarabel_gives_up_it_is_asked_what_has_to_be_held(monkeypatch):
    """As of walls of 650 stones of which a chip of a hundredth of the mean weight falls."""
    bond = [[x + 0.5 * (row % 2), row * 1.0, 1, 1] for row in range(5) for x in range(6)]
    walls = [boxes(*bond), boxes(*bond, [3.0, 5.3, 0.1, 0.1])]
    expected = [lateral_resistance(wall, solver="clarabel") for wall in walls]
    said = []
    solve = clarabel.ClarabelSession._solved

    def stopping(session, matrix, costs):
        found = solve(session, matrix, costs)
        said.append(found.status)
        stopped = len(said) % 2  # each answer that is not about what has to be held
        return (
            replace(found, status=LimitStatus.OPTIMAL, said="MaxIterations") if stopped else found
        )

    monkeypatch.setattr(clarabel.ClarabelSession, "_solved", stopping)
    again = [lateral_resistance(wall, solver="clarabel") for wall in walls]
    assert said == 4 * [LimitStatus.OPTIMAL] + [LimitStatus.UNSTABLE, LimitStatus.OPTIMAL]
    assert [statuses(one) for one in again] == [statuses(one) for one in expected]
    assert again[0].value == pytest.approx(expected[0].value)
    assert again[1].left.certificate.fall_work > 0.0


@pytest.mark.parametrize("wrong", ["columns", "duals"])
def test_a_wrong_optimal_answer_is_found_out_and_asked_again(wrong, monkeypatch):
    """As a warm-started solver once gave them (HiGHS issue 3194)."""
    model = model_from_labels(coursed(5, 4, 90)).model
    expected = lateral_resistance(model)
    right = HighsSession._vectors

    def vectors(session, status):
        found = dict(zip(("columns", "duals"), right(session, status), strict=True))
        if session.name == "HiGHS simplex":
            found[wrong] = found[wrong] + 1e-3 * np.arange(len(found[wrong]))
        return found["columns"], found["duals"]

    monkeypatch.setattr(HighsSession, "_vectors", vectors)
    again = lateral_resistance(model)
    assert again.right.solver == "HiGHS ipm"
    assert again.value == pytest.approx(expected.value, abs=1e-8)
    alone = lateral_resistance(model, solver="highs")
    assert statuses(alone) == (LimitStatus.FAILED, LimitStatus.FAILED)


SOLVERS = ("highs", "highs-ipm", "clarabel")


def test_no_solver_keeps_another_from_working_in_a_process():
    """HiGHS refuses another number of threads than that of the first call of a process."""
    script = (
        "from drystone.contacts.given import model_from_json\n"
        "from drystone.statics.limit import lateral_resistance\n"
        "model = model_from_json({'blocks_xywh': [[0, 0, 1, 2]], 'mu': 0.7})\n"
        "for solver in ('highs-ipm', 'highs', 'highs-ipm'):\n"
        "    print(lateral_resistance(model, solver=solver).left.status.value)\n"
    )
    ran = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-c", script], check=True, stdout=subprocess.PIPE, text=True
    )
    assert ran.stdout.split() == ["optimal"] * 3


@given(seed=st.integers(0, 10**6), count=st.integers(2, 25), coursing=st.booleans())
@repeatable(25)
def test_solvers_agree_and_every_answer_is_certified(seed, count, coursing):
    labels = coursed(seed, 2 + count // 8, 90) if coursing else irregular(seed, count, 90, 50)
    model = model_from_labels(labels).model
    answers = [lateral_resistance(model, solver=solver, mechanism=True) for solver in SOLVERS]
    assert len({statuses(both) for both in answers}) == 1
    for both in answers:
        for result, twin in ((both.left, answers[0].left), (both.right, answers[0].right)):
            assert result.certificate.holds
            if result.success:
                assert result.alpha == pytest.approx(twin.alpha, abs=1e-8)
                assert result.certificate.gap <= 1e-8
            else:
                assert result.certificate.fall_work > 1e-6


@pytest.mark.parametrize(("held", "alpha"), [((), 0.25), (("turn",), 0.58), (("x", "turn"), None)])
def test_a_guide_keeps_a_block_from_turning(held, alpha):
    model = model_from_labels(stacked((10, 40, 0))).model
    guided = replace(model, blocks=(replace(model.blocks[0], held=held),))
    result = limit_load(guided, "right", mechanism=True)
    if alpha is None:
        assert result.status is LimitStatus.UNBOUNDED
        assert result.certificate.holds
    else:
        assert result.alpha == pytest.approx(alpha)
        assert (result.mechanism.velocity[0][2] == 0) == bool(held)


def test_many_blocks_are_solved_by_the_interior_point_method(monkeypatch):
    model = model_from_labels(coursed(5, 4, 90)).model
    expected = lateral_resistance(model)
    monkeypatch.setattr(extremes, "MANY_BLOCKS", 3)
    found = lateral_resistance(model)
    assert found.left.solver == "Clarabel"
    assert found.value == pytest.approx(expected.value, abs=1e-9)
    assert lateral_resistance(model, mechanism=True).left.solver == "HiGHS simplex"


@pytest.mark.parametrize("solver", ["auto", "highs", "highs-ipm", "clarabel"])
def test_a_wall_that_falls_carries_no_load_in_spite_of_self_stress(solver):
    """Between abutments a bond carries any live load; a stone of it in the air still falls."""
    bond = [[x + 0.5 * (row % 2), row * 1.0, 1, 1] for row in range(8) for x in range(1, 8)]
    model = boxes(*bond, [3, 8.3, 1, 1], [0, 0, 1, 8], [8.5, 0, 1, 8], fixed=(58, 59))
    assert len(bond) + 1 >= extremes.MANY_BLOCKS
    loads = Loads(weight(model), point_load(model, 4, (4.5, 0.5), (1.0, 0.0)))
    both = lateral_resistance(model, loads, solver=solver)
    assert LimitStatus.UNBOUNDED not in statuses(both)
    assert not both.stable
    if solver in ("auto", "highs"):
        assert statuses(both) == (LimitStatus.UNSTABLE, LimitStatus.UNSTABLE)


def test_a_wall_stands_where_nothing_limits_the_load():
    """Pressed onto the ground, a block carries any load; lifted, its own weight."""
    block = boxes([0, 0, 2, 1])
    both = lateral_resistance(block, Loads(weight(block), np.array([[0.0, -1.0, 0.0]])))
    assert statuses(both) == (LimitStatus.OPTIMAL, LimitStatus.UNBOUNDED)
    assert (both.value, both.stable) == (None, True)


def test_friction_at_which_nothing_slides_has_one_answer():
    """That of the greatest friction which counts; whole walls, and walls that grow."""
    mu = 1e300
    for labels in (irregular(3, 30, 120, 100), coursed(3, 5, 120, 2)):
        model = model_from_labels(labels, mu).model
        both = lateral_resistance(model)
        counted = lateral_resistance(replace(model, mu=NO_SLIP))
        assert (both.left.alpha, both.right.alpha) == (counted.left.alpha, counted.right.alpha)
        assert both.left.certificate.holds
        own = tuple(replace(interface, mu=mu) for interface in model.interfaces)
        assert lateral_resistance(replace(model, interfaces=own)).left.alpha == both.left.alpha
        found = incremental_analysis(model, units_of(model)).result
        assert not found.solved_cold
        assert found.resistance.left.alpha == pytest.approx(both.left.alpha, abs=1e-8)
    stack = model_from_labels(stacked((20, 20, 0), (20, 20, 0)), mu).model
    found = incremental_analysis(stack, units_of(stack)).result.resistance.left
    assert found.solver in {SIMPLEX, highs.WARM}
    assert found.alpha == pytest.approx(0.5, abs=1e-9)


def test_residuals_of_large_friction_are_corrected():
    """Otherwise three of 240 walls at a friction of 1,000 to 10,000 had no certified answer."""
    for labels, mu in ((irregular(11, 31, 140, 100), 1e4), (coursed(48, 9, 150, 0), 1e3)):
        both = lateral_resistance(model_from_labels(labels, mu).model)
        assert both.left.certificate.holds
        assert both.right.certificate.holds
