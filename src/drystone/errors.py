"""Errors and notices: each has a code and says what is wrong, where, and what to do."""

import errno
import os
from dataclasses import dataclass
from enum import IntEnum


class ExitCode(IntEnum):
    """What the command line returns to the shell."""

    DONE = 0
    USAGE = 2
    BAD_INPUT = 3
    INCOMPLETE = 4
    CHECK_FAILED = 5
    OWN_FAULT = 70
    INTERRUPTED = 130
    TERMINATED = 143


@dataclass(frozen=True)
class Notice:
    """Something the user should know that does not stop the work.

    Parameters
    ----------
    code : str
        Stable code, for example ``"W112"``; documented in ``docs/errors.md``.
    message : str
        What was found and where.
    cure : str
        What to do about it; empty when nothing needs doing.
    """

    code: str
    message: str
    cure: str = ""

    def __str__(self) -> str:
        return f"{self.code} {self.message}" + (f" {self.cure}" if self.cure else "")


class DrystoneError(Exception):
    """Base of all errors that a user can cause and cure.

    Parameters
    ----------
    code : str
        Stable code, for example ``"E104"``; documented in ``docs/errors.md``.
    what : str
        What is wrong and why it matters.
    where : str
        File, stone or option concerned.
    cure : str
        What to do.
    """

    exit_code = ExitCode.BAD_INPUT

    def __init__(self, code: str, what: str, *, where: str = "", cure: str = "") -> None:
        self.code = code
        self.what = what
        self.where = where
        self.cure = cure
        super().__init__(code, what)

    def __str__(self) -> str:
        where = f"{self.where}: " if self.where else ""
        cure = f" {self.cure}" if self.cure else ""
        return f"{self.code} {where}{self.what}{cure}"


class InputError(DrystoneError):
    """A file or array cannot be read as what it should be."""


class LabelImageError(InputError):
    """An image is not a usable picture of stones."""


class UsageError(DrystoneError):
    """Options or parameters that make no sense together."""

    exit_code = ExitCode.USAGE


class OwnFaultError(DrystoneError):
    """What no user can cause: the last net of the command line says so."""

    exit_code = ExitCode.OWN_FAULT


class PlanError(DrystoneError):
    """A plan file is not valid or does not belong to these stones."""


NO_ROOM = (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC))
"""What the system says when the disk, or the user's share of it, is full."""


def not_written(error: OSError) -> PlanError:
    """Return the error with a code (E206) of a file that the system does not write."""
    return PlanError(
        "E206",
        f"the file cannot be written ({error.strerror or error}).",
        where=os.fspath(error.filename or ""),
        cure="Give a folder that exists, has room and may be written to.",
    )
