"""Walls of several sets, by several ways, from several seeds: what most items are made of."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from drystone.model.wall import Wall
from drystone_lab.paired import median_of
from drystone_lab.pictures.charts import group_panels
from drystone_lab.pictures.walls import TitledWall, plot_walls
from drystone_lab.reproduce import cells
from drystone_lab.reproduce.item import Context, ItemFigure
from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.runs.spec import Changes, RunSpec
from drystone_lab.table import Cell, Rows
from drystone_lab.walls import Target

ONE_WAY: Mapping[str, Changes] = {"variant": ()}
"""The paper's method as it is."""


@dataclass(frozen=True, kw_only=True)
class Study:
    """What is built."""

    walls: tuple[Target, ...]  # The sets
    # Settings that replace the paper's, by name of the way
    ways: Mapping[str, Changes] = field(default_factory=lambda: ONE_WAY)
    seeds: int = 20  # seeds, quick_seeds: How many, the same for all; in the quick version
    quick_seeds: int = 3
    quick_walls: tuple[Target, ...] = ()  # Of the quick version; empty for the same
    then: Callable[["StudyWalls"], Any] = lambda found: found  # What is done with the walls

    def __call__(self, context: Context) -> Any:
        """Build the walls, and do with them what is to be done."""
        walls = (context.quick and self.quick_walls) or self.walls
        walls = tuple(wall.here(context.data) for wall in walls)
        count = self.quick_seeds if context.quick else self.seeds
        seeds = range(context.seed, context.seed + count)
        return self.then(built(context, walls, self.ways, seeds))


@dataclass(frozen=True, eq=False)
class Trials:
    """Walls of one set by one way, which differ in their seeds: runs and what came out of them."""

    wall: Target
    way: str
    specs: tuple[RunSpec, ...]
    outcomes: tuple[RunOutcome, ...]

    def values(self, figure: str) -> tuple[float | None, ...]:
        """Return a figure of all of them; None where a wall has none."""
        found = (outcome.figures[figure] for outcome in self.outcomes)
        return tuple(None if value is None else float(value) for value in found)

    def median(self, figure: str) -> float | None:
        """Return the median of a figure over the walls that have it; None when none has."""
        return median_of(self.values(figure))

    def about(self, name: str) -> Cell:
        """Return the way, or what the set says of itself by an attribute."""
        return self.way if name == "way" else getattr(self.wall, name)

    @property
    def middle(self) -> int:
        """Place of the wall in the middle by filling, the lower one of two."""
        filled = [value or 0.0 for value in self.values("F_SF")]
        return sorted(range(len(filled)), key=filled.__getitem__)[(len(filled) - 1) // 2]


@dataclass(frozen=True, eq=False)
class StudyWalls:
    """The walls of a study: of the first set by every way, then of the next."""

    context: Context
    all: tuple[Trials, ...]

    def __iter__(self) -> Iterator[Trials]:
        return iter(self.all)

    @property
    def seeds(self) -> tuple[int, ...]:
        """Of every set and way."""
        return tuple(spec.seed for spec in self.all[0].specs)

    @property
    def by_wall(self) -> tuple["StudyWalls", ...]:
        """The walls of each set."""
        walls = dict.fromkeys(trials.wall for trials in self.all)
        return tuple(
            StudyWalls(self.context, tuple(one for one in self.all if one.wall == wall))
            for wall in walls
        )

    @property
    def name(self) -> str:
        """Of the first set."""
        return self.all[0].wall.name

    @property
    def names(self) -> str:
        """Of all sets."""
        return ", ".join(dict.fromkeys(one.wall.name for one in self.all))

    def of(self, way: str) -> list[Trials]:
        """Return the trials of one way, in the order of the sets."""
        return [each for each in self.all if each.way == way]

    def values(self, way: str, figure: str) -> list[float | None]:
        """Return a figure of all walls of one way, in the order of sets and seeds."""
        return [value for trials in self.of(way) for value in trials.values(figure)]

    def wall(self, trials: Trials, which: int = 0) -> Wall:
        """Return one of the walls, built again."""
        return trials.outcomes[which].wall(trials.specs[which], self.context.data)

    def drawn(self, trials: Trials, title: str, which: int = 0) -> TitledWall:
        """Return one of the walls as a panel, stones coloured by cluster."""
        return title, self.wall(trials, which), trials.outcomes[which].clusters

    def titled(self, trials: Trials, title: str, which: int = 0) -> TitledWall:
        """Return one of the walls as a panel, with its figures in the title."""
        figures = trials.outcomes[which].figures
        placed = f"{figures['placed']} of {figures['stones']} stones"
        return self.drawn(trials, f"{title}: {placed}\n{cells.in_words(figures)}", which)


def built(
    context: Context, walls: Sequence[Target], ways: Mapping[str, Changes], seeds: Sequence[int]
) -> StudyWalls:
    """Build walls of every set, by every way, from every seed."""
    asked = [
        (wall, way, tuple(wall.run(seed, *changes) for seed in seeds))
        for wall in walls
        for way, changes in ways.items()
    ]
    outcomes = iter(context.run([spec for *_, specs in asked for spec in specs]))
    trials = [Trials(*one, tuple(next(outcomes) for _ in one[-1])) for one in asked]
    return StudyWalls(context, tuple(trials))


def medians(
    *about: str, extra: Callable[[Trials], tuple[Cell, ...]] = lambda _: ()
) -> Callable[[StudyWalls], Rows]:
    """Return rows of medians and ranges, one a set and way, between what they are and `extra`."""
    return lambda found: [
        (*map(one.about, about), *cells.summary(one.outcomes), *extra(one)) for one in found
    ]


def each_wall(
    *about: str, extra: Callable[[RunOutcome], tuple[Cell, ...]] = lambda _: ()
) -> Callable[[StudyWalls], Rows]:
    """Return a row a wall: what it is, its seed, figures that are named, the metrics, `extra`."""

    def row(one: Trials, spec: RunSpec, outcome: RunOutcome) -> tuple[Cell, ...]:
        own = {"seed": spec.seed, **outcome.figures}
        named = (own[name] if name in own else one.about(name) for name in about)
        return *named, *cells.metric_cells(outcome), *extra(outcome)

    return lambda found: [
        row(one, *run) for one in found for run in zip(one.specs, one.outcomes, strict=True)
    ]


def of_each(rows: Callable[[StudyWalls], Rows]) -> Callable[[Any], Rows]:
    """Return rows of several groups of walls, each of which is `built`."""
    return lambda groups: (row for group in groups for row in rows(group.built))


def pairs(way: str, others: Sequence[str]) -> Callable[[StudyWalls], Rows]:
    """Return rows of one way against others, pairs of one set and seed, by figure."""
    return lambda found: [
        (other, *cells.wins(found.values(way, figure), found.values(other, figure), figure))
        for other in others
        for figure in cells.METRICS
    ]


def strips(
    found: StudyWalls, name: str, figures: Sequence[str], label: Callable[[Trials], str]
) -> ItemFigure:
    """Draw a point a wall: a panel a figure, a group a set and way."""
    panels = {figure: {label(one): one.values(figure) for one in found} for figure in figures}
    return ItemFigure(name, group_panels(panels), found)


def sheet(found: StudyWalls, name: str, columns: int, label: Callable[[Trials], str]) -> ItemFigure:
    """Draw the wall of the first seed of every set and way."""
    return ItemFigure(name, plot_walls([found.titled(one, label(one)) for one in found], columns))
