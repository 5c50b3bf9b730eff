"""Loads without dilatancy: closed forms, slow twins, statuses and the check.

And blocks that are let go: what is held by its own squeeze falls, what holds itself rests.
"""

import math
from dataclasses import astuple, fields, replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.statics.flow import nonassociative, release
from drystone.statics.flow.flow_search import STARTS, NonassociativeSettings
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.flow.release import fall_of, held_by_upright_faces, with_inertia
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads, tilting_table
from drystone.statics.lp.program import assemble
from drystone.statics.result import LimitStatus, Mechanism
from drystone_lab.statics_cases import arch
from tests.naive.flow import falls, least_limit
from tests.statics import walls
from tests.statics.walls import between_piers, boxes, irregular, slot
from tests.strategies import repeatable

FEW = NonassociativeSettings(random_starts=0)


@pytest.mark.parametrize(("seed", "count", "mu"), [(7, 2, 0.7), (8, 2, 0.4), (3, 3, 0.7)])
def test_the_least_of_all_sets_of_contact_states(seed, count, mu):
    model = model_from_labels(irregular(seed, count, 24, 18), mu).model
    found, associative = nonassociative_resistance(model), lateral_resistance(model)
    for result in (found.left, found.right):
        if result.status is LimitStatus.UNSTABLE:
            assert associative.left.status is LimitStatus.UNSTABLE
            continue
        assert result.alpha == pytest.approx(least_limit(model, result.direction), abs=1e-7)
    if seed == 7:  # well below the load with dilatancy
        assert found.right.alpha < associative.right.alpha - 0.05


@pytest.mark.parametrize(("seed", "direction"), [(13, "left"), (13, "right"), (24, "left")])
def test_a_single_start_finds_an_answer_where_equal_steps_need_many_rounds(seed, direction):
    model = model_from_labels(irregular(seed, 20, 110, 60), 0.75).model
    one = NonassociativeSettings(rounds=25, starts=STARTS[:1], random_starts=0)
    result = getattr(nonassociative_resistance(model, settings=one), direction)
    assert result.success
    assert result.check.holds


def test_no_load_has_no_sign():
    pair = boxes([0, 0, 1, 1], [0.5, 1, 1, 1])  # it just stands
    alphas = nonassociative_resistance(pair).right.answers
    assert [math.copysign(1.0, alpha) for alpha in alphas] == [1.0] * len(alphas) != []


def test_the_same_every_time_with_a_check_that_holds():
    model = model_from_labels(irregular(3, 8, 60, 40), 0.58).model
    first, second = (nonassociative_resistance(model).right for _ in range(2))
    assert first.success
    assert first.check.holds
    assert first.rounds > 0
    again = nonassociative.check_flow(
        model, None, "right", first.alpha, first.mechanism, first.forces
    )
    assert first.check == again
    assert np.hypot(*first.mechanism.velocity[:, :2].T).max() == pytest.approx(1.0)
    assert (first.alpha, first.method) == (second.alpha, second.method)
    np.testing.assert_array_equal(first.forces, second.forces)
    np.testing.assert_array_equal(first.mechanism.velocity, second.mechanism.velocity)


SLIPPERY = boxes([0, 0, 1, 4], mu=0.65)
(BLOCK,), (BED,) = SLIPPERY.blocks, SLIPPERY.interfaces


