"""A search: the same budget gives the same wall, and a larger one none that is worse."""

import math
import sys
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.generate.polygon import PolygonSettings, polygon_stones
from drystone.model.site import Site
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.events import Callbacks, Incumbent
from drystone.planner.planner import Planner
from drystone.planner.search_settings import UNLIMITED
from drystone.planner.solves import Solves
from drystone.search import anytime, work
from drystone.search.anytime import PROMISING, _links, _shared, searching
from drystone.search.chain import in_cycle, wedged
from drystone.search.course_plan import CoursePlan
from drystone.search.first_walls import PROMISE
from drystone.search.found import Courses, Found
from drystone.search.packed import Packed, found_again
from drystone.search.plan_wall import SoFar, plan_wall
from drystone.search.processes import processes
from drystone.search.standing import PackedLink, Progress, Standing
from drystone.search.whole_search import run_to_end
from drystone.search.work import Job, planned_first
from drystone.verify.check import check_plan
from tests.planner.scenes import RUBBLE_SITE, Ticks, after_looks, finish, greedy, order, rubble

SMALL = {"passes": 3, "chains": 2, "share_every": 2, "cycle": 3}
"""A search that does everything within ten walls."""

WALLS = {
    "one_pass": {"in_time", "annealed", "course", "_with_one_more", "_needed", "_round"},
    "newly_planned": {"annealed", "course", "in_time"},
    "replanned": {"annealed", "course"},
    "relaid": {"course"},
    "recreated": {"replayed", "in_time"},
    "more_links": {"replayed", "in_time", "annealed", "course", "_with_one_more", "_round"},
    "wedged": {"replayed", "_with_one_more", "_needed", "_round"},
    "surest": {"replayed", "fall_of", "_round"},
}
"""What builds or judges a wall, and the loops of it in which the clock is looked at."""

LOOPS = {name for names in WALLS.values() for name in names}


def first(budget: int, seed: int = 1, patience: int = 12) -> Planner:
    search = {"budget": budget, "patience": patience, **SMALL}
    settings = greedy({"search": search})
    return finish(Planner(rubble(), RUBBLE_SITE, seed=seed, settings=settings))


def searched(planner: Planner, jobs: int = 1, until: Deadline = NEVER) -> list[Progress]:
    with processes(jobs) as executor:
        return list(
            searching(
                Found.of(planner), planner.workshop, planner.settings, planner.seed,
                executor=executor, until=until,
            )
        )  # fmt: skip


def judged(planner: Planner) -> Found:
    return Found.of(planner).judged(planner.workshop, planner.settings)


def same(one: Packed, other: Packed) -> bool:
    """Whether two packed walls are one wall."""
    return one.merit == other.merit and [(g.stone_id, g.angle_deg, g.side) for g in one.groups] == [
        (g.stone_id, g.angle_deg, g.side) for g in other.groups
    ]


def test_walls_get_better_and_are_complete() -> None:
    planner = first(12, seed=2)
    found = searched(planner)
    assert found[0].walls == 1
    assert found[0].best.merit == judged(planner).merit
    assert [p.walls for p in found] == [1, 2, 3, 5, 7, 9, 11, 12]
    assert all(a.best.merit <= b.best.merit for a, b in pairwise(found))
    assert found[-1].best.merit > found[0].best.merit
    best = found_again(found[-1].best, planner.workshop, planner.settings)
    assert all(a.sturdy and a.resistance.stable for a in best.build.actions)
    # What was measured when the wall was found is what is measured of it now.
    again = Found.measured(best.build, planner.workshop, planner.settings)
    assert again.merit >= best.merit
    again = again.judged(planner.workshop, planner.settings)
    assert again.figures == best.figures
    assert again.merit == best.merit


def test_the_best_first_wall_counts_though_chains_begin_with_what_promises_more() -> None:
    found = searched(first(9, seed=5))
    assert all(a.best.merit <= b.best.merit for a, b in pairwise(found))


