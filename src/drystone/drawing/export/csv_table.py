"""steps.csv: the build list, UTF-8, a comma between values, nothing where there is no value."""

import csv
import io
from pathlib import Path
from typing import Any

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.export.out import put
from drystone.drawing.export.rows import columns
from drystone.drawing.export.settings import ExportSettings

FILE = "steps.csv"


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written."""
    return (FILE,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:  # noqa: ARG001
    """Write the table; ids of neighbours are separated by blanks."""
    table = columns(assembly)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([column.name for column in table])
    writer.writerows(zip(*(map(_cell, column.values) for column in table), strict=True))
    return (put(folder, FILE, text.getvalue()),)


def _cell(value: Any) -> Any:
    if isinstance(value, tuple):
        return " ".join(map(str, value))
    return value + 0.0 if isinstance(value, float) else value
