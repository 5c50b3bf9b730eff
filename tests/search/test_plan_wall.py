"""What is no input of `plan_wall` is said, before anything is planned; what time does to a wall."""

import math

import pytest

import drystone as ds
from drystone.model.wall import Wall
from drystone.planner.deadline import Deadline
from drystone.planner.events import OUT_OF_TIME
from drystone.planner.settings import method_settings
from tests.planner.scenes import Ticks, after_looks, blocks, bricks, greedy, proven, rubble
from tests.verify.exact_examples import with_stone


@pytest.mark.parametrize(
    ("size", "options", "code"),
    [
        ((60, 20), {"seed": -1}, "E138"),
        ((60, 20), {"budget": 0}, "E123"),
        ((60, 20), {"px_per_m": -400.0}, "E138"),
        ((60, 20), {"scale": math.nan}, "E125"),
        ((60, 20), {"method": "worst"}, "E124"),
        ((math.nan, 20), {}, "E127"),
        ((60, math.inf), {}, "E127"),
        ((0, 20), {}, "E121"),
    ],
)
def test_values_that_make_no_sense(size, options, code):
    with pytest.raises(ds.DrystoneError) as caught:
        ds.plan_wall(bricks(3), *size, **options)
    assert caught.value.code == code
    assert caught.value.cure


def test_inputs_that_exclude_each_other_or_are_of_the_wrong_type():
    stones = bricks(3)
    wall = ds.plan_wall(stones, 60, 20, scale=1.0, budget=1).wall
    with pytest.raises(ds.DrystoneError, match="E138"):
        ds.plan_wall(stones, 60, 20, scale=1.0, built=wall, begin=wall)
    for settings in ({"mu": 0.6}, {}, "best"):
        with pytest.raises(TypeError, match="settings must be PlannerSettings, not "):
            ds.plan_wall(stones, 60, 20, settings=settings)


def test_of_a_built_wall_that_does_not_stand_nothing_better_is_looked_for():
    """A search could not build it again; the plan goes on with it, as with one pass."""
    stones = blocks({1: (10, 10), 2: (30, 10), 3: (20, 10)})
    fallen = Wall.empty(ds.Site(60, 30), exact=True)
    for stone_id, bottom in ((1, 0.01), (2, 10.02)):
        fallen = with_stone(fallen, stones, (stone_id, 0.0), (0.0, bottom))
    results = [
        ds.plan_wall(stones, 60, 30, scale=1.0, settings=greedy(), budget=budget, built=fallen)
        for budget in (1, 3)
    ]
    for result in results:
        assert [step.stone for step in result.plan.stone_steps][:2] == [1, 2]
    assert results[0].plan == results[1].plan
    assert [notice.code for notice in results[0].notices] == []
    (told,) = results[1].notices
    assert (told.code, "after stones 2;" in told.message) == ("W126", True)


FEW = {"search": {"budget": 4, "passes": 3, "chains": 2, "share_every": 2}}
"""Few walls of every kind."""

STONES = rubble(count=5)
WAYS = {
    "best": {"settings": greedy(FEW)},
    "one pass in threads": {"settings": greedy(), "n_jobs": 2, "budget": 1},
    "pixels": {"settings": greedy({"geometry": "raster"}), "budget": 1},
    "paper": {"settings": method_settings("paper"), "budget": 1},
    "policy": {"settings": greedy({"selection_rule": "lowest"}), "budget": 1},
}


def planned(until, **options):
    """A wall of rubble, with a time limit by another clock than that of the world."""

    def after(seconds, _=None):
        return until if until and seconds == 5.0 else Deadline()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Deadline, "after", after)
        return ds.plan_wall(STONES, 100, 36, scale=1.0, seed=1, seconds=5.0, **options)


def gone_on_with(result):
    """What `--resume` hands over."""
    return {"built": result.wall, "course_heights_px": result.plan.course_heights_px}


@pytest.mark.parametrize("way", WAYS)
def test_a_first_wall_cut_short_is_a_plan_that_is_gone_on_with(way):
    options = {"budget": 3, **WAYS[way]}
    clock = Ticks()
    alone = planned(Deadline(math.inf, clock), **{**options, "budget": 1})
    whole = planned(None, **options)
    placed = set()
    for share in (0.0, 0.6):
        result = planned(after_looks(int(share * clock.count)), **options)
        assert result.plan.stopped == OUT_OF_TIME.text
        assert result.status == ("incomplete" if result.shortfall else "complete")
        proven(result, STONES)
        placed.add(len(result.plan.stone_steps))
        (notice,) = result.notices
        assert notice.code == "W128"
        assert f"after {len(result.plan.stone_steps)} of 5 stones" in notice.message
        assert result.plan.steps == alone.plan.steps[: len(result.plan.steps)]
        assert result.plan.settings["search"]["budget"] == 1
    assert len(placed) == 2
    assert planned(None, **options, **gone_on_with(result)).plan == whole.plan


def test_after_a_whole_first_wall_no_wall_that_is_cut_short_counts():
    options, clock = WAYS["best"], Ticks()
    planned(Deadline(math.inf, clock), **options, budget=1)
    for more, n_jobs in ((1, 1), (40, 2)):
        result = planned(after_looks(clock.count + more), **options, budget=6, n_jobs=n_jobs)
        used = result.plan.settings["search"]["budget"]
        assert used < 6
        again = planned(None, **options, budget=used)
        assert (again.plan, again.notices) == (result.plan, ())
        (notice,) = result.notices
        assert notice.code == "W131"
        assert f"after {used} walls of 6;" in notice.message


def test_every_time_a_wall_grows_by_a_stone_however_little_time_there_is():
    settings, placed = greedy(FEW), 0
    before = {}
    while True:
        result = planned(after_looks(0), settings=settings, **before)
        if result.plan.stopped != OUT_OF_TIME.text:
            break
        assert len(result.plan.stone_steps) == placed + 1
        before, placed = gone_on_with(result), placed + 1
    assert placed >= 3
    whole = planned(None, settings=settings, budget=1).plan
    assert result.plan == whole
    assert planned(after_looks(0), settings=settings, first_whole=True).plan == whole
