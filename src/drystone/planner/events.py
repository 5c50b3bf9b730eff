"""What the planner tells while it works."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from drystone.planner.build import Build, Candidate


@dataclass(frozen=True, eq=False)
class Step:
    """One chosen action, as :meth:`drystone.planner.planner.Planner.steps` yields it.

    Parameters
    ----------
    number : int
        1 for the first stone.
    action : Candidate
        Stone, placement, wedges, indices and resistance.
    build : Build
        The state after it.
    candidates : int
        How many candidates were evaluated for it.
    """

    number: int
    action: Candidate
    build: Build
    candidates: int


@dataclass(frozen=True)
class Stopped:
    """Why construction ended.

    Parameters
    ----------
    reason : {"filled", "stones", "failures", "interrupted"}
        Design goal reached, all stones placed, too many failures in a row, or stopped by the user.
    text : str
        The same in words.
    """

    reason: Literal["filled", "stones", "failures", "interrupted"]
    text: str


StepCallback = Callable[[Step], None]
