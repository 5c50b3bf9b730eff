"""Lists and names in messages: strangers make both as long as they like."""

from collections.abc import Iterable

SHOWN = 8
MANY = 50
"""Of what was left out or added, which users look up one by one."""

_LONGEST = 500


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
