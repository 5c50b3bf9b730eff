"""What is no input of `plan_wall` is said, before anything is planned."""

import math
from typing import Any

import numpy as np
import pytest

import drystone as ds
from drystone.model.placement import Placement
from drystone.model.wall import Wall
from drystone.poses import PoseBook
from tests.planner.scenes import blocks, greedy


@pytest.fixture(scope="module")
def stones() -> ds.StoneSet:
    """Three bricks."""
    bricks = ds.generate.BrickSettings(count=3, height_px=10, aspect=2)
    return ds.generate.brick_stones(bricks, np.random.default_rng(1))


@pytest.mark.parametrize(
    ("size", "options", "code"),
    [
        ((60, 20), {"seed": -1}, "E138"),
        ((60, 20), {"px_per_m": -400.0}, "E138"),
        ((60, 20), {"scale": math.nan}, "E125"),
        ((60, 20), {"method": "worst"}, "E124"),
        ((math.nan, 20), {}, "E127"),
        ((60, math.inf), {}, "E127"),
        ((0, 20), {}, "E121"),
    ],
)
def test_values_that_make_no_sense(
    stones: ds.StoneSet, size: tuple[float, float], options: dict[str, Any], code: str
) -> None:
    with pytest.raises(ds.DrystoneError) as caught:
        ds.plan_wall(stones, *size, **options)
    assert caught.value.code == code
    assert caught.value.cure


def test_a_wall_is_built_already_or_to_begin_with(stones: ds.StoneSet) -> None:
    wall = ds.plan_wall(stones, 60, 20, scale=1.0, budget=1).wall
    with pytest.raises(ds.DrystoneError) as caught:
        ds.plan_wall(stones, 60, 20, scale=1.0, built=wall, begin=wall)
    assert caught.value.code == "E138"


def test_of_a_built_wall_that_does_not_stand_nothing_better_is_looked_for() -> None:
    """A search could not build it again; the plan goes on with it, as with one pass."""
    stones = blocks({1: (10, 10), 2: (30, 10), 3: (20, 10)})
    settings = greedy({"geometry": "raster"})
    site = ds.Site(60, 30)
    fallen = Wall.empty(site).add(lying(stones, 1, row=20)).add(lying(stones, 2, row=10))
    results = [
        ds.plan_wall(stones, 60, 30, scale=1.0, settings=settings, budget=budget, built=fallen)
        for budget in (1, 3)
    ]
    for result in results:
        assert [step.stone for step in result.plan.stone_steps][:2] == [1, 2]
    assert results[0].plan == results[1].plan
    assert [notice.code for notice in results[0].notices] == []
    (told,) = results[1].notices
    assert (told.code, "after stones 2;" in told.message) == ("W126", True)


def lying(stones: ds.StoneSet, stone_id: int, row: int) -> Placement:
    """A stone as it is, at the left end."""
    return Placement(PoseBook(1.0).pose(stones.by_id(stone_id), 0.0), row, 0)


@pytest.mark.parametrize("settings", [{"mu": 0.6}, {}, "best"])
def test_settings_of_the_wrong_type(stones: ds.StoneSet, settings: Any) -> None:
    with pytest.raises(TypeError, match="settings must be PlannerSettings, not "):
        ds.plan_wall(stones, 60, 20, settings=settings)