def test_chains_go_on_from_planned_walls_that_promise_more_until_they_are_long() -> None:
    def packed(merit: float, planned: bool) -> Packed:
        courses = Courses(CoursePlan((), 0.0), (0,)) if planned else None
        return Packed((), None, merit, Solves(), courses)

    alone, planned = packed(1.0, planned=False), packed(0.9, planned=True)
    links = _links([alone, planned, packed(0.2, planned=True)], 0, 2)
    assert [link.best for link in links] == [planned, alone]
    assert _shared(list(links))[1].now is planned
    long = [replace(link, done=PROMISING) for link in links]
    assert _shared(long)[0].now is alone
    # Half of the promise is as much as they are apart, and a little more.
    nearly = packed(1.0 - 0.4 * PROMISE, planned=True)
    half = [replace(link, done=PROMISING // 2) for link in _links([alone, nearly], 0, 2)]
    assert _shared(half)[1].best is nearly
    assert _shared(half[:1] * 2) == half[:1] * 2


def test_the_first_wall_is_wedged_as_the_others_are() -> None:
    planner = first(2, seed=8)
    start = judged(planner)
    better = wedged(start, planner.workshop, planner.settings)
    assert better.merit > start.merit
    found = searched(planner)
    assert [p.walls for p in found] == [1, 2]
    # Nothing that the budget 1 does not repeat.
    assert found[0].best.merit == start.merit
    assert found[1].best.merit == better.merit


def test_a_part_of_a_search_is_a_search_with_a_smaller_budget() -> None:
    """What the clock cut off, the budget that is recorded repeats."""
    whole = searched(first(12))
    for part in whole:
        again = searched(first(part.walls))[-1] if part.walls > 1 else whole[0]
        assert again.walls == part.walls
        assert same(again.best, part.best)


def test_after_many_walls_in_vain_other_first_walls_begin_another_round(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    begun: list[int] = []
    chained: list[tuple[int, int]] = []

    def one_pass(job: Job, number: int, share: float) -> Packed | None:
        begun.append(number)
        return work.one_pass(job, number, share)

    def more_links(job: Job, link: PackedLink, count: int) -> PackedLink | None:
        chained.append((link.number, link.done))
        return work.more_links(job, link, count)

    monkeypatch.setattr(anytime, "one_pass", one_pass)
    monkeypatch.setattr(anytime, "more_links", more_links)
    whole = searched(first(25, seed=4, patience=1))
    assert len(begun) > 3
    assert begun == list(range(1, len(begun) + 1))
    assert chained[:2] == [(0, 0), (1, 0)]
    # The chains of another round draw anew.
    assert (2, 0) in chained
    assert (3, 0) in chained
    assert all(a.walls < b.walls for a, b in pairwise(whole))
    assert whole[-1].walls == 25
    # What earlier rounds have found is not lost.
    assert all(a.best.merit <= b.best.merit for a, b in pairwise(whole))
    assert all(any(same(p.best, kept) for kept in p.kept) for p in whole)


def test_a_part_of_several_rounds_is_a_search_with_a_smaller_budget() -> None:
    for part in searched(first(21, patience=1))[-4::3]:
        again = searched(first(part.walls, patience=1))[-1]
        assert again.walls == part.walls
        assert same(again.best, part.best)
        assert again.solves == part.solves


def test_what_was_built_in_time_counts_even_where_a_wall_was_cut_off() -> None:
    clock = Ticks()
    assert searched(first(9), until=Deadline(math.inf, clock))[-1].walls == 9
    reached = set()
    for looks in range(0, clock.count, clock.count // 8):
        timed = searched(first(1000), until=after_looks(looks))[-1]
        again = searched(first(timed.walls))[-1]
        assert again.walls == timed.walls
        # There is no time to judge a first wall by both flow rules: its merit is then known less.
        best = again.best if looks else replace(again.best, merit=timed.best.merit)
        assert same(best, timed.best)
        assert again.solves == timed.solves
        reached.add(timed.walls)
    assert len(reached) > 4
    assert min(reached) == 1


def test_the_clock_is_looked_at_inside_everything_that_takes_long(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In first walls by policy and by courses, restarts, chains, wedging, and judging."""
    inside: set[tuple[str, str]] = set()

    def look(_: Deadline) -> None:
        names, frame = [], sys._getframe(1)
        while frame is not None:
            names.append(frame.f_code.co_name)
            frame = frame.f_back  # type: ignore[assignment]
        inside.update(
            (inner, outer) for inner in LOOPS for outer in WALLS if {inner, outer} <= {*names}
        )

    monkeypatch.setattr(Deadline, "look", look)
    run_to_end(first(24, seed=1, patience=1))
    missing = {(inner, outer) for outer, inners in WALLS.items() for inner in inners} - inside
    assert not missing


def test_processes_change_nothing() -> None:
    one, two = searched(first(16, patience=1)), searched(first(16, patience=1), jobs=2)
    assert [p.walls for p in one] == [p.walls for p in two]
    assert all(same(a.best, b.best) for a, b in zip(one, two, strict=True))


@pytest.mark.parametrize("looks", [150, 500])
def test_the_clock_cuts_off_walls_of_other_processes_too(looks: int) -> None:
    # Every task has a copy of the clock as it is when it is handed over.
    timed = searched(first(9), jobs=2, until=after_looks(looks))[-1]
    again = searched(first(timed.walls))[-1]
    assert again.walls == timed.walls
    assert same(again.best, timed.best)


def test_the_clock_ends_a_search_and_the_plan_says_after_how_many_walls() -> None:
    settings = greedy({"search": {"budget": 1, **SMALL}})
    timed = plan_wall(rubble(), 100, 36, scale=1.0, seed=2, settings=settings, seconds=1.0)
    used = timed.plan.settings["search"]["budget"]
    assert 1 < used < UNLIMITED
    again = plan_wall(rubble(), 100, 36, scale=1.0, seed=2, settings=settings, budget=used)
    assert again.plan == timed.plan


def test_a_budget_ends_a_search_that_has_more_time() -> None:
    settings = greedy({"search": {"budget": 1, **SMALL}})
    result = plan_wall(
        rubble(), 100, 36, scale=1.0, seed=2, settings=settings, budget=3, seconds=1e6
    )
    assert result.plan.settings["search"]["budget"] == 3


def test_a_policy_builds_one_wall_in_any_time() -> None:
    settings = greedy({"selection_rule": "lowest", "search": {"budget": 1}})
    result = plan_wall(rubble(), 100, 36, scale=1.0, settings=settings, seconds=100.0)
    assert result.plan.settings["search"]["budget"] == 1


def test_no_budget_is_none_to_plan_with() -> None:
    with pytest.raises(UsageError, match="E123"):
        plan_wall(rubble(), 100, 36, scale=1.0, budget=0)


def test_no_time_is_one_wall_where_that_is_built_whole() -> None:
    settings = greedy({"search": {"budget": 100, **SMALL}})
    planner = Planner(rubble(), RUBBLE_SITE, seed=1, settings=settings)
    best, stopped, walls, *_ = run_to_end(planner, until=after_looks(0), first_whole=True)
    assert walls == 1
    assert best is planner
    assert stopped == planner.stopped
    assert order(planner) == order(
        finish(Planner(rubble(), RUBBLE_SITE, seed=1, settings=settings))
    )


def test_an_interrupt_keeps_the_best_wall_so_far() -> None:
    told: list[Incumbent] = []

    class Impatient(Callbacks):
        def on_walls(self, incumbent: Incumbent) -> None:
            told.append(incumbent)
            if incumbent.walls >= 5:
                raise KeyboardInterrupt

    settings = greedy({"search": {"budget": 50, **SMALL}})
    stones = rubble()
    result = plan_wall(stones, 100, 36, scale=1.0, seed=1, settings=settings, callbacks=Impatient())
    assert [one.walls for one in told] == [1, 2, 3, 5]
    assert result.plan.settings["search"]["budget"] == 5
    assert (result.status, result.plan.stopped) == ("interrupted", "interrupted")
    assert result.notices == ()
    assert check_plan(result.plan, stones, wall_labels=result.wall.labels).problems == ()
    best = searched(first(5))[-1].best
    assert [step.stone for step in result.plan.stone_steps] == [g.stone_id for g in best.groups]
    assert told[-1].merit == best.merit
    assert told[-1].stones == len(best.groups)


def test_a_search_goes_on_from_where_it_stood_to_the_walls_that_it_would_have_found() -> None:
    planner = first(25, seed=4, patience=1)
    whole = searched(planner)
    stood = [k for k, one in enumerate(whole) if one.standing is not None]
    rounds = {standing(whole[k]).number for k in stood}
    assert len(rounds) > 1
    assert {standing(whole[k]).chains is None for k in stood} == {True, False}
    # Where there is but a first wall, and where the budget cut a chain short, there is nothing.
    assert set(range(len(whole))) - set(stood) <= {0, len(whole) - 1}
    for k in stood[::3]:
        again = list(
            searching(standing(whole[k]), planner.workshop, planner.settings, planner.seed)
        )
        assert [one.walls for one in again] == [one.walls for one in whole[k:]]
        assert standing(whole[k]).walls == whole[k].walls
        for one, other in zip(again, whole[k:], strict=True):
            assert same(one.best, other.best)
            assert one.solves == other.solves
            assert [wall.merit for wall in one.kept] == [wall.merit for wall in other.kept]


def test_a_search_that_goes_on_with_a_smaller_budget_ends() -> None:
    planner = first(25, seed=4, patience=1)
    last = searched(planner)[-2]
    assert standing(last).before is not None
    less = planner.settings.updated({"search": {"budget": 1}})
    (only,) = searching(standing(last), planner.workshop, less, planner.seed)
    assert (only.walls, only.best) == (last.walls, last.best)


def standing(progress: Progress) -> Standing:
    assert progress.standing is not None
    return progress.standing


def test_a_plan_that_is_kept_is_that_of_an_interrupt_and_leads_to_the_whole_one() -> None:
    settings = greedy({"search": {"budget": 9, **SMALL}})
    told: list[SoFar] = []
    stones = rubble()
    whole = plan_wall(stones, 100, 36, scale=1.0, seed=1, settings=settings, keep=told.append)
    placed = [one for one in told if one.progress is None]
    assert len(placed) > 3
    assert [one.progress.walls for one in told if one.progress] == [1, 2, 3, 5, 7, 9]
    for one in (told[len(placed) + 1], told[-1]):
        partial = one.plan()
        assert partial.status == "interrupted"
        assert check_plan(partial.plan, stones, wall_labels=partial.wall.labels).problems == ()
    assert one.progress is not None
    assert [step.stone for step in partial.plan.stone_steps] == [
        group.stone_id for group in one.progress.best.groups
    ]
    for one in told[len(placed) + 1 :]:
        again = plan_wall(
            stones, 100, 36, scale=1.0, seed=1, settings=settings, standing=standing(one.progress)
        )
        assert again.plan == whole.plan


def test_nothing_to_build_is_no_trouble() -> None:
    """No stone that is 100 px wide fits."""
    settings = greedy({"search": {"budget": 6, **SMALL}, "skip_too_large": True})
    planner = Planner(rubble(), Site(6, 6), settings=settings)
    best, stopped, walls, *_ = run_to_end(planner)
    assert (best.build.actions, stopped.reason, walls) == ((), "stones", 6)


def test_cycles_double() -> None:
    walked = [in_cycle(done, 3) for done in range(22)]
    assert [length for position, length in walked if position == 0] == [3, 6, 12, 24]
    assert all(b[0] in (a[0] + 1, 0) for a, b in pairwise(walked))


@pytest.mark.parametrize(
    ("changes", "planned"),
    [
        ({}, True),
        ({"orientations": "45deg"}, False),
        ({"orientations": "90deg"}, False),
        ({"orientations": "sf"}, False),
        ({"orientations": "40deg"}, False),
        ({"two_sided": False}, False),
        ({"order": "given"}, False),
    ],
)
def test_courses_are_planned_where_quarter_turns_and_both_ends_may_be_used(
    changes: dict[str, object], planned: bool
) -> None:
    assert planned_first(greedy(changes)) is planned


def test_a_process_that_dies_ends_the_search_with_the_best_so_far() -> None:
    class Dying(Callbacks):
        def on_walls(self, incumbent: Incumbent) -> None:
            if incumbent.walls >= 3:
                raise BrokenProcessPool

    settings = greedy({"search": {"budget": 50, **SMALL}})
    stones = rubble()
    result = plan_wall(stones, 100, 36, scale=1.0, seed=1, settings=settings, callbacks=Dying())
    assert [notice.code for notice in result.notices] == ["W122"]
    assert result.plan.settings["search"]["budget"] == 3
    assert check_plan(result.plan, stones, wall_labels=result.wall.labels).problems == ()


@pytest.mark.parametrize("orientations", ["45deg", "90deg"])
def test_walls_of_other_orientations_hold(orientations: str) -> None:
    settings = greedy({"orientations": orientations, "search": {"budget": 8, **SMALL}})
    stones = polygon_stones(PolygonSettings(count=8, noise=0.5), np.random.default_rng(4))
    result = plan_wall(stones, 400, 200, scale=0.2, seed=1, settings=settings)
    report = check_plan(result.plan, stones, wall_labels=result.wall.labels)
    assert report.problems == ()
