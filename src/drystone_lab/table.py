"""What a suite of experiments gives back: tables, as text, Markdown, or records."""

import csv
import io
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from drystone.errors import DrystoneError
from drystone_lab.runs.spec import Changes

Cell = str | int | float | bool | None
Rows = Iterable[tuple[Cell, ...]]


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
        lines = [""] * (1 + len(self.rows))
        for k, name in enumerate(self.columns):
            cells = [name, *(written(row[k]) for row in self.rows)]
            width = max(map(len, cells))
            left = all(isinstance(row[k], str | bool) for row in self.rows)
            padded = [cell.ljust(width) if left else cell.rjust(width) for cell in cells]
            lines = [f"{line}  {cell}" for line, cell in zip(lines, padded, strict=True)]
        lines = [line[2:].rstrip() for line in lines]
        return "\n".join([self.title, *lines, *(f"* {note}" for note in self.notes)])

    def markdown(self) -> str:
        """Return the table in Markdown, its title above."""
        rows = [[written(cell) for cell in row] for row in self.rows]
        notes = [""] * bool(self.notes) + [f"* {note}" for note in self.notes]
        return "\n".join([f"**{self.title}**", "", markdown_rows(self.columns, rows), *notes])

    def csv(self) -> str:
        r"""Return the table as CSV: numbers that read back as they were, nothing for None.

        >>> Table("Blocks", ("name", "alpha"), (("tall", 0.1 + 0.2), ("flat", None))).csv()
        'name,alpha\ntall,0.30000000000000004\nflat,\n'
        """
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        for row in self.rows:
            cells = (written(cell) if isinstance(cell, bool) else cell for cell in row)
            # Floats of NumPy are floats, but write their type.
            writer.writerow([float(c) if isinstance(c, float) else c for c in cells])
        return text.getvalue()


def markdown_rows(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [columns, ["---"] * len(columns), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def figure_in(text: str) -> int | float | None:
    """Read a figure, which is whole where it counts something; None where it is not defined."""
    if not text:
        return None
    return int(text) if text.isdecimal() else float(text)


def read_rows(
    path: Path, kinds: Mapping[str, Callable[[str], Any]], refused: DrystoneError
) -> Iterator[dict[str, Any]]:
    """Read a CSV file of such a table, if it is there; of another one what is refused says where.

    `kinds` are the columns, and what reads a cell of each.
    """
    if not path.is_file():
        return
    with path.open(newline="", encoding="utf-8") as file:
        rows = csv.DictReader(file)
        try:
            if (rows.fieldnames or []) != [*kinds]:
                raise ValueError(rows.fieldnames)
            for row in rows:
                if None in row.values():
                    raise ValueError(row)  # fewer cells than columns
                yield {name: read(row[name]) for name, read in kinds.items()}
        except (TypeError, ValueError, csv.Error) as error:
            refused.where = f"{path}:{max(1, rows.line_num)}"
            raise refused from error


def worded(
    words: Mapping[str, Any],
    rows: Rows,
    *found: object,
    columns: Mapping[str, Sequence[str]] = MappingProxyType({}),
    more: Iterable[str] = (),
    **values: object,
) -> Table:
    """Return a table whose title, columns and notes are written elsewhere, as TOML.

    Title and notes take what was found and values; `columns` are what names in angle brackets stand
    for; `more` notes come after those that are always there.

    >>> words = {"title": "{0} walls", "columns": ["wall", "<figures>"], "notes": ["{n} seeds."]}
    >>> print(worded(words, [("R", 1)], "Two", columns={"<figures>": ["F_SF"]}, n=3).text())
    Two walls
    wall  F_SF
    R        1
    * 3 seeds.
    """
    names = [name for each in words["columns"] for name in columns.get(each, (each,))]
    notes = (note.format(*found, **values) for note in words.get("notes", ()))
    title = words["title"].format(*found, **values)
    return Table(title, tuple(names), tuple(rows), (*notes, *more))


BENCH: Mapping[str, Mapping[str, Any]] = tomllib.loads(
    Path(__file__).with_name("tables.toml").read_text("utf-8")
)
"""The suites of `drystone bench` by name, and words of their tables."""


@dataclass(frozen=True)
class BenchSettings:
    """What a suite is run with; each goes by some of it."""

    data: Path | None = None  # folder of the published sets; rows that need it say so without it
    output: Path | None = None  # folder for pictures; None draws none
    seed: int = 0  # of all random choices, or the first
    quick: bool = False  # a smaller version, for tests
    seconds: tuple[float, ...] = ()  # CPU times of each search; empty for the suite's
    seeds: int | None = None  # how many, from `seed` on; None for the suite's
    only: tuple[str, ...] = ()  # how the names of walls begin; empty for all
    policies: tuple[str, ...] = ()  # methods that are compared; empty for all
    changes: Changes = ()  # settings that are replaced for all methods
    jobs: int | None = None  # processes; None for this one
    runs: Path | None = None  # table of searches, of which none is done again
    say: Callable[[str], None] = lambda _: None  # told of every result as it comes
    # Of public suites alone:
    dask: str | None = None  # address of a scheduler
    store: Path | None = None  # folder of the runs that are kept
    again: bool = False  # do runs again that are kept
    shake: bool = False  # shake the walls too


def written(cell: Cell) -> str:
    """Write a cell for people, to five digits."""
    if cell is None:
        return "-"
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    if isinstance(cell, float):
        return f"{cell:.1e}" if 0 < abs(cell) < 1e-3 else f"{cell + 0.0:.5g}"  # -0.0 + 0.0 is 0.0
    return str(cell)
