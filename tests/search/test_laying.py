"""Course plans laid on outlines: as planned where that is possible, and the truth where not."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
import shapely

from drystone.kernels.polygons import Points
from drystone.model.landscape import Landscape
from drystone.model.outlines import Outlined
from drystone.model.placement import Side
from drystone.model.site import Site
from drystone.planner.build import Build
from drystone.planner.evaluate import Evaluator, Loaded
from drystone.planner.laying_settings import LayingSettings
from drystone.planner.planner import Planner
from drystone.search.course_plan import PlannedStone
from drystone.search.laying import Laid, lay
from drystone.statics.incremental import IncrementalResult
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import Block, RigidBlockModel
from tests.planner.scenes import RUBBLE_SITE, blocks, rubble, stones_of_masks
from tests.search.yards import Yard


def _statuses(laid: Laid) -> list[list[str]]:
    return [[one.status for one in course] for course in laid.courses]


def _corners(build: Build) -> dict[int, Points]:
    assert build.wall.outlines is not None
    return dict(build.wall.outlines.blocks)


def _boxes(laid: Laid) -> dict[int, list[float]]:
    return {
        block: [*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist()]
        for block, corners in _corners(laid.build).items()
    }


def _bytes(laid: Laid) -> list[tuple[int, bytes]]:
    return [(block, corners.tobytes()) for block, corners in _corners(laid.build).items()]


BRICKS = {1: (20, 10), 2: (20, 10), 3: (20, 10), 4: (10, 10), 5: (20, 10), 6: (20, 10), 7: (10, 10)}
"""A course of three stones, and one of two with a half at each end."""


def _bond(yard: Yard) -> list[list[PlannedStone]]:
    place = yard.planned
    return [
        [place(1, 0, 0), place(2, 20, 0), place(3, 40, 0, "right")],
        [place(4, 0, 10), place(5, 10, 10), place(7, 50, 10, "right"), place(6, 30, 10, "right")],
    ]


def test_bricks_lie_as_planned() -> None:
    yard = Yard(blocks(BRICKS), Site(60, 20))
    laid = yard.lay(*_bond(yard))
    assert _statuses(laid) == [["as planned"] * 3, ["as planned"] * 4]
    assert [one.stone_id for one in laid.laid] == [1, 2, 3, 4, 5, 7, 6]
    assert laid.failed == ()
    boxes = _boxes(laid)
    for one in laid.laid:
        box = boxes[one.stone_id]
        assert box[0] == pytest.approx(one.left_px, abs=0.3)
        assert box[2] == pytest.approx(one.right_px, abs=0.3)
        assert box[3] == pytest.approx(one.top_px, abs=0.05)
    assert [len(state.actions) for state in laid.states] == [0, 3, 7]
    assert [action.side for action in laid.build.actions] == [
        *("left", "left", "right", "left", "left", "right", "right")
    ]
    assert all(action.proposal.trial_angle_deg == 0.0 for action in laid.build.actions)


def test_a_mirrored_plan_gives_the_mirrored_wall() -> None:
    # One stone less, or which stones are pushed against each other depends on the side.
    yard = Yard(blocks(BRICKS), Site(64, 20))
    plans = [
        [yard.planned(1, 0, 0), yard.planned(2, 20, 0)],
        [yard.planned(1, 44, 0, "right"), yard.planned(2, 24, 0, "right")],
    ]
    left, right = (_boxes(yard.lay(plan)) for plan in plans)
    for stone_id, box in left.items():
        mirrored = [64 - box[2], box[1], 64 - box[0], box[3]]
        assert right[stone_id] == pytest.approx(mirrored, abs=1e-5)


def test_a_stone_is_pushed_to_its_neighbour() -> None:
    yard = Yard(blocks(BRICKS), Site(60, 20))
    # The plan leaves 2 px between them; the stone comes to rest against the first.
    sides: dict[Side, tuple[int, int]] = {"left": (0, 22), "right": (40, 18)}
    for side, lefts in sides.items():
        plan = [yard.planned(k, left, 0, side) for k, left in enumerate(lefts, 1)]
        boxes = sorted(_boxes(yard.lay(plan)).values())
        assert boxes[1][0] - boxes[0][2] < 0.1


def test_a_course_closes_up_where_a_stone_is_left_out() -> None:
    yard = Yard(blocks(BRICKS), Site(60, 20))
    low = yard.planned(1, 0, 0, top=2)
    laid = yard.lay([low, yard.planned(2, 20, 0), yard.planned(3, 40, 0)])
    assert _statuses(laid) == [["no place", "as planned", "as planned"]]
    boxes = _boxes(laid)
    assert boxes[2][0] == pytest.approx(0.0, abs=0.3)
    assert boxes[3][0] == pytest.approx(20.0, abs=0.3)


def test_a_stone_without_room_has_no_place() -> None:
    yard = Yard(blocks({1: (20, 10), 2: (20, 10), 3: (20, 10)}), Site(50, 30))
    course = [yard.planned(1, 0, 0), yard.planned(2, 20, 0), yard.planned(3, 30, 0, "right")]
    laid = yard.lay(course)
    assert _statuses(laid) == [["as planned", "as planned", "no place"]]
    assert [one.stone for one in laid.failed] == [course[2]]
    assert len(laid.build.actions) == len(laid.laid) == 2


def test_a_stone_that_cannot_rest_is_reported() -> None:
    # Its centroid is far beside the only stone that could carry it.
    yard = Yard(blocks({1: (10, 10), 2: (40, 10)}), Site(60, 30))
    laid = yard.lay([yard.planned(1, 0, 0)], [yard.planned(2, 0, 10)])
    assert _statuses(laid) == [["as planned"], ["no rest"]]
    assert sorted(_corners(laid.build)) == [1]


OVERHANG = {1: (22, 10), 2: (40, 10), 3: (50, 20), 4: (28, 20)}
"""A support, a stone that stands out over it, and stones that would tip it over."""


def test_a_stone_that_would_bring_down_the_wall_is_reported() -> None:
    yard = Yard(blocks(OVERHANG), Site(50, 40))
    laid = yard.lay([yard.planned(1, 0, 0)], [yard.planned(2, 0, 10)], [yard.planned(3, 0, 20)])
    assert _statuses(laid) == [["as planned"], ["as planned"], ["falls"]]
    assert sorted(_corners(laid.build)) == [1, 2]


def test_what_cannot_be_laid_in_its_turn_is_laid_elsewhere_in_its_course() -> None:
    yard = Yard(blocks(OVERHANG), Site(50, 40))
    near = LayingSettings(reach=0.05)
    over = [yard.planned(4, 22, 20)]
    laid = yard.lay([yard.planned(1, 0, 0)], [yard.planned(2, 0, 10)], over, laying=near)
    assert _statuses(laid) == [["as planned"], ["as planned"], ["elsewhere"]]
    assert _boxes(laid)[4][0] < 15.0
    assert [one.stone_id for one in laid.laid] == [1, 2, 4]


def test_elsewhere_both_sides_are_tried() -> None:
    yard = Yard(blocks(OVERHANG), Site(50, 40))
    # From the left the first place that comes to mind is at the end that tips over.
    narrow = LayingSettings(reach=0.05, starts=1)
    support = [yard.planned(1, 28, 0, "right")]
    over = [yard.planned(2, 10, 10, "right")], [yard.planned(4, 10, 20)]
    laid = yard.lay(support, *over, laying=narrow)
    assert _statuses(laid) == [["as planned"], ["as planned"], ["elsewhere"]]
    assert laid.build.actions[-1].side == "right"
    assert _boxes(laid)[4][2] == pytest.approx(50.0, abs=0.3)


def test_what_would_stand_out_above_the_wall_is_not_laid() -> None:
    yard = Yard(blocks(BRICKS), Site(60, 19))
    laid = yard.lay(*_bond(yard))
    assert _statuses(laid) == [["as planned"] * 3, ["no rest"] * 4]


TIP = np.array([[abs(x - 11.5) <= 12 - row for x in range(24)] for row in range(12)])
"""A triangle on its tip."""


def test_a_wall_that_is_not_sturdy_counts_as_fallen(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object) -> Loaded:
        # Nothing is below the stone.
        model = RigidBlockModel((), (), 0.0).with_added((Block(9, 1.0, (0.0, 5.0)),), ())
        return Loaded(model, IncrementalResult(lateral_resistance(model)))

    monkeypatch.setattr(Evaluator, "sturdily", never)
    yard = Yard(stones_of_masks({1: np.ones((12, 24), bool), 2: TIP}), Site(60, 30))
    for angle in (0.0, -180.0):  # one of the poses does not rest at all
        course = [yard.planned(1, 0, 0), yard.planned(2, 24, 0, angle=angle)]
        assert _statuses(yard.lay(course)) == [["falls", "falls"]]


def test_an_action_is_what_is_judged_of_its_place() -> None:
    yard = Yard(rubble(1, 14), RUBBLE_SITE)
    laid = yard.lay(*yard.rows(3).courses)
    evaluator = Evaluator(yard.settings, yard.workshop.stock)
    states = laid.build.states()
    assert len(states) > 6
    for before, action in zip(states, laid.build.actions, strict=False):
        landscape = Landscape.of(before.wall, action.side)
        again = evaluator.judge(before, landscape, action.proposal)
        assert again.indices == action.indices
        assert again.resistance.value == action.resistance.value
        assert again.sturdy == action.sturdy is True
        assert again.sturdy_model is not None
        assert action.sturdy_model is not None
        for mine, same in ((action.model, again.model), (action.sturdy_model, again.sturdy_model)):
            assert mine.blocks == same.blocks
            assert [(i.block, i.other, i.mu) for i in mine.interfaces] == [
                (i.block, i.other, i.mu) for i in same.interfaces
            ]


def test_of_places_that_do_not_stand_sturdily_the_next_best_is_taken(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sturdily, asked = Evaluator.sturdily, []

    def not_at_once(this: Evaluator, build: Build, blocks: list[Outlined]) -> Loaded | None:
        asked.append(float(blocks[0][1][:, 0].min()))
        found = sturdily(this, build, blocks)
        assert found is not None
        falls = RigidBlockModel((), (), 0.0).with_added((Block(9, 1.0, (0.0, 5.0)),), ())
        return (
            Loaded(falls, IncrementalResult(lateral_resistance(falls)))
            if len(asked) == 1
            else found
        )

    monkeypatch.setattr(Evaluator, "sturdily", not_at_once)
    yard = Yard(blocks(BRICKS), Site(60, 20))
    many = LayingSettings(apart=0.1, enough=9)
    laid = yard.lay([yard.planned(1, 10, 0)], laying=many)
    assert _statuses(laid) == [["as planned"]]
    assert len(asked) == 2
    assert _boxes(laid)[1][0] == pytest.approx(asked[1])
    assert asked[0] != pytest.approx(asked[1], abs=1.0)


def test_a_stone_on_its_tip_is_turned_by_half() -> None:
    yard = Yard(stones_of_masks({1: np.ones((12, 24), bool), 2: TIP}), Site(60, 30))
    laid = yard.lay([yard.planned(1, 0, 0), yard.planned(2, 24, 0)])
    assert _statuses(laid) == [["as planned", "half turn"]]
    angle = laid.build.actions[1].stabilised.placement.posed.angle_deg
    assert abs(angle) == pytest.approx(180.0, abs=1.0)
    half = yard.lay([yard.planned(1, 0, 0), yard.planned(2, 24, 0, angle=-180.0)])
    assert _statuses(half) == [["as planned", "as planned"]]


def test_a_stone_that_does_not_rest_is_wedged() -> None:
    sizes = {1: (10, 10), 2: (10, 8), 3: (30, 10)}
    stones, site = blocks(sizes), Site(38, 30)
    for method, status, wedges in (("wedge", "as planned", 1), ("none", "no rest", 0)):
        yard = Yard(stones, site, {"stabilise": {"method": method}})
        laid = yard.lay([yard.planned(1, 0, 0), yard.planned(2, 20, 0)], [yard.planned(3, 0, 10)])
        assert _statuses(laid)[1] == [status]
        assert len(laid.build.wall.wedges) == wedges
        if wedges:
            assert laid.build.wall.wedges[0].under == 3
            assert laid.build.wall.wedges[0].id == 4


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_every_state_stands_and_nothing_overlaps(seed: int) -> None:
    yard = Yard(rubble(seed, 14), RUBBLE_SITE)
    laid = yard.lay(*yard.rows(3).courses)
    actions = laid.build.actions
    assert len(actions) == len(laid.laid) >= 6
    assert all(action.sturdy and (action.resistance.value or 0.0) > 0 for action in actions)
    assert len(laid.build.states()) == len(actions) + 1
    placements = [action.stabilised.placement for action in actions]
    still = [p.posed.angle_deg for p in placements if not p.rotation_moves]
    assert 0 < len(still) < len(placements)
    assert set(still) <= {0.0, -180.0}
    corners = _corners(laid.build).values()
    for one, other in combinations(map(shapely.Polygon, corners), 2):
        assert shapely.distance(one, other) > 0.0
    beyond_px = yard.settings.settle.beyond_px
    points = np.concatenate(list(corners))
    assert points.min() >= -beyond_px
    assert (points.max(axis=0) <= np.array(yard.site.extent_px) + beyond_px).all()


def test_laying_is_repeatable_and_the_greedy_goes_on_from_it() -> None:
    yard = Yard(rubble(3, 14), RUBBLE_SITE)
    plan = yard.rows(2)
    one, other = (lay(plan, yard.empty(), yard.workshop, yard.settings) for _ in range(2))
    assert _bytes(one) == _bytes(other)
    assert _statuses(one) == _statuses(other)
    planner = Planner(
        yard.stones, yard.site, seed=1, settings=yard.settings, workshop=yard.workshop
    )
    planner.build = one.build
    added = len(list(planner.steps()))
    assert planner.stopped is not None
    assert planner.build.actions[: len(one.laid)] == one.build.actions
    assert len(planner.build.actions) == len(one.laid) + added
    assert added > 0


def test_a_stone_goes_where_the_wall_resists_more() -> None:
    yard = Yard(blocks({1: (22, 10), 2: (40, 10), 3: (12, 10)}), Site(50, 40))
    free = LayingSettings(
        starts=30, enough=99, reach=3.0, width=0.0, top=0.0, turn=0.0, rest=0.0, judged=30
    )
    below = [yard.planned(1, 0, 0)], [yard.planned(2, 0, 10)]
    walls = [
        yard.lay(*below, [yard.planned(3, 28, 20, "right")], laying=laying)
        for laying in (
            replace(free, llc=0.0, analysed=30),
            replace(free, llc=1.0, analysed=30),
            replace(free, llc=1.0, analysed=1),
        )
    ]
    assert [_statuses(wall)[2] for wall in walls] == [["as planned"]] * 3
    cheapest, strongest, first = (wall.build.actions[-1] for wall in walls)
    assert (strongest.indices.LLC or 0.0) > 1.2 * (cheapest.indices.LLC or 0.0)
    # Further in over what carries it.
    assert _boxes(walls[1])[3][2] < _boxes(walls[0])[3][2] - 1.0
    assert first.resistance.value == cheapest.resistance.value
