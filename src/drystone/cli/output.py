"""Folders, files, tables and JSON on the way out."""

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from drystone.errors import UsageError
from drystone.io.atomic import refuse_existing

_PICTURES = (".png", ".pdf", ".svg")


def prepare_folder(path: Path, *, overwrite: bool) -> Path:
    """Make a folder to write into; refuse one that has files, unless told otherwise (E129)."""
    make_folder(path)
    if any(path.iterdir()) and not overwrite:
        raise UsageError(
            "E129",
            "the folder is not empty.",
            where=str(path),
            cure="Choose another with -o, or add --overwrite; nothing else in it is touched.",
        )
    return path


def prepare_files(paths: Sequence[Path], *, overwrite: bool) -> None:
    """Make room for files, with the folders they go into; refuse to replace one (E129)."""
    for path in paths:
        refuse_existing(path, overwrite=overwrite)
    for path in paths:
        make_folder(path.parent)


def prepare_picture(path: Path, *, overwrite: bool) -> None:
    """Make room for a picture; refuse an ending that is no format (E139)."""
    if path.suffix.lower() not in _PICTURES:
        raise UsageError(
            "E139",
            f"pictures are written as {', '.join(_PICTURES)}.",
            where=str(path),
            cure="Choose another ending.",
        )
    prepare_files([path], overwrite=overwrite)


def print_json(value: Mapping[str, Any]) -> None:
    """Print one JSON object."""
    print(json.dumps(value, indent=2, ensure_ascii=False))


def print_table(title: str, rows: Sequence[tuple[str, str]]) -> None:
    """Print names and values, one a line."""
    width = max(len(name) for name, _ in rows)
    print(title)
    for name, value in rows:
        print(f"{name:<{width}}  {value}")


def number(value: float | None, digits: int = 3) -> str:
    """Write a number, or that there is none."""
    return "not defined" if value is None else f"{value:.{digits}f}"


def make_folder(path: Path) -> None:
    """Make a folder, with those that it lies in; refuse where a file is in the way (E129)."""
    for place in (path, *path.parents):
        if place.exists() and not place.is_dir():
            raise UsageError(
                "E129",
                "is a file, not a folder.",
                where=str(place),
                cure="Choose another folder with -o, or move the file away.",
            )
    path.mkdir(parents=True, exist_ok=True)


def say(text: str) -> None:
    """Print a result as it comes, where it does not get in the way of the tables."""
    print(text, file=sys.stderr, flush=True)
