"""A progress bar on stderr that follows the planner's steps."""

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from drystone.planner.events import Step, StepCallback


@contextmanager
def step_bar(stones: int, *, quiet: bool) -> Iterator[tuple[StepCallback, ...]]:
    """Show stones placed, filling, load multiplier and the time that is left.

    Parameters
    ----------
    stones : int
        How many there are.
    quiet : bool
        Show nothing.

    Yields
    ------
    callbacks : tuple of callables
        For the planner.
    """
    if quiet:
        yield ()
        return
    bar = Progress(
        TextColumn("stone"),
        MofNCompleteColumn(),
        BarColumn(bar_width=24),
        TextColumn("{task.description}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
    )
    task = bar.add_task("", total=stones)

    def show(step: Step) -> None:
        resistance = step.action.resistance.value
        carried = "" if resistance is None else f", LLC {resistance:.2f}"
        text = f"filling {100 * step.build.wall.filling:.0f} %{carried}"
        bar.update(task, advance=1, description=text)

    with bar:
        yield (show,)
