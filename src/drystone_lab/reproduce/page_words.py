"""What the report of the paper's tables and figures says of them, in words."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

Cell = str | int | float | bool | None
Record = Mapping[str, Any]


def heading(name: str, title: str) -> str:
    """Return the heading of an item: its numbers in the paper and what it shows.

    Examples
    --------
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

    Examples
    --------
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

    Examples
    --------
    >>> duration(3.21), duration(90), duration(7300)
    ('3.2 s', '1 min 30 s', '2 h 1 min')
    """
    if seconds < 59.95:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def shown(cell: Cell) -> str:
    """Write a cell of a table to five digits; the CSV has all of them.

    Examples
    --------
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
