"""Load multipliers without dilatancy: closed forms, the slow twin, statuses, and the check."""

from dataclasses import astuple, fields, replace

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.statics.flow import nonassociative
from drystone.statics.flow.flow_search import STARTS, NonassociativeSettings
from drystone.statics.flow.nonassociative import (
    FlowCheck,
    NonassociativeResult,
    check_flow,
    nonassociative_load,
    nonassociative_resistance,
)
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads, tilting_table
from drystone.statics.result import LimitStatus, Mechanism
from tests.naive.nonassociative import all_limits
from tests.statics.walls import boxes, irregular

DIRECTIONS = ("left", "right")
FEW = NonassociativeSettings(random_starts=0)


def test_a_stack_rocks_where_its_lines_of_thrust_leave_it():
    both = nonassociative_resistance(boxes([0, 0, 1, 1], [0.2, 1, 1, 1], mu=0.9))
    assert (both.right.alpha, both.left.alpha) == pytest.approx((0.4, 0.6), abs=1e-9)
    assert both.value == pytest.approx(0.4 / 0.9, abs=1e-9)


@pytest.mark.parametrize(("seed", "count", "mu"), [(7, 2, 0.7), (8, 2, 0.4), (3, 3, 0.7)])
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_the_least_of_all_sets_of_contact_states(seed, count, mu, direction):
    model = model_from_labels(irregular(seed, count, 24, 18), mu).model
    result = nonassociative_load(model, direction)
    if result.status is LimitStatus.UNSTABLE:
        assert lateral_resistance(model).left.status is LimitStatus.UNSTABLE
        return
    limits = all_limits(model, direction)
    assert result.alpha == pytest.approx(min(limit.least for limit in limits), abs=1e-7)
    if (seed, direction) == (7, "right"):  # well below the load with dilatancy
        assert result.alpha < lateral_resistance(model).right.alpha - 0.05


@pytest.mark.parametrize(("seed", "direction"), [(13, "left"), (13, "right"), (24, "left")])
def test_a_single_start_finds_an_answer_where_equal_steps_need_many_rounds(seed, direction):
    model = model_from_labels(irregular(seed, 20, 110, 60), 0.75).model
    one = NonassociativeSettings(rounds=25, starts=STARTS[:1], random_starts=0)
    result = nonassociative_load(model, direction, settings=one)
    assert result.success
    assert result.check.holds


def test_the_same_every_time_with_a_check_that_holds():
    model = model_from_labels(irregular(3, 8, 60, 40), 0.58).model
    first, second = (nonassociative_load(model, "right") for _ in range(2))
    assert first.success
    assert first.check.holds
    again = check_flow(model, None, "right", first.alpha, first.mechanism, first.forces)
    assert first.check == again
    assert np.hypot(*first.mechanism.velocity[:, :2].T).max() == pytest.approx(1.0)
    assert first.alpha == second.alpha
    assert first.method == second.method
    np.testing.assert_array_equal(first.forces, second.forces)
    np.testing.assert_array_equal(first.mechanism.velocity, second.mechanism.velocity)


def test_without_starts_it_says_that_it_did_not_converge():
    nothing = NonassociativeSettings(starts=(), random_starts=0)
    result = nonassociative_load(boxes([0, 0, 1, 2], mu=0.7), "left", settings=nothing)
    assert result.status is LimitStatus.FAILED
    assert result.alpha is None
    assert "did not converge in 0 rounds" in result.message
    assert "0.5" in result.message


def test_answers_whose_check_does_not_hold_are_not_told(monkeypatch):
    monkeypatch.setattr("drystone.statics.flow.nonassociative.HOLDS", -1.0)
    result = nonassociative_load(boxes([0, 0, 1, 2], mu=0.7), "left", settings=FEW)
    assert (result.status, result.alpha) == (LimitStatus.FAILED, None)
    assert result.rounds > 0


def test_walls_that_stand_only_when_contacts_are_jammed():
    model = model_from_labels(irregular(15, 12, 48, 40), 0.9).model
    assert lateral_resistance(model).stable
    result = nonassociative_load(model, "right")
    assert result.status is LimitStatus.UNSTABLE
    assert result.alpha is None
    assert result.check.holds
    assert "dead load alone" in result.message


