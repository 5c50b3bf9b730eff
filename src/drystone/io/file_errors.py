"""What is said of files: errors that several readers raise, the name of the file, and lists.

Strangers make lists and names as long as they like.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from drystone.errors import DrystoneError, InputError, UsageError

SHOWN = 8
MANY = 50
"""Of what was left out or added, which users look up one by one."""

_LONGEST = 500  # of a thing in a list
_LONGEST_WHAT = 300


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
