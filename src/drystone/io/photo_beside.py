"""The photograph of the stones, beside their label image and beside a plan.

What stands beside the label image of a photograph says its scale, and where it came from.
"""

import hashlib
import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from drystone.errors import InputError, UsageError
from drystone.io.files import short
from drystone.io.json_text import json_in
from drystone.io.read_settings import MOST_PX_PER_M
from drystone.model.stone import writable
from drystone.whole_files import refuse_existing, write_whole

SCHEMA = "drystone-photo/1"
SIDECAR = "stones.json"
"""Name of the file beside `LABELS`."""
LABELS = "stones.png"
PAGE = "outlines.html"
"""The page on which a person corrects the outlines."""

NAMES = ("photo.jpg", "photo.png")
"""Beside a plan; it shows the whole source image, at any resolution."""

RECORD = "photo"
"""In the source of a plan: the copy that was put beside it, so that a later one knows it."""


@dataclass(frozen=True)
class PhotoSidecar:
    """Beside a label image that was found in a photograph."""

    width_px: int  # of the label image, so that a scale does not go to another picture
    height_px: int
    px_per_m: float | None = None  # of the label image
    photo: str = ""
    """Base name of the photograph in the frame of the label image, beside it; empty for none."""
    details: Mapping[str, Any] = field(default_factory=dict)
    """What else was found out: markers, residuals, doubts."""
    labels: str = LABELS
    """Base name of the label image."""
    photograph: tuple[tuple[str, Any], ...] = ()
    """Of the details, what a plan keeps (see `Source`); for one that was read."""
    doubtful: tuple[str, ...] = ()
    """Of the details, what speaks against all that was found; for one that was read."""


def write_sidecar(sidecar: PhotoSidecar, folder: Path) -> Path:
    """Write it into the folder of the label image."""
    names = ("labels", "width_px", "height_px", "px_per_m", "photo")
    known = {name: getattr(sidecar, name) for name in names}
    data = {"schema": SCHEMA, **known, **sidecar.details}
    path = folder / SIDECAR
    write_whole(path, (json.dumps(data, indent=1, ensure_ascii=False) + "\n").encode())
    return path


def read_sidecar(labels: Path) -> PhotoSidecar | None:
    """Read what stands beside a label image; None when there is nothing of this kind.

    It names the image that it is of.  A damaged one of `LABELS` is refused (E112).
    """
    if not labels.name or labels.name == "..":  # a folder such as "." has no name to replace
        return None
    path = labels.with_name(SIDECAR)
    if not path.is_file() or path == labels:
        return None
    try:
        data = json_in(path)
        if not isinstance(data, dict) or data.get("schema") != SCHEMA:
            return None
        if data.get("labels", LABELS) != labels.name:
            return None
        scale = data["px_per_m"]
        if scale is not None and not 0.0 < float(scale) <= MOST_PX_PER_M:
            raise ValueError(f"px_per_m is {scale}")
        return PhotoSidecar(
            int(data["width_px"]),
            int(data["height_px"]),
            None if scale is None else float(scale),
            str(data.get("photo", "")),
            labels=labels.name,
            photograph=photograph_in(data),
            doubtful=tuple(map(str, data.get("doubtful") or ())),
        )
    except (OSError, ValueError, KeyError, TypeError, OverflowError) as error:
        if labels.name != LABELS:  # nobody knows what it is of
            return None
        what = f"what it says of the photograph cannot be used ({short(error)})."
        cure = "Find the stones again with `drystone segment`, or remove the file."
        raise InputError("E112", what, where=str(path), cure=cure) from error


def photograph_in(data: Mapping[str, Any]) -> tuple[tuple[str, Any], ...]:
    """Return the name of the photograph, and where its markers are; ValueError for nonsense."""

    def numbers(one: dict[str, Any], name: str, shape: tuple[int, int]) -> dict[str, Any]:
        found = np.array(one[name], float)
        if found.shape != shape or not np.isfinite(found).all():
            raise ValueError(f"{name} has no {shape[0]} x {shape[1]} numbers")
        return {"id": int(one["id"]), name: found.tolist()}

    known: dict[str, Any] = {}
    if isinstance(data.get("source"), dict):
        known["name"] = writable(str(data["source"].get("name", "")))
    if data.get("markers") and data.get("P_from_marker"):
        known["markers"] = [numbers(one, "corners_m", (4, 2)) for one in data["markers"]]
        known["P_from_marker"] = numbers(data["P_from_marker"], "matrix", (4, 4))
    return tuple(known.items())


def scale_beside(
    sidecar: PhotoSidecar | None, size_px: tuple[int, ...], path: Path
) -> float | None:
    """Return the scale of a label image, width and height; E117 when it is of another picture."""
    if sidecar is None:
        return None
    if size_px != (sidecar.width_px, sidecar.height_px):
        raise InputError(
            "E117",
            f"it has {' x '.join(map(str, size_px))} px, but {SIDECAR} beside it is of one of "
            f"{sidecar.width_px} x {sidecar.height_px}.",
            where=str(path),
            cure=f"Find the stones again with `drystone segment`, or remove {SIDECAR}, and give "
            "the scale of the new picture.",
        )
    return sidecar.px_per_m


def photo_of(stones: Path) -> Path | None:
    """Return the photograph in the frame of stones, or of the folder with them, if any."""
    labels = stones / LABELS if (stones / LABELS).is_file() else stones
    sidecar = read_sidecar(labels)
    with suppress(OSError, ValueError):  # no file can have some names
        name = "" if sidecar is None else sidecar.photo
        if sidecar is None and labels.suffix.lower() == ".json":
            content = json_in(labels)
            if isinstance(content, dict) and "drystone" in content:  # our page drew over it
                name = str(content.get("imagePath", ""))
        # A base name: what stands in the file leads nowhere else.
        photo = labels.with_name(Path(name).name)
        if photo.is_file() and _copy_of(photo, photo.parent).name in NAMES:
            return photo
    return None


def check_place(photo: Path | None, folder: Path) -> None:
    """Refuse to replace a photograph that no plan put beside itself (E129)."""
    if photo is None:
        return
    copy = _copy_of(photo, folder)
    refuse_existing(copy, overwrite=True)
    if copy.exists() and not _is_ours(copy) and copy.read_bytes() != photo.read_bytes():
        what = "no plan put this photograph here, and that of these stones has the same name."
        cure = "Choose another folder with -o, or move it away; --overwrite leaves it."
        raise UsageError("E129", what, where=str(copy), cure=cure)


def place_photo(photo: Path | None, folder: Path) -> tuple[Path | None, Mapping[str, Any]]:
    """Put a photograph of the stones beside a plan; the copy of an earlier plan is removed.

    A photograph that no plan put there stays.  Returned are the photograph beside the plan, and
    what the source of the plan must say: nothing when none was put there.
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
        record = json_in(photo.parent / "plan.json")["source"][RECORD]
        name, digest = record["name"], record["sha256"]
    except (OSError, ValueError, LookupError, TypeError):
        return False
    found = photo.name, hashlib.sha256(photo.read_bytes()).hexdigest()
    return found == (str(name), str(digest))