@pytest.mark.parametrize(
    ("model", "alphas", "along", "factor"),
    [
        (boxes([0, 0, 1, 1], [0.2, 1, 1, 1], mu=0.9), (0.6, 0.4), 0.0, 1.0),
        (boxes([0, 0, 1, 2], mu=0.7), (0.25, 0.25), 0.0, 2.0),
        (boxes([0, 0, 1, 2], mu=0.7), (0.6, 0.4), 0.1, 1.0),
        (replace(SLIPPERY, interfaces=(replace(BED, mu=0.1),)), (0.1, 0.1), 0.0, 1.0),
        (replace(SLIPPERY, blocks=(replace(BLOCK, held=("turn",)),)), (0.65, 0.65), 0.0, 1.0),
        (replace(SLIPPERY, mu=0.0), (0.0, 0.0), 0.0, 1.0),
        (boxes([0, 0, 1, 1], fixed=(1,)), (None, None), 0.0, 1.0),
    ],
)
def test_blocks_slide_and_rock_where_they_do_by_hand(model, alphas, along, factor):
    """Also under a live load that is greater, or acts already in part."""
    table = tilting_table(model)
    loads = Loads(table.dead + along * table.live, factor * table.live)
    both = nonassociative_resistance(model, loads=loads)
    assert (both.left.alpha, both.right.alpha) == pytest.approx(alphas, abs=1e-9)
    if None in alphas:
        assert both.left.status is both.right.status is LimitStatus.UNBOUNDED
    elif model.mu and model.interfaces[0].mu is None:
        assert both.value == pytest.approx(min(alphas) / model.mu, abs=1e-9)
    else:  # a ratio to no friction, or to one that no joint has
        assert both.value is None


# The check itself, on a cube of weight 1 that slides to the right, mu = .3.

CUBE = boxes([0, 0, 1, 1], mu=0.3)
NORMAL = np.where(CUBE.interfaces[0].points[:, 0] > 0.5, 0.65, 0.35)
FORCES = np.column_stack((NORMAL, -0.3 * NORMAL))
SLIDES = np.array([[1.0, 0.0, 0.0]])


def cube_check(alpha=0.3, velocity=SLIDES, forces=FORCES, direction="right", cube=CUBE):
    return nonassociative.check_flow(
        cube, None, direction, alpha, Mechanism((1,), np.array(velocity)), forces
    )


def test_the_check_holds_for_a_sliding_cube_and_what_is_held_must_not_move():
    assert cube_check().holds
    assert max(astuple(cube_check())) < 1e-12
    guided = replace(CUBE, blocks=(replace(CUBE.blocks[0], held=("x",)),))
    assert cube_check(cube=guided).held == 1.0


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
        ({"velocity": [[0.0, 0.0, 1.0]]}, "dilatancy", np.inf),
    ],
)
def test_the_check_names_what_is_wrong(changed, error, size):
    check = cube_check(**changed)
    assert not check.holds
    assert getattr(check, error) == pytest.approx(size)


def told(associative, *alphas):
    """What is said of verified answers, the last of them by another method."""
    found = nonassociative.NonassociativeResult(LimitStatus.OPTIMAL, "right", associative)
    answers = [replace(found, alpha=a, method="last" * (a == alphas[-1])) for a in alphas]
    return nonassociative._least_verified(found, replace(found, rounds=9), answers)


def test_the_least_answer_is_told_and_falling_only_of_what_moves_under_no_load():
    least = told(0.6, 0.5, 0.3)
    assert (least.alpha, least.method, least.answers) == (0.3, "last", (0.3, 0.5))
    assert (least.status, least.rounds) == (LimitStatus.OPTIMAL, 9)
    assert told(0.0, 0.0).alpha == 0.0  # it just stands, by associated flow too
    for associative in (0.6, None):
        falls = told(associative, 0.5, 0.0)
        assert (falls.status, falls.alpha, falls.answers) == (
            LimitStatus.UNSTABLE,
            None,
            (0.0, 0.5),
        )
        assert "reach up to 0.5000" in falls.message


# Live loads that take a block off the face it lies on, or press it on: friction goes with them.

CLAMP = [[0, 0], [1, 0], [1, 3], [0, 3]], [[1, 1], [2, 1], [2, 2], [1, 2]]
LEANING = [[0, 0], [1, 0], [1.3, 3], [0, 3]], [[1.1, 1], [2, 1], [2, 2], [1.2, 2]]
RAMP = [[0, 0], [10, 0], [0, 5]], [[4, 3], [5, 2.5], [5.5, 3.5], [4.5, 4]]
FLAT = [[0, 0], [3, 0], [3, 1], [0, 1]], [[1, 1], [2, 1], [2, 2], [1, 2]]


