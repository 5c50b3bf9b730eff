"""A search: the same budget gives the same wall, and a larger one none that is worse."""

import sys
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from itertools import pairwise, permutations
from types import SimpleNamespace

import numpy as np
import pytest

from drystone import Planner, Site, plan_wall
from drystone.planner.build import Solves
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.events import Callbacks
from drystone.planner.search_settings import SearchSettings
from drystone.planner.workshop import Workshop
from drystone.search import anytime
from drystone.search.chain import in_cycle, planned_first, recreated, wedged
from drystone.search.courses import CoursePlan
from drystone.search.goal import Courses, FoundWall
from drystone.search.packed import PackedWall, archived, found_again
from drystone.search.processes import processes
from drystone.search.whole_search import run_to_end
from drystone.search.yard import Yard
from tests.planner import scenes

SMALL = {"passes": 3, "chains": 2, "share_every": 2, "cycle": 3}
"""A search that does everything within ten walls."""

WALLS = {
    "one_pass": {"in_time", "plan_courses", "course", "_with_one_more", "_needed", "_round"},
    "newly_planned": {"plan_courses", "course", "in_time"},
    "replanned": {"plan_courses", "course"},
    "relaid": {"course"},
    "recreated": {"replayed", "in_time"},
    "more_links": {"replayed", "in_time", "plan_courses", "course", "_with_one_more", "_round"},
    "wedged": {"replayed", "_with_one_more", "_needed", "_round"},
    "surest": {"replayed", "fall_of", "_round"},
}
"""What builds or judges a wall, and the loops of it in which the clock is looked at."""

LOOPS = {name for names in WALLS.values() for name in names}


STONES = scenes.rubble(3, 5)
WORKSHOP = Workshop.prepare(STONES, scenes.RUBBLE_SITE, scenes.greedy())


def planner_of(budget, patience=12):
    settings = scenes.greedy({"search": {"budget": budget, "patience": patience, **SMALL}})
    return Planner(STONES, scenes.RUBBLE_SITE, seed=5, settings=settings, workshop=WORKSHOP)


def planned_wall(settings, **options):
    return plan_wall(STONES, 100, 36, scale=1.0, settings=settings, **options)


def first(*asked, **more):
    return scenes.finish(planner_of(*asked, **more))


def searched(planner, executor=None, until=NEVER):
    yard = Yard.of(planner, until)
    return [*anytime.searching(FoundWall.of(planner), yard, planner.seed, executor)]


def judged(planner):
    return FoundWall.of(planner).judged(Yard.of(planner))


def same(one, other):
    return (one.groups, one.merit) == (other.groups, other.merit)


def alike(one, other):
    return (
        (one.walls, one.solves) == (other.walls, other.solves)
        and same(one.best, other.best)
        and len(one.kept) == len(other.kept)
        and all(map(same, one.kept, other.kept))
    )


