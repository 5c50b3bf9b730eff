"""Tables of the public benchmark: what each method comes to on each wall and on all."""

from collections.abc import Sequence
from math import fsum, sqrt
from statistics import fmean, stdev

from drystone_lab.public.results import PLACED, SHAKE, Result, Results, best_of
from drystone_lab.table import Cell, Table

UNITS = {PLACED: "placed share", SHAKE: "PGA, g"}
"""Figures that are written otherwise in tables."""


def comparison(results: Results) -> tuple[Table, ...]:
    """Return the figures of every method on every wall, on all walls, and the times."""
    walls = Table(
        "Walls: mean over seeds, standard deviation (±), best",
        ("wall", "method", "seeds", *_columns(results.figures)),
        tuple(
            (wall.name, method, len(results.of(method, wall)),
             *_cells(results.figures, [results.of(method, wall)]))
            for wall in results.walls
            for method in results.methods
        ),
        (
            "Higher is better, for F_AH lower. Seconds are in a table of their own.",
            *_undefined(results),
        ),
    )  # fmt: skip
    everything = Table(
        "All walls",
        ("method", "walls", *_columns(results.figures)),
        tuple(
            (method, len(results.of(method)),
             *_cells(results.figures, [results.of(method, wall) for wall in results.walls]))
            for method in results.methods
        ),
        (
            "Means over walls of their means and of their best; ±: the spread over seeds, root "
            "mean square of the walls' standard deviations.",
        ),
    )  # fmt: skip
    return walls, everything, _times(results)


def _columns(figures: Sequence[str]) -> tuple[str, ...]:
    named = ((UNITS.get(figure, figure), figure) for figure in figures)
    return tuple(text for name, short in named for text in (name, f"±{short}", f"best {short}"))


def _cells(figures: Sequence[str], walls: Sequence[Sequence[Result]]) -> tuple[Cell, ...]:
    """Return mean, spread and best of every figure; None where no wall of the method has it."""
    cells: list[Cell] = []
    for figure in figures:
        defined = [
            [value for result in each if (value := result.figures[figure]) is not None]
            for each in walls
        ]
        found = [values for values in defined if values]
        spreads = [stdev(values) for values in found if len(values) > 1]
        cells += [
            _mean([fmean(values) for values in found]),
            _rounded(sqrt(fsum(s * s for s in spreads) / len(spreads))) if spreads else None,
            _mean([best_of(values, figure) for values in found]),
        ]
    return tuple(cells)


_NOT_SHAKEN = "nothing was built, or it does not stand at rest in the engine"


def _undefined(results: Results) -> tuple[str, ...]:
    """Say how many walls have no value of a figure, which is left out of means and never 0."""
    notes = []
    for figure in results.figures:
        counts = {m: results.values(m, figure).count(None) for m in results.methods}
        if any(counts.values()):
            said = ", ".join(
                f"{method} {count} of {len(results.of(method))}"
                for method, count in counts.items()
                if count
            )
            why = f"{_NOT_SHAKEN}; " if figure == SHAKE else ""
            notes.append(
                f"{figure} is not defined for walls of {said}: {why}left out of means, never 0."
            )
    return tuple(notes)


def _times(results: Results) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for wall in results.walls:
        for method in results.methods:
            found = results.of(method, wall)
            seconds = [result.seconds for result in found]
            spread = _rounded(stdev(seconds), 3) if len(seconds) > 1 else None
            rows.append(
                (wall.name, method, _rounded(fmean(seconds), 3), spread, _rounded(min(seconds), 3))
            )
    return Table(
        "Seconds a wall, from the stones to the last step",
        ("wall", "method", "s", "±s", "least s"),
        tuple(rows),
        ("They depend on the machine and on what else it did; all else here does not.",),
    )


def _mean(values: Sequence[float]) -> float | None:
    return _rounded(fmean(values)) if values else None


def _rounded(value: float, digits: int = 4) -> float:
    return float(f"{value:.{digits}g}")
