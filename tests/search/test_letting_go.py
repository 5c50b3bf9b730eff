"""Where planned stones are let go, what it costs where they rest, and what they see."""

from dataclasses import replace
from itertools import pairwise

import pytest
import shapely

from drystone.kernels.profiles import hanging
from drystone.planner.search_settings import LayingSettings
from drystone.planner.views import SideView
from drystone.search.letting_go import Aim, Hand
from drystone.settle.rest import Turned
from drystone.settle.wedge import wedged
from tests.planner.scenes import RUBBLE_SITE, rubble
from tests.search.yards import Plot


class Drop:
    """A stone of some rubble over two others."""

    def __init__(self, side, settings):
        plot = Plot(rubble(2, 8), RUBBLE_SITE, {"settle": {"margin": 0.2}})
        outlines = plot.lay(*plot.rows(1)).build.wall.outlines
        self.view = SideView.bare(100.0, side, 0.58, 1.0).grown(outlines.polygons)
        stone = next(s for s in plot.stones if s.id not in dict(outlines.blocks))
        outline = plot.yard.workshop.outlines.outline(stone)
        self.stone = Turned.of(outline, 0.0, side, stone.area_px**0.5)
        self.hung = hanging(self.stone.corners, 1.0)
        self.unit_px = plot.yard.workshop.stock.mean_height_px
        self.hand = Hand(settings, plot.yard.settings.settle, plot.yard.limits, "both")

    def lifts(self):
        """Where the stone first touches, column by column."""
        tops, bottoms = self.view.profile.tops.tolist(), self.hung.bottoms.tolist()
        places = range(len(tops) - len(bottoms) + 1)
        return [max(tops[at + k] - b for k, b in enumerate(bottoms)) for at in places]

    def lost(self, at):
        """How far a left end in column `at` is from one at 30: a quarter of a height is free."""
        return max(0.0, at - 30.0, 30.0 - 0.25 * self.unit_px - at)

    def aim(self, left, top):
        return Aim(left, top, 0.0, 1e9, self.unit_px)

    def starts(self, aim):
        return self.hand.starts(self.stone, self.view, aim)

    def resting(self, aim, starts=None):
        starts = self.starts(aim) if starts is None else starts
        return self.hand.resting(self.stone, self.view, aim, starts)


@pytest.mark.parametrize("side", ["left", "right"])
def test_stones_are_let_go_where_they_first_touch_the_cheapest_place_first(side):
    settings = LayingSettings(starts=4, apart=0.1, reach=0.4, astray=2.0)
    drop = Drop(side, settings)
    hung, lifts, size = drop.hung, drop.lifts(), drop.stone.size_px
    starts = drop.starts(drop.aim(30.0, 20.0))
    assert len(starts) == 4
    costs = []
    for x, y in starts:
        at = round(x + hung.left)
        assert x + hung.left == pytest.approx(at, abs=1e-9)
        assert y == pytest.approx(lifts[at] + 0.02, abs=1e-9)
        costs.append(abs(y + hung.top - 20.0) + settings.width * drop.lost(at))
    assert costs == sorted(costs)
    columns = sorted(x for x, _ in starts)
    assert min(b - a for a, b in pairwise(columns)) >= 0.1 * size
    # No place beside these is cheaper.
    inside = range(30 - int(0.4 * size), 30 + int(0.4 * size) + 1)
    best = min(abs(lifts[at] + 0.02 + hung.top - 20.0) + 2.0 * drop.lost(at) for at in inside)
    assert costs[0] <= best + 1e-9


@pytest.mark.parametrize("side", ["left", "right"])
def test_stones_are_let_go_within_reach_not_too_high_and_inside(side):
    drop = Drop(side, LayingSettings(starts=100, apart=0.0, reach=0.5, astray=9.0))
    columns = sorted(round(x + drop.hung.left) for x, _ in drop.starts(drop.aim(30.0, 20.0)))
    reach = 0.5 * drop.stone.size_px
    assert columns == list(range(round(29.5 - reach), round(30.5 + reach) + 1))
    drop = Drop("left", LayingSettings(starts=100, apart=0.0, astray=0.3))
    hung, highest = drop.hung, min(drop.lifts()) + drop.hung.top
    starts = drop.starts(drop.aim(None, highest))
    assert starts
    assert max(y + hung.top for _, y in starts) <= highest + 0.3 * drop.unit_px
    assert min(x + hung.left for x, _ in starts) >= 0.0
    assert max(x + hung.right for x, _ in starts) <= 100.25
    assert drop.starts(drop.aim(None, highest - 0.4 * drop.unit_px)) == []


