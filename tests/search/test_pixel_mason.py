"""Course plans laid on pixels: as planned where that is possible, and the truth where not."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from drystone.model.placement import Side
from drystone.model.site import Site
from drystone.planner.build import Candidate
from drystone.planner.evaluate import Evaluator
from drystone.search.course_plan import PlannedStone
from drystone.search.laying_settings import LayingSettings, PutDownSettings
from tests.planner.scenes import blocks, stones_of_masks
from tests.search.pixel_yards import PixelYard, pixel_boxes, statuses

BRICKS = {1: (20, 10), 2: (20, 10), 3: (20, 10), 4: (10, 10), 5: (20, 10), 6: (20, 10), 7: (10, 10)}
"""A course of three stones, and one of two with a half at each end."""


def _bond(yard: PixelYard) -> list[list[PlannedStone]]:
    place = yard.planned
    return [
        [place(1, 0, 0), place(2, 20, 0), place(3, 40, 0, "right")],
        [place(4, 0, 10), place(5, 10, 10), place(7, 50, 10, "right"), place(6, 30, 10, "right")],
    ]


def _near(**changes: Any) -> LayingSettings:
    return LayingSettings(put_down=PutDownSettings(**changes))


@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_bricks_lie_as_planned(scale: float) -> None:
    yard = PixelYard(blocks(BRICKS), Site.from_source(60, 20, scale))
    laid = yard.lay(*_bond(yard))
    assert statuses(laid) == [["as planned"] * 3, ["as planned"] * 4]
    boxes = pixel_boxes(laid)
    for one in laid.laid:
        left, _, right, top = (side / scale for side in boxes[one.stone_id])
        assert [left, right, top] == [one.left_px, one.right_px, one.top_px]
    assert [len(state.actions) for state in laid.states] == [0, 3, 7]
    assert [action.side for action in laid.build.actions] == [
        *("left", "left", "right", "left", "left", "right", "right")
    ]


def test_a_mirrored_plan_gives_the_mirrored_wall() -> None:
    yard = PixelYard(blocks(BRICKS), Site(64, 20))
    plans = [
        [yard.planned(1, 0, 0), yard.planned(2, 20, 0)],
        [yard.planned(1, 44, 0, "right"), yard.planned(2, 24, 0, "right")],
    ]
    left, right = (pixel_boxes(yard.lay(plan)) for plan in plans)
    mirrored = {k: (64 - box[2], box[1], 64 - box[0], box[3]) for k, box in left.items()}
    assert right == mirrored


@pytest.mark.parametrize(("side", "lefts"), [("left", (0, 24)), ("right", (40, 16))])
def test_a_stone_is_as_far_from_its_neighbour_as_planned_or_nearer(
    side: Side, lefts: tuple[int, int]
) -> None:
    yard = PixelYard(blocks(BRICKS), Site(60, 20))
    plan = [yard.planned(k, left, 0, side) for k, left in enumerate(lefts, 1)]
    boxes = sorted(pixel_boxes(yard.lay(plan)).values())
    assert 0 <= boxes[1][0] - boxes[0][2] <= 4


def test_a_course_closes_up_where_a_stone_is_left_out() -> None:
    yard = PixelYard(blocks(BRICKS), Site(60, 20))
    low = yard.planned(1, 0, 0, top=2)
    laid = yard.lay([low, yard.planned(2, 20, 0), yard.planned(3, 40, 0)])
    assert statuses(laid) == [["no place", "as planned", "as planned"]]
    assert [pixel_boxes(laid)[k][0] for k in (2, 3)] == [0, 20]


def test_a_stone_without_room_has_no_place() -> None:
    yard = PixelYard(blocks({1: (20, 10), 2: (20, 10), 3: (20, 10)}), Site(50, 30))
    course = [yard.planned(1, 0, 0), yard.planned(2, 20, 0), yard.planned(3, 30, 0, "right")]
    laid = yard.lay(course)
    assert statuses(laid) == [["as planned", "as planned", "no place"]]
    assert [one.stone for one in laid.failed] == [course[2]]
    assert len(laid.build.actions) == len(laid.laid) == 2


def test_what_would_stand_out_above_the_wall_is_not_laid() -> None:
    yard = PixelYard(blocks(BRICKS), Site(60, 19))
    assert statuses(yard.lay(*_bond(yard))) == [["as planned"] * 3, ["no place"] * 4]


OVERHANG = {1: (22, 10), 2: (40, 10), 3: (50, 20), 4: (28, 20)}
"""A support, a stone that stands out over it, and stones that would tip it over."""


def test_a_stone_that_would_bring_down_the_wall_is_reported() -> None:
    yard = PixelYard(blocks(OVERHANG), Site(50, 40), {"stabilise": {"margin": 0.0}})
    laid = yard.lay([yard.planned(1, 0, 0)], [yard.planned(2, 0, 10)], [yard.planned(3, 0, 20)])
    assert statuses(laid) == [["as planned"], ["as planned"], ["falls"]]
    assert sorted(pixel_boxes(laid)) == [1, 2]


@pytest.mark.parametrize("side", ["left", "right"])
def test_what_cannot_be_laid_in_its_turn_is_laid_elsewhere_in_its_course(side: Side) -> None:
    """From both sides: that of the plan has but the end that tips over."""
    yard = PixelYard(blocks(OVERHANG), Site(50, 40), {"stabilise": {"margin": 0.0}})
    near = _near(reach=0.05)
    x = {1: 0, 2: 0, 4: 22} if side == "left" else {1: 28, 2: 10, 4: 0}
    plan = [[yard.planned(k, left, bottom, side)] for (k, left), bottom in zip(
        x.items(), (0, 10, 20), strict=True)]  # fmt: skip
    laid = yard.lay(*plan, laying=near)
    assert statuses(laid) == [["as planned"], ["as planned"], ["elsewhere"]]
    left, _, right, _ = pixel_boxes(laid)[4]
    assert (left < 15) if side == "left" else (right > 35)
    assert [one.stone_id for one in laid.laid] == [1, 2, 4]


def test_elsewhere_both_sides_are_tried() -> None:
    """From the left the first place that comes to mind is at the end that tips over."""
    yard = PixelYard(blocks(OVERHANG), Site(50, 40), {"stabilise": {"margin": 0.0}})
    place = yard.planned
    over = [place(2, 10, 10, "right")], [place(4, 10, 20)]
    laid = yard.lay([place(1, 28, 0, "right")], *over, laying=_near(reach=0.05, places=1))
    assert statuses(laid)[2] == ["elsewhere"]
    assert laid.build.actions[-1].side == "right"


TIP = np.array([[abs(x - 11.5) <= 12 - row for x in range(24)] for row in range(12)])
"""A triangle on its tip."""


def test_a_stone_on_its_tip_is_turned_by_half() -> None:
    stones = stones_of_masks({1: np.ones((12, 24), bool), 2: TIP})
    yard = PixelYard(stones, Site(60, 30), {"stabilise": {"method": "none"}})
    laid = yard.lay([yard.planned(1, 0, 0), yard.planned(2, 24, 0)])
    assert statuses(laid) == [["as planned", "half turn"]]
    angle = laid.build.actions[1].stabilised.placement.posed.angle_deg
    assert abs(angle) == pytest.approx(180.0, abs=1.0)
    half = yard.lay([yard.planned(1, 0, 0), yard.planned(2, 24, 0, angle=-180.0)])
    assert statuses(half) == [["as planned", "as planned"]]


@pytest.mark.parametrize(
    ("method", "status", "wedges"), [("wedge", "as planned", 1), ("none", "no place", 0)]
)
def test_a_stone_that_does_not_lie_is_wedged(method: str, status: str, wedges: int) -> None:
    yard = PixelYard(
        blocks({1: (10, 10), 2: (10, 7), 3: (30, 10)}),
        Site(40, 30),
        {"stabilise": {"method": method}},
    )
    laid = yard.lay([yard.planned(1, 0, 0), yard.planned(2, 20, 0)], [yard.planned(3, 0, 10)])
    assert statuses(laid)[1] == [status]
    assert len(laid.build.wall.wedges) == wedges
    if wedges:
        assert (laid.build.wall.wedges[0].under, laid.build.wall.wedges[0].id) == (3, 4)


def test_a_stone_goes_where_the_wall_resists_more() -> None:
    yard = PixelYard(
        blocks({1: (22, 10), 2: (40, 10), 3: (12, 10)}),
        Site(50, 40),
        {"stabilise": {"margin": 0.0}},
    )
    free: dict[str, Any] = {
        "places": 30, "judged": 30, "reach": 3.0, "width": 0.0, "top": 0.0, "turn": 0.0,
    }  # fmt: skip
    below = [yard.planned(1, 0, 0)], [yard.planned(2, 0, 10)]
    walls = [
        yard.lay(*below, [yard.planned(3, 28, 20, "right")], laying=_near(**free, **changes))
        for changes in ({"llc": 0.0, "analysed": 30}, {"analysed": 30}, {"analysed": 1})
    ]
    assert [statuses(wall)[2] for wall in walls] == [["as planned"]] * 3
    cheapest, strongest, first = (wall.build.actions[-1] for wall in walls)
    assert (strongest.indices.LLC or 0.0) > 1.2 * (cheapest.indices.LLC or 0.0)
    assert first.resistance.value == cheapest.resistance.value


def test_every_solve_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    judge = Evaluator.judge

    def cold(this: Evaluator, *args: Any) -> Candidate:
        return replace(judge(this, *args), solved_cold=True)

    monkeypatch.setattr(Evaluator, "judge", cold)
    yard = PixelYard(blocks(BRICKS), Site(60, 20))
    laid = yard.lay(*_bond(yard), laying=_near(analysed=1))
    assert laid.solves.cold == 7
