"""What a search came to, measured, and kept in a table."""

import csv
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from drystone.errors import UsageError
from drystone.metrics.second import (
    SecondArrangement,
    finer_labels,
    outlined_labels,
    second_arrangement,
)
from drystone.model.wall import Wall
from drystone_lab.search_ways import Looked

FIGURES = (
    "placed", "F_SF", "F_AV", "F_AH", "F_LR", "2nd F_AV", "2nd F_AH", "T_LEVEL", "E_FLUSH", "merit",
)  # fmt: skip
"""What is compared."""


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

    def words(self, stones: int) -> str:
        """Return it for people who wait."""
        values = {name: "-" if v is None else f"{v:.4g}" for name, v in self.figures.items()}
        named = ", ".join(f"{name} {values[name]}" for name in FIGURES[1:])
        return f"{values['placed']} of {stones} stones, {named}, {self.walls} walls"


def second_of(wall: Wall) -> SecondArrangement:
    """Measure a planned wall by the second definition, on outlines where it has them."""
    if wall.outlines is None:
        labels = finer_labels(wall.labels)
    else:
        labels = outlined_labels(wall.outlines.blocks, wall.site)
    return second_arrangement(labels)


@dataclass(frozen=True)
class Run:
    """One method that looks for one wall.

    Parameters
    ----------
    wall : str
        Name of the target.
    way : str
        Of the method.
    seed : int
        Of all that is drawn.
    seconds : float
        CPU time.
    """

    wall: str
    way: str
    seed: int
    seconds: float


KEY = ("wall", "method", "seed", "seconds")
COLUMNS = (*KEY, *FIGURES, "possible F_SF", "walls", "CPU s")
"""Of the table."""


def read_results(path: Path) -> dict[Run, Result]:
    """Read the results that a table holds; none when there is no table.

    Raises
    ------
    UsageError
        E148 when it is another kind of file.
    """
    if not path.exists():
        return {}
    with path.open(newline="", encoding="utf-8") as file:
        rows = csv.DictReader(file)
        if tuple(rows.fieldnames or ()) != COLUMNS:
            raise _no_table(path, 1)
        return dict(_result(row, path, rows.line_num) for row in rows)


def _result(row: dict[str, str], path: Path, line: int) -> tuple[Run, Result]:
    try:
        run = Run(row["wall"], row["method"], int(row["seed"]), float(row["seconds"]))
        figures = {name: _number(row[name]) for name in FIGURES}
        walls, possible, seconds = int(row["walls"]), row["possible F_SF"], row["CPU s"]
        return run, Result(figures, walls, float(possible), float(seconds))
    except (TypeError, ValueError) as error:
        raise _no_table(path, line) from error


def _number(cell: str) -> float | None:
    """Return a figure; those that count something are whole."""
    if not cell:
        return None
    return int(cell) if cell.isdecimal() else float(cell)


def _no_table(path: Path, line: int) -> UsageError:
    return UsageError(
        "E148",
        "this is no table of searches of this version.",
        where=f"{path}:{line}",
        cure="Name another file, which is begun anew, or take out the line if it was cut off.",
    )


def append_results(path: Path, results: Iterable[tuple[Run, Result]]) -> None:
    """Add results at the end of a table, which is begun when there is none."""
    new = not path.exists()
    with path.open("a", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        if new:
            writer.writerow(COLUMNS)
        for run, result in results:
            key = run.wall, run.way, run.seed, run.seconds
            figures = [result.figures[name] for name in FIGURES]
            writer.writerow([*key, *figures, result.possible, result.walls, result.seconds])
