"""The craft terms of an action, by hand, and what is known of the stone set as a whole."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone import Planner, PlannerSettings, Site, Stone
from drystone.model.landscape import Landscape
from drystone.model.placement import Placement, Wedge
from drystone.model.wall import Group, Wall
from drystone.planner.craft import PoseCosts, action_craft, place_cost, pose_cost
from drystone.planner.stock import Rest, Stock
from drystone.planner.workshop import Workshop
from drystone.poses import PoseBook
from drystone.selection.scored import PIN_BONUS, ScoreSettings, craft_cost
from tests.planner.scenes import blocks
from tests.strategies import posed_on_walls, repeatable

STOCK = Stock(narrowest_px=4.0, mean_height_px=5.0, mean_area_px=50.0, median_area_px=50.0)
SITE = Site(40, 20)


def _rest(leaves=0):
    """Stones that always leave so much of a free length."""
    return Rest(np.full(21, leaves), np.full(41, leaves))


def _placed(stone_id, width, height, left, bottom, side="left"):
    """A block with its left end and its lower edge somewhere."""
    posed = PoseBook().pose(Stone(stone_id, np.ones((height, width), bool)), 0.0)
    return Placement(posed, SITE.height_px - bottom - height, left, side)


def _craft(blocks, placement, rest=None, wedges=(), side="left"):
    """The craft of a placement on blocks: width, height, left end and lower edge of each."""
    wall = Wall.empty(SITE)
    for stone_id, block in enumerate(blocks, 1):
        wall = wall.add(_placed(stone_id, *block))
    group = Group(placement, wedges)
    return action_craft(Landscape.of(wall, side), group, STOCK, rest or _rest())


PILLAR, BED = (10, 5, 0, 0), ((20, 5, 0, 0), (20, 5, 20, 0))
NOTHING = dict.fromkeys(("void", "gap", "slot", "headroom", "step", "roughness", "upright"), 0.0)


@pytest.mark.parametrize(
    ("blocks", "block", "rest", "expected"),
    [
        # A boundary stone whose top does not slope: IS = 0.
        ([], PILLAR, 0, {**NOTHING, "height": 2.5 / 5, "area": 1.0, "joint": 1.0}),
        # On the pillar, 4 of 10 columns over nothing: 4 x 5 px; 6 px free on the left, 4 px high.
        ([PILLAR], (8, 4, 6, 5), 0, {"height": 7 / 5, "void": 4 * 5 / 50, "gap": 6 * 4 / 50}),
        ([], (8, 8, 30, 0), 0, {"gap": 1.0}),  # it counts for one stone at most
        ([PILLAR], (10, 8, 10, 0), 0, {"step": 3 / 5}),
        ([PILLAR], (10, 5, 10, 0), 0, {"step": 0.0}),
        ([], (10, 8, 10, 0), 0, {"step": 0.0}),  # there is nothing to compare with
        ([], PILLAR, 3, {"slot": 3 * 5 / 50, "headroom": 3 * 10 / 50}),
        (BED, (4, 10, 10, 5), 0, {"upright": 1 - 4 / 10, "roughness": 0.0}),
    ],
)
def test_craft_of_blocks(blocks, block, rest, expected):
    craft = vars(_craft(blocks, _placed(9, *block), _rest(rest)))
    assert {name: craft[name] for name in expected} == pytest.approx(expected)


def test_what_a_wedge_fills_and_the_rest_cannot_fill():
    wedge = Wedge(10, 2, np.ones((5, 3), bool), 15, 11)
    craft = _craft([PILLAR], _placed(2, 8, 4, 6, 5), wedges=(wedge,))
    assert craft.void == pytest.approx((4 * 5 - 15) / 50)
    # The free width on the right is 30, the free height 15.
    width, height = np.zeros(41, int), np.zeros(21, int)
    width[30], height[15] = 2, 4
    craft = _craft([], _placed(1, *PILLAR), Rest(height, width))
    assert craft.slot == pytest.approx(2 * 5 / 50)
    assert craft.headroom == pytest.approx(4 * 10 / 50)


def test_roughness_and_joint():
    mask = np.ones((6, 8), bool)
    mask[:2, :4] = False  # a step of 2 px half way: 1 px on average from the median, 1 px down
    stepped = PoseBook().pose(Stone(3, mask), 0.0)
    craft = _craft(BED, Placement(stepped, SITE.height_px - 5 - stepped.height_px, 10))
    assert craft.roughness == pytest.approx(1 / 5)
    assert craft.upright == 0
    # Its ends are 10 and 2 px from the joint at 20, of stones 20 px wide: IWR = (.5 + .1) / 2.
    assert craft.joint == pytest.approx(1 - 0.3)


def test_from_the_right_everything_is_mirrored():
    left = _craft([PILLAR], _placed(2, 8, 4, 6, 5), _rest(2))
    placement = _placed(2, 8, 4, SITE.width_px - 6 - 8, 5, "right")
    assert _craft([(10, 5, 30, 0)], placement, _rest(2), side="right") == left


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
    poses = [_placed(1, 20, 5, 0, 0).posed, _placed(2, 4, 10, 0, 0).posed]
    costs = PoseCosts(STOCK, frozenset({2}))
    for score in (ScoreSettings(), ScoreSettings(area=9.0), ScoreSettings()):
        first, second = (pose_cost(posed, STOCK, score) for posed in poses)
        assert costs.of(poses, score).tolist() == [first, second - PIN_BONUS]


def workshop_of(sizes):
    return Workshop.prepare(blocks(sizes), Site(40, 20), PlannerSettings())


def test_stock_and_the_sides_that_are_left():
    workshop = workshop_of({7: (20, 10), 300: (8, 4), 12: (12, 6)})
    stock = workshop.stock
    assert stock.narrowest_px == 8.0
    assert stock.mean_height_px == pytest.approx(20 / 3)
    assert stock.mean_area_px == pytest.approx((200 + 32 + 72) / 3)
    assert stock.sides == {7: (10, 20), 300: (4, 8), 12: (6, 12)}
    # One pose at a time is enough.
    assert Stock.of(workshop.poses(i)[0] for i in (7, 12, 300)) == stock
    # Nobody waits for what is placed, nor for what is banned.
    stones = blocks({1: (20, 10), 2: (8, 4), 3: (10, 20), 4: (14, 4)})
    planner = Planner(stones, SITE, settings=PlannerSettings(ban=(4,)))
    built = next(planner.steps())
    left = {1: (10, 20), 2: (4, 8), 3: (10, 20)}
    del left[built.stone_id]
    rest, asked = planner.workshop.rest(built.build), Rest.of([*left.values()], SITE)
    assert rest.width_px.tolist() == asked.width_px.tolist()
    assert rest.height_px.tolist() == asked.height_px.tolist()


@pytest.mark.parametrize(
    ("sizes", "heights", "widths"),
    [
        # Flat on each other; beside each other 4 or 8, 10 or 20, and sums of one of each.
        ({1: (20, 10), 2: (8, 4)}, [0, 4, 10, 14], [0, 4, 8, 10, 14, 18, 20, 24, 28]),
        # Also where they are of one height and of different widths.
        ({1: (20, 6), 2: (14, 6)}, [0, 6, 12], [0, 6, 12, 14, 20, 26, 34]),
    ],
)
def test_rest_lays_stones_flat_on_each_other_and_any_way_beside(sizes, heights, widths):
    workshop = workshop_of(sizes)
    rest = Rest.of([*workshop.stock.sides.values()], workshop.site)
    assert (rest.height_px.shape, rest.width_px.shape) == ((21,), (41,))
    assert np.flatnonzero(rest.height_px == 0).tolist() == heights
    assert np.flatnonzero(rest.width_px == 0).tolist() == widths
