"""A first wall, the search for better ones, and what follows it; an interrupt keeps the best."""

import math
from collections.abc import Callable
from concurrent.futures import Executor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from typing import NamedTuple

from drystone.errors import PlanError
from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from drystone.planner.events import INTERRUPTED, OUT_OF_TIME, Incumbent, Stopped
from drystone.planner.planner import Planner
from drystone.planner.replay import stands
from drystone.search.anytime import searching
from drystone.search.archive import archived
from drystone.search.ending import as_found, surest, with_the_rest
from drystone.search.found import Found
from drystone.search.interrupts import held
from drystone.search.packed import Packed
from drystone.search.standing import Progress, Standing
from drystone.search.work import forget


class Ended(NamedTuple):
    """How a search ended."""

    planner: Planner  # The one that built the best wall
    # Why its construction ended; `~drystone.planner.events.INTERRUPTED` where somebody had
    # enough
    stopped: Stopped
    walls: int  # How many walls were built: the budget that repeats it
    # Walls that none beats in every figure of merit, the best first; none of a single pass
    kept: tuple[Packed, ...]
    # A process of the search died, and it ended there; what follows the search took too long
    lost: bool = False
    cut: bool = False
    # Stones after which the wall to begin with does not stand, so that nothing was looked for
    fallen: tuple[int, ...] = ()


def run_to_end(
    planner: Planner,
    *,
    start: Standing | None = None,
    until: Deadline = NEVER,
    grace_s: float = math.inf,
    first_whole: bool = False,
    executor: Executor | None = None,
    told: Callable[[Progress | None], None] = lambda _: None,
) -> Ended:
    """Build a first wall, and look for better ones; an interrupt keeps the best so far.

    So does the time limit; a first wall that either cuts short is what is built of it.
    """
    stopped = INTERRUPTED
    if start is None:
        stopped = _built(planner, NEVER if first_whole else until, told)
        if planner.settings.search.budget == 1 or stopped in (INTERRUPTED, OUT_OF_TIME):
            return Ended(planner, stopped, 1, ())
        fallen = tuple(one.stone_id for one in planner.build.actions if not stands(one))
        if fallen:
            return Ended(planner, stopped, 1, (), fallen=fallen)
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
    start: Standing | Stopped,
    until: Deadline,
    grace_s: float,
    executor: Executor | None,
    told: Callable[[Progress | None], None],
) -> Ended:
    """Look for better walls; see :func:`run_to_end`."""
    progress: Progress | None = None
    lost = interrupted = False
    try:
        begun = start if isinstance(start, Standing) else Found.of(planner)
        with planner.profile.part("search"):
            for progress in searching(
                begun,
                planner.workshop,
                planner.settings,
                planner.seed,
                until=until,
                executor=executor,
            ):
                planner.failed_solves = progress.solves.failed
                planner.cold_solves = progress.solves.cold
                planner.callbacks.on_walls(_incumbent(progress))
                told(progress)
    except BrokenProcessPool:
        lost = True
    except KeyboardInterrupt:
        interrupted = True  # every wall of a search is complete
    finally:
        forget()
    with suppress(KeyboardInterrupt):
        if not interrupted:
            if isinstance(start, Stopped) and (progress is None or progress.walls == 1):
                return Ended(planner, start, 1, progress.kept if progress else (), lost)
            assert progress is not None  # noqa: S101 - what a search goes on from comes first
            return _ended(planner, progress, Deadline.after(grace_s, until.clock), lost=lost)
    with suppress(KeyboardInterrupt), held():
        ended = cut_off(planner, progress)
    return ended


def cut_off(planner: Planner, progress: Progress | None) -> Ended:
    """Return what there is so far, as the end of a search that somebody has had enough of."""
    if progress is None:
        return Ended(planner, INTERRUPTED, 1, ())
    last = planner if progress.walls == 1 else as_found(planner, progress.best)[0]
    return Ended(last, INTERRUPTED, progress.walls, progress.kept)


def _ended(planner: Planner, progress: Progress, grace: Deadline, *, lost: bool) -> Ended:
    """Judge the best walls of a search thoroughly, and add what finds a place on the best."""
    kept = progress.kept
    surer, unsure = surest(planner, kept, grace)
    best = surer or progress.best
    last, stopped, cut = with_the_rest(planner, best, grace)
    planner.failed_solves += last.failed_solves
    planner.cold_solves += last.cold_solves
    if len(last.build.actions) > len(best.groups):
        kept = archived(kept, [Packed.of(Found.of(last))])
    return Ended(last, stopped, progress.walls, kept, lost, unsure or cut)


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
    figures = progress.best.figures
    if figures is None:
        return Incumbent(progress.walls, 0, progress.best.merit, 0.0, 0.0, 0.0, 0.0)
    return Incumbent(
        progress.walls,
        figures.stones,
        progress.best.merit,
        figures.F_SF,
        figures.F_LR,
        figures.F_AV,
        figures.F_AH,
    )
