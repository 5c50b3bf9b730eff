"""From stones to a finished plan in one call."""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from importlib.metadata import version
from typing import NamedTuple

import numpy as np

from drystone.errors import UsageError
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall
from drystone.planner.assemble import Frame
from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from drystone.planner.events import INTERRUPTED, OUT_OF_TIME, Callbacks, Incumbent, Stopped
from drystone.planner.planner import Planner
from drystone.planner.replay import stands
from drystone.planner.search_settings import UNLIMITED
from drystone.planner.settings import PlannerSettings, method_settings
from drystone.planner.solves import Solves
from drystone.search.anytime import Progress, searching
from drystone.search.archive import archived
from drystone.search.ending import as_found, surest, with_the_rest
from drystone.search.found import Found
from drystone.search.interrupts import insisted
from drystone.search.notices import planning_notices
from drystone.search.packed import Packed
from drystone.search.plan_result import PlanResult, finish
from drystone.search.processes import processes, threads
from drystone.search.warm_start import begin_with
from drystone.search.work import forget

TYPICAL_STONE_PX = 40
"""Longer side of the median stone at the resolution that is chosen when none is given."""


GRACE = 0.5
"""What follows a search may take this share of its time, and at least a second: judging its best
walls, the rest of the stones.  So may the last figures of merit, and the walls to choose from."""


def working_scale(stones: StoneSet) -> float:
    """Return the working resolution at which the median stone's longer side is about 40 px.

    Never finer than the source; in steps of 1 %.
    """
    longer = float(np.median([max(stone.mask.shape) for stone in stones])) if len(stones) else 1.0
    return min(1.0, max(0.01, round(TYPICAL_STONE_PX / longer, 2)))


