"""Files that are either whole or not there, and none that is replaced unasked."""

from pathlib import Path

from drystone.errors import UsageError, not_written
from drystone.whole_files import write_whole


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
    try:
        write_whole(path, data)
    except OSError as error:
        raise not_written(error) from error


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
