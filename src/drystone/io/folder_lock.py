"""One run at a time in a folder: the system ends the lock with its process, whatever ends that."""

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from drystone.errors import PlanError, UsageError
from drystone.whole_files import PART, remove_parts

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

LOCK = ".drystone.lock"
"""In a folder that is worked in; it may stay when a run is killed, and locks nothing then."""

_TAKEN = (errno.EACCES, errno.EAGAIN, errno.EDEADLK)


@contextmanager
def locked(folder: Path, within: str = "") -> Iterator[None]:
    """Keep other runs out of a folder, as long as the block lasts.

    Files that a killed run was writing there are removed.  Where the file system knows no locks
    there is none.  `within` is the pattern of the folders in it that belong to it, and in which no
    other run may be.
    """
    path = folder / LOCK
    file = _taken(path)
    try:
        for place in (folder, *(folder.glob(within) if within else ())):
            remove_parts(place)
        yield
    finally:
        if sys.platform == "win32":  # which removes no file that somebody has open
            file.close()
            with suppress(OSError):
                path.unlink(missing_ok=True)
        else:  # while it is locked, so that nobody holds a lock on a file that is no longer there
            path.unlink(missing_ok=True)
            file.close()


def has_files(folder: Path) -> bool:
    """Say whether a folder has files, but for what killed runs have left of their own."""
    return any(one.name != LOCK and not PART.fullmatch(one.name) for one in folder.iterdir())


def _taken(path: Path) -> BinaryIO:
    """Open and lock the file, again when it was removed in between."""
    while True:
        try:
            file = path.open("ab")
        except OSError as error:
            what = f"no file can be written there ({error.strerror})."
            cure = "Choose another folder with -o, one that has room and may be written to."
            raise PlanError("E206", what, where=str(path.parent), cure=cure) from error
        try:
            _lock(file)
            if os.path.samestat(os.fstat(file.fileno()), path.stat()):
                return file
        except FileNotFoundError:
            pass
        except OSError as error:
            if error.errno not in _TAKEN:
                return file
            file.close()
            what = "another run of drystone works in this folder."
            cure = "Choose another with -o, or wait until that run has ended."
            raise UsageError("E149", what, where=str(path.parent), cure=cure) from error
        file.close()


def _lock(file: BinaryIO) -> None:
    if sys.platform == "win32":
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
