"""A progress bar on stderr that follows the planner's steps."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Timer

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


class _StepBar(Callbacks):
    def __init__(self, bar: Progress, stones: int, total: float, timed: bool) -> None:
        self._bar, self._count, self._total, self._timed = bar, stones, total, timed
        self._stones = bar.add_task(f"stone 0/{stones}", total=stones)
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
        turn = incumbent.repairs
        made = f"repairs {turn}" if turn else f"{incumbent.walls} walls"
        text = (
            f"{made}; best: {incumbent.stones} stones, "
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

    The search ends after `seconds`, or else with its budget of walls.
    """
    total = settings.search.budget if seconds is None else round(seconds)
    with _shown(quiet=quiet) as bar:
        yield Callbacks() if bar is None else _StepBar(bar, stones, total, seconds is not None)


@contextmanager
def counting_bar(name: str, total: int, *, quiet: bool) -> Iterator[Callable[[int], None]]:
    """Show how many of a number are done; yields what is to be told that number."""
    with _shown(MofNCompleteColumn(), TimeElapsedColumn(), quiet=quiet) as bar:
        task = TaskID(0) if bar is None else bar.add_task(name, total=total)
        yield lambda done: None if bar is None else bar.update(task, completed=done)


@contextmanager
def busy(text: str = "", *, quiet: bool, after_s: float = 0.0) -> Iterator[Callable[[str], None]]:
    """Show, once it has taken some time, that something is being done, and for how long.

    Yields what is to be told what.
    """
    with _shown(TimeElapsedColumn(), quiet=quiet, after_s=after_s) as bar:
        task = TaskID(0) if bar is None else bar.add_task(text, total=None)
        yield lambda text: None if bar is None else bar.update(task, description=text)


@contextmanager
def _shown(
    *columns: ProgressColumn, quiet: bool, after_s: float = 0.0
) -> Iterator[Progress | None]:
    """Show a bar after some time; None when nobody wants one, or stderr is not a terminal."""
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield None
        return
    text = TextColumn("{task.description}")
    eta = (BarColumn(bar_width=16), TextColumn("eta"), TimeRemainingColumn(compact=True))
    bar = Progress(text, *columns, *eta, console=console, transient=True)
    timer = Timer(after_s, bar.start)
    timer.daemon = True
    (timer.start if after_s else bar.start)()
    try:
        yield bar
    finally:
        timer.cancel()
        if after_s:
            timer.join()  # it may be starting the bar just now
        bar.stop()
