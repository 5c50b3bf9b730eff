"""A progress bar on stderr that follows the planner's steps."""

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

from drystone.planner.events import Callbacks, Round, Step


class _Bar(Callbacks):
    def __init__(self, bar: Progress, stones: int) -> None:
        self._bar = bar
        self._stones = bar.add_task("stones", total=stones)
        self._rounds: TaskID | None = None

    def on_step(self, step: Step) -> None:
        carried = step.action.resistance.value
        text = "" if carried is None else f", LLC {carried:.2f}"
        filling = 100 * step.build.wall.filling
        self._bar.update(
            self._stones, advance=1, description=f"stones, filling {filling:.0f} %{text}"
        )

    def on_round(self, round_: Round) -> None:
        if round_.rounds == 0:
            return
        if self._rounds is None:
            self._rounds = self._bar.add_task("rework", total=round_.rounds)
        text = f"rework, best has {round_.stones} stones, merit {round_.merit:.2f}"
        self._bar.update(self._rounds, completed=round_.number, description=text)


@contextmanager
def step_bar(stones: int, *, quiet: bool) -> Iterator[Callbacks]:
    """Show stones placed, filling, load multiplier, rounds of rework and the time that is left.

    Parameters
    ----------
    stones : int
        How many there are.
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
        yield _Bar(bar, stones)


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
