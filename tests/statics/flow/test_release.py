"""Blocks that are let go: what is held by its own squeeze falls, what holds itself rests."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.statics.flow import release
from drystone.statics.flow.flow_search import NonassociativeSettings
from drystone.statics.flow.nonassociative import (
    check_flow,
    nonassociative_load,
    nonassociative_resistance,
)
from drystone.statics.flow.release import fall_of, with_inertia
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads, tilting_table
from drystone.statics.lp.program import assemble
from drystone.statics.result import LimitStatus, Mechanism
from drystone_lab.statics_cases import arch
from tests.naive.release import greatest_power_of_a_fall
from tests.statics.walls import (
    JAMS,
    between_piers,
    boxes,
    brick_model,
    irregular,
    slot,
    stacked,
    under_a_roof,
)
from tests.strategies import repeatable

FEW = NonassociativeSettings(random_starts=0)


def fall(model, rounds=60):
    return fall_of(model, assemble(model), rounds)


def moving(result):
    fast = np.abs(result.mechanism.velocity).max(axis=1) > 1e-6
    return [block for block, moves in zip(result.mechanism.block_ids, fast, strict=True) if moves]


@given(**JAMS)
@repeatable(10)
def test_a_brick_between_piers_falls_although_forces_exist_that_hold_it(
    pier, height, gap, mu, covered
):
    model = between_piers(pier, height, gap, mu, covered=covered)
    assume(lateral_resistance(model).stable)
    both = nonassociative_resistance(model, settings=FEW)
    for result, direction in ((both.left, "left"), (both.right, "right")):
        assert (result.status, result.alpha) == (LimitStatus.UNSTABLE, None)
        assert result.direction == direction
        assert result.check.holds
        assert moving(result) == [3]
        assert result.mechanism.velocity[2] == pytest.approx([0.0, -1.0, 0.0], abs=1e-9)
    assert nonassociative_load(model, "left", settings=FEW).status is LimitStatus.UNSTABLE


@pytest.mark.parametrize(("slope_deg", "mu"), [(0, 0.84), (25, 1.5), (40, 0.84)])
def test_what_hangs_under_a_roof_of_fixed_blocks_falls_freely(slope_deg, mu):
    """The models H and type b of Kao et al. (2022), whose faces lean away from the block."""
    model = under_a_roof(slope_deg, mu)
    associative = lateral_resistance(model)
    assert associative.left.status is LimitStatus.UNBOUNDED
    found = fall(model)
    assert found.acceleration == pytest.approx([0.0, -1.0, 0.0], abs=1e-9)
    assert np.abs(found.edges).max() < 1e-9
    assert nonassociative_load(model, "right").status is LimitStatus.UNSTABLE


@given(left=st.floats(-0.6, 0.4), right=st.floats(-0.4, 0.6), mu=st.sampled_from([0.2, 0.5, 0.9]))
@repeatable(10)
def test_a_block_in_a_slot_falls_as_its_twin_says(left, right, mu):
    assume(abs(left) > 0.02 and abs(right) > 0.02 and abs(right - left) > 0.02)
    model = slot(left, right, mu)
    falls = greatest_power_of_a_fall(model) > 0.0
    assert (fall(model) is not None) == falls


@pytest.mark.parametrize(
    "model",
    [brick_model(5, 4, 1.0, 0.58), arch(15, 0.3, 0.9), arch(20, 0.4, 0.5), slot(-0.5, 0.5, 0.58)],
)
def test_walls_and_arches_that_hold_themselves_rest(model):
    assert fall(model) is None


@given(seed=st.integers(0, 10**6), count=st.integers(4, 14), mu=st.sampled_from([0.4, 0.58, 0.9]))
@repeatable(25)
def test_every_fall_obeys_newton_and_coulomb(seed, count, mu):
    """Walls that do not stand fall too; what is said of them is checked in the same way."""
    model = model_from_labels(irregular(seed, count, 90, 50), mu).model
    program = assemble(model)
    found = fall_of(model, program, 60)
    stands = lateral_resistance(model).stable
    if found is None:
        return
    assert np.abs(found.inertia).max() > release.UNBALANCED
    loads, mechanism, forces = of_fall(model, program, found)
    assert check_flow(model, loads, "right", 0.0, mechanism, forces).holds
    # Weight does work; in equilibrium, without inertia, the same forces are no answer.
    assert float(loads.live.ravel() @ mechanism.velocity.ravel()) > 0.0
    if stands:
        assert not check_flow(model, None, "right", 0.0, mechanism, forces).holds


def of_fall(model, program, found):
    moves = found.acceleration.reshape(-1, 3) / (1.0, 1.0, program.length)
    first, second = program.weight * found.edges.T
    forces = np.column_stack((first + second, program.friction * (first - second)))
    loads = with_inertia(model, program, tilting_table(model), found)
    return loads, Mechanism(program.block_ids, moves), forces


@pytest.mark.parametrize(("size", "over"), [(20, 12), (20, 15), (40, 22)])
def test_a_block_over_an_edge_turns_about_it_as_fast_as_a_square_does(size, over):
    """Moment of weight over the moment of inertia about the edge; free fall is 1."""
    model = model_from_labels(stacked((size, size, 0), (size, size, over)), 2.0).model
    program = assemble(model)
    found = fall_of(model, program, 60)
    arm = over / size - 0.5
    turning = arm / (1.0 / 6.0 + arm**2 + 0.25)
    assert found.acceleration[3:] == pytest.approx([turning / 2, -turning * arm, -turning])
    loads, mechanism, forces = of_fall(model, program, found)
    assert check_flow(model, loads, "right", 0.0, mechanism, forces).holds


def test_falls_are_told_only_with_a_check_that_holds(monkeypatch):
    model = between_piers(1.0, 4.0, 1.0, 0.58)
    honest = release.fall_of

    def wrong(*asked):
        found = honest(*asked)
        return replace(found, inertia=found.inertia * 1.001)

    monkeypatch.setattr("drystone.statics.flow.nonassociative.fall_of", wrong)
    result = nonassociative_load(model, "left", settings=FEW)
    assert result.method != "let go"
    assert result.status is LimitStatus.FAILED
    assert "did not converge" in result.message


def test_a_solver_that_gives_up_tells_no_fall(monkeypatch):
    monkeypatch.setattr(release, "least_constraint", lambda *_: None)
    assert fall(between_piers(1.0, 4.0, 1.0, 0.58)) is None


@pytest.mark.parametrize(("unit", "density"), [(1e-3, 2500.0), (1e3, 1e-3)])
def test_what_falls_is_the_same_in_any_unit_and_density(unit, density):
    rows = [[unit * v for v in row] for row in ([0, 0, 1, 4], [2, 0, 1, 4], [1, 1.5, 1, 1])]
    model = boxes(*rows)
    heavy = tuple(replace(block, density=density) for block in model.blocks)
    result = nonassociative_load(replace(model, blocks=heavy), "right")
    assert (result.status, moving(result)) == (LimitStatus.UNSTABLE, [3])


def test_other_dead_loads_decide_what_falls():
    """Piers that are pushed together by more than the ground can take hold the brick."""
    model = between_piers(2.0, 4.0, 1.0, 0.58)
    table = tilting_table(model)
    pressed = table.dead.copy()
    pressed[0, 0], pressed[1, 0] = 6.0, -6.0
    assert nonassociative_load(model, "left").status is LimitStatus.UNSTABLE
    squeezed = Loads(pressed, table.live)
    assert nonassociative_load(model, "left", loads=squeezed, settings=FEW).success


def test_held_blocks_do_not_fall():
    model = between_piers(1.0, 4.0, 1.0, 0.58)
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
        [[0, 0], [-1, rise], [left, rise], [left, -rise], [-1, -rise]],
        [[0, 0], [-1, -rise], [-1, -3], [1, -3], [1, 0]],
        [[0, 0], [1, 0], [1, 3], [-1, 3], [-1, rise]],
    )
    blocks = [
        {"id": i, "fixed": i > 1, "polygon": [[x, y + 5] for x, y in corners]}
        for i, corners in enumerate(outlines, start=1)
    ]
    return model_from_json({"mu": mu, "blocks": blocks})


def pull_that_slides_it_out(model, half_angle_deg, mu):
    """It hangs on the lower lip and under the upper face at its tip, and slides at both.

    With all friction against the slip these are three equations for two forces and alpha.
    """
    angle = math.radians(half_angle_deg)
    s, c = math.sin(angle), math.cos(angle)
    block = model.blocks[0]
    x, y = block.centroid
    on_lip = np.array([-s + mu * c, c + mu * s])
    at_tip = np.array([-s + mu * c, -c - mu * s])
    arms = (np.array([-1.0 - x, 5.0 - s / c - y]), np.array([-x, 5.0 - y]))
    turning = [arm[0] * f[1] - arm[1] * f[0] for arm, f in zip(arms, (on_lip, at_tip), strict=True)]
    equations = np.array(
        [[on_lip[0], at_tip[0], -block.weight], [on_lip[1], at_tip[1], 0.0], [*turning, 0.0]]
    )
    first, second, alpha = np.linalg.solve(equations, [0.0, block.weight, 0.0])
    assert min(first, second, alpha) > 0.0
    return alpha


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


def test_where_the_search_gives_up_beside_an_unbounded_load_it_says_so():
    model = in_a_notch(30, 1.26, 0.84)
    nothing = NonassociativeSettings(starts=(), random_starts=0)
    result = nonassociative_load(model, "left", settings=nothing)
    assert (result.status, result.alpha) == (LimitStatus.FAILED, None)
    assert "no load is too great" in result.message