@pytest.mark.parametrize(
    ("outlines", "dead", "live", "side"),
    [
        (FLAT, (0.25, 0.0), (-0.05, 0.5), "right"),
        (FLAT, (-0.25, 0.0), (-0.05, -0.5), "left"),
        (RAMP, (0.0, 0.0), (0.3, 1.0), "right"),
        (LEANING, (-3.0, 0.0), (1.0, 0.0), "right"),
        (CLAMP, (-3.0, 0.0), (-1.0, 0.0), "left"),  # this load does no work as the block slides
        (CLAMP, (-3.0, 0.0), (1.0, 0.5), "right"),
    ],
)
def test_a_block_stands_until_the_load_has_taken_its_friction(outlines, dead, live, side):
    """By hand: with F the sum of the loads, F (tangent +- mu normal) is 0 as it slides."""
    model = walls.with_one_free(outlines, 0.6)
    forces = np.zeros((2, 2, 3))
    forces[:, 1, :2] = dead, live
    loads = Loads(tilting_table(model).dead + forces[0], forces[1])
    both = nonassociative_resistance(model, loads=loads, settings=FEW)
    result, other = (both.right, both.left) if side == "right" else (both.left, both.right)
    face, toward = model.interfaces[-1], 1.0 if side == "right" else -1.0
    (x, y), (still, grows) = face.normal, (loads.dead[1, :2], toward * loads.live[1, :2])
    slides = [np.array([y, -x]) + mu * np.array([x, y]) for mu in (0.6, -0.6)]
    alphas = [-(still @ slide) / (grows @ slide) for slide in slides]
    assert result.alpha == pytest.approx(min(a for a in alphas if a > 0.0), abs=1e-9)
    assert result.check == nonassociative.check_flow(
        model, loads, side, result.alpha, result.mechanism, result.forces
    )
    assert other.status in (LimitStatus.FAILED, LimitStatus.UNBOUNDED)


@pytest.mark.parametrize("part", [f.name for f in fields(nonassociative.FlowCheck)])
def test_a_check_with_an_error_or_no_number_does_not_hold(part):
    for error in (float("nan"), 1e-6):
        assert not replace(nonassociative.FlowCheck(*[0.0] * 6), **{part: error}).holds


# Blocks that are let go.


def fall(model):
    return fall_of(model, assemble(model), 60)


@given(
    pier=st.floats(0.6, 3.0),
    height=st.floats(2.5, 5.0),
    gap=st.floats(0.4, 1.5),
    mu=st.sampled_from([0.4, 0.58, 0.84]),
    covered=st.booleans(),
    unit=st.sampled_from([1.0, 1e-3, 1e3]),
    density=st.sampled_from([1.0, 2500.0, 1e-3]),
)
@repeatable(25)
def test_a_brick_between_piers_falls_although_forces_exist_that_hold_it(density, **scene):
    model = between_piers(**scene)
    assume(lateral_resistance(model).stable)
    assert held_by_upright_faces(model) == (3,)
    heavy = tuple(replace(block, density=density) for block in model.blocks)
    both = nonassociative_resistance(replace(model, blocks=heavy), settings=FEW)
    for result, direction in ((both.left, "left"), (both.right, "right")):
        assert (result.status, result.alpha) == (LimitStatus.UNSTABLE, None)
        assert result.direction == direction
        assert result.check.holds
        assert "dead load alone" in result.message
        fast = np.abs(result.mechanism.velocity).max(axis=1) > 1e-6
        assert fast.tolist() == [block.id == 3 for block in model.blocks]
        assert result.mechanism.velocity[2] == pytest.approx([0.0, -1.0, 0.0], abs=1e-9)


