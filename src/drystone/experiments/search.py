"""Suite "search": methods that look for good walls, compared at equal CPU time."""

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from drystone.experiments.masons import masons_walls
from drystone.experiments.paired import median_difference
from drystone.experiments.planned_walls import missing_data
from drystone.experiments.search_targets import SearchTarget, search_targets
from drystone.experiments.search_ways import (
    NO_COURSES,
    RESTARTS,
    SEARCH,
    WEDGED,
    Looked,
    looked_for,
    ways_of,
)
from drystone.experiments.table import BenchSettings, Cell, Table
from drystone.metrics.second import (
    SecondArrangement,
    finer_labels,
    outlined_labels,
    second_arrangement,
)
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall

SECONDS, SEEDS = 20.0, 6
QUICK_SECONDS, QUICK_SEEDS = 0.1, 2

FIGURES = (
    "placed", "F_SF", "F_AV", "F_AH", "F_LR", "2nd F_AV", "2nd F_AH", "T_LEVEL", "E_FLUSH", "merit",
)  # fmt: skip
"""What is compared."""

PAIRS = ((SEARCH, RESTARTS), (SEARCH, WEDGED), (SEARCH, NO_COURSES))
"""Methods that are compared: what the first has more than the second."""


@dataclass(frozen=True, eq=False)
class Result:
    """What one method came to with one seed.

    Parameters
    ----------
    figures : dict of str to float or None
        By the names of :data:`FIGURES`; None where a figure is not defined.
    walls : int
        How many walls it built.
    possible : float
        Area bound on F_SF.
    seconds : float
        How long it took.
    """

    figures: dict[str, float | None]
    walls: int
    possible: float
    seconds: float

    @classmethod
    def of(cls, looked: Looked) -> "Result":
        """Measure a wall by both definitions."""
        found, figures = looked.found, looked.found.figures
        if figures is None:
            raise ValueError("no stone stands in this wall")
        second = second_of(found.build.wall)
        values = (
            figures.stones, figures.F_SF, figures.F_AV, figures.F_AH, figures.F_LR, second.F_AV,
            second.F_AH, figures.T_LEVEL, figures.E_FLUSH, found.merit,
        )  # fmt: skip
        return cls(
            dict(zip(FIGURES, values, strict=True)), looked.walls, looked.possible, looked.seconds
        )


@dataclass(frozen=True, eq=False)
class Compared:
    """What all methods came to on one wall.

    Parameters
    ----------
    target : SearchTarget
        The wall.
    stones : int
        How many there are to build with.
    results : dict of str to list of Result
        Of each method, seed after seed.
    """

    target: SearchTarget
    stones: int
    results: dict[str, list[Result]]

    def values(self, way: str, figure: str) -> list[float | None]:
        """Return a figure of a method, seed after seed."""
        return [result.figures[figure] for result in self.results[way]]


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Let every method look for every wall with every seed."""
    compared = []
    for target in search_targets(settings):
        stones = target.target.stones(settings)
        if stones is not None:
            compared.append(_compared(target, stones, settings))
    seconds, seeds = _effort(settings)
    return (
        Table(
            f"Best walls after {seconds:g} s of CPU time, medians of {seeds} seeds",
            (
                "wall", "method", "range", *FIGURES[:2], "possible F_SF", *FIGURES[2:], "walls",
                "s",
            ),
            tuple(row for one in compared for row in _rows(one)),
            (
                "Restarts: single passes from seed to seed, the best by the merit that the search "
                "goes by; with wedges: small ones are put into the gaps of the good ones, as in "
                "the search. Without courses: ruin and recreate alone.",
                "CPU time of one process, from the stones on; the last wall is begun in time and "
                "finished. No F_SF can be above the possible one: the area of all stones over "
                "that of the wall.",
                "2nd: by a definition that no search goes by (drystone.metrics.second).",
                *missing_data(settings),
            ),
        ),
        Table(
            "What the search has more, medians of the pairs of one seed (95 % intervals)",
            ("wall", "more than", "merit higher", *FIGURES),
            tuple(row for one in compared for row in _differences(one)),
            (
                "Percentile bootstrap over the seeds with fixed random numbers. It cannot be wider "
                "than the differences that were seen, which hold the median of all with "
                f"{1 - 0.5 ** (seeds - 1):.1%} where there are {seeds}.",
                "Fewer is better for F_AH, T_LEVEL and E_FLUSH.",
            ),
        ),
        masons_walls(settings),
    )  # fmt: skip


def second_of(wall: Wall) -> SecondArrangement:
    """Measure a planned wall by the second definition, on outlines where it has them."""
    if wall.outlines is None:
        labels = finer_labels(wall.labels)
    else:
        labels = outlined_labels(wall.outlines.blocks, wall.site)
    return second_arrangement(labels)


def _effort(settings: BenchSettings) -> tuple[float, int]:
    """Return how many seconds each method has, and how many seeds there are."""
    usual = (QUICK_SECONDS, QUICK_SEEDS) if settings.quick else (SECONDS, SEEDS)
    return settings.seconds or usual[0], settings.seeds or usual[1]


def _compared(target: SearchTarget, stones: StoneSet, settings: BenchSettings) -> Compared:
    """Let every method look for a wall; the methods take turns, so that all have the same day."""
    seconds, seeds = _effort(settings)
    results: dict[str, list[Result]] = {way.name: [] for way in ways_of(target)}
    for seed in range(settings.seed, settings.seed + seeds):
        for way in ways_of(target):
            result = Result.of(looked_for(way, stones, target, seconds, seed))
            results[way.name].append(result)
            settings.say(f"{target.name}, {way.name}, seed {seed}: {_words(result, len(stones))}")
    return Compared(target, len(stones), results)


def _words(result: Result, stones: int) -> str:
    """Return a result for people who wait."""
    values = {name: "-" if v is None else f"{v:.4g}" for name, v in result.figures.items()}
    named = ", ".join(f"{name} {values[name]}" for name in FIGURES[1:])
    return f"{values['placed']} of {stones} stones, {named}, {result.walls} walls"


def _rows(one: Compared) -> list[tuple[Cell, ...]]:
    rows: list[tuple[Cell, ...]] = []
    for way, results in one.results.items():
        placed = [value for value in one.values(way, "placed") if value is not None]
        medians = [_median(one.values(way, figure)) for figure in FIGURES]
        rows.append(
            (
                one.target.name,
                way,
                f"{min(placed)}-{max(placed)} of {one.stones}",
                *medians[:2],
                results[0].possible,
                *medians[2:],
                median(result.walls for result in results),
                median(result.seconds for result in results),
            )
        )
    return rows


def _differences(one: Compared) -> list[tuple[Cell, ...]]:
    rows: list[tuple[Cell, ...]] = []
    for first, second in PAIRS:
        if first not in one.results or second not in one.results:
            continue
        merits = zip(one.values(first, "merit"), one.values(second, "merit"), strict=True)
        better = [a is not None and b is not None and a > b for a, b in merits]
        cells = [
            median_difference(one.values(first, figure), one.values(second, figure))
            for figure in FIGURES
        ]
        rows.append(
            (
                one.target.name,
                second,
                f"{sum(better)} of {len(better)}",
                *(None if cell is None else cell.text() for cell in cells),
            )
        )
    return rows


def _median(values: Sequence[float | None]) -> float | None:
    found = [value for value in values if value is not None]
    return median(found) if found else None
