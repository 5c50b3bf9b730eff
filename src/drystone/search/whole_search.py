"""A first wall, the search for better ones, and what follows it; an interrupt keeps the best."""

import math
from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from itertools import islice
from typing import NamedTuple

from drystone.errors import PlanError
from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from drystone.planner.events import INTERRUPTED, OUT_OF_TIME, Incumbent, Stopped
from drystone.planner.planner import Planner
from drystone.search.anytime import searching
from drystone.search.chain import forget
from drystone.search.goal import (
    LAST_RUNS,
    THOROUGH,
    FoundWall,
    Rehearsals,
    WallFigures,
    stays_at_every_step,
)
from drystone.search.interrupts import held
from drystone.search.packed import PackedWall, archived, found_again
from drystone.search.repair import TURNS, repairs
from drystone.search.state import Progress, SearchState, made_of
from drystone.search.yard import Yard

_FOUND = Stopped("search", "kept as the search found it")

JUDGED_AGAIN = 8
"""So many of the best walls of a search are looked at thoroughly at most."""


class SearchEnd(NamedTuple):
    """How a search ended."""

    planner: Planner  # the one that built the best wall
    stopped: Stopped  # why its construction ended; INTERRUPTED where somebody had enough
    walls: int  # how many were built: the budget that repeats it
    # Those that none beats in every figure of merit, the best first; none of a single pass.
    kept: tuple[PackedWall, ...]
    lost: bool = False  # a process of the search died, and it ended there
    cut: bool = False  # what follows the search took too long
    # Stones after which the wall to begin with does not stand, so that nothing was looked for.
    fallen: tuple[int, ...] = ()


def run_to_end(
    planner: Planner,
    *,
    start: SearchState | None = None,
    until: Deadline = NEVER,
    grace_s: float = math.inf,
    first_whole: bool = False,
    executor: Executor | None = None,
    told: Callable[[Progress | None], None] = lambda _: None,
) -> SearchEnd:
    """Build a first wall, and look for better ones; an interrupt keeps the best so far.

    So does the time limit; a first wall that either cuts short is what is built of it, but with
    `first_whole` it is built to its end whatever the clock says.  Of a search that goes on from
    `start` there is no first wall to build.  What follows the search may take `grace_s`.  Told of
    every progress of the search, and before it, with None, of stones of the first wall.
    PlanError (E207): `start` is of another search, or a wall of it cannot be built again.
    """
    stopped = INTERRUPTED
    if start is None:
        stopped = _built(planner, NEVER if first_whole else until, told)
        if planner.settings.search.budget == 1 or stopped in (INTERRUPTED, OUT_OF_TIME):
            return SearchEnd(planner, stopped, 1, ())
        fallen = tuple(one.stone_id for one in planner.build.actions if not one.stands)
        if fallen:
            return SearchEnd(planner, stopped, 1, (), fallen=fallen)
    try:
        if start is not None and start.made_of != made_of(Yard.of(planner), planner.seed):
            raise ValueError("it is of other stones, another wall, other settings or another seed")
        return _improved(planner, start or stopped, until, grace_s, executor, told)
    except (ValueError, LookupError, ArithmeticError) as error:
        if start is None:
            raise
        raise PlanError(
            "E207",
            f"the search cannot go on from it: {error}.",
            where="checkpoint",
            cure="Give what it is of, or remove it and give the same command again.",
        ) from error
    finally:
        forget()


def _improved(
    planner: Planner,
    start: SearchState | Stopped,
    until: Deadline,
    grace_s: float,
    executor: Executor | None,
    told: Callable[[Progress | None], None],
) -> SearchEnd:
    """Look for better walls; see :func:`run_to_end`."""
    progress: Progress | None = None
    lost = False
    try:
        try:
            begun = start if isinstance(start, SearchState) else FoundWall.of(planner)
            yard = Yard.of(planner, until)
            with planner.profile.part("search"):
                for progress in searching(begun, yard, planner.seed, executor):
                    planner.solves = progress.solves
                    # First, so that who is interrupted in a callback goes on from this wall.
                    told(progress)
                    planner.callbacks.on_walls(_incumbent(progress.walls, progress.best))
        except BrokenProcessPool:
            lost = True
        if isinstance(start, Stopped) and (progress is None or progress.walls == 1):
            return SearchEnd(planner, start, 1, progress.kept if progress else (), lost)
        assert progress is not None  # noqa: S101 - what a search goes on from comes first
        grace = Deadline.after(grace_s, until.clock)
        return _ended(planner, progress, grace, executor, lost=lost)
    except KeyboardInterrupt:  # every wall of a search is complete
        with suppress(KeyboardInterrupt), held():
            ended = cut_off(planner, progress)
        return ended


def cut_off(planner: Planner, progress: Progress | None) -> SearchEnd:
    """Return what there is so far, as the end of a search that somebody has had enough of."""
    if progress is None:
        return SearchEnd(planner, INTERRUPTED, 1, ())
    last = planner if progress.walls == 1 else as_found(planner, progress.best)[0]
    return SearchEnd(last, INTERRUPTED, progress.walls, progress.kept)