def test_starts_along_the_whole_wall_are_further_from_each_other():
    drop = Drop("left", LayingSettings(starts=3, apart=0.0, spread=0.4, astray=9.0))
    near, far = (sorted(x for x, _ in drop.starts(drop.aim(left, 20.0))) for left in (30.0, None))
    assert len(near) == len(far) == 3
    assert min(b - a for a, b in pairwise(far)) >= 0.4 * drop.stone.size_px
    assert min(b - a for a, b in pairwise(near)) < 0.4 * drop.stone.size_px


@pytest.mark.parametrize("name", ["top", "width", "turn", "rest"])
def test_where_a_stone_rests_costs_what_the_settings_say(name):
    plain = LayingSettings(top=0.0, width=0.0, turn=0.0, rest=0.0, astray=5.0, enough=99)
    drop = Drop("right", replace(plain, **{name: 1.0}))
    resting = drop.resting(drop.aim(20.0, 25.0))
    assert resting
    assert [one.cost for one in resting] == sorted(one.cost for one in resting)
    for one in resting:
        box = shapely.Polygon(one.repose.settled.corners).bounds
        expected = {
            "top": abs(box[3] - 25.0) / drop.unit_px,
            "width": max(0.0, 100.0 - box[2] - 20.0) / drop.unit_px,
            "turn": abs(one.repose.angle_deg) / 10.0,
            "rest": max(0.0, 1.0 - one.repose.margin),
        }
        assert one.cost == pytest.approx(expected[name], abs=1e-9)
    alike = {
        (round(r.repose.settled.x_px), round(r.repose.settled.y_px), r.repose.angle_deg)
        for r in resting
    }
    assert len(alike) == len(resting)


def test_a_stone_is_let_go_until_it_rests_in_enough_places():
    drop = Drop("left", LayingSettings(astray=5.0, apart=0.2, enough=99))
    aim = drop.aim(None, 25.0)
    starts = drop.starts(aim)

    def places(enough, starts):
        drop.hand = replace(drop.hand, settings=replace(drop.hand.settings, enough=enough))
        found = drop.resting(aim, starts)
        return {(one.repose.settled.x_px, one.repose.settled.y_px) for one in found}

    of_starts = [places(99, starts[: k + 1]) for k in range(len(starts))]
    assert len(of_starts[-1]) > len(of_starts[0]) >= 1
    for enough in range(1, len(of_starts[-1]) + 1):
        first = next(found for found in of_starts if len(found) >= enough)
        assert places(enough, starts) == first


def test_a_stone_is_wedged_at_the_cheapest_place_first():
    drop = Drop("left", LayingSettings(astray=5.0, apart=0.1, starts=9))
    hand = replace(drop.hand, method="wedge", settle=replace(drop.hand.settle, margin=1.4))
    drop.hand = hand = replace(hand, limits=replace(hand.limits, rest=0.05))
    aim = drop.aim(None, 25.0)
    found, scene = drop.resting(aim), drop.view.scene
    one_by_one = [
        wedged(drop.stone, scene, start, hand.settle, hand.limits) for start in drop.starts(aim)
    ]
    expected = {
        (round(one.repose.settled.x_px), round(one.repose.settled.y_px)): one.wedge.tobytes()
        for one in reversed(one_by_one)
        if one is not None
    }
    assert len(found) == len(expected) > 1
    assert [one.cost for one in found] == sorted(one.cost for one in found)
    for one in found:
        settled = one.repose.settled
        top = float(settled.corners[:, 1].max())
        unsure = hand.settings.rest * max(0.0, 1.0 - one.repose.margin)
        assert one.cost == pytest.approx(abs(top - 25.0) / drop.unit_px + 0.2 + unsure)
        assert one.wedge.tobytes() == expected[round(settled.x_px), round(settled.y_px)]


def test_a_stone_that_rests_above_the_wall_or_far_from_its_top_does_not_count():
    drop = Drop("left", LayingSettings(astray=5.0, enough=99))
    aim = drop.aim(None, 25.0)
    starts = drop.starts(aim)
    tops = sorted(one.repose.settled.corners[:, 1].max() for one in drop.resting(aim, starts))
    lower = float(tops[len(tops) // 2])
    assert 0 < len(drop.resting(replace(aim, highest_px=lower), starts)) < len(tops)
    near = Drop("left", LayingSettings(astray=0.01, enough=99))
    found = near.resting(near.aim(None, lower), starts)
    assert 0 < len(found) < len(tops)
    for one in found:
        assert one.repose.settled.corners[:, 1].max() == pytest.approx(lower, abs=0.2)
