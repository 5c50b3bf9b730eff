"""Files that users name: their bytes, what is said of them, and what decoders of others raise.

Strangers make lists and names as long as they like.
"""

import errno
import logging
import os
import re
import stat
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from drystone.errors import DrystoneError, InputError, UsageError

SHOWN = 8
MANY = 50
"""Of what was left out or added, which users look up one by one."""

_LONGEST = 500  # of a thing in a list
_LONGEST_WHAT = 300
_LONGEST_REASON = 200


def short(text: object, most: int = 100) -> str:
    """Return the beginning of a text, such as a name."""
    said = str(text)
    return said if len(said) <= most else f"{said[:most]} …"


def listed(things: Iterable[object], between: str = ", ", most: int = SHOWN) -> str:
    """Return the first of some things, and how many more there are."""
    found = list(things)
    said = [short(thing, _LONGEST) for thing in found[:most]]
    if len(found) > most:
        said.append(f"and {len(found) - most} more")
    return between.join(said)


@contextmanager
def naming(where: str) -> Iterator[None]:
    """Give errors of the block the name of their file, unless they say where they are."""
    try:
        yield
    except DrystoneError as error:
        error.where = error.where or where
        raise


@contextmanager
def entry(what: str) -> Iterator[None]:
    """Turn what fails in one entry of a file into an error that names it (E114)."""
    try:
        yield
    except KeyError as error:
        raise unusable(f"{what} has no {error}") from error
    except (TypeError, ValueError, IndexError, AttributeError, ArithmeticError) as error:
        raise unusable(f"{what} cannot be used ({error})") from error


def damaged(why: str, what: str = "file", cure: str = "Copy or export it again.") -> InputError:
    """Make the error for bytes that are not what their format says (E106)."""
    text = f"the {what} is damaged or cut short ({why})."
    return InputError("E106", text, cure=cure)


def unread(what: str, cure: str) -> InputError:
    """Make the error for a format, or a kind of it, that is not read (E107)."""
    return InputError("E107", what, cure=cure)


def several_pages(found: str) -> InputError:
    """Make the error for stacks and animations (E109)."""
    cure = "Give one page as a picture of its own, or a folder of one-stone masks."
    what = f"{found} were found where one picture is needed."
    return InputError("E109", what, cure=cure)


def too_large(what: str, cure: str) -> InputError:
    """Make the error for what would fill the memory, or take too long (E110)."""
    return InputError("E110", what, cure=cure)


def unusable(what: str) -> InputError:
    """Make the error for a file whose content is not what its format says (E114)."""
    cure = "Correct it, or export the file again."
    return InputError("E114", f"{short(what, _LONGEST_WHAT)}.", cure=cure)


def unfit(what: str, cure: str) -> UsageError:
    """Make the error for settings that are not for what is read (E118)."""
    return UsageError("E118", what, cure=cure)


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


for _package in ("PIL", "ezdxf", "tifffile"):
    # Without any handler logging prints to stderr; those of the user's own program still hear.
    logging.getLogger(_package).addHandler(logging.NullHandler())


@contextmanager
def foreign(failed: Callable[[str], DrystoneError]) -> Iterator[None]:
    """Turn whatever another package raises into a coded error, and silence its warnings.

    Parsers of other people raise anything on damaged bytes, so there is no list of what to expect.
    Only the call into them belongs inside: a fault of ours must stay one.  `failed` makes the error
    from a reason; E110 says where the memory is not large enough.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except DrystoneError:
        raise
    except MemoryError as error:
        what = "there is not enough memory for what is in this file."
        where = failed("").where
        raise InputError("E110", what, where=where, cure="Reduce it or crop it.") from error
    except (Exception, SystemExit) as error:
        # Where an object lies in memory is another place in every run.
        reason = " ".join(re.sub(r" at 0x[0-9a-f]+", "", str(error)).split())
        raise failed(reason[:_LONGEST_REASON] or type(error).__name__) from error


@contextmanager
def silent_stderr() -> Iterator[None]:
    """Throw away what a library in C writes to stderr by itself, as libtiff does."""
    try:
        kept = os.dup(2)
    except OSError:  # there is none
        yield
        return
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 2)
        os.close(nowhere)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
