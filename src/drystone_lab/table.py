"""What a suite of experiments gives back: tables, as text, Markdown, or records."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from drystone_lab.runs.spec import Changes

Cell = str | int | float | bool | None


@dataclass(frozen=True)
class Table:
    """Rows under named columns."""

    title: str
    columns: tuple[str, ...]  # Names, with units
    rows: tuple[tuple[Cell, ...], ...]  # A cell a column; None where there is no value
    notes: tuple[str, ...] = ()  # What a reader must know: sources, misses and their causes

    def records(self) -> list[dict[str, Cell]]:
        """Return a dict a row."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]

    def text(self) -> str:
        """Return the table for a terminal, numbers to the right.

        >>> print(Table("Blocks", ("name", "alpha"), (("tall", 0.25), ("flat", None))).text())
        Blocks
        name  alpha
        tall   0.25
        flat      -
        """
        cells = [list(self.columns), *([_written(cell) for cell in row] for row in self.rows)]
        widths = [max(len(row[k]) for row in cells) for k in range(len(self.columns))]
        words = [_is_words([row[k] for row in self.rows]) for k in range(len(self.columns))]
        lines = [_aligned(row, widths, words) for row in cells]
        return "\n".join([self.title, *lines, *(f"* {note}" for note in self.notes)])

    def markdown(self) -> str:
        """Return the table in Markdown, its title above."""
        lines = [self.columns, ["---"] * len(self.columns)]
        lines += [[_written(cell) for cell in row] for row in self.rows]
        return "\n".join(
            [f"**{self.title}**", ""]
            + ["| " + " | ".join(line) + " |" for line in lines]
            + [""] * bool(self.notes)
            + [f"* {note}" for note in self.notes]
        )


@dataclass(frozen=True)
class BenchSettings:
    """What every suite is run with."""

    # Folder of the published data sets; rows that need it say so without it
    data: Path | None = None
    output: Path | None = None  # Folder for pictures; None draws none
    seed: int = 0
    quick: bool = False  # A smaller version, for tests
    # Times of each search, for suites of searches; empty for theirs
    seconds: tuple[float, ...] = ()
    seeds: int | None = None  # How many seeds they search with, from `seed` on; None for theirs
    only: tuple[str, ...] = ()  # How the names of walls begin that are searched; empty for all
    policies: tuple[str, ...] = ()  # Names of the ways to search that are compared; empty for all
    # Settings that are replaced for all of them, by names such as ``"goal.F_AH"``
    changes: Changes = ()
    # How many searches run side by side, each in a process of its own; None for one
    jobs: int | None = None
    # Table to which every search is added, and of which none is done again; None keeps nothing
    runs: Path | None = None
    say: Callable[[str], None] = lambda _: None  # Told of every result of a long suite as it comes


def _written(cell: Cell) -> str:
    if cell is None:
        return "-"
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    if isinstance(cell, float):
        return f"{cell:.1e}" if 0 < abs(cell) < 1e-3 else f"{cell + 0.0:.5g}"  # -0.0 + 0.0 is 0.0
    return str(cell)


def _is_words(cells: Sequence[Cell]) -> bool:
    return all(isinstance(cell, str | bool) for cell in cells)


def _aligned(row: Sequence[str], widths: Sequence[int], words: Sequence[bool]) -> str:
    parts = [
        cell.ljust(width) if left else cell.rjust(width)
        for cell, width, left in zip(row, widths, words, strict=True)
    ]
    return "  ".join(parts).rstrip()
