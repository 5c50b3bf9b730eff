"""The craft terms of an action, by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.model.landscape import Landscape
from drystone.model.placement import Placement, Wedge
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Group, Wall
from drystone.planner.craft import PoseCosts, action_craft, place_cost, pose_cost
from drystone.planner.stock import Rest, Stock
from drystone.poses import PoseBook
from drystone.selection.scored import PIN_BONUS, ScoreSettings, craft_cost
from tests.strategies import posed_on_walls, repeatable

STOCK = Stock(
    narrowest_px=4.0, mean_height_px=5.0, mean_area_px=50.0, median_area_px=50.0, largest_id=9
)
SITE = Site(40, 20)


def _block(stone_id, width, height):
    return PoseBook().pose(Stone(stone_id, np.ones((height, width), bool)), 0.0)


def _rest(leaves=0):
    """Stones that always leave so much of a free length."""
    return Rest(np.full(21, leaves), np.full(41, leaves))


def _at(posed, left, bottom):
    return Placement(posed, SITE.height_px - bottom - posed.height_px, left)


def _wall(*placements):
    wall = Wall.empty(SITE)
    for placement in placements:
        wall = wall.add(placement)
    return wall


def _craft(wall, placement, rest=None):
    return action_craft(Landscape.of(wall), Group(placement), STOCK, rest or _rest())


def test_a_block_in_the_corner():
    craft = _craft(_wall(), _at(_block(1, 10, 5), 0, 0))
    assert craft.height == pytest.approx(2.5 / 5)
    assert craft.area == pytest.approx(1.0)
    nothing = (craft.void, craft.gap, craft.slot, craft.headroom, craft.step, craft.roughness)
    assert nothing == (0, 0, 0, 0, 0, 0)
    assert craft.upright == 0
    assert craft.joint == 1.0  # a boundary stone whose top does not slope: IS = 0


def test_height_void_and_gap():
    pillar = _at(_block(1, 10, 5), 0, 0)
    # On the pillar, 4 of 10 columns over nothing: 4 x 5 px; 6 px free on the left, 4 px high.
    craft = _craft(_wall(pillar), _at(_block(2, 8, 4), 6, 5))
    assert craft.height == pytest.approx((5 + 2) / 5)
    assert craft.void == pytest.approx(4 * 5 / 50)
    assert craft.gap == pytest.approx(6 * 4 / 50)
    # The gap counts for one stone at most.
    assert _craft(_wall(), _at(_block(2, 8, 8), 30, 0)).gap == 1.0


def test_a_wedge_fills_its_part_of_the_void():
    wall = _wall(_at(_block(1, 10, 5), 0, 0))
    placement = _at(_block(2, 8, 4), 6, 5)
    wedge = Wedge(10, 2, np.ones((5, 3), bool), 15, 11)
    craft = action_craft(Landscape.of(wall), Group(placement, (wedge,)), STOCK, _rest())
    assert craft.void == pytest.approx((4 * 5 - 15) / 50)


def test_step_to_the_neighbour():
    wall = _wall(_at(_block(1, 10, 5), 0, 0))
    assert _craft(wall, _at(_block(2, 10, 8), 10, 0)).step == pytest.approx(3 / 5)
    assert _craft(wall, _at(_block(2, 10, 5), 10, 0)).step == 0.0
    assert _craft(_wall(), _at(_block(2, 10, 8), 10, 0)).step == 0.0  # nothing to compare with


def test_what_the_rest_cannot_fill():
    craft = _craft(_wall(), _at(_block(1, 10, 5), 0, 0), _rest(3))
    assert craft.slot == pytest.approx(3 * 5 / 50)
    assert craft.headroom == pytest.approx(3 * 10 / 50)
    # The free width on the right is 30, the free height 15.
    width, height = np.zeros(41, int), np.zeros(21, int)
    width[30], height[15] = 2, 4
    craft = _craft(_wall(), _at(_block(1, 10, 5), 0, 0), Rest(height, width))
    assert craft.slot == pytest.approx(2 * 5 / 50)
    assert craft.headroom == pytest.approx(4 * 10 / 50)


def test_roughness_upright_and_joint():
    mask = np.ones((6, 8), bool)
    mask[:2, :4] = False  # a step of 2 px half way: 1 px on average from the median, 1 px down
    wall = _wall(_at(_block(1, 20, 5), 0, 0), _at(_block(2, 20, 5), 20, 0))
    stepped = PoseBook().pose(Stone(3, mask), 0.0)
    craft = _craft(wall, _at(stepped, 10, 5))
    assert craft.roughness == pytest.approx(1 / 5)
    assert craft.upright == 0
    # Its ends are 10 and 2 px from the joint at 20, of stones 20 px wide: IWR = (.5 + .1) / 2.
    assert craft.joint == pytest.approx(1 - 0.3)
    upright = _craft(wall, _at(_block(3, 4, 10), 10, 5))
    assert upright.upright == pytest.approx(1 - 4 / 10)
    assert upright.roughness == 0


def test_from_the_right_everything_is_mirrored():
    pillar, stone = _block(1, 10, 5), _block(2, 8, 4)
    left = _craft(_wall(_at(pillar, 0, 0)), _at(stone, 6, 5), _rest(2))
    mirrored = Placement(stone, SITE.height_px - 9, SITE.width_px - 6 - 8, "right")
    wall = _wall(_at(pillar, 30, 0))
    right = action_craft(Landscape.of(wall, "right"), Group(mirrored), STOCK, _rest(2))
    assert right == left


@repeatable(60)
@given(posed_on_walls(), st.sampled_from(["left", "right"]))
def test_place_and_pose_cost_what_the_action_costs_but_for_step_and_joint(scene, side):
    wall, posed, row, col = scene
    rest = Rest(np.arange(wall.site.height_px + 1), np.arange(wall.site.width_px + 1) // 2)
    score = ScoreSettings(thickness=1.5)
    landscape = Landscape.of(wall, side)
    craft = action_craft(landscape, Group(Placement(posed, row, col, side)), STOCK, rest)
    assert min(craft.step, craft.joint) >= 0
    place = row, landscape.view_col(posed, col)
    quick = place_cost(landscape, landscape.view(posed), place, STOCK, rest, score)
    known = quick + pose_cost(posed, STOCK, score)
    others = score.step * craft.step + score.joint * craft.joint
    assert known + others == pytest.approx(craft_cost(craft, score), abs=1e-9)


def test_costs_of_poses_are_those_of_the_weights_of_now():
    poses, costs = [_block(1, 20, 5), _block(2, 4, 10)], PoseCosts(STOCK, frozenset({2}))
    for score in (ScoreSettings(), ScoreSettings(area=9.0), ScoreSettings()):
        first, second = (pose_cost(posed, STOCK, score) for posed in poses)
        assert costs.of(poses, score).tolist() == [first, second - PIN_BONUS]
