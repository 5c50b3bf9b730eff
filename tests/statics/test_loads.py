import math

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.errors import InputError
from drystone.statics.failing.mechanism import describe_mechanism
from drystone.statics.limit import load_range
from drystone.statics.loads import (
    LoadCase,
    Loads,
    growing_with_height,
    load_case,
    point_load,
    support_settlement,
    tilting_table,
    weight,
)
from drystone.statics.model import GROUND, Block, RigidBlockModel
from drystone.statics.result import LimitStatus
from tests.statics.walls import boxes, limit_load, stacked


def tower(mu=0.9):
    """Two blocks 1 x 2 on top of each other."""
    return boxes([0, 0, 1, 2], [0, 2, 1, 2], mu=mu)


@pytest.mark.parametrize("angle_deg", [3.0, 9.0])
def test_what_a_tilted_base_leaves_is_the_rest_of_the_angle(angle_deg):
    """Block 1 x 4: it falls at tan = .25; gravity has the share cos of it left downwards."""
    block = boxes([0, 0, 1, 4])
    _, loads = load_case(LoadCase("tilting", angle_deg, (), (), None), block)
    left, right = (limit_load(block, d, loads) for d in ("left", "right"))
    angle = math.radians(angle_deg)
    assert right.alpha == pytest.approx(0.25 * math.cos(angle) - math.sin(angle))
    assert left.alpha == pytest.approx(0.25 * math.cos(angle) + math.sin(angle))
    _, loads = load_case(LoadCase("tilting", 14.1, (), (), None), block)
    beyond = limit_load(block, "right", loads)
    assert beyond.status is LimitStatus.UNSTABLE  # atan .25 = 14.04 degrees


def test_a_load_that_grows_with_height_overturns_sooner():
    """Forces w alpha y / 2 at heights 1 and 3: moment alpha w (1 + 9) / 2 against 2 w / 2."""
    model = tower()
    assert limit_load(model, "right").alpha == pytest.approx(0.25)
    growing = limit_load(model, "right", growing_with_height(model))
    assert growing.alpha == pytest.approx(1 / 5)
    pushed = growing_with_height(model).live
    assert pushed[:, 0].sum() == pytest.approx(sum(block.weight for block in model.blocks))


def test_what_is_fixed_or_below_the_ground_is_not_pushed_by_a_load_that_grows_with_height():
    """All of the weight of the others is."""
    heights, fixed = (3.0, -3.0, 1.0, 9.0), (False, False, False, True)
    blocks = [Block(k, 2.0, (0.0, y), fixed=fixed[k]) for k, y in enumerate(heights)]
    pushed = growing_with_height(RigidBlockModel(tuple(blocks), ())).live[:3, 0]
    assert pushed == pytest.approx([4.5, 0.0, 1.5])
    with pytest.raises(InputError, match="E307"):
        growing_with_height(boxes([0, 0, 1, 2], fixed=(1,)))


def test_a_point_load_holds_the_block_down_it_acts_on():
    """A weight P at the top centre: (W + P) b / 2 = alpha W h / 2."""
    block = boxes([0, 0, 1, 4])
    table = tilting_table(block)
    pressed = Loads(table.dead + point_load(block, 1, (0.5, 4), (0, -2)), table.live)
    assert limit_load(block, "right", pressed).alpha == pytest.approx((4 + 2) * 0.5 / (4 * 2))


def test_the_gravity_factor_says_how_light_a_wall_may_be():
    block = boxes([0, 0, 1, 4])
    _, loads = load_case(LoadCase("gravity", 0.0, ("1@0,3:0.5,0",), (), None), block)
    carried = load_range(block, loads, mechanism=True)
    assert carried.least.alpha == pytest.approx(0.5 * 3 / (4 * 0.5))
    assert carried.least.certificate.holds
    assert carried.greatest.status is LimitStatus.UNBOUNDED
    assert carried.greatest.certificate.holds


def test_a_settling_support_is_held_up_by_its_share():
    """A beam of weight 4 on two supports; the right one gives way below half of it."""
    bridge = boxes([0, 0, 1, 1], [3, 0, 1, 1], [0, 1, 4, 1], fixed=(1, 2))
    model, loads = support_settlement(bridge, 2)
    assert not [i for i in model.interfaces if {i.block, i.other} == {2, GROUND}]
    carried = load_range(model, loads, mechanism=True)
    # The beam turns about the inner edge of the left support; the right one bears at x = 4.
    assert carried.least.alpha == pytest.approx(1 / 3)
    settling = carried.least.mechanism
    down = settling.velocity[settling.block_ids.index(2)]
    assert down[1] < 0
    assert (down[0], down[2]) == (0, 0)
    said = describe_mechanism(model, settling).words
    assert "2 rocks" not in said
    # Pressed up, the support lifts the beam about its far end, from its own inner edge on.
    assert carried.greatest.alpha == pytest.approx(2 / 3)


def test_a_support_much_larger_than_the_wall_may_settle():
    wall = boxes([0, 0, 1, 1000], [3, 0, 10_000, 1000], [0, 1000, 4, 1], fixed=(1, 2))
    carried = load_range(*support_settlement(wall, 2))
    ends = carried.least.alpha, carried.greatest.alpha
    assert ends == pytest.approx((1 / 3, 2 / 3))


def test_only_a_fixed_block_can_settle():
    with pytest.raises(InputError, match=r"E306.*not fixed.*Name a fixed one: there is none"):
        support_settlement(tower(), 1)
    with pytest.raises(InputError, match=r"E306.*no block 7.*There are 1, 2"):
        point_load(tower(), 7, (0, 0), (1, 0))


def test_no_alpha_may_hold_a_wall_up():
    labels = stacked((20, 20, 0), (20, 20, 12))
    model = model_from_labels(labels, 0.9).model
    pull = np.zeros((2, 3))
    pull[1] = (0, -1, 0)
    carried = load_range(model, Loads(weight(model), pull), mechanism=True)
    # Less weight does not hold it up before the stone is pulled off: it takes all of its weight.
    assert carried.greatest.alpha == pytest.approx(-400)
    sideways = np.zeros((2, 3))
    sideways[0] = (1, 0, 0)
    none = load_range(model, Loads(weight(model), sideways), mechanism=True)
    assert none.least.status is none.greatest.status is LimitStatus.UNSTABLE
    assert none.least.certificate.holds
    assert none.least.message == "No alpha holds the blocks up."
