"""A time limit that is looked at between steps and inside long loops.

Where it has struck, the work is left by an exception, as after an interrupt (Ctrl-C): what is built
so far stays.  Nothing depends on a clock that does not strike.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass


class TimeIsUp(Exception):  # noqa: N818 - no error: the work ends here because it was asked to
    """The time limit struck in the midst of some work."""


@dataclass(frozen=True)
class Deadline:
    """When time is up."""

    at: float = math.inf  # by the clock, s; infinite for no limit
    # gives seconds; the same in all processes, where there are several
    clock: Callable[[], float] = time.time

    @classmethod
    def after(cls, seconds: float, clock: Callable[[], float] = time.time) -> "Deadline":
        """Return the limit so many seconds from now."""
        return cls(clock() + seconds, clock)

    def look(self) -> None:
        """Raise TimeIsUp when the limit has struck."""
        if self.clock() > self.at:
            raise TimeIsUp


NEVER = Deadline()
"""No limit."""
