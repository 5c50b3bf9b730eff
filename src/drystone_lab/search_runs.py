"""Runs of the suite "search": one method, one wall and one seed each, side by side if asked."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from drystone.errors import UsageError
from drystone.model.stone import StoneSet
from drystone_lab.runs.changes import Changes, told
from drystone_lab.runs.processes import crew
from drystone_lab.search_results import Result, Run, append_results, read_results
from drystone_lab.search_ways import WAYS, Way, looked_at_times
from drystone_lab.table import BenchSettings
from drystone_lab.walls import BRICKS, SEARCHED, UNSEEN, Target, chosen


@dataclass(frozen=True)
class Task:
    """What one process does: a method looks for a wall, and is asked at several times.

    Parameters
    ----------
    wall, way : str
        Names of the target and the method.
    seed : int
        Of all that is drawn.
    times : tuple of float
        CPU times, s.
    data : Path or None
        Folder of the published data.
    quick : bool
        Whether targets are those of the smaller version.
    changes : tuple of (str, value)
        Settings that are replaced.
    """

    wall: str
    way: str
    seed: int
    times: tuple[float, ...]
    data: Path | None
    quick: bool
    changes: Changes = ()

    @property
    def method(self) -> str:
        """The way with its settings: in a table runs with others are not taken for these."""
        return method_name(self.way, self.changes)

    @property
    def runs(self) -> list[Run]:
        """What its results are called."""
        return [Run(self.wall, self.method, self.seed, seconds) for seconds in self.times]

    def __str__(self) -> str:
        return f"{self.wall}, {self.method}, seed {self.seed}"


def method_name(way: str, changes: Changes) -> str:
    """Return what a way with settings is called in a table.

    Examples
    --------
    >>> method_name("search", (("goal.F_AV", 24.0),))
    'search, goal.F_AV = 24.0'
    """
    return f"{way}, {told(changes)}" if changes else way


def searched(
    walls: Sequence[tuple[Target, StoneSet]],
    seeds: Sequence[int],
    times: tuple[float, ...],
    settings: BenchSettings,
) -> dict[Run, Result]:
    """Let every method look for every wall with every seed; what is in the table is not done again.

    Parameters
    ----------
    walls : sequence of (Target, StoneSet)
        What is searched.
    seeds : sequence of int
        One after the other; with each all methods take turns, so that all have the same day.
    times : tuple of float
        CPU times at which methods are asked, rising, s.
    settings : BenchSettings
        Which methods, how many processes, and the table.

    Raises
    ------
    UsageError
        E138: a method that there is not; E148: see :func:`read_results`.
    DrystoneError
        E402: a process died; what the others were doing is done and kept.
    """
    known = {} if settings.runs is None else read_results(settings.runs)
    tasks = [
        Task(target.name, way.name, seed, times, settings.data, settings.quick, settings.changes)
        for seed in seeds
        for target, _ in walls
        for way in chosen_ways(settings.policies)
    ]
    wanted = [run for task in tasks for run in task.runs]
    counts = {target.name: len(stones) for target, stones in walls}
    left = [task for task in tasks if not known.keys() >= set(task.runs)]
    for task, results in _done(left, settings.jobs):
        found = zip(task.runs, results, strict=True)
        new = {run: result for run, result in found if run not in known}
        known |= new
        if settings.runs is not None:
            append_results(settings.runs, new.items())
        for run, result in new.items():
            settings.say(
                f"{run.wall}, {run.way}, seed {run.seed}, {run.seconds:g} s: "
                f"{result.words(counts[run.wall])}"
            )
    return {run: known[run] for run in wanted}


def searched_walls(settings: BenchSettings) -> tuple[Target, ...]:
    """Return the walls of the suite: of published stones, and sets that are made for it alone."""
    return chosen((BRICKS,) if settings.quick else (*SEARCHED, *UNSEEN), settings.only)


def chosen_ways(names: Sequence[str]) -> tuple[Way, ...]:
    """Return all ways, or those that are named.

    Raises
    ------
    UsageError
        E138 for a name that none has.
    """
    unknown = set(names) - {way.name for way in WAYS}
    if unknown:
        raise UsageError(
            "E138",
            f"there is no way to search that is called {min(unknown)!r}.",
            where="--policy",
            cure=f"There are {', '.join(repr(way.name) for way in WAYS)}.",
        )
    return tuple(way for way in WAYS if not names or way.name in names)


def _done(tasks: Sequence[Task], jobs: int) -> Iterator[tuple[Task, list[Result]]]:
    """Do tasks, and give their results as they come."""
    if jobs == 1:
        yield from map(_with_results, tasks)
        return
    with crew(jobs, fresh=True) as processes:
        yield from processes.work(_with_results, tasks)


def _with_results(task: Task) -> tuple[Task, list[Result]]:
    """Do a task, and say which it was."""
    return task, do(task)


def do(task: Task) -> list[Result]:
    """Do a task."""
    settings = BenchSettings(data=task.data, quick=task.quick)
    (target,) = (one for one in searched_walls(settings) if one.name == task.wall)
    (way,) = (one for one in WAYS if one.name == task.way)
    stones = target.stones(task.data)
    assert stones is not None  # noqa: S101 - who asks has seen them
    looked = looked_at_times(way, stones, target, task.times, task.seed, changes=task.changes)
    return [Result.of(one) for one in looked]
