"""The report of the paper's tables and figures: one page of all, and one of each."""

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from drystone.drawing.report.html import HERE
from drystone.errors import counted
from drystone.whole_files import write_whole
from drystone_lab.table import written

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
    walls = sum(record["taken"]["walls"] for record in records)
    planned = sum(record["taken"]["wall_seconds"] for record in records)
    packages = dict.fromkeys(name for one in made for name in one["packages"])
    return (
        ("drystone", _different(record["request"]["version"] for record in records)),
        ("kernels", _different(one["kernels"] for one in made)),
        ("Python", _different(one["python"] for one in made)),
        *((name, _different(one["packages"].get(name, "–") for one in made)) for name in packages),  # noqa: RUF001
        ("machine", _different(one["machine"] for one in made)),
        ("seeds", _different(record["request"]["seed"] for record in records)),
        ("walls", f"{walls} in {duration(planned)}"),  # those of several items once for each
    )


def duration(seconds: float) -> str:
    """Write a time.

    >>> duration(3.21), duration(90), duration(7300)
    ('3.2 s', '1 min 30 s', '2 h 1 min')
    """
    if seconds < 59.95:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def _different(values: Iterable[object]) -> str:
    return "; ".join(dict.fromkeys(map(str, values)))


PAGE = "index.html"
LONG = 30
"""Tables of more rows are folded up."""

SHOWN = 0.624
"""CSS px of a px of a picture: its text is then a little larger than drawn (200 px an inch)."""


def write_page(
    path: Path, records: Sequence[Record], misses: Mapping[str, Record], order: Sequence[str]
) -> Path:
    """Write the report of everything that was made; pictures and tables are linked beside it.

    `misses` are title, section and error of items that could not be made when they were last asked
    for; they may have a record of an earlier time all the same.  `order` has the names of all.
    """
    sections = {name: {"name": name, **miss} for name, miss in misses.items()}
    for record in records:
        name = record["name"]
        error = misses.get(name, {}).get("error")
        sections[name] = {**record, "prefix": f"{name}/", "error": error}
    return _write(
        path,
        title="The paper's tables and figures, made again",
        lead=lead(records, len(order)),
        sections=[sections[name] for name in order if name in sections],
        made=made_rows(records),
        up="",
    )


def write_item_page(path: Path, record: Record) -> Path:
    """Write the page of one item, into the folder of its files."""
    return _write(
        path,
        title=heading(record["name"], record["title"]),
        lead="",
        sections=[{**record, "prefix": "", "error": None}],
        made=made_rows([record]),
        up=f"../{PAGE}#{record['name']}",
    )


def _words(table: Mapping[str, Any]) -> list[bool]:
    """Return which columns are not numbers."""
    columns = range(len(table["columns"]))
    return [any(isinstance(row[k], str) for row in table["rows"]) for k in columns]


def _write(path: Path, **content: object) -> Path:
    environment = Environment(
        loader=FileSystemLoader([Path(__file__).parent, HERE]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.globals |= {
        "heading": heading, "part": part, "counted": counted, "duration": duration,
        "written": written, "words": _words, "LONG": LONG, "SHOWN": SHOWN,
    }  # fmt: skip
    text = environment.get_template("page.html").render(**content)
    write_whole(path, text.encode("utf-8", "replace"))
    return path
