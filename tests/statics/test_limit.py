"""What walls carry, by all solvers, under all loads."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.errors import InputError
from drystone.statics import loads as other_loads
from drystone.statics.failing.mechanism import describe_mechanism
from drystone.statics.incremental import SIMPLEX, incremental_analysis
from drystone.statics.limit import lateral_resistance, load_range
from drystone.statics.loads import LoadCase, Loads, load_case, point_load, tilting_table, weight
from drystone.statics.lp import clarabel, extremes, highs
from drystone.statics.lp.highs import HighsSession
from drystone.statics.lp.program import assemble, units_of
from drystone.statics.model import GROUND, NO_SLIP, Block, RigidBlockModel
from drystone.statics.result import LimitStatus
from tests.polygons import box_of
from tests.statics.walls import alphas, boxes, coursed, irregular, limit_load
from tests.strategies import repeatable

WALL = model_from_labels(coursed(5, 4, 90)).model


def statuses(both):
    return both.left.status, both.right.status


def test_what_overhangs_too_far_is_unstable_in_both_directions():
    """A push to the left would hold it up; by itself it falls."""
    both = lateral_resistance(boxes([0, 0, 1, 1], [0.6, 1, 1, 1], mu=0.9))
    assert statuses(both) == (LimitStatus.UNSTABLE, LimitStatus.UNSTABLE)
    assert (both.left.alpha, both.right.alpha, both.value, both.stable) == (None, None, None, False)
    assert "own weight" in both.right.message


def test_a_solver_that_there_is_not_is_named():
    model = boxes((0, 0, 2, 1))
    for loads in (None, tilting_table(model)):
        find = lateral_resistance if loads is None else load_range
        with pytest.raises(ValueError, match=r"solver must be one of 'auto', .*, not 'x'"):
            find(model, loads, solver="x")


def test_a_wall_stands_where_nothing_limits_the_load():
    """Pressed onto the ground, or between fixed ones, a block carries any load."""
    both = lateral_resistance(boxes([0, 0, 1, 2], [1, 0, 1, 1], fixed=(1,)), mechanism=True)
    assert statuses(both) == (LimitStatus.UNBOUNDED, LimitStatus.OPTIMAL)
    assert (both.left.alpha, both.value, both.stable) == (None, None, True)
    assert both.right.alpha == pytest.approx(0.58)
    assert both.right.mechanism.block_ids == (2,)
    block = boxes([0, 0, 2, 1])
    both = lateral_resistance(block, Loads(weight(block), np.array([[0.0, -1.0, 0.0]])))
    assert statuses(both) == (LimitStatus.OPTIMAL, LimitStatus.UNBOUNDED)


def test_what_all_algorithms_give_up_on_is_failed_and_no_number(monkeypatch):
    brief = {**highs._SIMPLEX, "simplex_iteration_limit": 1}
    monkeypatch.setattr(highs, "_OPTIONS", {**highs._OPTIONS, "simplex": brief, "ipm": brief})
    settings = clarabel._settings(1e-12)
    settings.max_iter = 1
    monkeypatch.setattr(clarabel, "_settings", lambda _: settings)
    both = lateral_resistance(WALL, mechanism=True)
    assert statuses(both) == (LimitStatus.FAILED, LimitStatus.FAILED)
    assert (both.value, both.left.alpha, both.left.mechanism) == (None, None, None)
    assert "gave up" in both.left.message


def test_one_failed_direction_leaves_the_other_unknown(monkeypatch):
    """That the wall stands by itself follows only from both."""
    monkeypatch.setattr(highs, "_PRIMAL", {"simplex_iteration_limit": 0})
    both = lateral_resistance(WALL, solver="highs")
    assert both.left.status is LimitStatus.OPTIMAL  # a cold solve came to help
    only_upwards = extremes.certified_extreme

    def stuck(program, session, sign):
        answer = only_upwards(program, session, sign)
        return answer if sign > 0 else replace(answer, certificate=None)

    monkeypatch.setattr(extremes, "certified_extreme", stuck)
    both = lateral_resistance(WALL)
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
        gave_up = replace(found, status=LimitStatus.OPTIMAL, said="MaxIterations")
        return gave_up if stopped else found

    monkeypatch.setattr(clarabel.ClarabelSession, "_solved", stopping)
    again = [lateral_resistance(wall, solver="clarabel") for wall in walls]
    assert said == 4 * [LimitStatus.OPTIMAL] + [LimitStatus.UNSTABLE, LimitStatus.OPTIMAL]
    assert [statuses(one) for one in again] == [statuses(one) for one in expected]
    assert again[0].value == pytest.approx(expected[0].value)
    assert again[1].left.certificate.fall_work > 0.0


@pytest.mark.parametrize("wrong", ["columns", "duals"])
def test_a_wrong_optimal_answer_is_found_out_and_asked_again(wrong, monkeypatch):
    """As a warm-started solver once gave them (HiGHS issue 3194)."""
    expected = lateral_resistance(WALL)
    right = HighsSession._vectors

    def vectors(session, status):
        found = dict(zip(("columns", "duals"), right(session, status), strict=True))
        if session.name == "HiGHS simplex":
            found[wrong] = found[wrong] + 1e-3 * np.arange(len(found[wrong]))
        return found["columns"], found["duals"]

    monkeypatch.setattr(HighsSession, "_vectors", vectors)
    again = lateral_resistance(WALL)
    assert again.right.solver == "HiGHS ipm"
    assert again.value == pytest.approx(expected.value, abs=1e-8)
    alone = lateral_resistance(WALL, solver="highs")
    assert statuses(alone) == (LimitStatus.FAILED, LimitStatus.FAILED)


@given(seed=st.integers(0, 10**6), count=st.integers(2, 25), coursing=st.booleans())
@repeatable(25)
def test_solvers_agree_and_every_answer_is_certified(seed, count, coursing):
    labels = coursed(seed, 2 + count // 8, 90) if coursing else irregular(seed, count, 90, 50)
    model = model_from_labels(labels).model
    answers = [
        lateral_resistance(model, solver=solver, mechanism=True)
        for solver in ("highs", "highs-ipm", "clarabel")
    ]
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
def test_a_guide_from_a_file_keeps_a_block_from_turning(held, alpha):
    tall = {"id": 1, "polygon": box_of(0, 0, 10, 40).tolist(), "held": list(held)}
    result = limit_load(model_from_json({"blocks": [tall]}), "right", mechanism=True)
    if alpha is None:
        assert result.status is LimitStatus.UNBOUNDED
        assert result.certificate.holds
    else:
        assert result.alpha == pytest.approx(alpha)
        assert (result.mechanism.velocity[0][2] == 0) == bool(held)


def test_many_blocks_are_solved_by_the_interior_point_method(monkeypatch):
    expected = lateral_resistance(WALL)
    monkeypatch.setattr(extremes, "MANY_BLOCKS", 3)
    found = lateral_resistance(WALL)
    assert found.left.solver == "Clarabel"
    assert found.value == pytest.approx(expected.value, abs=1e-9)
    assert lateral_resistance(WALL, mechanism=True).left.solver == "HiGHS simplex"


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


def test_friction_at_which_nothing_slides_has_one_answer():
    """That of the greatest friction which counts; whole walls, and walls that grow."""
    mu = 1e300
    for labels in (irregular(3, 30, 120, 100), coursed(3, 5, 120, 2)):
        model = model_from_labels(labels, mu).model
        both = lateral_resistance(model)
        assert alphas(model) == alphas(replace(model, mu=NO_SLIP))
        assert both.left.certificate.holds
        own = tuple(replace(interface, mu=mu) for interface in model.interfaces)
        assert alphas(replace(model, interfaces=own)) == alphas(model)
        found = incremental_analysis(model, units_of(model)).result
        assert not found.solved_cold
        assert found.resistance.left.alpha == pytest.approx(both.left.alpha, abs=1e-8)
    stack = boxes([0, 0, 1, 1], [0, 1, 1, 1], mu=mu)
    found = incremental_analysis(stack, units_of(stack)).result.resistance.left
    assert found.solver in {SIMPLEX, highs.WARM}
    assert found.alpha == pytest.approx(0.5, abs=1e-9)


def test_residuals_of_large_friction_are_corrected():
    """Otherwise three of 240 walls at a friction of 1,000 to 10,000 had no certified answer."""
    for labels, mu in ((irregular(11, 31, 140, 100), 1e4), (coursed(48, 9, 150, 0), 1e3)):
        both = lateral_resistance(model_from_labels(labels, mu).model)
        assert both.left.certificate.holds
        assert both.right.certificate.holds


# A stone far lighter than the others falls at its own load, not at that of the wall.


@given(
    side=st.floats(100, 1500), height=st.floats(1.8, 3), solver=st.sampled_from(["highs", "auto"])
)
@repeatable(20)
def test_a_speck_on_a_block_overturns_by_its_own_shape(side, height, solver):
    model = model_from_json({"blocks_xywh": [[0, 0, side, side], [side / 3, side, 1, height]]})
    both = lateral_resistance(model, solver=solver, mechanism=True)
    assert (both.left.alpha, both.right.alpha) == pytest.approx((1 / height, 1 / height), rel=1e-6)
    # Alone, and turning: the large one stays.
    speed = np.abs(both.right.mechanism.velocity)
    assert speed[0].max() < 1e-6 * speed[1].max()


def test_a_speck_that_stands_on_nothing_brings_the_wall_down():
    model = boxes([0, 0, 900, 900], [899.6, 900, 1, 2])
    assert lateral_resistance(model).left.status is LimitStatus.UNSTABLE


@pytest.mark.parametrize("count", [3, 10])
def test_slivers_under_a_heavy_block_have_an_answer(count):
    thin = 3e-6 * 50
    slivers = [[0, thin * k, 100, thin] for k in range(count)]
    assert alphas(boxes(*slivers, [0, thin * count, 100, 50])) == pytest.approx((0.58, 0.58))


def test_what_weighs_nothing_falls_at_no_load_of_its_own():
    model = boxes([0, 0, 9, 9], [8, 9, 2, 2])
    for density in (0.0, 1e-12):
        weightless = replace(model.blocks[1], density=density)
        model = replace(model, blocks=(model.blocks[0], weightless))
        assert alphas(model) == pytest.approx((0.58, 0.58))


def test_walls_of_like_stones_have_the_units_of_the_wall():
    assert extremes.units_of_light_blocks(WALL, assemble(WALL)) is None


# Loads other than the tilting table.


@pytest.mark.parametrize("angle_deg", [3.0, 9.0, 14.1])
def test_what_a_tilted_base_leaves_is_the_rest_of_the_angle(angle_deg):
    """Block 1 x 4: it falls at tan = .25; gravity has the share cos of it left downwards."""
    block, angle = boxes([0, 0, 1, 4]), math.radians(angle_deg)
    _, loads = load_case(LoadCase("tilting", angle_deg, (), (), None), block)
    both = lateral_resistance(block, loads)
    if angle_deg > 14.04:
        assert both.right.status is LimitStatus.UNSTABLE
        return
    left, right = (0.25 * math.cos(angle) + sign * math.sin(angle) for sign in (1, -1))
    assert (both.left.alpha, both.right.alpha) == pytest.approx((left, right))


def test_what_is_fixed_or_below_the_ground_is_not_pushed_by_a_load_that_grows_with_height():
    """All of the weight of the others is."""
    heights, fixed = (3.0, -3.0, 1.0, 9.0), (False, False, False, True)
    blocks = [Block(k, 2.0, (0.0, y), fixed=fixed[k]) for k, y in enumerate(heights)]
    pushed = other_loads.growing_with_height(RigidBlockModel(tuple(blocks), ())).live[:3, 0]
    assert pushed == pytest.approx([4.5, 0.0, 1.5])
    with pytest.raises(InputError, match="E307"):
        other_loads.growing_with_height(boxes([0, 0, 1, 2], fixed=(1,)))


@pytest.mark.parametrize(("y", "below"), [(0, ()), (1, (2,)), (100, (2,)), (-1, (2,))])
def test_heights_of_a_load_count_from_where_the_blocks_stand(y, below):
    """On the ground, or on a fixed block wherever it lies."""
    rows = [0, y + bool(below), 1, 1], [0, y, 2, 1], [0, y + 1 + bool(below), 1, 1]
    model = boxes(*(rows if below else (rows[0], rows[2])), fixed=below)
    pushed = other_loads.growing_with_height(model).live
    assert pushed[[0, -1], 0].tolist() == [0.5, 1.5]


def test_a_point_load_holds_the_block_down_it_acts_on():
    """A weight P at the top centre: (W + P) b / 2 = alpha W h / 2."""
    block = boxes([0, 0, 1, 4])
    table = tilting_table(block)
    pressed = Loads(table.dead + point_load(block, 1, (0.5, 4), (0, -2)), table.live)
    assert limit_load(block, "right", pressed).alpha == pytest.approx((4 + 2) * 0.5 / (4 * 2))


def test_the_gravity_factor_says_how_light_a_wall_may_be():
    block = boxes([0, 0, 1, 4])
    _, loads = load_case(LoadCase("gravity", 0.0, ("1@0,3:0.5,0",), (), None), block)
    carried = load_range(block, loads)
    assert carried.least.alpha == pytest.approx(0.5 * 3 / (4 * 0.5))
    assert carried.least.certificate.holds
    assert carried.greatest.status is LimitStatus.UNBOUNDED
    assert carried.greatest.certificate.holds


@pytest.mark.parametrize(("size", "height"), [(1, 1), (10_000, 1000)])
def test_a_settling_support_is_held_up_by_its_share(size, height):
    """A beam of weight 4 on two supports; the right one gives way below half of it."""
    rows = [0, 0, 1, height], [3, 0, size, height], [0, height, 4, 1]
    model, loads = other_loads.support_settlement(boxes(*rows, fixed=(1, 2)), 2)
    assert not [i for i in model.interfaces if {i.block, i.other} == {2, GROUND}]
    carried = load_range(model, loads)
    # The beam turns about the inner edge of the left support; the right one bears at x = 4.
    assert carried.least.alpha == pytest.approx(1 / 3)
    settling = carried.least.mechanism
    down = settling.velocity[settling.block_ids.index(2)]
    assert down[1] < 0
    assert (down[0], down[2]) == (0, 0)
    assert "2 rocks" not in describe_mechanism(model, settling).words
    # Pressed up, the support lifts the beam about its far end, from its own inner edge on.
    assert carried.greatest.alpha == pytest.approx(2 / 3)


def test_only_a_fixed_block_can_settle():
    tower = boxes([0, 0, 1, 2], [0, 2, 1, 2])
    with pytest.raises(InputError, match=r'E306.*not fixed.*Say "fixed": true of the'):
        other_loads.support_settlement(tower, 1)
    with pytest.raises(InputError, match=r"E306.*not fixed.*Name a fixed one: 1"):
        other_loads.support_settlement(boxes([0, 0, 1, 2], [0, 2, 1, 2], fixed=(1,)), 2)
    with pytest.raises(InputError, match=r"E306.*no block 7.*There are 1, 2"):
        point_load(tower, 7, (0, 0), (1, 0))


def test_loads_that_do_nothing_are_refused():
    """Nothing would limit them."""
    tower = boxes([0, 0, 1, 2], [0, 2, 1, 2], fixed=(1,))
    with pytest.raises(InputError, match=r"E306.*block 1 is fixed.*Name a free one: 2"):
        point_load(tower, 1, (0, 0), (1, 0))
    for live in (["2@0,3:0,0"], ["2@0,3:.1,0", "2@0,3:.2,0", "2@0,3:-.3,0"]):
        with pytest.raises(InputError, match=r"E308.*0, or cancel"):
            load_case(LoadCase("points", 0.0, (), live, None), tower)
    # A couple loads in any unit.
    for unit in (1e-14, 1.0, 1e14):
        block, weighs = boxes([0, 0, 2 * unit, 4 * unit]), 8 * unit**2
        pair = [f"1@{x * unit},{unit}:0,{y * weighs}" for x, y in ((0, 1), (2, -1))]
        _, loads = load_case(LoadCase("points", 0.0, (), pair, None), block)
        assert loads.live[0].tolist() == [0, 0, pytest.approx(-2 * unit * weighs)]


def test_a_force_that_solvers_would_leave_out_or_drown_in_is_refused():
    """Under one of 1e-9 mean weights nothing limited the load; not a number had no end."""
    block, dead = boxes([0, 0, 1000, 3000]), weight(boxes([0, 0, 1000, 3000]))
    for most in (1e-7, 1e7):
        live = point_load(block, 1, (500, 1500), (3e6 * most, 0))
        assert limit_load(block, "right", Loads(dead, live)).alpha * most == pytest.approx(1 / 3)
    for force in (1e-3, 1e14):
        with pytest.raises(InputError, match=r"E308.*times the mean weight"):
            point_load(block, 1, (500, 1500), (force, 0))
    with pytest.raises(InputError, match=r"E308.*finite"):
        Loads(dead, dead * np.nan)


@pytest.mark.parametrize(
    "given", [[[0, 0, 0]], 1.0, None, np.zeros(3), np.zeros((1, 2)), np.full((1, 3), "one"), ()]
)
def test_loads_that_are_no_arrays_of_three_numbers_a_block_are_refused(given):
    dead = weight(boxes([0, 0, 1, 1]))
    for loads in ((dead, given), (given, dead)):
        with pytest.raises(InputError, match=r"E308.*two arrays of finite numbers"):
            Loads(*loads)
    with pytest.raises(InputError, match=r"E308.*on 1 blocks, and 2 blocks"):
        lateral_resistance(boxes([0, 0, 1, 1], [0, 1, 1, 1]), Loads(dead, dead))


def test_no_alpha_may_hold_a_wall_up():
    model = boxes([0, 0, 20, 20], [12, 20, 20, 20], mu=0.9)
    # Less weight does not hold it up before the stone is pulled off: it takes all of its weight.
    pulled = Loads(weight(model), np.array([[0, 0, 0], [0, -1, 0]]))
    assert load_range(model, pulled).greatest.alpha == pytest.approx(-400)
    pushed = Loads(weight(model), np.array([[1, 0, 0], [0, 0, 0]]))
    none = load_range(model, pushed)
    assert none.least.status is none.greatest.status is LimitStatus.UNSTABLE
    assert none.least.certificate.holds
    assert none.least.message == "No alpha holds the blocks up."