def test_other_loads_and_none_where_nothing_is_free():
    fixed = boxes([0, 0, 1, 1], fixed=(1,))
    assert nonassociative_load(fixed, "left").status is LimitStatus.UNBOUNDED
    model = boxes([0, 0, 1, 2], mu=0.7)
    table = tilting_table(model)
    twice = nonassociative_load(model, "left", loads=Loads(table.dead, 2.0 * table.live))
    assert twice.alpha == pytest.approx(0.25, abs=1e-9)
    leaning = Loads(table.dead + 0.1 * table.live, table.live)
    both = nonassociative_resistance(model, loads=leaning)
    assert (both.left.alpha, both.right.alpha) == pytest.approx((0.6, 0.4), abs=1e-9)


def test_friction_of_an_interface_and_held_blocks():
    model = boxes([0, 0, 1, 4], mu=0.65)
    slippery = replace(model, interfaces=(replace(model.interfaces[0], mu=0.1),))
    assert nonassociative_load(slippery, "right").alpha == pytest.approx(0.1, abs=1e-9)
    level = replace(model, blocks=(replace(model.blocks[0], held=("turn",)),))
    assert nonassociative_load(level, "right").alpha == pytest.approx(0.65, abs=1e-9)
    smooth = replace(model, mu=0.0)
    assert nonassociative_load(smooth, "right").alpha == pytest.approx(0.0, abs=1e-9)


# The check itself, on a cube of weight 1 that slides to the right, mu = .3.

CUBE = boxes([0, 0, 1, 1], mu=0.3)
NORMAL = np.where(CUBE.interfaces[0].points[:, 0] > 0.5, 0.65, 0.35)
FORCES = np.column_stack((NORMAL, -0.3 * NORMAL))
SLIDES = np.array([[1.0, 0.0, 0.0]])


def cube_check(alpha=0.3, velocity=SLIDES, forces=FORCES, direction="right"):
    return check_flow(CUBE, None, direction, alpha, Mechanism((1,), np.array(velocity)), forces)


def test_the_check_holds_for_a_sliding_cube_and_what_is_held_must_not_move():
    assert cube_check().holds
    assert max(astuple(cube_check())) < 1e-12
    guided = replace(CUBE, blocks=(replace(CUBE.blocks[0], held=("x",)),))
    assert check_flow(guided, None, "right", 0.3, Mechanism((1,), SLIDES), FORCES).held == 1.0


@pytest.mark.parametrize(
    ("changed", "error", "size"),
    [
        ({"alpha": 0.31}, "equilibrium", 0.01),
        ({"forces": FORCES * (1.0, 1.1)}, "friction", 0.3 * 0.065),
        ({"forces": -FORCES}, "friction", 0.65),
        ({"velocity": [[1.0, -0.2, 0.0]]}, "closing", 0.2),
        ({"velocity": [[1.0, 0.3, 0.0]]}, "dilatancy", 0.3),
        ({"velocity": [[-1.0, 0.0, 0.0]], "direction": "left"}, "dissipation", 0.6),
        ({"forces": FORCES * (1.0, 0.5)}, "dissipation", 0.15),
        ({"velocity": [[-1.0, 0.0, 0.0]]}, "dilatancy", np.inf),
    ],
)
def test_the_check_names_what_is_wrong(changed, error, size):
    check = cube_check(**changed)
    assert not check.holds
    assert getattr(check, error) == pytest.approx(size)


def fabricated(alpha, error=0.0, method=""):
    check = FlowCheck(error, 0.0, 0.0, 0.0, 0.0, 0.0)
    found = LimitStatus.OPTIMAL, "right", alpha, Mechanism((1,), SLIDES), np.zeros((2, 2))
    return NonassociativeResult(*found, method=method, check=check)


def test_the_least_verified_answer_is_told_but_no_motion_against_the_load():
    answers = [fabricated(0.5), fabricated(0.3, method="second"), fabricated(0.1, error=1e-3)]
    told = nonassociative._least_verified("right", 0.6, 9, answers)
    assert (told.alpha, told.method, told.answers) == (0.3, "second", (0.3, 0.5))
    assert told.status is LimitStatus.OPTIMAL
    against = nonassociative._least_verified("right", 0.6, 9, [fabricated(0.5), fabricated(-0.1)])
    assert (against.status, against.alpha) == (LimitStatus.UNSTABLE, None)
    assert against.answers == (-0.1, 0.5)
    assert "even against a load of 0.1000" in against.message


@pytest.mark.parametrize("part", [f.name for f in fields(FlowCheck)])
def test_a_check_with_an_error_or_no_number_does_not_hold(part):
    for error in (float("nan"), 1e-6):
        assert not replace(FlowCheck(*[0.0] * 6), **{part: error}).holds
