"""From stones to a finished plan in one call."""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from drystone.errors import Notice, UsageError
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall
from drystone.planner.deadline import Deadline, TimeIsUp
from drystone.planner.events import INTERRUPTED, OUT_OF_TIME, Callbacks
from drystone.planner.planner import Planner
from drystone.planner.search_settings import UNLIMITED
from drystone.planner.settings import PlannerSettings, method_settings
from drystone.search.interrupts import held
from drystone.search.plan_result import PlanResult, finish, missing_stones, provenance_of
from drystone.search.processes import processes, threads
from drystone.search.state import Progress, SearchState
from drystone.search.warm_start import begin_with
from drystone.search.whole_search import SearchEnd, as_found, cut_off, run_to_end

TYPICAL_STONE_PX = 40
"""Longer side of the median stone at the resolution that is chosen when none is given."""

GRACE = 0.5
"""What follows a search may take this share of its time, and at least a second: judging its best
walls, the rest of the stones.  So may the last figures of merit, and the walls to choose from."""

SOON_S = 2.0
"""After an interrupt the last figures of merit may take so long: who interrupts waits."""

MOST_WALLS, LEAST_WALLS, WORK = 32, 8, 1280
"""So many walls are tried when nothing is said: at most, at least, and times stones in between."""


@dataclass(frozen=True, eq=False)
class SoFar:
    """What a plan has come to while it is made.

    Parameters
    ----------
    progress : Progress or None
        Of the search; None while the first wall is built.
    plan : callable
        Returns the result that an interrupt would give now, without F_LR_coulomb.
    """

    progress: Progress | None
    plan: Callable[[], PlanResult]


def working_scale(stones: StoneSet) -> float:
    """Return the working resolution at which the median stone's longer side is about 40 px.

    Parameters
    ----------
    stones : StoneSet
        All stones that there are to choose from.

    Returns
    -------
    scale : float
        Working px over source px, in (0, 1] and steps of 0.01: never finer than the source.

    Examples
    --------
    >>> from drystone.model.stone import Stone
    >>> working_scale(StoneSet((Stone(1, np.ones((30, 80), bool)),)))
    0.5
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
    keep: Callable[[SoFar], None] | None = None,
    state: SearchState | None = None,
    coulomb: bool = True,
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
        and without `seconds` that of the settings; for ``"best"`` 32 of up to 40 stones, fewer of
        more, 8 at least.
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
        A wall of the same stones and geometry, on pixels of the same size and resolution, to
        begin with as far as its stones may be used and stand
        (:func:`drystone.search.warm_start.begin_with`).
    choice : bool
        Keep the walls of the search that none beats in every figure of merit.
    keep : callable, optional
        Told of what there is so far, whenever a stone of the first wall is placed or walls of the
        search are built: to be kept, so that a program that is killed loses little.
    state : SearchState, optional
        Where a search of the same stones, wall, seed and settings was cut off
        (:class:`SoFar`): it goes on from there to the plan that it would have come to itself.
    coulomb : bool
        Look for `F_LR_coulomb`, which takes longer than a wall of ``"paper"``.

    Returns
    -------
    result : PlanResult
        An interrupt (Ctrl-C) ends the search at once: the result is the best wall so far as it was
        found, "interrupted"; while the first wall is built, it is what is built.

    Raises
    ------
    UsageError
        E138: the seed or the time is negative, there is no process, or both `built` and `begin` are
        given; E123: the budget is less than 1; E120 to E127, E137, E145: the wall, the scale or the
        stones make no sense together; E144: `built` or `begin` is of something else.
    PlanError
        E207: `state` is of another search, or a wall of it cannot be built again.

    Examples
    --------
    >>> import drystone as ds
    >>> bricks = ds.generate.BrickSettings(count=6, height_px=10, aspect=2)
    >>> stones = ds.generate.brick_stones(bricks, np.random.default_rng(1))
    >>> result = ds.plan_wall(stones, 60, 20, scale=1.0, budget=4)
    >>> result.success, len(result.plan.steps)
    (True, 6)
    """
    for where, value, least in (("--jobs", n_jobs, 1), ("--time", seconds, 0)):
        if not value >= least:
            what = f"{value} makes no sense."
            raise UsageError("E138", what, where=where, cure=f"Give {least} or more.")
    if built is not None and begin is not None:
        raise UsageError(
            "E138",
            "a wall that is built already and one to begin with exclude each other.",
            where="built, begin",
            cure="Give the one that is built, or the one to begin with.",
        )
    method = method or ("custom" if settings else "best")
    settings = _searched(settings or method_settings(method), budget, seconds, len(stones))
    scale = working_scale(stones) if scale is None else float(scale)
    if not 0 < scale <= 1:
        raise UsageError(
            "E125",
            f"a scale of {scale} is not in (0, 1].",
            where="--scale",
            cure="Give a share of the source resolution such as 0.5, or none to have it chosen.",
        )
    site = Site.from_source(width, height, scale, px_per_m)
    asked = _PlanOrigin(settings, method, seed, time.perf_counter())
    grace_s = max(1.0, GRACE * seconds)
    single = settings.search.budget == 1
    own = threads(n_jobs if executor is None and single else 1)
    ended: SearchEnd | None = None
    try:
        with own as pool, processes(1 if single else n_jobs) as workers:
            first = Planner(
                stones, site, seed=seed, settings=settings,
                executor=executor or pool, callbacks=callbacks,
            )  # fmt: skip
            if built is not None:
                first.restore(built, course_heights_px or {})
            left_out = () if begin is None else begin_with(first, begin, course_heights_px or {})
            ended = run_to_end(
                first,
                start=state,
                until=Deadline.after(seconds),
                grace_s=grace_s,
                first_whole=first_whole,
                executor=workers,
                told=lambda one: keep and keep(SoFar(one, lambda: asked.cut_off(first, one))),
            )
        asked = replace(asked, took=time.perf_counter() - asked.started)
        if ended.stopped is not INTERRUPTED:
            grace = Deadline.after(grace_s if coulomb else -math.inf)
            return asked.result(first, ended, left_out, grace, choice=choice)
    except KeyboardInterrupt:
        if ended is None:
            raise
        ended = ended._replace(stopped=INTERRUPTED)
    with suppress(KeyboardInterrupt), held():
        result = asked.result(first, ended, left_out, Deadline.after(SOON_S), choice=False)
    return result


