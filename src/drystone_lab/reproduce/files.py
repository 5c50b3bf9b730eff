"""The files of an item: tables as CSV, pictures as PNG and SVG."""

import csv
import io
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from PIL import PngImagePlugin

from drystone.drawing.files import save
from drystone.whole_files import write_whole
from drystone_lab.reproduce.item import Output, Picture
from drystone_lab.table import Cell, Table

TIMES = "_times"


def write_tables(folder: Path, output: Output) -> dict[str, list[dict[str, Any]]]:
    """Write the tables of an item; those of times under names that end with ``_times.csv``.

    Returns
    -------
    dict
        ``"tables"`` and ``"times"``, as JSON writes them, each with its ``"file"``.

    Raises
    ------
    ValueError
        Two tables have one name, or a number is not finite: both are faults of the item.
    """
    tables = [(name, table) for name, table in output.tables]
    times = [(name.removesuffix(TIMES) + TIMES, table) for name, table in output.times]
    names = [name for name, _ in (*tables, *times)]
    if len({*names}) < len(names) or any(name.endswith(TIMES) for name, _ in tables):
        raise ValueError(f"names of tables are not unique: {', '.join(names)}")
    return {
        "tables": [_write_table(folder, name, table) for name, table in tables],
        "times": [_write_table(folder, name, table) for name, table in times],
    }


def write_picture(folder: Path, picture: Picture) -> dict[str, Any]:
    """Write a picture as PNG and SVG; return its names, size in px and caption for JSON."""
    png, svg = f"{picture.name}.png", f"{picture.name}.svg"
    for name in (png, svg):
        save(picture.figure, folder / name)
    with PngImagePlugin.PngImageFile(folder / png) as image:
        width, height = image.size
    return {
        "name": picture.name, "png": png, "svg": svg, "width_px": width, "height_px": height,
        "caption": picture.caption,
    }  # fmt: skip


def files_of(record: dict[str, Any]) -> Iterator[str]:
    """Yield the names of the files of an item, without its JSON and page."""
    for table in (*record["tables"], *record["times"]):
        yield table["file"]
    for picture in record["pictures"]:
        yield picture["png"]
        yield picture["svg"]


def csv_text(table: Table) -> str:
    r"""Return a table as CSV: numbers that read back as they were, nothing for None.

    Examples
    --------
    >>> csv_text(Table("Blocks", ("name", "alpha"), (("tall", 0.1 + 0.2), ("flat", None))))
    'name,alpha\ntall,0.30000000000000004\nflat,\n'
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(table.columns)
    writer.writerows([_written(cell) for cell in row] for row in table.rows)
    return text.getvalue()


def _write_table(folder: Path, name: str, table: Table) -> dict[str, Any]:
    for row in table.rows:
        if any(isinstance(cell, float) and not math.isfinite(cell) for cell in row):
            raise ValueError(f"{name}: a number of {row} is not finite; None says there is none")
    file = f"{name}.csv"
    write_whole(folder / file, csv_text(table).encode())
    return {
        "name": name, "file": file, "title": table.title, "columns": list(table.columns),
        "rows": [list(row) for row in table.rows], "notes": list(table.notes),
    }  # fmt: skip


def _written(cell: Cell) -> str:
    if cell is None:
        return ""
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    # Floats of NumPy are floats, but write their type.
    return repr(float(cell)) if isinstance(cell, float) else str(cell)
