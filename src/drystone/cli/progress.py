"""A progress bar on stderr that follows the planner's steps."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
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
        self._stones = bar.add_task("stones", total=stones)
        self._total = total
        self._timed = timed
        self._walls: TaskID | None = None
        self._started = time.monotonic()

    def on_step(self, step: Step) -> None:
        carried = step.action.resistance.value
        text = "" if carried is None else f", LLC {carried:.2f}"
        filling = 100 * step.build.wall.filling
        self._bar.update(
            self._stones, advance=1, description=f"stones, filling {filling:.0f} %{text}"
        )

    def on_walls(self, incumbent: Incumbent) -> None:
        if self._walls is None:
            self._walls = self._bar.add_task("walls", total=self._total)
        text = (
            f"{incumbent.walls} walls; best: {incumbent.stones} stones, "
            f"F_SF {incumbent.F_SF:.3f}, F_AV {incumbent.F_AV:.1f}, "
            f"F_AH {incumbent.F_AH:.2f}, F_LR {incumbent.F_LR:.2f}"
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
    with _progress(console) as bar:
        task = bar.add_task(name, total=total)
        yield lambda done: bar.update(task, completed=done)


def _progress(console: Console) -> Progress:
    return Progress(
        TextColumn("{task.description}"),
        MofNCompleteColumn(),
        BarColumn(bar_width=24),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
    )
