"""Searches that begin with a wall."""

from dataclasses import replace

import numpy as np

from drystone.kernels.polygons import on_grid
from drystone.model.placement import Wedge
from drystone.model.site import Site
from drystone.model.wall import Group
from drystone.model.wedge_shape import WedgeShape
from drystone.planner.planner import Planner
from drystone.search.goal import FoundWall
from drystone.search.packed import PackedWall, found_again
from drystone.search.plan_wall import plan_wall
from drystone.search.warm_start import begin_with
from drystone.search.yard import Yard
from tests.planner.scenes import (
    RUBBLE_SITE,
    WITH_WEDGES,
    blocks,
    few_stones,
    finish,
    greedy,
    ids,
    of_rubble,
    outlines,
    proven,
)
from tests.search.test_anytime import SMALL, STONES


def built(seed=3):
    return of_rubble(greedy(), seed=seed)


def new(settings):
    return of_rubble(settings, 0, seed=1)


def test_banned_stones_are_taken_out_with_what_falls_then():
    old = built(seed=2)
    before = ids(old)
    fell, stayed = set(), set()
    for banned in before[::2]:
        planner = new(greedy({"ban": [banned]}))
        gone = begin_with(planner, old.build.wall, {})
        used = ids(planner)
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
    old = finish(Planner(few_stones(), site, seed=3, settings=greedy(WITH_WEDGES)))
    kept = set()
    for change in ({}, {"thickness": 0.2}, {"height": 0.1}, {"area": 0.001}):
        settings = greedy({**WITH_WEDGES, "wedge": {**WITH_WEDGES["wedge"], **change}})
        planner = Planner(few_stones(), site, settings=settings)
        begin_with(planner, old.build.wall, {})
        limits = Yard.of(planner).limits
        wedges = [w.corners for w in planner.build.wall.wedges if w.corners is not None]
        assert all(limits.allows(WedgeShape.of(corners)) for corners in wedges)
        kept.add(len(wedges))
    assert max(kept) == len(old.build.wall.wedges) > min(kept) == 0


def test_a_stone_stays_without_a_wedge_that_nothing_is_beside():
    """A slab on two blocks reaches over the second; the wall ends 2 or 7 px further on."""
    stones = blocks({1: (20, 4), 2: (20, 4), 3: (50, 10)})
    settings = greedy({"order": "given", "vary": 0.0, "wedge": {"height": 1.0, "area": 1.0}})
    corners = on_grid(np.array([[42.0, 0.01], [48.0, 0.01], [48.0, 4.01], [42.0, 4.01]]))
    for width, wedges in ((52, 0), (57, 1)):
        old = finish(Planner(stones, Site(width, 30), settings=settings))
        *below, slab = old.build.wall.groups
        assert slab.placement.stone_id == 3
        with_it = Group(slab.placement, (Wedge(9, 3, np.ones((4, 6), bool), 26, 42, corners),))
        planner = Planner(stones, Site(width, 30), settings=settings)
        begin = replace(old.build.wall, groups=(*below, with_it))
        assert begin_with(planner, begin, {}) == ()
        assert len(planner.build.wall.wedges) == wedges


def test_what_stands_out_further_than_now_allowed_is_taken_out():
    # A course may use all of 1 px; begun again with a smaller allowance, check would refuse it.
    old = built()
    corners = [action.stabilised.placement.settled.corners for action in old.build.actions]
    width, height = RUBBLE_SITE.extent_px
    out = [max(-c[:, 0].min(), c[:, 0].max() - width, c[:, 1].max() - height) for c in corners]
    furthest = max(out)
    assert furthest > 0.0
    planner = new(old.settings.updated({"settle": {"beyond_px": furthest - 1e-3}}))
    gone = begin_with(planner, old.build.wall, {})
    assert ids(old)[out.index(furthest)] in gone
    planner = new(old.settings.updated({"settle": {"beyond_px": furthest}}))
    assert begin_with(planner, old.build.wall, {}) == ()


def test_outlines_are_those_of_this_search_whatever_those_of_the_plan_were():
    """They are packed as their poses, and would be others when they are built again."""
    old = finish(new(greedy({"settle": {"outline_px": 0.5}})))
    planner = new(greedy())
    begin_with(planner, old.build.wall, {})
    assert len(planner.build.actions) > 3
    assert {*outlines(planner)} - {*outlines(old)}
    again = new(greedy())
    packed = PackedWall.of(FoundWall.of(planner))
    again.build = found_again(packed, Yard.of(again)).build
    assert outlines(again) == outlines(planner)


def test_in_a_given_order_only_what_ascends_is_used():
    old = built()
    before = ids(old)
    assert before != sorted(before)
    planner = new(greedy({"order": "given"}))
    gone = begin_with(planner, old.build.wall, {})
    used = ids(planner)
    assert used == sorted(used)
    assert used[0] == before[0]
    assert set(gone) == set(before) - set(used)
    done = ids(finish(planner))
    assert done == sorted(done)
    assert done[: len(used)] == used


def test_a_plan_that_begins_with_a_wall_is_no_worse():
    # What a fall is worth could outweigh a stone.
    settings = greedy({"search": {"budget": 5, **SMALL}, "goal": {"fallen": 0.0}})
    before = plan_wall(STONES, 100, 36, scale=1.0, seed=1, settings=settings)
    for budget in (1, 4):
        again = plan_wall(
            STONES, 100, 36, scale=1.0, seed=9, settings=settings, budget=budget,
            begin=before.wall,
            course_heights_px=before.plan.course_heights_px,
        )  # fmt: skip
        proven(again, STONES)
        now, then = ((len(one.plan.stone_steps), one.metrics.F_SF) for one in (again, before))
        assert now >= then
        if budget == 1:
            assert again.plan.steps == before.plan.steps