def plan_wall(  # noqa: PLR0913 - one call, everything by keyword
    stones: StoneSet,
    width: float,
    height: float,
    *,
    seed: int = 0,
    method: str | None = None,
    settings: PlannerSettings | None = None,
    scale: float | None = None,
    px_per_m: float | None = None,
    budget: int | None = None,
    seconds: float = math.inf,
    first_whole: bool = False,
    n_jobs: int = 1,
    executor: Executor | None = None,
    callbacks: Callbacks | None = None,
    built: Wall | None = None,
    course_heights_px: Mapping[int, float] | None = None,
    begin: Wall | None = None,
    choice: bool = False,
) -> PlanResult:
    """Plan a wall.

    Parameters
    ----------
    stones : StoneSet
        From :func:`drystone.read_stones`.
    width, height : float
        Of the wall, in px of the source image.
    seed : int
        Of the random choices; the same seed and budget give the same plan.
    method : str, optional
        Named settings: ``"best"`` (default) or ``"paper"``.
    settings : PlannerSettings, optional
        Used instead of the method's; without a method's name the plan says ``"custom"``.
    scale : float, optional
        Working resolution over source resolution, in (0, 1]; chosen when missing.
    px_per_m : float, optional
        Source px in a metre; the plan is then in metres.
    budget : int, optional
        How many walls are built, the best of which is the plan; 1 is a single pass.  Without it
        and without `seconds` that of the settings: 16 for ``"best"``, some eight seconds for 30
        stones.
    seconds : float
        Time after which the search ends with the best of the walls that are whole, as many as
        there are by then, whatever the budget of the settings; with `budget` it ends with the
        first of the two.  Policies build a single wall.  The plan's settings hold the budget that
        was used, which repeats the plan.  Where not even the first wall is whole by then, the
        plan is what is built of it; it can be gone on with (`built`).
    first_whole : bool
        Whether the first wall is built to its end whatever the clock says.
    n_jobs : int
        Processes that build the walls of a search, threads that evaluate candidates where a
        single wall is built; never changes the result.
    executor : concurrent.futures.Executor, optional
        Used for candidates; must share memory, such as a thread pool.
    callbacks : Callbacks, optional
        Told of every step of the first wall, and of the best wall of a search.
    built, course_heights_px : Wall and mapping, optional
        What is built already, to go on from (:meth:`Planner.restore`): where an interrupted plan
        was.  A search may take it down again, so for real stones give a budget of 1.
    begin : Wall, optional
        A wall of the same stones, size, resolution and geometry, to begin with as far as its
        stones may be used and stand (:func:`drystone.search.warm_start.begin_with`).
    choice : bool
        Keep the walls of the search that none beats in every figure of merit.

    Returns
    -------
    result : PlanResult
        An interrupt (Ctrl-C) ends the search, and the result is the best wall so far; while the
        first wall is built, the result holds what is built.

    Raises
    ------
    UsageError
        E138: the seed is negative, or both `built` and `begin` are given; E123: the budget is less
        than 1; E120 to E127, E137, E145: the wall, the scale or the stones make no sense together.

    Examples
    --------
    >>> import drystone as ds
    >>> bricks = ds.generate.BrickSettings(count=6, height_px=10, aspect=2)
    >>> stones = ds.generate.brick_stones(bricks, np.random.default_rng(1))
    >>> result = ds.plan_wall(stones, 60, 20, scale=1.0)
    >>> result.success, len(result.plan.steps)
    (True, 6)
    """
    if not isinstance(settings, PlannerSettings | None):
        raise TypeError(
            f"settings must be PlannerSettings, not {type(settings).__name__}; "
            "method_settings('best').updated({...}) makes them"
        )
    if seed < 0:
        raise UsageError("E138", f"{seed} is no seed.", where="--seed", cure="Give 0 or more.")
    if built is not None and begin is not None:
        raise UsageError(
            "E138",
            "a wall that is built already and one to begin with exclude each other.",
            where="built, begin",
            cure="Give the one that is built, or the one to begin with.",
        )
    method = method or ("custom" if settings else "best")
    settings = _searched(settings or method_settings(method), budget, seconds)
    scale = working_scale(stones) if scale is None else float(scale)
    if not 0 < scale <= 1:
        raise UsageError(
            "E125",
            f"a scale of {scale} is not in (0, 1].",
            where="--scale",
            cure="Give a share of the source resolution such as .5, or none to have it chosen.",
        )
    frame = Frame(width, height, Site.from_source(width, height, scale, px_per_m))
    started = time.perf_counter()
    single = settings.search.budget == 1
    own = threads(n_jobs if executor is None and single else 1)
    with own as pool, processes(1 if single else n_jobs) as workers:
        first = Planner(
            stones,
            frame.site,
            seed=seed,
            settings=settings,
            executor=executor or pool,
            callbacks=callbacks,
        )
        if built is not None:
            first.restore(built, course_heights_px or {})
        left_out = () if begin is None else begin_with(first, begin, course_heights_px or {})
        until, grace_s = Deadline.after(seconds), max(1.0, GRACE * seconds)
        ended = run_to_end(
            first, until=until, grace_s=grace_s, first_whole=first_whole, executor=workers
        )
    took = time.perf_counter() - started
    grace = Deadline.after(grace_s)
    used = replace(settings, search=replace(settings.search, budget=ended.walls))
    provenance = {
        "version": version("drystone"),
        "method": method,
        "seed": seed,
        "settings": used.as_dict(),
    }

    def finished(planner: Planner, stopped: Stopped) -> PlanResult:
        return finish(planner, frame, stopped, provenance, took, grace)

    best = insisted(lambda: finished(ended.planner, ended.stopped))
    to_choose = ended.kept if choice else ()
    others = tuple(_others(first, to_choose[1:], finished, grace))
    interrupted = ended.interrupted or len(others) < len(to_choose[1:])
    return replace(
        best,
        notices=planning_notices(
            first,
            ended.planner,
            left_out,
            lost=ended.lost,
            fallen=ended.fallen,
            interrupted_after=ended.walls if interrupted else None,
            cut_short=ended.stopped.reason == "time",
        ),
        solves=Solves(first.failed_solves, first.cold_solves),
        choice=(best, *others) if to_choose else (),
    )


def _searched(settings: PlannerSettings, budget: int | None, seconds: float) -> PlannerSettings:
    """Return the settings with the budget that is asked for, by number or by time."""
    if budget is None and (settings.by_policy or not math.isfinite(seconds)):
        return settings
    return settings.updated({"search": {"budget": UNLIMITED if budget is None else budget}})