@pytest.mark.parametrize(("slope_deg", "mu"), [(0, 0.84), (25, 1.5), (40, 0.84)])
def test_what_hangs_under_a_roof_of_fixed_blocks_falls_freely(slope_deg, mu):
    """The models H and type b of Kao et al. (2022), whose faces lean away from the block."""
    model = walls.under_a_roof(slope_deg, mu)
    associative = lateral_resistance(model)
    assert associative.left.status is LimitStatus.UNBOUNDED
    found = fall(model)
    assert found.acceleration == pytest.approx([0.0, -1.0, 0.0], abs=1e-9)
    assert np.abs(found.edges).max() < 1e-9
    assert nonassociative_resistance(model).right.status is LimitStatus.UNSTABLE


@given(left=st.floats(-0.6, 0.4), right=st.floats(-0.4, 0.6), mu=st.sampled_from([0.2, 0.5, 0.9]))
@repeatable(10)
def test_a_block_in_a_slot_falls_as_its_twin_says(left, right, mu):
    assume(abs(left) > 0.02 and abs(right) > 0.02 and abs(right - left) > 0.02)
    model = slot(left, right, mu)
    assert (fall(model) is not None) == falls(model)


@pytest.mark.parametrize(
    "model",
    [
        walls.brick_model(5, 4, 1.0, 0.58),
        arch(15, 0.3, 0.9),
        arch(20, 0.4, 0.5),
        slot(-0.5, 0.5, 0.58),
    ],
)
def test_walls_and_arches_that_hold_themselves_rest(model):
    assert fall(model) is None


@given(seed=st.integers(0, 10**6), count=st.integers(4, 14), mu=st.sampled_from([0.4, 0.58, 0.9]))
@repeatable(25)
def test_every_fall_obeys_newton_and_coulomb(seed, count, mu):
    """Walls that do not stand fall too; what is said of them is checked in the same way."""
    model = model_from_labels(irregular(seed, count, 90, 50), mu).model
    found = fall(model)
    if found is None:
        return
    assert np.abs(found.inertia).max() > release.UNBALANCED
    program = assemble(model)
    moves = found.acceleration.reshape(-1, 3) / (1.0, 1.0, program.length)
    mechanism = Mechanism(program.block_ids, moves)
    first, second = program.weight * found.edges.T
    forces = np.column_stack((first + second, program.friction * (first - second)))
    loads = with_inertia(model, program, tilting_table(model), found)
    # The dead load does work, or there would be no power.
    assert nonassociative.check_flow(model, loads, "right", 0.0, mechanism, forces).holds
    # In equilibrium, without inertia, the same forces are no answer.
    if lateral_resistance(model).stable:
        assert not nonassociative.check_flow(model, None, "right", 0.0, mechanism, forces).holds


@pytest.mark.parametrize(("size", "over"), [(20, 12), (20, 15), (40, 22)])
def test_a_block_over_an_edge_turns_about_it_as_fast_as_a_square_does(size, over):
    """Moment of weight over the moment of inertia about the edge; free fall is 1."""
    found = fall(boxes([0, 0, size, size], [over, size, size, size], mu=2.0))
    arm = over / size - 0.5
    turning = arm / (1.0 / 6.0 + arm**2 + 0.25)
    assert found.acceleration[3:] == pytest.approx([turning / 2, -turning * arm, -turning])


def test_falls_are_told_only_with_a_check_that_holds(monkeypatch):
    def wrong(*asked):
        found = fall_of(*asked)
        return replace(found, inertia=found.inertia * 1.001)

    monkeypatch.setattr("drystone.statics.flow.nonassociative.fall_of", wrong)
    one = NonassociativeSettings(starts=STARTS[:1], random_starts=0, paths=())
    result = nonassociative_resistance(between_piers(), settings=one).left
    assert result.method != "let go"
    assert "start to fall" not in result.message


def test_a_solver_that_gives_up_tells_no_fall_and_names_no_block(monkeypatch):
    with monkeypatch.context() as patched:
        patched.setattr(release, "least_constraint", lambda *_: None)
        assert fall(between_piers()) is None
        assert held_by_upright_faces(between_piers()) is None
    monkeypatch.setattr(release, "lateral_resistance", lambda *_, **__: walls.gave_up())
    assert held_by_upright_faces(between_piers()) is None


