"""`drystone reproduce`: items of the paper made one after the other, kept, and reported."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, Literal

from drystone.errors import DrystoneError
from drystone_lab.reproduce.folder import ReportFolder, made_with, request_of
from drystone_lab.reproduce.item import Context, PaperItem
from drystone_lab.reproduce.items import ITEMS, item_named
from drystone_lab.runs.outcome import Runner, RunWorker, absent_data, one_by_one
from drystone_lab.runs.spec import published

ItemStatus = Literal["made", "kept", "missing data", "failed"]

EVERY_S = 2.0
"""Walls are told of no oftener than that."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """How items are made."""

    data: Path | None = None  # Folder of the published data
    quick: bool = False  # quick, seed: See :class:`drystone_lab.reproduce.item.Context`
    seed: int = 1
    # Make items again that are finished; their walls are taken from the folder all the same
    again: bool = False
    work: RunWorker = one_by_one  # Who plans the walls
    say: Callable[[str], None] = lambda _: None  # Told of progress, a line each
    now: Callable[[], datetime] = lambda: datetime.now(
        UTC
    )  # Gives the time of day that is written into the report


@dataclass(frozen=True, eq=False)
class MadeItem:
    """What became of an item."""

    name: str
    status: ItemStatus  # "kept" when it was finished before
    record: Mapping[str, Any] | None  # Contents of its JSON, None when there is none
    error: DrystoneError | None  # Why there is none
    page: Path  # Its page, if it was made


def reproduce(
    names: Sequence[str],
    folder: Path,
    options: Options,
    items: Mapping[str, PaperItem] | None = None,
) -> Iterator[MadeItem]:
    """Make items and yield what became of each; the report is written anew after every one."""
    items = {name: item_named(name) for name in ITEMS} if items is None else items
    report = ReportFolder(folder)
    progress = ItemProgress(options.say, len(names))
    runner = Runner(report.runs, options.data, options.work, progress.walls)
    for name in names:
        progress.begin(name)
        made = _made(name, items[name], report, options, runner)
        report.write_report(items)
        progress.line(made.status)
        yield made


def _made(
    name: str, item: PaperItem, report: ReportFolder, options: Options, runner: Runner
) -> MadeItem:
    """Return what becomes of an item: it is kept, made, or there is an error."""
    page = report.page(name)
    request = request_of(quick=options.quick, seed=options.seed, data=options.data)
    kept = None if options.again else report.finished(name, request)
    if kept is not None:
        report.forget_miss(name)
        return MadeItem(name, "kept", kept, None, page)
    absent = [each for each in item.needs if not published(each).is_there(options.data)]
    if absent:
        error = absent_data(absent, known=options.data is not None)
        report.miss(name, item, error)
        return MadeItem(name, "missing data", None, error, page)
    begun = time.perf_counter()
    try:
        output = item.make(Context(runner, options.quick, options.seed))
    except DrystoneError as error:
        report.miss(name, item, error)
        return MadeItem(name, "failed", None, error, page)
    seconds = time.perf_counter() - begun
    # Whenever its walls were planned
    outcomes = [runner.store.get(key) for key in {spec.key for spec in output.runs}]
    walls = [outcome.times["wall"] for outcome in outcomes if outcome is not None]
    about = {
        "request": request,
        "made": made_with(options.now()),
        "taken": {"seconds": seconds, "walls": len(walls), "wall_seconds": sum(walls)},
    }
    return MadeItem(name, "made", report.keep(name, item, output, about), None, page)


class ItemProgress:
    """Says which item is made, and how many of its walls are there."""

    def __init__(
        self, say: Callable[[str], None], total: int, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._say = say
        self._clock = clock
        self._total = total
        self._begun = clock()
        self._number = 0

    def begin(self, name: str) -> None:
        """Say that an item is begun."""
        self._number += 1
        self._name = name
        self._said = float("-inf")
        self.line("")

    def walls(self, text: str) -> None:
        """Say how many of its walls are there, unless that was just done."""
        if self._clock() - self._said >= EVERY_S:
            self._said = self._clock()
            self.line(text)

    def line(self, text: str) -> None:
        """Say something of it."""
        elapsed = timedelta(seconds=int(self._clock() - self._begun))
        what = f"{self._number} of {self._total}, {self._name}"
        self._say(f"[{elapsed}] {what}{': ' if text else ''}{text}")
