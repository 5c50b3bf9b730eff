"""The bytes of a file that a user names."""

import errno
import stat
from pathlib import Path

from drystone.errors import InputError

MOST_BYTES = 2_000_000_000
"""Larger files are refused: a picture of 200 million px has at most 1.6 billion."""

_KINDS = {
    stat.S_IFIFO: "a pipe", stat.S_IFSOCK: "a socket", stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}  # fmt: skip


def file_bytes(path: Path, most: int = MOST_BYTES) -> bytes:
    """Read a regular file, of which the size is known before it is read."""
    found = path.stat()
    kind = _KINDS.get(stat.S_IFMT(found.st_mode))
    if kind is not None:
        raise OSError(errno.EINVAL, f"it is {kind}, and no regular file", str(path))
    if found.st_size > most:
        megabytes = f"{found.st_size / 1e6:.0f} MB, and the limit is {most / 1e6:g} MB"
        raise OSError(errno.EFBIG, f"it has {megabytes}", str(path))
    with path.open("rb") as file:
        data = file.read(found.st_size + 1)
    if len(data) > found.st_size:
        raise OSError(errno.EBUSY, "it grows while it is read", str(path))
    return data


def given_bytes(path: Path) -> bytes:
    """Read the same of what stones, walls or photographs are read from; E100 where that fails."""
    try:
        return file_bytes(path)
    except FileNotFoundError:
        what, cure = "there is no such file or folder.", "Check the path."
        raise InputError("E100", what, where=str(path), cure=cure) from None
    except OSError as error:
        what = f"it cannot be read ({error.strerror or error})."
        cure = "Check that it is a file and that you may read it."
        raise InputError("E100", what, where=str(path), cure=cure) from error