def _others(
    first: Planner,
    kept: Sequence[Packed],
    finished: Callable[[Planner, Stopped], PlanResult],
    until: Deadline,
) -> Iterator[PlanResult]:
    """Finish other walls to choose from; an interrupt leaves out those of least merit."""
    try:
        for wall in kept:
            yield finished(*as_found(first, wall, until))
    except (KeyboardInterrupt, TimeIsUp):
        pass


class Ended(NamedTuple):
    """How a search ended.

    Parameters
    ----------
    planner : Planner
        The one that built the best wall.
    stopped : Stopped
        Why its construction ended.
    walls : int
        How many walls were built: the budget that repeats it.
    kept : tuple of Packed
        Walls that none beats in every figure of merit, the best first; none of a single pass.
    lost, interrupted : bool
        A process of the search died, or somebody had enough, and it ended there; or what follows
        the search took too long.
    fallen : tuple of int
        Stones after which the wall to begin with does not stand, so that nothing was looked for.
    """

    planner: Planner
    stopped: Stopped
    walls: int
    kept: tuple[Packed, ...]
    lost: bool = False
    interrupted: bool = False
    fallen: tuple[int, ...] = ()


def run_to_end(
    planner: Planner,
    *,
    until: Deadline = NEVER,
    grace_s: float = math.inf,
    first_whole: bool = False,
    executor: Executor | None = None,
) -> Ended:
    """Build a first wall, and look for better ones; an interrupt keeps the best so far.

    So does the time limit; a first wall that either cuts short is what is built of it.

    Parameters
    ----------
    planner : Planner
        Of the first wall.
    until : Deadline
        Ends the search, or the first wall.
    grace_s : float
        So long may take what follows the search.
    first_whole : bool
        Whether the first wall is built to its end whatever the clock says.
    executor : concurrent.futures.Executor, optional
        Processes for the search.

    Returns
    -------
    ended : Ended
        With the best wall.
    """
    stopped = _built(planner, NEVER if first_whole else until)
    workshop, settings = planner.workshop, planner.settings
    if settings.search.budget == 1 or stopped in (INTERRUPTED, OUT_OF_TIME):
        return Ended(planner, stopped, 1, ())
    fallen = tuple(one.stone_id for one in planner.build.actions if not stands(one))
    if fallen:
        return Ended(planner, stopped, 1, (), fallen=fallen)
    best: Packed | None = None
    walls, lost, interrupted = 1, False, False
    kept: tuple[Packed, ...] = ()
    try:
        first = Found.of(planner)
        with planner.profile.part("search"):
            for progress in searching(
                first, workshop, settings, planner.seed, until=until, executor=executor
            ):
                best, walls, kept = progress.best, progress.walls, progress.kept
                planner.failed_solves = progress.solves.failed
                planner.cold_solves = progress.solves.cold
                planner.callbacks.on_walls(_incumbent(progress))
    except KeyboardInterrupt:
        interrupted = True  # every wall of a search is complete
    except BrokenProcessPool:
        lost = True
    finally:
        forget()
    if best is None or walls == 1:
        return Ended(planner, stopped, 1, kept, lost, interrupted)
    grace = Deadline.after(grace_s, until.clock)
    surer, unsure = insisted(lambda: surest(planner, kept, grace))
    best = surer or best
    last, stopped, cut = with_the_rest(planner, best, grace)
    planner.failed_solves += last.failed_solves
    planner.cold_solves += last.cold_solves
    if len(last.build.actions) > len(best.groups):
        kept = insisted(lambda: archived(kept, [Packed.of(Found.of(last))]))
    return Ended(last, stopped, walls, kept, lost, interrupted or unsure or cut)


def _built(planner: Planner, until: Deadline) -> Stopped:
    """Build a first wall, and say why its construction ended.

    At least a stone is placed, however late it is: a step may take longer than the time limit, and
    going on again and again (`--resume`) must lead to a whole wall.
    """
    try:
        if next(planner.steps(), None) is not None:
            for _ in planner.steps(until):
                pass
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