def test_chains_go_on_from_planned_walls_that_promise_more_until_they_are_long():
    alone, planned = packed(1.0, planned=False), packed(0.9, planned=True)
    links = anytime._links([alone, planned, packed(0.2, planned=True)], 0, 2)
    assert [link.best for link in links] == [planned, alone]
    assert anytime._shared(list(links))[1].now is planned
    long = [replace(link, done=anytime.PROMISING) for link in links]
    assert anytime._shared(long)[0].now is alone
    # Half of the promise is as much as they are apart, and a little more.
    nearly = packed(1.0 - 0.4 * anytime.PROMISE, planned=True)
    links = anytime._links([alone, nearly], 0, 2)
    half = [replace(link, done=anytime.PROMISING // 2) for link in links]
    assert anytime._shared(half)[1].best is nearly


def test_the_first_wall_is_wedged_as_the_others_are():
    planner = scenes.of_rubble(scenes.greedy({"search": {"budget": 2, **SMALL}}), seed=103)
    start = judged(planner)
    better = wedged(start, Yard.of(planner))
    assert better.merit > start.merit
    found = searched(planner)
    # Nothing that the budget 1 does not repeat.
    assert [(p.walls, p.best.merit) for p in found] == [(1, start.merit), (2, better.merit)]


def test_walls_of_a_search_take_turns():
    yard = Yard.of(first(2))
    joints = [yard.jointed(number).settings.settle.joint_px for number in range(4)]
    open_px = pytest.approx(0.03 * yard.workshop.seats.mean_size)
    assert joints == [0.0, open_px, 0.0, open_px]
    # Cycles double.
    walked = [in_cycle(done, 3) for done in range(22)]
    assert [length for position, length in walked if position == 0] == [3, 6, 12, 24]
    assert all(b[0] in (a[0] + 1, 0) for a, b in pairwise(walked))
    # Courses are planned where quarter turns and both ends may be used.
    assert planned_first(scenes.greedy())
    others = [{"orientations": one} for one in ("45deg", "90deg", "sf", "40deg")]
    for changes in (*others, {"two_sided": False}, {"order": "given"}):
        assert not planned_first(scenes.greedy(changes))


@pytest.fixture(scope="module")
def rounds():
    """A search of several rounds to its end, and where the clock was looked at in it."""
    inside, found = set(), []

    def look(_):
        names, frame = set(), sys._getframe(1)
        while frame is not None:
            names.add(frame.f_code.co_name)
            frame = frame.f_back
        inside.update((inner, outer) for inner in LOOPS & names for outer in names & {*WALLS})

    planner = planner_of(17, patience=1)
    with pytest.MonkeyPatch.context() as patch:
        passes = scenes.watched(patch, anytime, "one_pass")
        links = scenes.watched(patch, anytime, "more_links")
        patch.setattr(Deadline, "look", look)
        run_to_end(planner, told=found.append)
    whole = [one for one in found if one is not None]
    begun = [number for (_, number, _), _ in passes]
    chained = [(link.number, link.done) for (_, link, _), _ in links]
    return SimpleNamespace(
        planner=planner, begun=begun, chained=chained, inside=inside, whole=whole
    )


def test_walls_get_better_and_other_first_walls_begin_another_round_after_many_in_vain(rounds):
    begun, whole = rounds.begun, rounds.whole
    assert len(begun) > 3
    assert begun == list(range(1, len(begun) + 1))
    assert rounds.chained[:2] == [(0, 0), (1, 0)]
    # The chains of another round draw anew.
    assert {(2, 0), (3, 0)} <= {*rounds.chained}
    assert [p.walls for p in whole] == [1, 2, 3, 5, 7, 8, 9, 10, 12, 14, 15, 16, 17]
    # What earlier rounds have found is not lost.
    assert all(a.best.merit <= b.best.merit for a, b in pairwise(whole))
    assert all(any(same(p.best, kept) for kept in p.kept) for p in whole)
    assert whole[-1].best.merit > whole[0].best.merit == judged(rounds.planner).merit
    yard = Yard.of(rounds.planner)
    best = found_again(whole[-1].best, yard)
    assert all(a.sturdy and a.resistance.stable for a in best.build.actions)
    # What was measured when the wall was found is what is measured of it now.
    again = FoundWall.measured(best.build, yard)
    assert again.merit >= best.merit
    again = again.judged(yard)
    assert (again.figures, again.merit) == (best.figures, best.merit)


def test_the_clock_is_looked_at_inside_everything_that_takes_long(rounds):
    """In first walls by policy and by courses, restarts, chains, wedging, and judging."""
    asked = {(inner, outer) for outer, inners in WALLS.items() for inner in inners}
    assert not asked - rounds.inside


def test_a_part_of_several_rounds_in_processes_is_a_search_with_a_smaller_budget(rounds):
    """What the clock cut off, the budget that is recorded repeats."""
    part = rounds.whole[:-2]
    with processes(2) as workers:
        again = searched(first(part[-1].walls, patience=1), workers)
        # Every task has a copy of the clock as it is when it is handed over.
        timed = searched(first(9), workers, until=scenes.after_looks(80))[-1]
    assert 1 < timed.walls < 9
    assert all(alike(a, b) for a, b in zip(again, part, strict=True))
    again = searched(first(timed.walls))[-1]
    assert again.walls == timed.walls
    assert same(again.best, timed.best)


@pytest.mark.parametrize(("error", "most"), [(KeyboardInterrupt, 5), (BrokenProcessPool, 3)])
def test_an_interrupt_and_a_process_that_dies_keep_the_best_wall_so_far(error, most):
    told = []

    class Impatient(Callbacks):
        def on_walls(self, incumbent):
            told.append(incumbent)
            if incumbent.walls >= most:
                raise error

    settings = scenes.greedy({"search": {"budget": 50, **SMALL}})
    result = planned_wall(settings, seed=5, callbacks=Impatient())
    walls = [one.walls for one in told if not one.repairs]
    assert walls == [count for count in (1, 2, 3, 5) if count <= most]
    assert result.plan.settings["search"]["budget"] == most
    scenes.proven(result, STONES)
    if error is BrokenProcessPool:
        assert [notice.code for notice in result.notices] == ["W122"]
        return
    assert (result.status, result.plan.stopped) == ("interrupted", "interrupted")
    assert result.notices == ()
    best = searched(first(5))[-1].best
    assert [step.stone for step in result.plan.stone_steps] == [g.stone_id for g in best.groups]
    assert told[-1].merit == best.merit
    assert told[-1].stones == len(best.groups)


def test_a_search_goes_on_from_where_it_stood_to_the_walls_that_it_would_have_found(rounds):
    planner, whole = rounds.planner, rounds.whole
    stood = [k for k, one in enumerate(whole) if one.state is not None]
    assert len({whole[k].state.number for k in stood}) > 1
    late = {whole[k].state.chains is None: k for k in stood}
    assert late.keys() == {True, False}
    # Where there is but a first wall, and where the budget cut a chain short, there is nothing.
    assert set(range(len(whole))) - set(stood) <= {0, len(whole) - 1}
    yard = Yard.of(planner)
    for k in late.values():
        again = list(anytime.searching(whole[k].state, yard, planner.seed))
        assert alike(whole[k].state.reached, whole[k])
        assert all(alike(one, other) for one, other in zip(again, whole[k:], strict=True))
    # One that goes on with a smaller budget ends.
    last = whole[stood[-1]]
    assert last.state.before is not None
    less = planner.settings.updated({"search": {"budget": 1}})
    (only,) = anytime.searching(last.state, Yard(planner.workshop, less), planner.seed)
    assert (only.walls, only.best) == (last.walls, last.best)


KEPT = scenes.greedy({"search": {"budget": 9, **SMALL}})


@pytest.fixture(scope="module")
def kept():
    """A plan, and what is told of it while it is made."""
    told = []
    return planned_wall(KEPT, seed=1, choice=True, keep=told.append), told


def test_a_plan_that_is_kept_is_that_of_an_interrupt_and_leads_to_the_whole_one(kept):
    whole, told = kept
    placed = [one for one in told if one.progress is None]
    assert len(placed) > 3
    assert [one.progress.walls for one in told if one.progress] == [1, 2, 3, 5, 7, 9]
    for one in (told[len(placed) + 1], told[-1]):
        partial = one.plan()
        assert partial.status == "interrupted"
        scenes.proven(partial, STONES)
    assert [step.stone for step in partial.plan.stone_steps] == [
        group.stone_id for group in one.progress.best.groups
    ]
    for one in told[len(placed) + 1 :: 3]:
        again = planned_wall(KEPT, seed=1, state=one.progress.state)
        assert again.plan == whole.plan


def test_what_none_beats_is_kept_and_becomes_plans_that_hold(kept):
    result, told = kept
    found = [one.progress for one in told if one.progress]
    assert max(len(progress.kept) for progress in found) > 1
    for progress in found:
        assert progress.kept[0].merit == pytest.approx(progress.best.merit)  # of mirror images any
        assert archived((), progress.kept) == progress.kept
    assert len(result.choice) > 1
    assert result.choice[0].plan == result.plan
    for one in result.choice:
        scenes.proven(one, STONES)
    metrics = (one.metrics for one in result.choice)
    scores = [(m.F_SF, m.F_AV or 0.0, -(m.F_AH or 0.0), m.F_LR or 0.0) for m in metrics]
    for one, other in permutations(scores, 2):
        assert not all(a >= b for a, b in zip(one, other, strict=True))


def test_nothing_to_build_is_no_trouble():
    """No stone that is 100 px wide fits."""
    settings = scenes.greedy({"search": {"budget": 6, **SMALL}, "skip_too_large": True})
    planner = Planner(STONES, Site(6, 6), settings=settings)
    best, stopped, walls, *_ = run_to_end(planner)
    assert (best.build.actions, stopped.reason, walls) == ((), "stones", 6)


def packed(merit, planned):
    one = PackedWall((), None, merit, Solves(), None)
    return replace(one, courses=Courses(CoursePlan((), 0.0), (0,))) if planned else one


def numbers(search):
    """Batches of a search each of whose walls is better than the one before it."""
    found, batches = [packed(0.0, planned=True)], []
    while (batch := anytime.next_batch(found, search)) is not None:
        batches.append(list(batch[0]))
        found += [packed(float(number), planned=True) for number in batch[0]]
    return batches


@pytest.mark.parametrize("count", [1, 2, 5, 13])
def test_batches_number_every_wall_but_the_very_first(count):
    listed = numbers(SearchSettings(budget=count, passes=24))
    assert [n for batch in listed for n in batch] == list(range(1, count))
    # A smaller budget cuts the last batch, and changes no other: it repeats a part of a search.
    whole = numbers(SearchSettings(budget=count + anytime.BATCH, passes=24))
    assert all(set(a) <= set(b) for a, b in zip(listed, whole, strict=False))
    # So do fewer passes.
    assert numbers(SearchSettings(budget=60, passes=count)) == listed


def test_the_share_follows_the_better_half():
    planned_win = [packed(k, planned=k >= 4) for k in range(8)]
    greedy_win = [packed(k, planned=k < 4) for k in range(8)]
    usual = anytime.SHARE * anytime.WEIGHT
    assert anytime.planned_share([packed(1.0, planned=False)]) == anytime.SHARE
    assert anytime.planned_share(planned_win) == (4 + usual) / (4 + anytime.WEIGHT)
    assert anytime.planned_share(greedy_win) == usual / (4 + anytime.WEIGHT)
    assert anytime.planned_share(planned_win[::-1]) == anytime.planned_share(planned_win)
    # In the better half by their promise alone.
    behind = [packed(1.0, planned=False), packed(1.1 - anytime.PROMISE, planned=True)] * 4
    assert anytime.planned_share(behind) > anytime.SHARE


def test_first_walls_end_when_they_beat_none_that_was_not_planned():
    rising = [packed(float(k), planned=False) for k in range(20)]
    assert not any(anytime.stale(rising[: k + 1]) for k in range(20))
    level = [packed(0.3, planned=k % 2 > 0) for k in range(anytime.STALE)]
    level.insert(0, packed(1.0, planned=False))
    assert anytime.stale(level)
    # It is looked at when a batch begins; one that is begun is built to its end.
    more = [packed(0.3, planned=False)] * (anytime.BATCH - len(level) % anytime.BATCH)
    assert anytime.next_batch(level, SearchSettings(budget=60)) is not None
    assert anytime.next_batch([*level, *more], SearchSettings(budget=60)) is None
    # A planned wall that is a little behind promises more.
    best, behind = packed(2.0, planned=True), packed(1.0 - anytime.PROMISE / 2, planned=True)
    for walls in (level[:-1], [*level, packed(2.0, planned=False)], [*level, best, *level[1:]]):
        assert not anytime.stale(walls)
    assert not anytime.stale([behind, *level])


def test_a_search_finds_a_wall_with_what_is_pinned():
    def planned(changes):
        result = plan_wall(STONES, 60, 36, scale=1.0, seed=1, settings=scenes.greedy(changes))
        assert result.notices == ()
        return {placement.stone_id for placement in result.wall.placements}

    pin = sorted({stone.id for stone in STONES} - planned({}))[:2]
    assert len(pin) == 2
    assert set(pin) <= planned({"pin": pin, "search": {"budget": 4, **SMALL}})


def test_a_search_keeps_a_given_order_and_builds_the_last_stones_again():
    search = {"budget": 2, "spread": 2.0, "largest": 0.6}  # other weights, other walls
    planner = scenes.of_rubble(scenes.greedy({"order": "given", "search": search}), seed=1)
    found, rng = FoundWall.of(planner), np.random.default_rng(0)
    before = scenes.ids(planner)
    stay = len(before) - round(planner.settings.search.largest * len(before))
    walls = set()
    for _ in range(4):
        again = recreated(found, Yard.of(planner), rng)
        assert [action.stone_id for action in again.build.actions][:stay] == before[:stay]
        walls.add(again.build.wall.labels.tobytes())
    assert walls - {planner.build.wall.labels.tobytes()}
    settings = scenes.greedy({"order": "given", "search": {"budget": 7, **SMALL}})
    found = searched(scenes.finish(Planner(STONES, scenes.RUBBLE_SITE, seed=2, settings=settings)))
    assert found[-1].best.merit > found[0].best.merit
    for wall in (wall for progress in found for wall in (progress.best, *progress.kept)):
        order = [group.stone_id for group in wall.groups]
        assert order == sorted(order)
        assert wall.courses is None


def test_the_bound_is_the_area_of_what_may_be_used():
    stones = scenes.rubble()
    area = sum(stone.area_px for stone in stones) - stones.by_id(3).area_px
    settings = scenes.greedy({"ban": [3], "search": {"budget": 1}})
    without = plan_wall(stones, 100, 36, scale=0.7, settings=settings)
    assert without.F_SF_bound == pytest.approx(area / 3600)
    assert without.metrics.F_SF <= without.F_SF_bound
    assert plan_wall(stones, 60, 30, scale=0.7, settings=settings).F_SF_bound == 1.0
