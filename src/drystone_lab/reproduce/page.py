"""The report of the paper's tables and figures: one page of all, and one of each."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from drystone.drawing.report.html import HERE
from drystone.whole_files import write_whole

Cell = str | int | float | bool | None
Record = Mapping[str, Any]


def heading(name: str, title: str) -> str:
    """Return the heading of an item: its numbers in the paper and what it shows.

    >>> heading("fig26-27", "stones of four kinds")
    'Fig. 26–27: stones of four kinds'
    >>> heading("figB33", "irregular stones"), heading("growth", "time over size")
    ('Fig. B.33: irregular stones', 'Time over size')
    """
    found = re.fullmatch(r"(fig|table)(B?)(\d+)(?:-(\d+))?", name)
    if found is None:
        return title[:1].upper() + title[1:]
    kind, appendix, first, last = found.groups()
    number = f"{'B.' if appendix else ''}{first}" + (f"–{last}" if last else "")  # noqa: RUF001 - a range
    return f"{'Fig.' if kind == 'fig' else 'Table'} {number}: {title}"


def part(text: str) -> str:
    """Return a section of the paper with its sign.

    >>> part("5.2"), part("§5.2"), part("B.1")
    ('§5.2', '§5.2', 'Appendix B.1')
    """
    number = text.removeprefix("§").strip()
    return f"Appendix {number}" if number.startswith("B") else f"§{number}"


def about(record: Record) -> str:
    """Say in a line how an item was made."""
    request, taken = record["request"], record["taken"]
    words = [f"seed {request['seed']}", f"drystone {request['version']}", record["made"]["date"]]
    if taken["walls"]:
        walls = f"{taken['walls']} wall{'' if taken['walls'] == 1 else 's'}"
        words.append(f"{walls} planned in {duration(taken['wall_seconds'])}")
    return ", ".join(words)


def lead(records: Sequence[Record], total: int) -> str:
    """Say how much was made, with what, when, on what kind of machine."""
    if not records:
        return f"None of {total} was made so far."
    quick = sum(record["request"]["quick"] for record in records)
    kinds = [f"{quick} as quick versions"] * bool(quick)
    kinds += [f"{len(records) - quick} in full"] * (quick < len(records))
    days = sorted({record["made"]["date"].split()[0] for record in records})
    return (
        f"{len(records)} of {total} were made, {' and '.join(kinds)}, with drystone "
        f"{_different(record['request']['version'] for record in records)}, "
        f"{' to '.join(dict.fromkeys((days[0], days[-1])))}, on "
        f"{_different(record['made']['machine'] for record in records)}."
    )


def made_rows(records: Sequence[Record]) -> tuple[tuple[str, str], ...]:
    """Return what items were made with, by name; different values side by side."""
    if not records:
        return ()
    made = [record["made"] for record in records]
    packages = dict.fromkeys(name for one in made for name in one["packages"])
    return (
        ("drystone", _different(record["request"]["version"] for record in records)),
        ("kernels", _different(one["kernels"] for one in made)),
        ("Python", _different(one["python"] for one in made)),
        *((name, _different(one["packages"].get(name, "–") for one in made)) for name in packages),  # noqa: RUF001
        ("machine", _different(one["machine"] for one in made)),
        ("seeds", _different(record["request"]["seed"] for record in records)),
        ("walls", duration_of_walls(records)),
    )


def duration_of_walls(records: Sequence[Record]) -> str:
    """Say how many walls were planned in what time, those of several items once for each."""
    walls = sum(record["taken"]["walls"] for record in records)
    return f"{walls} in {duration(sum(record['taken']['wall_seconds'] for record in records))}"


def duration(seconds: float) -> str:
    """Write a time.

    >>> duration(3.21), duration(90), duration(7300)
    ('3.2 s', '1 min 30 s', '2 h 1 min')
    """
    if seconds < 59.95:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def shown(cell: Cell) -> str:
    """Write a cell of a table to five digits; the CSV has all of them.

    >>> shown(None), shown(True), shown(0.123456), shown(2e-5), shown(1200), shown("R")
    ('–', 'yes', '0.12346', '2.0e-05', '1200', 'R')
    """
    if cell is None:
        return "–"  # noqa: RUF001 - as the report of a plan writes it
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    if isinstance(cell, float):
        return f"{cell:.1e}" if 0 < abs(cell) < 1e-3 else f"{cell:.5g}"
    return str(cell)


def _different(values: Iterable[object]) -> str:
    return "; ".join(dict.fromkeys(map(str, values)))


PAGE = "index.html"
TEMPLATE = "page.html"

LONG = 30
"""Tables of more rows are folded up."""

SHOWN = 0.624
"""CSS px of a px of a picture: its text is then a little larger than drawn (200 px an inch)."""


@dataclass(frozen=True)
class Miss:
    """An item that could not be made when it was last asked for."""

    name: str
    title: str
    section: str
    error: str  # Why, with the cure


@dataclass(frozen=True)
class ShownTable:
    """A table as the page shows it: cells are text, `words` says which columns are no numbers."""

    title: str
    file: str
    columns: tuple[str, ...]
    words: tuple[bool, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...]

    @property
    def long(self) -> bool:
        """Whether it is folded up."""
        return len(self.rows) > LONG


@dataclass(frozen=True)
class ShownPicture:
    """A picture as the page shows it; `width` and `height` in px of the PNG."""

    png: str
    svg: str
    width: int
    height: int
    alt: str
    caption: str

    @property
    def shown_px(self) -> int:
        """Width on a page that is wide enough, CSS px."""
        return round(self.width * SHOWN)


@dataclass(frozen=True)
class Section:
    """An item as the page shows it; a miss has no record."""

    name: str
    heading: str
    part: str
    about: str
    version: str
    error: str
    paper: tuple[str, ...] = ()
    ours: tuple[str, ...] = ()
    tables: tuple[ShownTable, ...] = ()
    times: tuple[ShownTable, ...] = ()
    pictures: tuple[ShownPicture, ...] = ()
    json: str = ""


def write_page(
    path: Path, records: Sequence[Record], misses: Sequence[Miss], order: Sequence[str]
) -> Path:
    """Write the report of everything that was made; pictures and tables are linked beside it."""
    errors = {miss.name: miss.error for miss in misses}
    sections = {
        record["name"]: section(record, f"{record['name']}/", errors.get(record["name"], ""))
        for record in records
    }
    for miss in misses:
        alone = Section(
            miss.name, heading(miss.name, miss.title), part(miss.section), "", "", miss.error
        )
        sections.setdefault(miss.name, alone)
    shown = [sections[name] for name in order if name in sections]
    return _write(
        path,
        title="The paper's tables and figures, made again",
        lead=lead(records, len(order)),
        sections=shown,
        made=made_rows(records),
        up="",
    )


def write_item_page(path: Path, record: Record) -> Path:
    """Write the page of one item, into the folder of its files."""
    return _write(
        path,
        title=heading(record["name"], record["title"]),
        lead="",
        sections=[section(record, "", "")],
        made=made_rows([record]),
        up=f"../{PAGE}#{record['name']}",
    )


def section(record: Record, prefix: str, error: str) -> Section:
    """Return an item as the page shows it.

    `prefix` is the path from the page to its files; `error` says why it was not made.
    """
    head = heading(record["name"], record["title"])
    return Section(
        name=record["name"],
        heading=head,
        part=part(record["section"]),
        about=about(record),
        version="quick version" if record["request"]["quick"] else "full version",
        error=error,
        paper=tuple(record["paper"]),
        ours=tuple(record["ours"]),
        tables=tuple(_table(table, prefix) for table in record["tables"]),
        times=tuple(_table(table, prefix) for table in record["times"]),
        pictures=tuple(
            ShownPicture(
                prefix + picture["png"], prefix + picture["svg"], picture["width_px"],
                picture["height_px"], f"{head}. {picture['caption']}", picture["caption"],
            )
            for picture in record["pictures"]
        ),
        json=f"{prefix}{record['name']}.json",
    )  # fmt: skip


def _table(table: Mapping[str, Any], prefix: str) -> ShownTable:
    rows = tuple(tuple(row) for row in table["rows"])
    return ShownTable(
        table["title"],
        prefix + table["file"],
        tuple(table["columns"]),
        tuple(any(isinstance(row[k], str) for row in rows) for k in range(len(table["columns"]))),
        tuple(tuple(shown(cell) for cell in row) for row in rows),
        tuple(table["notes"]),
    )


def _write(path: Path, **content: object) -> Path:
    environment = Environment(
        loader=FileSystemLoader([Path(__file__).parent, HERE]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    text = environment.get_template(TEMPLATE).render(**content)
    write_whole(path, text.encode("utf-8", "replace"))
    return path
