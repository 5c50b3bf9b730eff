"""Files that are either whole or not there."""

import os
import uuid
from pathlib import Path

from drystone.errors import PlanError


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file beside its place and move it there, so that no reader ever sees half of it.

    Parameters
    ----------
    path : Path
        Where to; an existing file is replaced.
    data : bytes
        All of it.

    Raises
    ------
    PlanError
        E206: the folder is missing, full or not writable; an existing file is unchanged.
    """
    part = path.with_name(f".{path.name}.{uuid.uuid4().hex}.part")
    try:
        part.write_bytes(data)
        os.replace(part, path)  # noqa: PTH105 - Path.replace says the same, os.replace says atomic
    except OSError as error:
        part.unlink(missing_ok=True)
        raise PlanError(
            "E206",
            f"the file cannot be written ({error.strerror}).",
            where=str(path),
            cure="Give a folder that exists, has room and may be written to.",
        ) from error
