"""The report of the paper's tables and figures: one page of all, and one of each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from drystone.drawing.report.html import HERE
from drystone.whole_files import write_whole
from drystone_lab.reproduce.page_words import about, heading, lead, made_rows, part, shown

PAGE = "index.html"
TEMPLATE = "page.html"

LONG = 30
"""Tables of more rows are folded up."""

SHOWN = 0.624
"""CSS px of a px of a picture: its text is then a little larger than drawn (200 px an inch)."""

Record = Mapping[str, Any]


@dataclass(frozen=True)
class Miss:
    """An item that could not be made when it was last asked for.

    Parameters
    ----------
    name, title, section : str
        Of the item.
    error : str
        Why, with the cure.
    """

    name: str
    title: str
    section: str
    error: str


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
    """Write the report of everything that was made; pictures and tables are linked beside it.

    Parameters
    ----------
    path : Path
        The file; the files of an item lie in a folder of its name beside it.
    records : sequence of mapping
        What the JSON of each item says.
    misses : sequence of Miss
        Items that could not be made; one may have a record of an earlier time all the same.
    order : sequence of str
        Names in the order of the paper.
    """
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
    """Write the page of one item, into the folder of its files.

    Parameters
    ----------
    path : Path
        The file.
    record : mapping
        What the JSON of the item says.
    """
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

    Parameters
    ----------
    record : mapping
        What its JSON says.
    prefix : str
        Path from the page to its files, with the slash.
    error : str
        Why it could not be made when it was last asked for; empty when it could.
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
