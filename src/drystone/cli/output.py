"""What is read and written: what is read, and what nobody gave away, is never written over."""

import codecs
import json
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

from drystone.errors import PlanError, UsageError
from drystone.io.folder_lock import has_files, locked
from drystone.io.images import SUFFIXES
from drystone.io.photo_beside import LABELS, read_sidecar
from drystone.io.plan_folder import DRAWN, WRITTEN
from drystone.whole_files import refuse_existing

_PICTURES = (".png", ".pdf", ".svg")


def files_of(stones: Path) -> tuple[Path, ...]:
    """Return the files that stones are read from: itself, or what is read of a folder."""
    if not stones.is_dir():
        return (stones,)
    if read_sidecar(stones / LABELS) is not None:
        return (stones / LABELS,)
    return tuple(entry for entry in stones.iterdir() if entry.suffix.lower() in SUFFIXES)


def files_of_plan(plan: Path) -> tuple[Path, ...]:
    """Return the file that a plan is read from."""
    return (plan / "plan.json" if plan.is_dir() else plan,)


def files_of_wall(wall: Path) -> tuple[Path, ...]:
    """Return the files that a wall is read from: an image or a model, or what a plan's folder has.

    Not all of them need be there.
    """
    if not wall.is_dir() and wall.suffix.lower() != ".json":
        return (wall,)
    folder = wall if wall.is_dir() else wall.parent
    return (*files_of_plan(wall), *(folder / name for name in WRITTEN))


def refuse_inputs(read: Iterable[Path], written: Iterable[Path]) -> None:
    """Refuse to write where something is read, by any name, whatever is said of overwriting (E129).

    Files of both need not be there.
    """
    path = _first_of(read, written)
    if path is not None:
        what = "is read here, and what is read is never replaced, also not with --overwrite."
        raise _refusal(path, what, "Choose another place for what is written.")


def _first_of(kept: Iterable[Path], written: Iterable[Path]) -> Path | None:
    """Return the first file to be written that is one of those to be kept, by any name."""
    there = [path for path in kept if path.exists()]
    for path in written:
        if path.exists() and any(path.samefile(one) for one in there):
            return path
    return None


def refuse_plans_own(wall: Path, written: Iterable[Path]) -> None:
    """Refuse to write over what `plan` drew of a wall, when it is in that plan's folder (E129)."""
    folder = wall if wall.is_dir() else wall.parent
    if not (folder / "plan.json").is_file():
        return
    path = _first_of([folder / name for name in DRAWN], written)
    if path is not None:
        what = "belongs to the plan, and is not replaced by what is made of its wall."
        raise _refusal(path, what, "Choose another folder with -o.")


def refuse_among_masks(stones: Path, written: Iterable[Path]) -> None:
    """Refuse pictures in a folder of masks that is read: each would be one more stone (E129)."""
    if not stones.is_dir() or read_sidecar(stones / LABELS) is not None:
        return
    for path in written:
        among = path.parent.is_dir() and path.parent.samefile(stones)
        if among and path.suffix.lower() in SUFFIXES:
            what = "would lie among the masks that are read here, and be read as one of them."
            raise _refusal(path, what, "Choose another place for what is written.")


def refuse_file(path: Path) -> None:
    """Refuse a file where a folder is to be, or one that it lies in (E129)."""
    for place in (path, *path.parents):
        if place.exists() and not place.is_dir():
            cure = "Choose another folder with -o, or move the file away."
            raise _refusal(place, "is a file, not a folder.", cure)


def _refusal(path: Path, what: str, cure: str) -> UsageError:
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
        raise _refusal(path, "the folder is not empty.", cure)
    try:
        TemporaryFile(dir=path).close()
    except OSError as error:
        raise PlanError(
            "E206",
            f"no file can be written there ({error.strerror}).",
            where=str(path),
            cure="Choose another folder with -o, one that has room and may be written to.",
        ) from error


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
    for path in paths:
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


def say(text: str) -> None:
    """Print a result as it comes, where it does not get in the way of the tables."""
    print(text, file=sys.stderr, flush=True)
