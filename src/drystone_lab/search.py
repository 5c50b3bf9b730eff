"""Suite "search": methods that look for good walls, compared at equal CPU time."""

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from drystone.errors import UsageError
from drystone.metrics.frame import reduce_labels
from drystone.metrics.measure import measure_labels
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels
from drystone.planner.deadline import Deadline
from drystone.planner.planner import Planner
from drystone.planner.settings import method_settings
from drystone.search.anytime import searching
from drystone.search.chain import wedged
from drystone.search.goal import FoundWall, possible_filling
from drystone.search.packed import found_again
from drystone.search.yard import Yard
from drystone_lab import second_arrangement as second
from drystone_lab.cells import median_difference, median_of
from drystone_lab.planned_walls import SETS, missing_data
from drystone_lab.runs.spec import Changes, settings_of, told
from drystone_lab.runs.workers import Crew
from drystone_lab.table import BENCH, BenchSettings, Cell, Rows, Table, figure_in, read_rows, worded
from drystone_lab.walls import BRICKS, SEARCHED, UNSEEN, Target, chosen

Clock = Callable[[], float]

BETWEEN_SEEDS = 10_000
"""Restarts of two seeds that are nearer to each other than this have no pass in common."""


class WayState(NamedTuple):
    """How far a way is."""

    walls: int  # How many walls it has built
    best: Callable[[], FoundWall]  # Gives the best of them


Way = Callable[[Planner, float, Clock], Iterator[WayState]]
"""Looks for a good wall: goes on from the planner of the first one, which is built, for as long as
it is asked, or until a time of a clock."""


class WayResult(NamedTuple):
    """What a way came to."""

    found: FoundWall
    walls: int  # How many walls it built; the last may have been finished after the end
    possible: float  # Area bound on F_SF
    seconds: float


def _restarts(
    first: Planner, _end: float, _clock: Clock, *, wedges: bool = False
) -> Iterator[WayState]:
    """Build wall after wall from other seeds, and keep the best."""
    yard = Yard.of(first)

    def finished(found: FoundWall, best: FoundWall) -> FoundWall:
        # As a chain of the search does it: the others are not worth the time.
        near = wedges and found.merit > best.merit - yard.settings.search.wedge_below
        return wedged(found, yard) if near else found

    start = FoundWall.of(first)
    best, walls = finished(start, start), 1
    while True:
        yield WayState(walls, lambda best=best: best)  # type: ignore[misc]
        planner = yard.planner(first.seed + BETWEEN_SEEDS * walls)
        for _ in planner.steps():
            pass
        found = finished(FoundWall.of(planner), best)
        best, walls = max(best, found, key=lambda one: one.merit), walls + 1


def _search(
    first: Planner, end: float, clock: Clock, *, courses: bool = True
) -> Iterator[WayState]:
    settings = first.settings
    if not courses:
        # They are planned in further first walls only, and chains of other walls never do.
        settings = replace(settings, search=replace(settings.search, passes=1))
    yard = Yard(first.workshop, settings, Deadline(end, clock))
    for progress in searching(FoundWall.of(first), yard, first.seed):
        again = partial(found_again, progress.best, Yard(first.workshop, settings))
        yield WayState(progress.walls, again)


RESTARTS, WEDGED = "restarts", "restarts with wedges"
SEARCH, NO_COURSES = "search", "without courses"

WAYS: Mapping[str, Way] = {
    RESTARTS: _restarts,
    WEDGED: partial(_restarts, wedges=True),
    SEARCH: _search,
    NO_COURSES: partial(_search, courses=False),
}


