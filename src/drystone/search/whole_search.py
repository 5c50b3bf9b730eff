"""A first wall, the search for better ones, and what follows it; an interrupt keeps the best."""

import math
from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from itertools import islice
from typing import NamedTuple

import numpy as np

from drystone.errors import PlanError
from drystone.planner.build import Build
from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from drystone.planner.events import INTERRUPTED, OUT_OF_TIME, Incumbent, Stopped
from drystone.planner.planner import Planner
from drystone.planner.sturdy import ROUNDS
from drystone.planner.vary import REPAIR_DRAWS
from drystone.search.anytime import searching
from drystone.search.chain import forget, without
from drystone.search.goal import LAST_RUNS, FoundWall, Rehearsals, WallFigures
from drystone.search.interrupts import held
from drystone.search.packed import PackedWall, archived, found_again
from drystone.search.state import Progress, SearchState
from drystone.search.wedging import one_more_wedge
from drystone.search.yard import Yard
from drystone.statics.flow.flow_search import NonassociativeSettings
from drystone.statics.flow.release import fall_of
from drystone.statics.lp.program import assemble

_FOUND = Stopped("search", "kept as the search found it")

THOROUGH = NonassociativeSettings()
"""How the load without dilatancy is looked for at the end."""

REPAIRS, WORTH = 8, 0.1
"""So often repairs of the best wall are looked for at most; each gains at least so much merit."""

LOOK_RUNS = 24
"""So often repairs are rehearsed until it is known which could be better."""

WEDGED = 4
"""So many of the stones that fall first get one more wedge in turn, wherever there is room."""

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
    PlanError: a wall of `start` cannot be built again (E207).
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
        return _improved(planner, start or stopped, until, grace_s, executor, told)
    except (ValueError, LookupError, ArithmeticError) as error:
        if start is None:
            raise
        raise PlanError(
            "E207",
            f"the search cannot go on from it: {error}.",
            where="checkpoint",
            cure="Remove it and give the same command again: the partial plan is gone on from.",
        ) from error


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
    lost = interrupted = False
    try:
        begun = start if isinstance(start, SearchState) else FoundWall.of(planner)
        yard = Yard.of(planner, until)
        with planner.profile.part("search"):
            for progress in searching(begun, yard, planner.seed, executor):
                planner.solves = progress.solves
                # First, so that who is interrupted in a callback goes on from this wall.
                told(progress)
                planner.callbacks.on_walls(_incumbent(progress))
    except BrokenProcessPool:
        lost = True
    except KeyboardInterrupt:
        interrupted = True  # every wall of a search is complete
    finally:
        forget()
    with suppress(KeyboardInterrupt):
        if not interrupted:
            if isinstance(start, Stopped) and (progress is None or progress.walls == 1):
                return SearchEnd(planner, start, 1, progress.kept if progress else (), lost)
            assert progress is not None  # noqa: S101 - what a search goes on from comes first
            return _ended(planner, progress, Deadline.after(grace_s, until.clock), lost=lost)
    with suppress(KeyboardInterrupt), held():
        ended = cut_off(planner, progress)
    return ended


def cut_off(planner: Planner, progress: Progress | None) -> SearchEnd:
    """Return what there is so far, as the end of a search that somebody has had enough of."""
    if progress is None:
        return SearchEnd(planner, INTERRUPTED, 1, ())
    last = planner if progress.walls == 1 else as_found(planner, progress.best)[0]
    return SearchEnd(last, INTERRUPTED, progress.walls, progress.kept)


def _ended(planner: Planner, progress: Progress, grace: Deadline, *, lost: bool) -> SearchEnd:
    """Judge the best walls of a search thoroughly, and add what finds a place on the best."""
    kept = progress.kept
    sure, unsure = surest(planner, kept or [progress.best], grace)
    best = found = PackedWall.of(sure) if sure else progress.best
    try:
        if sure:
            # A turn takes as long as a few walls.
            turns = min(REPAIRS, progress.walls // 2)
            best = PackedWall.of(repaired(planner, sure, grace, turns))
    except TimeIsUp:
        unsure = True
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


def _incumbent(progress: Progress) -> Incumbent:
    best = progress.best
    figures = best.figures or WallFigures(0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return Incumbent(
        progress.walls,
        figures.stones,
        best.merit,
        figures.F_SF,
        figures.F_LR,
        figures.F_AV,
        figures.F_AH,
    )


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


def repaired(
    planner: Planner, best: FoundWall, until: Deadline = NEVER, turns: int = REPAIRS
) -> FoundWall:
    """Return a wall without what is weak in it, where that is better.

    Weak are the stones that fall first in its rehearsals, and those that move when it fails.  Of
    both the weakest one is taken out, or all are, and what they leave is built up again or stays
    open; or one of the first that fall gets one more wedge.  What is better is rehearsed again
    with other errors, for the best of many has luck with those that chose it; the best goes on.
    """
    yard = Yard.of(planner, until)
    for turn in range(turns):
        look = Rehearsals(yard, LOOK_RUNS, 2 + 2 * turn)
        least = best.judged(yard, rehearsals=look).merit + WORTH
        first = [stone for stone, _ in best.falls.first.most_common()] if best.falls else []
        weak = [frozenset(some) for s in (first, best.movers) for some in (s[:1], s) if some]
        walls, rng = [], np.random.default_rng([planner.seed, REPAIR_DRAWS, turn])
        for chosen in dict.fromkeys(weak):
            build, _, solves = without(best.build, chosen, yard)
            walls += [FoundWall.measured(build, yard, solves)]
            walls += [FoundWall.of(yard.built_up(build, rng), before=solves)]
        for stone in first[:WEDGED]:
            wedged = one_more_wedge(best.build, stone, yard)
            walls += [FoundWall.measured(build, yard, solves) for build, solves in wedged]
        judged = (wall.judged(yard, THOROUGH, least, look) for wall in walls)
        found = [wall for wall in judged if wall.merit > least]
        if not found:
            break
        again = Rehearsals(yard, LAST_RUNS, 3 + 2 * turn)
        least = best.judged(yard, rehearsals=again).merit + WORTH
        judged = (wall.judged(yard, None, least, again) for wall in found)
        better = max(judged, key=lambda one: one.merit)
        if better.merit <= least or not stays_at_every_step(better.build, until):
            break
        best = better
    return best


def stays_at_every_step(build: Build, until: Deadline = NEVER) -> bool:
    """Return whether a wall on outlines stays as it is when all of it is let go after each step.

    Forces that would hold it may exist that do not arise (DESIGN 4.8).  For the newest stone alone
    that is asked whenever a stone is placed; for all, which takes longer, only here.
    """
    if build.wall.outlines is None:
        return True
    models = (action.model for action in build.actions)
    return all(fall_of(m, assemble(m), ROUNDS, until.look) is None for m in models)


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
