"""Files that are either whole or not there, and none that is replaced unasked."""

import os
import uuid
from contextlib import suppress
from pathlib import Path

from drystone.errors import PlanError, UsageError


def write_whole(path: Path, data: bytes) -> None:
    """Write a file beside its place and move it there, so that no reader ever sees half of it.

    Whatever stops it, an interrupt too, leaves an existing file as it was and no other behind.

    Parameters
    ----------
    path : Path
        Where to; an existing file is replaced.
    data : bytes
        All of it.

    Raises
    ------
    PlanError
        E206: the folder is missing, full or not writable.
    """
    part = path.with_name(f".{path.name}.{uuid.uuid4().hex}.part")
    try:
        part.write_bytes(data)
        os.replace(part, path)  # noqa: PTH105 - Path.replace says the same, os.replace says atomic
    except BaseException as error:
        with suppress(OSError):
            part.unlink()
        if not isinstance(error, OSError):
            raise
        raise PlanError(
            "E206",
            f"the file cannot be written ({error.strerror or error}).",
            where=os.fspath(path),
            cure="Give a folder that exists, has room and may be written to.",
        ) from error


def refuse_existing(path: Path, *, overwrite: bool) -> None:
    """Refuse to write where a folder is, or a file that is not to be replaced.

    Raises
    ------
    UsageError
        E129.
    """
    if path.is_dir():
        raise UsageError(
            "E129",
            "is a folder, not a file.",
            where=str(path),
            cure="Give the name of a file, in the folder for example.",
        )
    if path.exists() and not overwrite:
        raise UsageError(
            "E129",
            "exists already.",
            where=str(path),
            cure="Choose another with -o, or add --overwrite to replace it.",
        )
