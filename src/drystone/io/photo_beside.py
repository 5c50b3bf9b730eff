"""The photograph of the stones, beside their label image and beside a plan."""

from pathlib import Path

from drystone.io.atomic import write_atomically
from drystone.io.photo_sidecar import LABELS, read_sidecar

NAMES = ("photo.jpg", "photo.png")
"""Beside a plan; it shows the whole source image, at any resolution."""


def photo_of(stones: Path) -> Path | None:
    """Return the photograph in the frame of a label image; None when there is none.

    Parameters
    ----------
    stones : Path
        What the stones are read from: a label image, or the folder that `drystone segment` wrote.
    """
    labels = stones / LABELS if (stones / LABELS).is_file() else stones
    sidecar = read_sidecar(labels)
    if sidecar is None or not sidecar.photo:
        return None
    # A base name: what stands in the file leads nowhere else.
    photo = labels.with_name(Path(sidecar.photo).name)
    return photo if photo.is_file() and f"photo{photo.suffix.lower()}" in NAMES else None


def place_photo(photo: Path | None, folder: Path) -> Path | None:
    """Put a photograph of the stones beside a plan; that of an earlier plan is removed."""
    for name in NAMES:
        (folder / name).unlink(missing_ok=True)
    if photo is None:
        return None
    copy = folder / f"photo{photo.suffix.lower()}"
    write_atomically(copy, photo.read_bytes())
    return copy


def photo_beside(folder: Path) -> Path | None:
    """Return the photograph beside a plan; None when there is none."""
    return next((folder / name for name in NAMES if (folder / name).is_file()), None)
