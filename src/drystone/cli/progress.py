"""A progress bar on stderr that follows the planner's steps."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from drystone.planner.events import Callbacks, Incumbent, Step
from drystone.planner.settings import PlannerSettings


class _Bar(Callbacks):
    def __init__(self, bar: Progress, stones: int, total: float, *, timed: bool) -> None:
        self._bar = bar
        self._stones = bar.add_task(f"stone 0/{stones}", total=stones)
        self._count = stones
        self._total = total
        self._timed = timed
        self._walls: TaskID | None = None
        self._started = time.monotonic()

    def on_step(self, step: Step) -> None:
        resistance = step.action.resistance
        alphas = [a for a in (resistance.left.alpha, resistance.right.alpha) if a is not None]
        text = f", alpha {min(alphas):.2f}" if alphas else ""
        said = f"stone {step.number}/{self._count}, filling {100 * step.build.wall.filling:.0f} %"
        self._bar.update(self._stones, completed=step.number, description=said + text)

    def on_walls(self, incumbent: Incumbent) -> None:
        if self._walls is None:
            self._walls = self._bar.add_task("walls", total=self._total)
        # With the bar and the time that is left it fits into a line of 80 characters.
        text = (
            f"{incumbent.walls} walls; best: {incumbent.stones} stones, "
            f"F_SF {incumbent.F_SF:.3f}, F_LR {incumbent.F_LR:.2f}"
        )
        spent = time.monotonic() - self._started
        done = round(spent) if self._timed else incumbent.walls
        self._bar.update(self._walls, completed=done, description=text)


@contextmanager
def step_bar(
    stones: int, settings: PlannerSettings, seconds: float | None, *, quiet: bool
) -> Iterator[Callbacks]:
    """Show stones placed, then the best wall of the search and the time that is left.

    Parameters
    ----------
    stones : int
        How many there are.
    settings : PlannerSettings
        Their budget of walls is the end of the search,
    seconds : float or None
        unless it ends by the clock.
    quiet : bool
        Show nothing; nothing is shown either when stderr is no terminal.

    Yields
    ------
    callbacks : Callbacks
        For the planner.
    """
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield Callbacks()
        return
    with _progress(console) as bar:
        timed = seconds is not None
        total = settings.search.budget if seconds is None else round(seconds)
        yield _Bar(bar, stones, total, timed=timed)


@contextmanager
def counting_bar(name: str, total: int, *, quiet: bool) -> Iterator[Callable[[int], None]]:
    """Show how many of a number are done; yields what is to be told that number."""
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield lambda _: None
        return
    with _progress(console, MofNCompleteColumn(), TimeElapsedColumn()) as bar:
        task = bar.add_task(name, total=total)
        yield lambda done: bar.update(task, completed=done)


def _progress(console: Console, *columns: ProgressColumn) -> Progress:
    return Progress(
        TextColumn("{task.description}"),
        *columns,
        BarColumn(bar_width=16),
        TextColumn("eta"),
        TimeRemainingColumn(compact=True),
        console=console,
        transient=True,
    )
