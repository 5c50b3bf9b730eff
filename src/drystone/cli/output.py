"""Folders, tables and JSON on the way out."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from drystone.errors import UsageError


def prepare_folder(path: Path, *, overwrite: bool) -> Path:
    """Make a folder to write into; refuse one that has files, unless told otherwise (E129)."""
    if path.exists() and not path.is_dir():
        raise UsageError("E129", "is a file, not a folder.", where=str(path))
    if path.is_dir() and any(path.iterdir()) and not overwrite:
        raise UsageError(
            "E129",
            "the folder is not empty.",
            where=str(path),
            cure="Choose another with -o, or add --overwrite; nothing in it is ever deleted.",
        )
    path.mkdir(parents=True, exist_ok=True)
    return path


def print_json(value: Mapping[str, Any]) -> None:
    """Print one JSON object."""
    print(json.dumps(value, indent=2, ensure_ascii=False))


def print_table(title: str, rows: Sequence[tuple[str, str]]) -> None:
    """Print names and values, one a line."""
    table = Table(title=title, title_justify="left", show_header=False, box=None, pad_edge=False)
    table.add_column(style="bold")
    table.add_column()
    for name, value in rows:
        table.add_row(name, value)
    Console(highlight=False, width=100).print(table)


def number(value: float | None, digits: int = 3) -> str:
    """Write a number, or that there is none."""
    return "not defined" if value is None else f"{value:.{digits}f}"