def _ended(
    planner: Planner, progress: Progress, grace: Deadline, executor: Executor | None, *, lost: bool
) -> SearchEnd:
    """Judge the best walls of a search, repair the best, and add what finds a place on it."""
    kept = progress.kept
    sure, unsure = surest(planner, kept or [progress.best], grace)
    best = found = PackedWall.of(sure) if sure else progress.best
    try:
        if sure:
            turns, workers = min(TURNS, progress.walls // 2), None if lost else executor
            for turn, wall in enumerate(repairs(planner, sure, grace, turns, workers), 1):
                best = PackedWall.of(wall)
                planner.callbacks.on_walls(_incumbent(progress.walls, best, turn))
    except TimeIsUp:
        unsure = True
    except BrokenProcessPool:
        lost = True
    except KeyboardInterrupt:
        with suppress(KeyboardInterrupt), held():
            ended = SearchEnd(as_found(planner, best)[0], INTERRUPTED, progress.walls, kept, lost)
        return ended
    last, stopped, cut = with_the_rest(planner, best, grace)
    planner.solves += last.solves
    if best.groups != found.groups or len(last.build.actions) > len(best.groups):
        kept = archived(kept, [PackedWall.of(FoundWall.of(last))])
    return SearchEnd(last, stopped, progress.walls, kept, lost, unsure or cut)


def _built(planner: Planner, until: Deadline, told: Callable[[Progress | None], None]) -> Stopped:
    """Build a first wall, and say why its construction ended.

    At least a stone is placed, however late it is: a step may take longer than the time limit, and
    going on again and again (`--resume`) must lead to a whole wall.
    """
    try:
        if next(planner.steps(), None) is not None:
            told(None)
            for _ in planner.steps(until):
                told(None)
    except KeyboardInterrupt:
        return INTERRUPTED
    except TimeIsUp:
        return OUT_OF_TIME
    assert planner.stopped is not None  # noqa: S101 - steps() ended by itself
    return planner.stopped


def _incumbent(walls: int, best: PackedWall, turn: int = 0) -> Incumbent:
    figures = best.figures or WallFigures(0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    told = {name: getattr(figures, name) for name in ("stones", "F_SF", "F_LR", "F_AV", "F_AH")}
    return Incumbent(walls=walls, merit=best.merit, repairs=turn, **told)


def surest(
    planner: Planner, walls: Iterable[PackedWall], until: Deadline = NEVER
) -> tuple[FoundWall | None, bool]:
    """Return the best of some walls once their load without dilatancy is looked for thoroughly.

    Walls come the best first.  A wall that falls when it is let go after some step is taken only
    where all do.  Says too whether time was up before all were looked at: the best is then one of
    those that were, and None where none was.
    """
    yard = Yard.of(planner, until)
    rehearsals = Rehearsals(yard, LAST_RUNS, 1)
    best, stays = None, False
    try:
        for wall in islice(walls, JUDGED_AGAIN):
            least = best.merit if best and stays else -math.inf
            judged = found_again(wall, yard).judged(yard, THOROUGH, least, rehearsals)
            if judged.merit <= least:
                continue
            found = stays_at_every_step(judged.build, until), judged.merit
            if best is None or found > (stays, best.merit):
                best, stays = judged, found[0]
    except TimeIsUp:
        return best, True
    return best, False


def as_found(
    planner: Planner, wall: PackedWall, until: Deadline = NEVER
) -> tuple[Planner, Stopped]:
    """Return a planner with a wall as a search has found it, and why nothing is added.

    The planner of the first wall gives all else.
    """
    yard = Yard.of(planner, until)
    last = yard.planner(planner.seed)
    last.profile = planner.profile
    last.build = found_again(wall, yard).build
    return last, last.finished or _FOUND


def with_the_rest(
    planner: Planner, best: PackedWall, until: Deadline = NEVER
) -> tuple[Planner, Stopped, bool]:
    """Return a planner with the best wall of a search, and why nothing more is placed on it.

    The passes of a search have weights of their own: a stone that found no place by those may
    find one by the weights of the first wall.  As many stay as make the wall best.  Says too
    whether time was up before all was tried.
    """
    last, _ = as_found(planner, best)
    build, merit, cut = last.build, -math.inf, False
    yard = Yard.of(planner, until)
    rehearsals = Rehearsals(yard, LAST_RUNS)
    try:
        for _ in last.steps(until):
            now = FoundWall.of(last)
            if now.merit <= best.merit:
                continue
            if merit == -math.inf:  # by the same rehearsals
                before = FoundWall.measured(build, yard)
                merit = before.judged(yard, THOROUGH, rehearsals=rehearsals).merit
            now = now.judged(yard, THOROUGH, merit, rehearsals)
            if now.merit > merit:
                build, merit = last.build, now.merit
    except TimeIsUp:
        cut = True
    if last.stopped is not None and last.build is build:
        return last, last.stopped, cut
    last.build = build
    if cut:
        return last, last.finished or _FOUND, True
    return last, Stopped("search", "the stones that are left do not make the wall better"), False