@dataclass(frozen=True, eq=False)
class _PlanOrigin:
    """What a plan says of how it was made."""

    settings: PlannerSettings
    method: str
    seed: int
    started: float  # by the clock of performance
    took: float = 0.0  # seconds to the last step

    def cut_off(self, first: Planner, progress: Progress | None) -> PlanResult:
        """Return the plan of the best wall so far, without what takes long."""
        return self.plan(cut_off(first, progress), Deadline(-math.inf))

    def plan(self, ended: SearchEnd, until: Deadline) -> PlanResult:
        """Judge the wall that a search ended with, and write its plan."""
        provenance = provenance_of(self.settings, self.method, self.seed, ended.walls)
        return finish(ended.planner, ended.stopped, provenance, self.took, until)

    def result(
        self,
        first: Planner,
        ended: SearchEnd,
        left_out: tuple[int, ...],
        until: Deadline,
        *,
        choice: bool,
    ) -> PlanResult:
        """Return the plan, with others to choose from, and all that there is to say of it."""
        plans = [self.plan(ended, until)]
        to_choose = ended.kept if choice else ()
        budget = self.settings.search.budget
        short = ended.walls < budget < UNLIMITED and not (ended.lost or ended.fallen)
        # Those of least merit that there is no time for are left out.
        with suppress(TimeIsUp):
            for wall in to_choose[1:]:
                planner, stopped = as_found(first, wall, until)
                other = ended._replace(planner=planner, stopped=stopped)
                plans.append(self.plan(other, until))
        cut = ended.cut or len(plans) < len(to_choose)
        return replace(
            plans[0],
            notices=tuple(_notices(first, ended, left_out, cut=cut, short=short)),
            solves=first.solves,
            choice=tuple(plans) if to_choose else (),
        )


def usual_budget(stones: int) -> int:
    """Return how many walls are built when nothing is said, from so many stones."""
    return min(MOST_WALLS, max(LEAST_WALLS, WORK // max(1, stones)))


def _searched(
    settings: PlannerSettings, budget: int | None, seconds: float, stones: int
) -> PlannerSettings:
    """Return the settings with the budget that is asked for, by number or by time."""
    single = settings.by_policy or settings.geometry == "raster"
    if budget is None:
        if math.isfinite(seconds) and not single:
            budget = UNLIMITED
        elif settings.search.budget == UNLIMITED:
            budget = usual_budget(stones)
        else:
            return settings
    return settings.updated({"search": {"budget": budget}})


def _notices(
    first: Planner, ended: SearchEnd, left_out: Sequence[int], *, cut: bool, short: bool
) -> Iterator[Notice]:
    """List the notices of a plan.

    `left_out` are stones of the wall that was begun with; `cut` says that there was no time for
    all that follows a search, `short` that there was none for all of its budget.
    """
    if left_out:
        yield Notice(
            "W121",
            f"stones {_listed(left_out)} of the plan to begin with were taken out: "
            "banned or not there, out of their turn, or not standing without the others or with "
            "these settings.",
        )
    if ended.fallen:
        yield Notice(
            "W126",
            "the wall that is built already does not stand after stones "
            f"{_listed(ended.fallen)}; no better wall was looked for.",
            "Take down the first of them and what rests on it, and plan again.",
        )
    if missing := missing_stones(ended.planner):
        yield Notice(
            "W120",
            f"pinned stones found no place in the wall: {_listed(missing)}.",
            "Look for longer (--time), or pin fewer stones.",
        )
    if ended.lost:
        yield Notice(
            "W122",
            "a process of the search died, and the search ended there with the best wall so far.",
            "Give less --jobs if memory ran out.",
        )
    if cut:
        yield Notice(
            "W125",
            f"what follows a search was cut short after {ended.walls} walls; this is the best of "
            "them.",
            "To look for a better one from here, give this plan to --from.",
        )
    if ended.stopped == OUT_OF_TIME:
        placed, fitting = len(ended.planner.build.actions), len(first.workshop.fitting)
        yield Notice(
            "W128",
            f"the time limit struck after {placed} of {fitting} stones of the first wall; the plan "
            "is what is built of it.",
            "Give the same command again with --resume to go on with it, or more --time.",
        )
    elif short and ended.stopped != INTERRUPTED:
        yield Notice(
            "W131",
            f"the time limit struck after {ended.walls} walls of "
            f"{first.settings.search.budget}; this is the best of them.",
            "More --time gives a better one."
            if cut
            else f"--budget {ended.walls} gives the same plan again, more --time a better one.",
        )
    if first.solves.failed:
        yield Notice(
            "W303",
            f"the solver gave up on {first.solves.failed} candidates, which were passed over.",
            "Please report this with the stones and the settings.",
        )


def _listed(stone_ids: Sequence[int]) -> str:
    return ", ".join(map(str, stone_ids))
