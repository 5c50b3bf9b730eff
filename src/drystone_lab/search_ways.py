"""Ways to look for a good wall, held to the same CPU time."""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.planner.deadline import Deadline
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings, method_settings
from drystone.search.anytime import searching
from drystone.search.chain import wedged
from drystone.search.goal import FoundWall, possible_filling
from drystone.search.packed import found_again
from drystone.search.yard import Yard
from drystone_lab.runs.spec import Changes, nested
from drystone_lab.walls import Target

Clock = Callable[[], float]

ENDLESS = 10**9
"""A budget that is never used up: the clock ends all ways."""

BETWEEN_SEEDS = 10_000
"""Restarts of two seeds that are nearer to each other than this have no pass in common."""


@dataclass(frozen=True, eq=False)
class WayState:
    """How far a way is."""

    walls: int  # How many walls it has built
    best: Callable[[], FoundWall]  # Gives the best of them


States = Callable[[Planner, float, Clock], Iterator[WayState]]


@dataclass(frozen=True)
class SearchWay:
    """A way to look for a good wall."""

    name: str
    # Goes on from the planner of the first wall, which is built, for as long as it is asked, or
    # until a time of a clock
    states: States


@dataclass(frozen=True, eq=False)
class WayResult:
    """What a way came to."""

    found: FoundWall
    walls: int  # How many walls it built; the last may have been finished after the end
    possible: float  # Area bound on F_SF
    seconds: float


def _restarts(first: Planner, _end: float, _clock: Clock) -> Iterator[WayState]:
    return _passes(first, lambda found, _: found)


def _restarts_with_wedges(first: Planner, _end: float, _clock: Clock) -> Iterator[WayState]:
    yard = Yard.of(first)

    def finished(found: FoundWall, best: FoundWall) -> FoundWall:
        # As a chain of the search does it: the others are not worth the time.
        if found.merit <= best.merit - yard.settings.search.wedge_below:
            return found
        return wedged(found, yard)

    return _passes(first, finished)


def _passes(
    first: Planner, finished: Callable[[FoundWall, FoundWall], FoundWall]
) -> Iterator[WayState]:
    """Build wall after wall from other seeds, and keep the best."""
    start = FoundWall.of(first)
    best, walls = finished(start, start), 1
    while True:
        yield WayState(walls, lambda best=best: best)  # type: ignore[misc]
        planner = Planner(
            first.workshop.stones,
            first.workshop.site,
            seed=first.seed + BETWEEN_SEEDS * walls,
            settings=first.settings,
            workshop=first.workshop,
        )
        for _ in planner.steps():
            pass
        found = finished(FoundWall.of(planner), best)
        best, walls = max(best, found, key=lambda one: one.merit), walls + 1


def _search(first: Planner, end: float, clock: Clock) -> Iterator[WayState]:
    return _searched(first, first.settings, end, clock)


def _without_courses(first: Planner, end: float, clock: Clock) -> Iterator[WayState]:
    # Courses are planned in further first walls only, and chains of other walls never do.
    settings = first.settings
    alone = replace(settings, search=replace(settings.search, passes=1))
    return _searched(first, alone, end, clock)


def _searched(
    first: Planner, settings: PlannerSettings, end: float, clock: Clock
) -> Iterator[WayState]:
    yard = Yard(first.workshop, settings, Deadline(end, clock))
    for progress in searching(FoundWall.of(first), yard, first.seed):
        packed = progress.best
        yield WayState(
            progress.walls,
            lambda packed=packed: found_again(packed, Yard(first.workshop, settings)),  # type: ignore[misc]
        )


RESTARTS, WEDGED = "restarts", "restarts with wedges"
SEARCH, NO_COURSES = "search", "without courses"

WAYS = (
    SearchWay(RESTARTS, _restarts),
    SearchWay(WEDGED, _restarts_with_wedges),
    SearchWay(SEARCH, _search),
    SearchWay(NO_COURSES, _without_courses),
)


def tries(budget: int) -> PlannerSettings:
    """Return the settings of `best` with so many walls tried; 1 is a single pass."""
    best = method_settings("best")
    return replace(best, search=replace(best.search, budget=budget))


def looked_at_times(
    way: SearchWay,
    stones: StoneSet,
    target: Target,
    times: Sequence[float],
    seed: int,
    clock: Clock = time.process_time,
    changes: Changes = (),
) -> list[WayResult]:
    """Look for a good wall, and say what was the best after several times.

    The last wall is the one that is begun before the end and finished after it, but for a search,
    which leaves it there; of the earlier times what was finished by then counts, though never less
    than the first wall.
    """
    started = clock()
    end = started + times[-1]
    # Another budget for every seed, so that nothing is left over from a search of another seed.
    settings = tries(ENDLESS + seed).updated(nested(changes))
    width, height = target.size(stones)
    site = Site.from_source(width, height, target.scale)
    first = Planner(stones, site, seed=seed, settings=settings)
    for _ in first.steps():
        pass
    reached: list[tuple[WayState, float]] = []
    before: tuple[WayState, float] | None = None
    for state in way.states(first, end, clock):
        now = state, clock()
        while len(reached) < len(times) - 1 and now[1] > started + times[len(reached)]:
            reached.append(before or now)
        before = now
        if now[1] > end:
            break
    assert before is not None  # noqa: S101 - the first wall is there
    reached += [before] * (len(times) - len(reached))
    # Packed walls are built again only now, in nobody's time.
    possible = possible_filling(first.workshop)
    return [WayResult(state.best(), state.walls, possible, at - started) for state, at in reached]