def looked_at_times(
    way: Way,
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
    # A budget that is never used up, another one for every seed, so that nothing is left over from
    # a search of another seed.
    settings = target.run(seed, ("search.budget", 10**9 + seed), *changes, method="best").settings()
    site = Site.from_source(*target.size(stones), target.scale)
    first = Planner(stones, site, seed=seed, settings=settings)
    for _ in first.steps():
        pass
    reached: list[tuple[WayState, float]] = []
    before: tuple[WayState, float] | None = None
    for state in way(first, end, clock):
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


FIGURES = (
    "placed", "F_SF", "F_AV", "F_AH", "F_LR", "2nd F_AV", "2nd F_AH", "T_LEVEL", "E_FLUSH", "merit",
)  # fmt: skip

SPENT = ("possible F_SF", "walls", "CPU s")
"""Area bound on F_SF, walls built, and time; every result has them."""

SearchResult = Mapping[str, float | None]
"""What one method came to, by :data:`FIGURES` and :data:`SPENT`; None where it is not defined."""


class SearchRun(NamedTuple):
    """One method that looks for one wall."""

    wall: str
    way: str  # the method, with the settings that were replaced
    seed: int
    seconds: float  # CPU time


RUN = {"wall": str, "method": str, "seed": int, "seconds": float}
KINDS: Mapping[str, Callable[[str], Any]] = {
    **RUN, **dict.fromkeys(FIGURES, figure_in), **dict(zip(SPENT, (float, int, float), strict=True))
}  # fmt: skip
"""Columns of a table of searches."""


def result_of(looked: WayResult) -> SearchResult:
    """Measure a wall by both definitions."""
    found, figures = looked.found, looked.found.figures
    if figures is None:
        raise ValueError("no stone stands in this wall")
    other = second.second_arrangement(second.finer_picture(found.build.wall))
    values = (
        figures.stones, figures.F_SF, figures.F_AV, figures.F_AH, figures.F_LR, *other,
        figures.T_LEVEL, figures.E_FLUSH, found.merit, looked.possible, looked.walls,
        looked.seconds,
    )  # fmt: skip
    return dict(zip((*FIGURES, *SPENT), values, strict=True))


def in_words(result: SearchResult, stones: int) -> str:
    """Return a result for people who wait; `stones` are all that there are."""
    values = {name: "-" if v is None else f"{v:.4g}" for name, v in result.items()}
    named = ", ".join(f"{name} {values[name]}" for name in FIGURES[1:])
    return f"{values['placed']} of {stones} stones, {named}, {result['walls']} walls"


def read_results(path: Path) -> dict[SearchRun, SearchResult]:
    """Read the results that a table holds; none when there is no table; E148 for another file."""
    what = "this is not a table of searches of this version."
    cure = "Name another file, which is begun anew, or take out the line if it was cut off."
    found: dict[SearchRun, SearchResult] = {}
    for row in read_rows(path, KINDS, UsageError("E148", what, cure=cure)):
        run = SearchRun(*(row.pop(name) for name in RUN))
        found[run] = row
    return found


def append_results(path: Path, results: Iterable[tuple[SearchRun, SearchResult]]) -> None:
    """Add results at the end of a table, which is begun when there is none."""
    names = (*FIGURES, *SPENT)
    rows = tuple((*run, *(result[name] for name in names)) for run, result in results)
    text = Table("", tuple(KINDS), rows).csv()
    with path.open("a", newline="", encoding="utf-8") as file:
        file.write(text if file.tell() == 0 else text.partition("\n")[2])


class SearchTask(NamedTuple):
    """What one process does: a method looks for a wall, and is asked at several times."""

    target: Target
    way: str
    seed: int
    times: tuple[float, ...]  # CPU times, s
    data: Path | None
    changes: Changes = ()

    @property
    def runs(self) -> list[SearchRun]:
        """What its results are called; runs with other settings are not taken for these."""
        method = method_name(self.way, self.changes)
        return [SearchRun(self.target.name, method, self.seed, seconds) for seconds in self.times]

    def __str__(self) -> str:
        return f"{self.target.name}, {method_name(self.way, self.changes)}, seed {self.seed}"


def method_name(way: str, changes: Changes) -> str:
    """Return what a way with settings is called in a table.

    >>> method_name("search", (("goal.F_AV", 24.0),))
    'search, goal.F_AV = 24.0'
    """
    return f"{way}, {told(changes)}" if changes else way


def searched(
    walls: Sequence[tuple[Target, StoneSet]],
    seeds: Sequence[int],
    times: tuple[float, ...],
    settings: BenchSettings,
) -> dict[SearchRun, SearchResult]:
    """Let every method look for every wall with every seed; what the table has is not done again.

    With each seed all methods take turns, so that all have the same day.  `times` are CPU times,
    rising, s.
    """
    known = {} if settings.runs is None else read_results(settings.runs)
    tasks = [
        SearchTask(target, way, seed, times, settings.data, settings.changes)
        for seed in seeds
        for target, _ in walls
        for way in chosen_ways(settings.policies)
    ]
    counts = {target.name: len(stones) for target, stones in walls}
    left = [task for task in tasks if not known.keys() >= set(task.runs)]
    jobs = settings.jobs or 1
    with Crew(0 if jobs == 1 else jobs, fresh=True) as processes:
        for task, results in map(do, left) if jobs == 1 else processes.work(do, left):
            found = dict(zip(task.runs, results, strict=True))
            new = {run: result for run, result in found.items() if run not in known}
            known |= new
            if settings.runs is not None:
                append_results(settings.runs, new.items())
            for run, result in new.items():
                settings.say(
                    f"{run.wall}, {run.way}, seed {run.seed}, {run.seconds:g} s: "
                    f"{in_words(result, counts[run.wall])}"
                )
    return {run: known[run] for task in tasks for run in task.runs}


def chosen_ways(names: Sequence[str]) -> tuple[str, ...]:
    """Return the names of all ways, or those that are named; E138 for a name that none has."""
    unknown = set(names) - {*WAYS}
    if unknown:
        what = f"there is no way to search that is called {min(unknown)!r}."
        cure = f"There are {', '.join(map(repr, WAYS))}."
        raise UsageError("E138", what, where="--policy", cure=cure)
    return tuple(way for way in WAYS if not names or way in names)


def do(task: SearchTask) -> tuple[SearchTask, list[SearchResult]]:
    """Do a task, and say which it was."""
    target = task.target
    looked = looked_at_times(
        WAYS[task.way], target.source.stones(task.data), target, task.times, task.seed,
        changes=task.changes,
    )  # fmt: skip
    return task, [result_of(one) for one in looked]


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Let every method look for every wall with every seed."""
    own = [name for name, _ in settings.changes if name in ("geometry", "search.budget")]
    if own:
        what = f"{own[0]} cannot be replaced: walls are searched on outlines, for a time."
        cure = "Leave it out; see --only and --seconds."
        raise UsageError("E138", what, where="--settings", cure=cure)
    method_settings("best").updated(settings_of(settings.changes))  # E123 for what there is not
    seconds, count = (0.1, 2) if settings.quick else (20.0, 6)
    times = tuple(sorted(set(settings.seconds))) or (seconds,)
    seeds = range(settings.seed, settings.seed + (settings.seeds or count))
    # Of published stones, and sets that are made for this suite alone.
    every = (BRICKS,) if settings.quick else (*SEARCHED, *UNSEEN)
    walls = [
        (target, stones)
        for target in chosen(every, settings.only)
        if (stones := target.stones(settings.data)) is not None
    ]
    results = searched(walls, seeds, times, settings)
    tables = []
    with_settings = [f"With {told(settings.changes)}."] if settings.changes else []
    notes = (*with_settings, *missing_data(settings))
    of = BENCH["search"]
    names = {way: method_name(way, settings.changes) for way in chosen_ways(settings.policies)}
    for seconds in times:
        found = [
            (target.name, len(stones), {
                way: [results[SearchRun(target.name, name, seed, seconds)] for seed in seeds]
                for way, name in names.items()
            })
            for target, stones in walls
        ]  # fmt: skip
        rows = [row for one in found for row in _rows(*one)]
        tables.append(worded(of["medians"], rows, more=notes, seconds=seconds, seeds=len(seeds)))
        rows = [row for wall, _, by_way in found for row in _differences(wall, by_way)]
        columns = {"<figures>": FIGURES}
        tables.append(worded(of["paired"], rows, columns=columns, seconds=seconds))
    return (*tables, masons_walls(settings))


def _rows(wall: str, stones: int, by_way: Mapping[str, Sequence[SearchResult]]) -> Rows:
    for way, results in by_way.items():
        placed = [one["placed"] for one in results if one["placed"] is not None]
        medians, spent = (
            [median_of(one[name] for one in results) for name in names]
            for names in (FIGURES, ("walls", "CPU s"))
        )
        words = f"{min(placed)}-{max(placed)} of {stones}"
        possible = results[0]["possible F_SF"]
        yield wall, way, words, *medians[:2], possible, *medians[2:], *spent


def _differences(wall: str, by_way: Mapping[str, Sequence[SearchResult]]) -> Rows:
    for way in (RESTARTS, WEDGED, NO_COURSES):
        if not by_way.keys() >= {SEARCH, way}:
            continue
        values = {
            figure: [[one[figure] for one in by_way[each]] for each in (SEARCH, way)]
            for figure in FIGURES
        }
        merits = zip(*values["merit"], strict=True)
        better = [a is not None and b is not None and a > b for a, b in merits]
        cells = [median_difference(first, second) for first, second in values.values()]
        yield wall, way, f"{sum(better)} of {len(better)}", *cells


def masons_walls(settings: BenchSettings) -> Table:
    """Measure the walls of Almeida et al. (2021) as they were traced, at the working scales."""
    data = settings.data
    rows = [
        masons_row(wall.name, wall.source.labels(data), wall.scale)
        for wall in SETS
        if data is not None and wall.source.is_there(data)
    ]
    return worded(BENCH["search"]["masons"], rows)


def masons_row(name: str, labels: Labels, scale: float) -> tuple[Cell, ...]:
    """Measure one of them."""
    reduced = reduce_labels(labels, scale)
    first = measure_labels(reduced)
    repeated = second.second_arrangement(second.finer_labels(reduced))
    sampled = second.second_arrangement(reduce_labels(labels, second.FINER * scale))
    height, width = reduced.shape
    return (
        name, f"{width}x{height}", first.stones, first.F_SF, first.F_AV, first.F_AH,
        *repeated, *sampled,
    )  # fmt: skip
