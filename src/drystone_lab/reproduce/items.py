"""The paper's tables and figures by name, and what is written about them."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

from drystone.errors import UsageError

if TYPE_CHECKING:  # names are listed without waiting for matplotlib
    from drystone_lab.reproduce.item import PaperItem

ITEMS: Mapping[str, Mapping[str, Any]] = tomllib.loads(
    Path(__file__).with_name("paper.toml").read_text("utf-8")
)
"""What ``paper.toml`` says of each, in the order of the paper."""

ALSO: Mapping[str, str] = {
    other: name for name, words in ITEMS.items() for other in words.get("also", ())
}
"""Other names, of those that are made together."""

ALL = "all"


def item_names(asked: str) -> tuple[str, ...]:
    """Return the names of the items that are meant.

    >>> item_names("fig18"), len(item_names("all"))
    (('table2',), 28)
    """
    if asked == ALL:
        return tuple(ITEMS)
    name = ALSO.get(asked, asked)
    if name not in ITEMS:
        what = f"the paper has no {asked!r} that can be made again."
        cure = f"Name one of {', '.join(ITEMS)}, or all; `drystone reproduce --list` explains."
        raise UsageError("E138", what, where="reproduce", cure=cure)
    return (name,)


def item_named(name: str) -> "PaperItem":
    """Return one of :data:`ITEMS`."""
    made = ITEMS[name].get("made", "item.PLAIN")
    item: PaperItem = resolve_name(f"drystone_lab.reproduce.{made}")
    return item.worded(ITEMS[name])
