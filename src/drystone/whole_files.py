"""Files that are either whole or not there, and none that is replaced unasked."""

import os
import re
import uuid
from contextlib import suppress
from pathlib import Path

from drystone.errors import UsageError, not_written

PART = re.compile(r"\..+\.[0-9a-f]{32}\.part")
"""Names of files that are being written."""


def write_whole(path: Path, data: bytes) -> None:
    """Write a file beside its place and move it there, so that no reader ever sees half of it.

    Whatever stops it, an interrupt too, leaves an existing file as it was and no other behind; a
    power cut leaves the old one or the new one.  PlanError (E206): the folder is missing, full or
    not writable.
    """
    part = path.with_name(f".{path.name}.{uuid.uuid4().hex}.part")
    try:
        with part.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)  # noqa: PTH105 - Path.replace says the same, os.replace says atomic
    except BaseException as error:
        with suppress(OSError):
            part.unlink()
        if isinstance(error, OSError):
            raise not_written(
                OSError(error.errno, error.strerror or str(error), str(path))
            ) from error
        raise


def remove_parts(folder: Path) -> None:
    """Remove what runs that were killed have left of files that they were writing."""
    for part in folder.glob(".*.part"):
        if PART.fullmatch(part.name):
            part.unlink(missing_ok=True)


def refuse_existing(path: Path, *, overwrite: bool) -> None:
    """Refuse to write where a folder is, or a file that is not to be replaced (E129)."""
    if path.is_dir():
        cure = "Give the name of a file, in the folder for example."
        raise UsageError("E129", "is a folder, not a file.", where=str(path), cure=cure)
    if path.exists() and not overwrite:
        cure = "Choose another with -o, or add --overwrite to replace it."
        raise UsageError("E129", "exists already.", where=str(path), cure=cure)
