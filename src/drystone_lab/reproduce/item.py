"""A table or figure of the paper that can be made again, and the walls that most are made of."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from pkgutil import resolve_name
from types import MappingProxyType
from typing import Any, NamedTuple

from matplotlib.figure import Figure, SubFigure

from drystone.model.wall import Wall
from drystone.selection.policies.table1 import MARKS
from drystone_lab import cells, timed_walls
from drystone_lab.pictures import Panel, group_panels, sheet_of, wall_panel
from drystone_lab.runs.outcome import Runner, RunOutcome
from drystone_lab.runs.spec import Changes, RunSpec
from drystone_lab.table import Cell, Rows, Table, worded
from drystone_lab.walls import Target, coarser

COLUMN_SETS: Mapping[str, tuple[str, ...]] = {
    "<metrics>": cells.METRICS, "<summary>": cells.COLUMNS, "<wins>": cells.WINS,
    "<policies>": tuple(MARKS), "<parts>": timed_walls.COLUMNS,
}  # fmt: skip
"""Columns that several tables have, by their name in ``paper.toml``."""

VERDICTS = {True: "Agrees", False: "Differs", None: "Cannot be told"}


@dataclass(frozen=True, eq=False)
class Context:
    """What an item is made with."""

    runner: Runner  # Does and keeps runs; `runner.data` is the folder of the published data or None
    # A smaller version: the same kind of walls, fewer or smaller ones, a minute of one core at most
    quick: bool = False
    seed: int = 1  # Of all random choices, or the first of several
    asked: list[RunSpec] = field(default_factory=list)  # Runs so far: what the item is made of

    @property
    def data(self) -> Path | None:
        """Folder of the published data."""
        return self.runner.data

    def run(self, specs: Sequence[RunSpec]) -> tuple[RunOutcome, ...]:
        """Return the outcomes of runs, in their order."""
        self.asked.extend(specs)
        return self.runner.run(specs)

    def wall(self, spec: RunSpec) -> Wall:
        """Return the finished wall of a run."""
        (outcome,) = self.run((spec,))
        return outcome.wall(spec, self.data)


class ItemFigure(NamedTuple):
    """A picture; written as NAME.png and NAME.svg."""

    name: str
    figure: Figure | SubFigure
    # What its caption is formatted with, that of the longest key with which its name begins; None
    # for what the study found.  Of a finished item the caption itself
    about: Any = None


class Output(NamedTuple):
    """What an item came to."""

    # What we found, in sentences whose numbers are computed, and why it differs; a paragraph each
    ours: tuple[str, ...]
    # Name of the CSV file without ending, and the table.  Equal seeds give equal tables on every
    # machine: no times are in them
    tables: tuple[tuple[str, Table], ...]
    # Tables of measured times, which differ from machine to machine and run to run
    times: tuple[tuple[str, Table], ...]
    pictures: tuple[ItemFigure, ...]
    runs: tuple[RunSpec, ...]  # That the item is made of, for its JSON


class Claimed:
    """A claim of the paper, and what our walls say of it."""

    def __init__(self, key: str, holds: bool | None, **values: object) -> None:
        self.key = key  # In ``paper.toml``, where claim and finding are written
        self.holds = holds  # Whether they agree; None where that cannot be told
        self.values = values  # What both are formatted with


def worded_study(
    context: Context,
    *,
    walls: Sequence[str],
    ways: Mapping[str, Mapping[str, Any]] = MappingProxyType({"variant": {}}),
    seeds: int = 20,
    quick_walls: Sequence[str] = (),
    quick_seeds: int = 3,
) -> "StudyWalls":
    """Build the walls of a study as ``paper.toml`` words it, all from so many seeds.

    `ways` are settings that replace the paper's, by name of the way; without `quick_walls` the
    quick version has the same walls.
    """
    if context.quick:
        walls, seeds = quick_walls or walls, quick_seeds
    targets = [wall.here(context.data) for name in walls for wall in targets_named(name)]
    changes = {name: tuple(settings.items()) for name, settings in ways.items()}
    return StudyWalls.built(context, targets, changes, range(context.seed, context.seed + seeds))


def targets_named(name: str) -> Iterator[Target]:
    """Yield walls that are constants of the lab, coarser ones with their scale.

    >>> [wall.scale for wall in targets_named("walls.MASONS at 0.25")]
    [0.2, 0.25, 0.25]
    """
    name, _, scale = name.partition(" at ")
    found = resolve_name(f"drystone_lab.{name}")
    for wall in (found,) if isinstance(found, Target) else found:
        yield coarser(wall, float(scale)) if scale else wall


@dataclass(frozen=True, eq=False)
class Trials:
    """Walls of one set by one way, which differ in their seeds: runs and what came out of them."""

    wall: Target
    way: str
    specs: tuple[RunSpec, ...]
    outcomes: tuple[RunOutcome, ...]
    data: Path | None  # Folder of the published data

    def values(self, figure: str) -> tuple[float | None, ...]:
        """Return a figure of all of them; None where a wall has none.

        The share of wedges in the wall is one too, in percent.
        """
        if figure == "wedge_share":
            whole = self.wall.width * self.wall.height
            areas = self.values("wedge_area")
            return tuple(None if area is None else 100 * area / whole for area in areas)
        found = (outcome.figures[figure] for outcome in self.outcomes)
        return tuple(None if value is None else float(value) for value in found)

    def median(self, figure: str) -> float | None:
        """Return the median of a figure over the walls that have it; None when none has."""
        return cells.median_of(self.values(figure))

    def least(self, figure: str) -> float:
        """Return the median of a figure, 0 when no wall has it: one that falls has none."""
        return self.median(figure) or 0.0

    @property
    def whole(self) -> int:
        """How many walls have all stones."""
        return sum(o.figures["placed"] == o.figures["stones"] for o in self.outcomes)

    def told(self, name: str) -> tuple[Cell, ...]:
        """Return what is told of all walls: of the set, medians of figures, or their summary."""
        if name == "<summary>":
            return cells.summary(self.outcomes)
        for about in (self, self.wall):
            if hasattr(about, name):
                return (getattr(about, name),)
        return (cells.rounded(self.median(name)),)

    def told_of(self, which: int, name: str) -> tuple[Cell, ...]:
        """Return what is told of one wall: its seed, a figure, its metrics, or that of the set.

        A figure may be followed by what it is to be above, as in ``F_SF > 0.6``.
        """
        if name == "<metrics>":
            return cells.metric_cells(self.outcomes[which].figures)
        own = {"seed": self.specs[which].seed, **self.outcomes[which].figures}
        figure, _, least = name.partition(" > ")
        if least:
            return ((own[figure] or 0.0) > float(least),)
        return (own[name],) if name in own else self.told(name)

    @property
    def middle(self) -> int:
        """Place of the wall in the middle by filling, the lower one of two."""
        filled = [value or 0.0 for value in self.values("F_SF")]
        return sorted(range(len(filled)), key=filled.__getitem__)[(len(filled) - 1) // 2]

    def built(self, which: int = 0) -> Wall:
        """Return one of the walls, built again."""
        return self.outcomes[which].wall(self.specs[which], self.data)

    def drawn(self, title: str, which: int = 0) -> Panel:
        """Return one of the walls as a panel, stones coloured by cluster."""
        return wall_panel(title, self.built(which), self.outcomes[which].clusters)

    def titled(self, title: str, which: int = 0) -> Panel:
        """Return one of the walls as a panel, with its figures in the title."""
        figures = self.outcomes[which].figures
        placed = f"{figures['placed']} of {figures['stones']} stones"
        return self.drawn(f"{title}: {placed}\n{cells.in_words(figures)}", which)


class StudyWalls(tuple[Trials, ...]):
    """The walls of a study: of the first set by every way, then of the next."""

    @classmethod
    def built(
        cls,
        context: Context,
        walls: Sequence[Target],
        ways: Mapping[str, Changes],
        seeds: Sequence[int],
    ) -> "StudyWalls":
        """Build walls of every set, by every way, from every seed."""
        asked = [
            (wall, way, tuple(wall.run(seed, *changes) for seed in seeds))
            for wall in walls
            for way, changes in ways.items()
        ]
        outcomes = iter(context.run([spec for *_, specs in asked for spec in specs]))
        data = context.data
        return cls(Trials(*one, tuple(next(outcomes) for _ in one[-1]), data) for one in asked)

    @property
    def seeds(self) -> tuple[int, ...]:
        """Of every set and way."""
        return tuple(spec.seed for spec in self[0].specs)

    @property
    def by_wall(self) -> list["StudyWalls"]:
        """The walls of each set."""
        return [StudyWalls(group) for _, group in groupby(self, key=attrgetter("wall"))]

    @property
    def name(self) -> str:
        """Of the first set."""
        return self[0].wall.name

    @property
    def names(self) -> str:
        """Of all sets."""
        return ", ".join(dict.fromkeys(one.wall.name for one in self))

    def of(self, way: str) -> list[Trials]:
        """Return the trials of one way, in the order of the sets."""
        return [each for each in self if each.way == way]

    def values(self, way: str, figure: str) -> list[float | None]:
        """Return a figure of all walls of one way, in the order of sets and seeds."""
        return [value for trials in self.of(way) for value in trials.values(figure)]

    def strips(self, name: str, figures: Sequence[str], label: str) -> ItemFigure:
        """Draw a point a wall: a panel a figure, a group a set and way, called as a label says."""
        panels = {
            figure: {label.format(one): one.values(figure) for one in self} for figure in figures
        }
        return ItemFigure(name, group_panels(panels), self)

    def sheet(self, name: str, columns: int, label: str) -> ItemFigure:
        """Draw the wall of the first seed of every set and way."""
        panels = [one.titled(label.format(one)) for one in self]
        return ItemFigure(name, sheet_of(panels, columns))


def rows_of(words: Mapping[str, Any], found: StudyWalls) -> Rows:
    """Return the rows that words ask for.

    `medians` and `walls` name the cells of a row a set and way, or a wall; `pairs` one way and
    those against which it is set, by pairs of one set and seed.
    """
    for one in found:
        if "medians" in words:
            yield tuple(cell for name in words["medians"] for cell in one.told(name))
        for k in range(len(one.specs) if "walls" in words else 0):
            yield tuple(cell for name in words["walls"] for cell in one.told_of(k, name))
    way, *others = words.get("pairs", ("",))
    for other in others:
        for figure in cells.METRICS:
            first, second = (found.values(name, figure) for name in (way, other))
            yield other, *cells.wins(first, second, figure)


@dataclass(frozen=True, kw_only=True)
class PaperItem:
    """A table or figure of the paper: data, and what is read off it."""

    # Does what the item is about: builds walls, or times them; see :func:`worded_study`
    study: Callable[[Context], Any] = lambda context: context
    then: Callable[[Any], Any] = lambda built: built  # What is made of that; all below take it
    # Compares what was found with claims of the paper; they are a table too
    claims: Callable[[Any], Iterable[Claimed]] = lambda _: ()
    # tables, times: By the name of the CSV file; times differ from machine to machine.  Other
    # tables are rows of the study, and some pictures its walls, as words say
    tables: Mapping[str, Callable[[Any], Rows]] = field(default_factory=dict)
    times: Mapping[str, Callable[[Any], Rows]] = field(default_factory=dict)
    pictures: Callable[[Any], Iterable[ItemFigure]] = lambda _: ()  # Draws
    words: Mapping[str, Any] = field(default_factory=dict)  # Of ``paper.toml``

    def worded(self, words: Mapping[str, Any]) -> "PaperItem":
        """Return it with its words, and with the study that they name."""
        study = partial(worded_study, **words["study"]) if "study" in words else self.study
        return replace(self, words=words, study=study)

    def make(self, context: Context) -> Output:
        """Do the study, and read everything off it."""
        context = replace(context, asked=[])
        built = self.study(context)
        found = self.then(built)
        tables = []
        for name, words in self.words.get("tables", {}).items():
            rows = self.tables[name](found) if name in self.tables else rows_of(words, built)
            tables.append((name, worded(words, rows, found, columns=COLUMN_SETS)))
        times = [
            (name, worded(self.words["times"][name], rows(found), found, columns=COLUMN_SETS))
            for name, rows in self.times.items()
        ]
        texts = self.words.get("claims", {})
        checked = [
            (*(text.format(**one.values) for text in texts[one.key]), one.holds)
            for one in self.claims(found)
        ]
        said: Sequence[str] = ()
        # Where times are what is claimed, the table of claims is one of times, and no paragraph.
        if "claims" in self.words.get("times", {}):
            title = self.words["times"]["claims"]["title"]
            times.insert(0, ("claims", Table(title, CLAIMS, tuple(checked))))
        elif checked:
            tables.append(("claims", Table("The paper's claims", CLAIMS, tuple(checked))))
            said = sentences(checked)
        drawn = [
            (built.strips if "figures" in words else built.sheet)(name, **words)
            for name, words in self.words.get("pictures", {}).items()
        ]
        pictures = []
        for one in (*drawn, *self.pictures(found)):
            captions = self.words["captions"]
            key = max((k for k in captions if one.name.startswith(k)), key=len)
            about = captions[key].format(found if one.about is None else one.about)
            pictures.append(one._replace(about=about))
        return Output(
            ours=(*self.words.get("notes", ()), *said),
            tables=tuple(tables),
            times=tuple(times),
            pictures=tuple(pictures),
            runs=tuple(dict.fromkeys(context.asked)),
        )


PLAIN = PaperItem()
"""All of it is in its words."""

CLAIMS = ("the paper", "here", "agrees")


def sentences(checked: Sequence[tuple[str, str, bool | None]]) -> tuple[str, ...]:
    """Return of how many claims the walls agree with the paper, and a paragraph each.

    >>> sentences([("Walls are low.", "2 px.", True)])[0]
    'Of 1 claims of the paper that can be told, 1 agree.'
    """
    told = [holds for *_, holds in checked if holds is not None]
    count = f"Of {len(told)} claims of the paper that can be told, {sum(told)} agree."
    return (count, *(f"{VERDICTS[holds]}: {claim} Here: {here}" for claim, here, holds in checked))
