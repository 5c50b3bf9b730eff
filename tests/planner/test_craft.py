"""The craft terms of an action, and what is known of the stone set as a whole."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone import Planner, PlannerSettings, Site
from drystone.model.landscape import Landscape
from drystone.model.placement import Placement, Wedge
from drystone.model.wall import Group
from drystone.planner.craft import PoseCosts, action_craft, place_cost, pose_cost
from drystone.planner.stock import Rest, Stock
from drystone.planner.workshop import Workshop
from drystone.poses import PoseBook
from drystone.selection.scored import PIN_BONUS, ScoreSettings, craft_cost
from tests.naive import indices
from tests.naive.placement import gap_beside, void_below
from tests.planner.scenes import blocks
from tests.strategies import posed_on_walls, repeatable

STOCK = Stock(narrowest_px=4.0, mean_height_px=5.0, mean_area_px=50.0, median_area_px=50.0)
SITE = Site(40, 20)


def slow_craft(labels, posed, place, wedges_px, rest):
    """The craft terms of a stone that is placed from the left, on whole images."""
    row, col = place
    (height, width), occupied = posed.mask.shape, labels > 0
    stone = indices.painted(labels.shape, posed.mask, row, col)
    extent, neighbour = indices.extent_of(stone), indices.left_neighbour(labels, stone)
    right = min(
        gap_beside(occupied[:, ::-1], line[None, ::-1], (row + k, labels.shape[1] - col - width))
        for k, line in enumerate(posed.mask)
    )
    tops = posed.mask.argmax(axis=0)
    if min(extent.x0, labels.shape[1] - extent.x1) < 4:
        joint = 1.0 - indices.inward_slope(stone, col + posed.anchor[0])
    else:
        joint = 1.0 - indices.interlocking(labels, stone, 4)
    step = 0 if neighbour is None else extent.y1 - indices.extent_of(labels == neighbour).y1
    return {
        "height": (extent.y0 + posed.anchor[1]) / 5,
        "void": (void_below(occupied, posed.mask, place) - wedges_px) / 50,
        "gap": min(1.0, gap_beside(occupied, posed.mask, place) / 50),
        "slot": rest.width_px[right] * height / 50,
        "headroom": rest.height_px[row] * width / 50,
        "step": abs(step) / 5,
        "roughness": np.abs(tops - np.median(tops)).mean() / 5,
        "upright": max(0.0, 1.0 - width / height),
        "joint": joint,
        "area": posed.area_px / 50,
        "thickness": min(height, width) / 5,
    }


@repeatable(200)
@given(
    scene=posed_on_walls(),
    side=st.sampled_from(["left", "right"]),
    wedges_px=st.sampled_from([0, 3]),
)
def test_craft_is_that_of_whole_images_and_known_before_but_for_step_and_joint(
    scene, side, wedges_px
):
    """From the right all is mirrored; a stone that stays costs what its place and its pose do."""
    wall, posed, row, col = scene
    rest = Rest(np.arange(wall.site.height_px + 1), np.arange(wall.site.width_px + 1) // 2)
    landscape = Landscape.of(wall, side)
    wedges = (Wedge(100, 99, np.ones((wedges_px, 1), bool), 0, 0),) if wedges_px else ()
    craft = action_craft(landscape, Group(Placement(posed, row, col, side), wedges), STOCK, rest)
    seen, place = landscape.view(posed), (row, landscape.view_col(posed, col))
    labels = wall.labels if side == "left" else wall.labels[:, ::-1]
    expected = slow_craft(labels, seen, place, wedges_px, rest)
    assert vars(craft) == pytest.approx(expected)
    assert min(craft.step, craft.joint) >= 0
    score = ScoreSettings(thickness=1.5)
    quick = place_cost(landscape, seen, place, STOCK, rest, score)
    known = quick + pose_cost(posed, STOCK, score) - score.void * wedges_px / 50
    others = score.step * craft.step + score.joint * craft.joint
    assert known + others == pytest.approx(craft_cost(craft, score), abs=1e-9)


def test_costs_of_poses_are_those_of_the_weights_of_now():
    book = PoseBook()
    poses = [book.pose(stone, 0.0) for stone in blocks({1: (20, 5), 2: (4, 10)})]
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
