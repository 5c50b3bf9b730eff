"""What an interrupt (Ctrl-C) must not take away: the end of a search that has found something."""

from collections.abc import Callable
from typing import TypeVar

Result = TypeVar("Result")


def insisted(work: Callable[[], Result]) -> Result:
    """Do some work in spite of one interrupt, so that a search is not lost at its end."""
    try:
        return work()
    except KeyboardInterrupt:
        return work()