def test_other_dead_loads_decide_what_falls():
    """Piers that are pushed together by more than the ground can take hold the brick."""
    model = between_piers(2.0)
    table = tilting_table(model)
    pressed = table.dead.copy()
    pressed[0, 0], pressed[1, 0] = 6.0, -6.0
    assert nonassociative_resistance(model).left.status is LimitStatus.UNSTABLE
    squeezed = Loads(pressed, table.live)
    assert nonassociative_resistance(model, loads=squeezed, settings=FEW).left.success


def test_held_blocks_do_not_fall():
    model = between_piers()
    held = replace(model.blocks[2], held=("y",))
    guided = replace(model, blocks=(*model.blocks[:2], held))
    assert fall(guided) is None
    nailed = replace(model.blocks[2], held=("x", "y", "turn"))
    alone = replace(model, blocks=(nailed,), interfaces=())
    assert fall(alone) is None


# Where no load is too great for associated flow.


def in_a_notch(half_angle_deg, length, mu):
    """A block, 1, in a notch that opens to the left; 2 and 3 are the lips, 1 long across."""
    rise = math.tan(math.radians(half_angle_deg))
    left = -1.0 - length
    outlines = (
        [[0, 5], [-1, 5 + rise], [left, 5 + rise], [left, 5 - rise], [-1, 5 - rise]],
        [[0, 5], [-1, 5 - rise], [-1, 2], [1, 2], [1, 5]],
        [[0, 5], [1, 5], [1, 8], [-1, 8], [-1, 5 + rise]],
    )
    return walls.with_one_free(outlines, mu, free=1)


def pull_that_slides_it_out(model, half_angle_deg, mu):
    """It hangs on the lower lip and under the upper face at its tip, and slides at both.

    With all friction against the slip these are three equations for two forces and alpha.
    """
    s, c = math.sin(math.radians(half_angle_deg)), math.cos(math.radians(half_angle_deg))
    (block, *_), across = model.blocks, -s + mu * c
    forces = np.array([[across, c + mu * s], [across, -c - mu * s]])  # on the lip, at the tip
    arms = np.array([[-1.0, 5.0 - s / c], [0.0, 5.0]]) - block.centroid
    turning = arms[:, 0] * forces[:, 1] - arms[:, 1] * forces[:, 0]
    pull = [[-block.weight], [0.0], [0.0]]
    equations = np.hstack((np.vstack((forces.T, turning)), pull))
    found = np.linalg.solve(equations, [0.0, block.weight, 0.0])
    assert found.min() > 0.0
    return found[2]


@pytest.mark.parametrize(
    ("half_angle_deg", "length", "mu"), [(30, 1.26, 0.84), (30, 2.0, 0.84), (20, 1.5, 0.6)]
)
def test_a_gripped_block_is_pulled_out_without_dilatancy(half_angle_deg, length, mu):
    """The model type b of Kao et al. (2022), lying; an engine pulls the first out at .347."""
    model = in_a_notch(half_angle_deg, length, mu)
    assert lateral_resistance(model).left.status is LimitStatus.UNBOUNDED
    both = nonassociative_resistance(model, settings=FEW)
    expected = pull_that_slides_it_out(model, half_angle_deg, mu)
    assert both.left.alpha == pytest.approx(expected, abs=1e-7)
    assert both.left.check.holds
    assert (both.right.status, both.right.alpha) == (LimitStatus.UNBOUNDED, None)
    assert "No motion" in both.right.message


@pytest.mark.parametrize(
    ("model", "most"),
    [(in_a_notch(30, 1.26, 0.84), "no load is too great"), (boxes([0, 0, 1, 2]), "one, 0.5.")],
)
def test_where_the_search_gives_up_it_says_what_associated_flow_carries(model, most):
    nothing = NonassociativeSettings(starts=(), random_starts=0, paths=())
    result = nonassociative_resistance(model, settings=nothing).left
    assert (result.status, result.alpha) == (LimitStatus.FAILED, None)
    assert "did not converge in 0 rounds" in result.message
    assert most in result.message
