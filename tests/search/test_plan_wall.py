"""What `plan_wall` is given, how its search ends, and what time, walls and interrupts do to it."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from drystone import Planner, Site, method_settings, plan_wall
from drystone.drawing.words.planned import rows
from drystone.errors import UsageError
from drystone.kernels.polygons import on_grid
from drystone.model.placement import Wedge
from drystone.model.stone import StoneSet
from drystone.model.wall import Group, Wall
from drystone.model.wedge_shape import WedgeShape
from drystone.planner.deadline import Deadline, TimeIsUp
from drystone.planner.events import INTERRUPTED, OUT_OF_TIME, Stopped
from drystone.search import goal, whole_search
from drystone.search.chain import _opened
from drystone.search.goal import FoundWall, stays_at_every_step
from drystone.search.packed import PackedWall, found_again
from drystone.search.warm_start import begin_with
from drystone.search.whole_search import as_found, run_to_end, surest, with_the_rest
from drystone.search.yard import Yard
from tests.planner import scenes
from tests.verify.exact_examples import with_stone


def test_values_that_make_no_sense_or_exclude_each_other():
    stones = scenes.bricks(3)
    wall = plan_wall(stones, 60, 20, scale=1.0, budget=1).wall
    for options, code in (
        ({"seed": -1}, "E138"),
        ({"n_jobs": 0}, "E138"),
        ({"seconds": math.nan}, "E138"),
        ({"budget": 0}, "E123"),
        ({"scale": math.nan}, "E125"),
        ({"scale": 1.01}, "E125"),
        ({"built": wall, "begin": wall}, "E138"),
    ):
        with pytest.raises(UsageError, match=code) as caught:
            plan_wall(stones, 60, 20, **options)
        assert caught.value.cure


def test_of_a_built_wall_that_does_not_stand_nothing_better_is_looked_for():
    """A search could not build it again; the plan goes on with it, as with one pass."""
    stones = scenes.blocks({1: (10, 10), 2: (30, 10), 3: (20, 10)})
    fallen = Wall.empty(Site(60, 30), exact=True)
    for stone_id, bottom in ((1, 0.01), (2, 10.02)):
        fallen = with_stone(fallen, stones, (stone_id, 0.0), (0.0, bottom))
    results = [
        plan_wall(stones, 60, 30, scale=1.0, settings=scenes.greedy(), budget=budget, built=fallen)
        for budget in (1, 3)
    ]
    for result in results:
        assert [step.stone for step in result.plan.stone_steps][:2] == [1, 2]
    assert results[0].plan == results[1].plan
    assert [notice.code for notice in results[0].notices] == []
    (told,) = results[1].notices
    assert (told.code, "after stones 2;" in told.message) == ("W126", True)


@scenes.GEOMETRIES
def test_a_wall_of_something_else_is_refused_where_it_cannot_be_gone_on_with(settings):
    """What is built must be the same; outlines to begin with may be of another wall."""
    stones = scenes.blocks({1: (20, 10), 2: (24, 12), 3: (30, 10), 4: (16, 10)})
    asked = {"stones": stones, "width": 60.0, "height": 20.0, "scale": 1.0, "settings": settings,
             "budget": 1, "coulomb": False}  # fmt: skip
    plan, whole = (made := plan_wall(**asked)).plan, made.wall
    first, *others = stones
    fewer = StoneSet(tuple(s for s in stones if s.id != whole.placements[-1].stone_id))
    own, other = ("exact", "raster") if whole.outlines else ("raster", "exact")
    exact = own == "exact"
    for changes, said, may_begin in (
        ({"stones": StoneSet((replace(first, left_px=9), *others))}, "other stones", False),
        ({"stones": StoneSet((replace(first, mask=np.ones((9, 21), bool)), *others))},
         "other stones", False),
        ({"stones": fewer}, "other stones", True),
        ({"width": 58.0, "height": 30.0}, "another wall (60x20 px, not 58x30)", exact),
        ({"scale": 0.5}, "another resolution. Add --scale 1.", exact),
        ({"settings": settings.updated({"geometry": other})}, f"--geometry {own}", False),
        ({"settings": settings.updated({"two_sided": False})}, "both sides. Add --two", False),
    ):  # fmt: skip
        given = asked | changes
        with pytest.raises(UsageError, match=r"^E144 wall: it is of ") as refused:
            plan_wall(**given, built=whole)
        assert said in str(refused.value)
        if may_begin:
            heights = plan.course_heights_px
            begun = plan_wall(**given, begin=whole, course_heights_px=heights)
            scenes.proven(begun, given["stones"])
            assert begun.plan.steps[0].course_height == plan.steps[0].course_height
        else:
            with pytest.raises(UsageError, match=r"^E144 begin: it is of "):
                plan_wall(**given, begin=whole)


FEW = {"search": {"budget": 4, "passes": 3, "chains": 2, "share_every": 2}}
"""Few walls of every kind."""

STONES = scenes.rubble(count=5)
WAYS = {
    "best": {"settings": scenes.greedy(FEW)},
    "one pass in threads": {"settings": scenes.greedy(), "n_jobs": 2, "budget": 1},
    "pixels": {"settings": scenes.greedy({"geometry": "raster"}), "budget": None},
    "paper": {"settings": method_settings("paper"), "budget": 1},
    "policy": {"settings": scenes.greedy({"selection_rule": "lowest"}), "budget": None},
}


def planned(until, **options):
    """A wall of rubble, with a time limit by another clock than that of the world."""

    def after(seconds, _=None):
        return until if until and seconds == 5.0 else Deadline()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Deadline, "after", after)
        return plan_wall(STONES, 100, 36, scale=1.0, seed=1, seconds=5.0, **options)


def gone_on_with(result):
    """What `--resume` hands over."""
    return {"built": result.wall, "course_heights_px": result.plan.course_heights_px}


@pytest.mark.parametrize("way", WAYS)
def test_a_first_wall_cut_short_is_a_plan_that_is_gone_on_with(way):
    options = {"budget": 3, **WAYS[way]}
    clock = scenes.Ticks()
    alone = planned(Deadline(math.inf, clock), **{**options, "budget": 1})
    whole = planned(None, **options)
    placed = set()
    for share in (0.0, 0.6):
        result = planned(scenes.after_looks(int(share * clock.count)), **options)
        assert result.plan.stopped == OUT_OF_TIME.text
        assert result.status == ("incomplete" if result.shortfall else "complete")
        scenes.proven(result, STONES)
        placed.add(len(result.plan.stone_steps))
        (notice,) = result.notices
        assert notice.code == "W128"
        assert f"after {len(result.plan.stone_steps)} of 5 stones" in notice.message
        assert result.plan.steps == alone.plan.steps[: len(result.plan.steps)]
        assert result.plan.settings["search"]["budget"] == 1
    assert len(placed) == 2
    assert planned(None, **options, **gone_on_with(result)).plan == whole.plan


def test_after_a_whole_first_wall_no_wall_that_is_cut_short_counts():
    options, clock = WAYS["best"], scenes.Ticks()
    planned(Deadline(math.inf, clock), **options, budget=1)
    for more, n_jobs in ((1, 1), (40, 2)):
        result = planned(scenes.after_looks(clock.count + more), **options, budget=6, n_jobs=n_jobs)
        used = result.plan.settings["search"]["budget"]
        assert used < 6
        again = planned(None, **options, budget=used)
        assert (again.plan, again.notices) == (result.plan, ())
        (notice,) = result.notices
        assert notice.code == "W131"
        assert f"after {used} walls of 6;" in notice.message


def test_every_time_a_wall_grows_by_a_stone_however_little_time_there_is():
    settings, placed = scenes.greedy(FEW), 0
    result = planned(scenes.after_looks(0), settings=settings)
    while result.plan.stopped == OUT_OF_TIME.text:
        placed += 1
        assert len(result.plan.stone_steps) == placed
        result = planned(scenes.after_looks(0), settings=settings, **gone_on_with(result))
    assert placed >= 3
    whole = planned(None, settings=settings, budget=1).plan
    assert result.plan == whole
    assert planned(scenes.after_looks(0), settings=settings, first_whole=True).plan == whole


def begun(old, changes):
    """A planner with other settings that begins with what another has built, and what is gone."""
    planner = scenes.of_rubble(old.settings.updated(changes), 0, seed=1)
    return planner, begin_with(planner, old.build.wall, {})


def test_banned_stones_are_taken_out_with_what_falls_then():
    old = scenes.of_rubble(scenes.greedy(), seed=13)
    before, fell, stayed = scenes.ids(old), set(), set()
    for banned in before[::2]:
        planner, gone = begun(old, {"ban": [banned]})
        used = scenes.ids(planner)
        assert gone[0] == banned
        assert [stone_id for stone_id in before if stone_id not in gone] == used
        assert all(a.sturdy and a.resistance.stable for a in planner.build.actions)
        fell.update(gone[1:])
        if len(gone) > 1:
            stayed.update(used[before.index(gone[1]) :])
    # Some fall without what carried them, and later ones that stand without these stay.
    assert fell
    assert stayed


def test_wedges_that_are_none_by_the_new_settings_are_left_out():
    site = Site.from_source(84.0, 34.0, 0.5)
    old = scenes.finish(
        Planner(scenes.few_stones(), site, seed=3, settings=scenes.greedy(scenes.WITH_WEDGES))
    )
    kept = set()
    for change in ({}, {"thickness": 0.2}, {"height": 0.1}, {"area": 0.001}):
        settings = scenes.greedy(
            {**scenes.WITH_WEDGES, "wedge": {**scenes.WITH_WEDGES["wedge"], **change}}
        )
        planner = Planner(scenes.few_stones(), site, settings=settings)
        begin_with(planner, old.build.wall, {})
        limits = planner.workshop.limits
        wedges = [w.corners for w in planner.build.wall.wedges if w.corners is not None]
        assert all(limits.allows(WedgeShape.of(corners)) for corners in wedges)
        kept.add(len(wedges))
    assert max(kept) == len(old.build.wall.wedges) > min(kept) == 0


def test_a_stone_stays_without_a_wedge_that_nothing_is_beside():
    """A slab on two blocks reaches over the second; the wall ends 2 or 7 px further on."""
    stones = scenes.blocks({1: (20, 4), 2: (20, 4), 3: (50, 10)})
    settings = scenes.greedy({"order": "given", "vary": 0.0, "wedge": {"height": 1.0, "area": 1.0}})
    corners = on_grid(np.array([[42.0, 0.01], [48.0, 0.01], [48.0, 4.01], [42.0, 4.01]]))
    for width, wedges in ((52, 0), (57, 1)):
        old, planner = (Planner(stones, Site(width, 30), settings=settings) for _ in range(2))
        *below, slab = scenes.finish(old).build.wall.groups
        assert slab.placement.stone_id == 3
        with_it = Group(slab.placement, (Wedge(9, 3, np.ones((4, 6), bool), 26, 42, corners),))
        begin = replace(old.build.wall, groups=(*below, with_it))
        assert begin_with(planner, begin, {}) == ()
        assert len(planner.build.wall.wedges) == wedges


def test_what_stands_out_further_than_now_allowed_is_taken_out():
    # A course may use all of 1 px; begun again with a smaller allowance, check would refuse it.
    old = scenes.of_rubble(scenes.greedy(), seed=3)
    corners = [action.stabilised.placement.settled.corners for action in old.build.actions]
    width, height = scenes.RUBBLE_SITE.extent_px
    out = [max(-c[:, 0].min(), c[:, 0].max() - width, c[:, 1].max() - height) for c in corners]
    furthest = max(out)
    assert furthest > 0.0
    _, gone = begun(old, {"settle": {"beyond_px": furthest - 1e-3}})
    assert scenes.ids(old)[out.index(furthest)] in gone
    assert begun(old, {"settle": {"beyond_px": furthest}})[1] == ()


def test_outlines_are_those_of_this_search_whatever_those_of_the_plan_were():
    """They are packed as their poses, and would be others when they are built again."""
    old = scenes.of_rubble(scenes.greedy({"settle": {"outline_px": 0.8}}), seed=7)
    planner, _ = begun(old, {"settle": scenes.greedy().as_dict()["settle"]})
    assert len(planner.build.actions) > 3
    assert {*scenes.outlines(planner)} - {*scenes.outlines(old)}
    again = scenes.of_rubble(scenes.greedy(), 0)
    packed = PackedWall.of(FoundWall.of(planner))
    again.build = found_again(packed, Yard.of(again)).build
    assert scenes.outlines(again) == scenes.outlines(planner)


def test_in_a_given_order_only_what_ascends_is_used():
    old = scenes.of_rubble(scenes.greedy(), seed=3)
    before = scenes.ids(old)
    assert before != sorted(before)
    planner, gone = begun(old, {"order": "given"})
    used = scenes.ids(planner)
    assert used[0] == before[0]
    assert set(gone) == set(before) - set(used)
    done = scenes.ids(scenes.finish(planner))
    assert done == sorted(done)
    assert done[: len(used)] == used


def test_a_plan_that_begins_with_a_wall_is_no_worse():
    # What a fall is worth could outweigh a stone.
    settings = scenes.greedy({**FEW, "goal": {"fallen": 0.0}})
    before = plan_wall(STONES, 100, 36, scale=1.0, seed=1, settings=settings)
    for budget in (1, 4):
        again = plan_wall(
            STONES, 100, 36, scale=1.0, seed=9, settings=settings, budget=budget,
            begin=before.wall, course_heights_px=before.plan.course_heights_px,
        )  # fmt: skip
        scenes.proven(again, STONES)
        now, then = ((len(one.plan.stone_steps), one.metrics.F_SF) for one in (again, before))
        assert now >= then
        if budget == 1:
            assert again.plan.steps == before.plan.steps


def small_search():
    return plan_wall(STONES, 100, 36, scale=1.0, seed=1, settings=scenes.greedy(FEW), choice=True)


@pytest.fixture(scope="module")
def planner():
    """One that has built a whole wall, than which its search finds a better one."""
    settings = scenes.greedy({"search": {"budget": 3}, "goal": {"fallen": 0.0}})
    return scenes.finish(Planner(STONES, scenes.RUBBLE_SITE, seed=3, settings=settings))


@pytest.fixture(scope="module")
def found(planner):
    """The end of its search."""
    return run_to_end(planner)


def half_of(planner):
    """A wall on which there is room."""
    half = Planner(STONES, scenes.RUBBLE_SITE, settings=planner.settings)
    half.build = planner.build.states()[len(planner.build.actions) // 2]
    return PackedWall.of(FoundWall.of(half))


def test_a_wall_to_choose_is_as_it_was_found(planner):
    half = half_of(planner)
    found, why = as_found(planner, half)
    assert scenes.ids(found) == [group.stone_id for group in half.groups]
    assert why.reason == "search"
    filled = planner.settings.updated({"stop": {"filling": 0.1}})
    full = Planner(STONES, scenes.RUBBLE_SITE, settings=filled)
    assert as_found(full, half)[1] == Stopped("filled", "filling above 0.1")


def raising(error):
    """Something that never ends by itself."""

    def raises(*_):
        raise error

    return raises


@pytest.mark.parametrize("place", ["surest", "repairs", "with_the_rest"])
def test_an_interrupt_at_the_end_keeps_the_best_as_it_was_found(place, planner, found, monkeypatch):
    monkeypatch.setattr(whole_search, place, raising(KeyboardInterrupt))
    cut = run_to_end(planner)
    assert (cut.stopped, cut.walls) == (INTERRUPTED, found.walls)
    best = max(found.kept, key=lambda wall: wall.merit)
    assert scenes.ids(cut.planner) == [group.stone_id for group in best.groups]


def test_stones_that_find_a_place_stay_where_that_is_better_and_there_is_time(planner):
    half, clock = half_of(planner), scenes.Ticks()
    before = [group.stone_id for group in half.groups]
    whole, stopped, interrupted = with_the_rest(planner, half, Deadline(math.inf, clock))
    assert (stopped, interrupted) == (whole.stopped, False)
    assert scenes.ids(whole)[: len(before)] == before
    assert len(scenes.ids(whole)) > len(before)
    left, why, interrupted = with_the_rest(planner, replace(half, merit=math.inf))
    assert (scenes.ids(left), interrupted) == (before, False)
    assert why == Stopped("search", "the stones that are left do not make the wall better")
    placed = set()
    for share in (0.0, 0.5, 0.9):
        until = scenes.after_looks(int(share * clock.count))
        found, why, interrupted = with_the_rest(planner, half, until)
        assert (why.reason, interrupted) == ("search", True)
        assert before == scenes.ids(found)[: len(before)]
        assert scenes.ids(whole)[: len(scenes.ids(found))] == scenes.ids(found)
        placed.add(len(scenes.ids(found)))
    assert len(placed) > 1
    # Nor is there time for stones that do not make the wall better.
    assert with_the_rest(planner, replace(half, merit=math.inf), scenes.after_looks(0))[2]
    with pytest.raises(TimeIsUp):
        as_found(planner, half, scenes.after_looks(0))


def test_of_walls_that_there_is_no_time_to_judge_the_first_is_taken(planner):
    half, clock = half_of(planner), scenes.Ticks()
    # Nobody knows yet that it carries less than it seems to.
    whole = PackedWall.of(FoundWall.of(planner))
    walls = [replace(half, merit=whole.merit + 2.0), replace(whole, merit=whole.merit + 1.0)]
    best, interrupted = surest(planner, walls, Deadline(math.inf, clock))
    assert (len(best.build.actions), interrupted) == (len(whole.groups), False)
    assert surest(planner, walls, scenes.after_looks(0)) == (None, True)
    # The half was judged, and the other one was not.
    judged, interrupted = surest(planner, walls, scenes.after_looks(clock.count - 1))
    assert (len(judged.build.actions), interrupted) == (len(half.groups), True)
    assert judged.merit < walls[0].merit


def test_walls_to_choose_are_left_out_where_there_is_no_time_or_an_interrupt(monkeypatch):
    whole = small_search()
    assert len(whole.choice) > 1
    assert _opened.cache_info().currsize == 0  # nothing is kept in memory
    with monkeypatch.context() as patch:
        patch.setattr("drystone.search.plan_wall.as_found", raising(KeyboardInterrupt))
        result = small_search()
    assert (result.status, result.plan.stopped) == ("interrupted", "interrupted")
    assert result.plan.steps == whole.plan.steps
    assert result.choice == ()
    limits = iter([Deadline(), Deadline(), scenes.after_looks(0)])
    monkeypatch.setattr(Deadline, "after", lambda *_: next(limits))
    result = small_search()
    assert [one.plan for one in result.choice] == [result.plan]
    assert [notice.code for notice in result.notices] == ["W125"]
    assert "again" not in dict(rows(result, Path()))["walls tried"]
    assert "--budget 4 builds the same again" in dict(rows(whole, Path()))["walls tried"]
    assert result.metrics.F_LR is not None
    assert result.metrics.F_LR_coulomb is None


def test_a_wall_that_falls_when_it_is_let_go_gives_way_to_one_that_stays(planner, monkeypatch):
    whole, half = PackedWall.of(FoundWall.of(planner)), half_of(planner)
    walls = sorted((whole, half), key=lambda wall: -wall.merit)
    best, _ = surest(planner, walls)
    assert stays_at_every_step(planner.build)
    lost = len(best.build.actions)

    def fall(model, *_):
        return len(model.blocks) == lost or None

    monkeypatch.setattr(goal, "fall_of", fall)
    other, _ = surest(planner, walls)
    assert len(other.build.actions) != lost
    monkeypatch.setattr(goal, "fall_of", lambda *_: True)
    again, _ = surest(planner, walls)
    assert again.merit == best.merit  # all fall


@pytest.mark.parametrize("error", [TimeIsUp, KeyboardInterrupt])
def test_repairs_made_before_an_end_stay(error, planner, found, monkeypatch):
    half = found_again(half_of(planner), Yard.of(planner))

    def repairs(*_):
        yield half
        raise error

    monkeypatch.setattr(whole_search, "repairs", repairs)
    monkeypatch.setattr(whole_search, "with_the_rest", lambda *asked: (*as_found(*asked), False))
    ended = run_to_end(planner)
    assert scenes.ids(ended.planner) == scenes.ids(half)
    interrupted = error is KeyboardInterrupt
    assert (ended.cut, ended.stopped is INTERRUPTED) == (not interrupted, interrupted)
    assert not found.cut
