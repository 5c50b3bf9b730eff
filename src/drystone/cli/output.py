"""What is written and printed; what nobody gave away is never written over."""

import codecs
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

from drystone.errors import PlanError, UsageError
from drystone.io.folder_lock import has_files, locked
from drystone.whole_files import refuse_existing

_PICTURES = (".png", ".pdf", ".svg")
_GONE_ON_FROM = "plan.json", "checkpoint.json"  # by `plan --resume`


def refuse_file(path: Path) -> None:
    """Refuse a file where a folder is to be, or one that it lies in (E129)."""
    for place in (path, *path.parents):
        if place.exists() and not place.is_dir():
            cure = "Choose another folder with -o, or move the file away."
            raise refusal(place, "is a file, not a folder.", cure)


def refusal(path: Path, what: str, cure: str) -> UsageError:
    """Make the error of something that is in the way (E129)."""
    return UsageError("E129", what, where=str(path), cure=cure)


def make_folder(path: Path) -> None:
    """Make a folder, with those that it lies in; refuse where a file is in the way (E129)."""
    refuse_file(path)
    path.mkdir(parents=True, exist_ok=True)


def prepare_folder(path: Path, names: Sequence[str], *, overwrite: bool) -> None:
    """Make a folder to write files of these names into; what cannot be written is refused now.

    E129: it has files, or a folder of the name of a file.  E206: nothing can be written there.
    """
    for name in names:
        refuse_existing(path / name, overwrite=True)
    make_folder(path)
    if has_files(path) and not overwrite:
        cure = "Choose another with -o, or add --overwrite; nothing else in it is touched."
        if "checkpoint.json" in names and any((path / n).exists() for n in _GONE_ON_FROM):
            cure = f"Add --resume to go on with a plan that was cut off. {cure}"
        raise refusal(path, "the folder is not empty.", cure)
    try:
        TemporaryFile(dir=path).close()
    except OSError as error:
        what = f"no file can be written there ({error.strerror})."
        cure = "Choose another folder with -o, one that has room and may be written to."
        raise PlanError("E206", what, where=str(path), cure=cure) from error


@contextmanager
def working_in(
    path: Path, names: Sequence[str], *, overwrite: bool, within: str = ""
) -> Iterator[None]:
    """Prepare a folder, and keep other runs out of it meanwhile (E149).

    `within`: see :func:`~drystone.io.folder_lock.locked`.
    """
    make_folder(path)
    with locked(path, within):
        prepare_folder(path, names, overwrite=overwrite)
        yield


def prepare_files(paths: Sequence[Path], *, overwrite: bool) -> None:
    """Make room for files, with the folders they go into; refuse to replace one (E129)."""
    for path in paths:
        refuse_existing(path, overwrite=overwrite)
        make_folder(path.parent)


def prepare_picture(path: Path, *, overwrite: bool) -> None:
    """Make room for a picture; refuse an ending that is no format (E139)."""
    if path.suffix.lower() not in _PICTURES:
        what = f"pictures are written as {', '.join(_PICTURES)}."
        raise UsageError("E139", what, where=str(path), cure="Choose another ending.")
    prepare_files([path], overwrite=overwrite)


def print_json(value: Mapping[str, Any]) -> None:
    """Print one JSON object; where stdout is not UTF-8, as JSON has to be, letters are escaped."""
    utf8 = codecs.lookup(sys.stdout.encoding or "ascii").name == "utf-8"
    print(json.dumps(value, indent=2, ensure_ascii=not utf8))


def print_table(title: str, rows: Sequence[tuple[str, str]]) -> None:
    """Print names and values, one a line."""
    width = max(len(name) for name, _ in rows)
    print(title)
    for name, value in rows:
        print(f"{name:<{width}}  {value}")


def note(*said: object) -> None:
    """Print notices or words on stderr, a line each; None is nothing to say."""
    for one in said:
        if one is not None:
            print(f"drystone: {one}", file=sys.stderr)
