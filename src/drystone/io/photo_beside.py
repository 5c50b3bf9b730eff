"""The photograph of the stones, beside their label image and beside a plan."""

import hashlib
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from drystone.errors import UsageError
from drystone.io.file_bytes import file_bytes
from drystone.io.json_text import json_of
from drystone.io.photo_sidecar import LABELS, SIDECAR, read_sidecar
from drystone.whole_files import refuse_existing, write_whole

NAMES = ("photo.jpg", "photo.png")
"""Beside a plan; it shows the whole source image, at any resolution."""

RECORD = "photo"
"""In the source of a plan: the copy that was put beside it, so that a later one knows it."""


def photo_of(stones: Path) -> Path | None:
    """Return the photograph in the frame of a label image; None when there is none."""
    labels = stones / LABELS if (stones / LABELS).is_file() else stones
    sidecar = read_sidecar(labels)
    if sidecar is None or not sidecar.photo:
        return None
    with suppress(OSError, ValueError):  # no file can have some names
        # A base name: what stands in the file leads nowhere else.
        photo = labels.with_name(Path(sidecar.photo).name)
        if photo.is_file() and _copy_of(photo, photo.parent).name in NAMES:
            return photo
    return None


def check_place(photo: Path | None, folder: Path) -> None:
    """Refuse to replace a photograph that no plan put beside itself."""
    if photo is None:
        return
    copy = _copy_of(photo, folder)
    refuse_existing(copy, overwrite=True)
    if copy.exists() and not _is_ours(copy) and copy.read_bytes() != photo.read_bytes():
        raise UsageError(
            "E129",
            "no plan put this photograph here, and that of these stones has the same name.",
            where=str(copy),
            cure="Choose another folder with -o, or move it away; --overwrite leaves it.",
        )


def place_photo(photo: Path | None, folder: Path) -> tuple[Path | None, Mapping[str, Any]]:
    """Put a photograph of the stones beside a plan; the copy of an earlier plan is removed.

    A photograph that no plan put there stays.
    """
    check_place(photo, folder)
    # All is read before anything is removed: the photograph may be what an earlier plan left.
    data = b"" if photo is None else photo.read_bytes()
    copy = None if photo is None else _copy_of(photo, folder)
    put = copy is not None and (not copy.exists() or _is_ours(copy))
    for old in _beside(folder):
        if old != copy and _is_ours(old):
            old.unlink()
    if copy is None or not put:
        return copy, {}
    write_whole(copy, data)
    return copy, {RECORD: {"name": copy.name, "sha256": hashlib.sha256(data).hexdigest()}}


def photo_beside(folder: Path) -> Path | None:
    """Return the photograph beside a plan; None when there is none."""
    return next(iter(_beside(folder)), None)


def _beside(folder: Path) -> list[Path]:
    return [folder / name for name in NAMES if (folder / name).is_file()]


def _copy_of(photo: Path, folder: Path) -> Path:
    return folder / f"photo{photo.suffix.lower()}"


def _is_ours(photo: Path) -> bool:
    """Tell whether the plan in this folder put a photograph there, and nobody changed it since."""
    if (photo.parent / SIDECAR).exists():
        return False  # it belongs to the label image that `drystone segment` wrote there
    try:
        plan = json_of(file_bytes(photo.parent / "plan.json").decode("utf-8-sig"))
        record = plan["source"][RECORD]
        name, digest = record["name"], record["sha256"]
    except (OSError, ValueError, LookupError, TypeError):
        return False
    found = photo.name, hashlib.sha256(photo.read_bytes()).hexdigest()
    return found == (str(name), str(digest))
