"""What the planner tells while it works."""

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


@dataclass(frozen=True)
class Incumbent:
    """The best wall of a search so far (:mod:`drystone.search`).

    Parameters
    ----------
    walls : int
        How many have been built: the budget that repeats it.
    stones : int
        Placed in the best one.
    merit : float
        What the goal makes of it; higher is better.
    F_SF, F_LR, F_AV, F_AH : float
        Its figures of merit at the working resolution.
    """

    walls: int
    stones: int
    merit: float
    F_SF: float
    F_LR: float
    F_AV: float
    F_AH: float


class Callbacks:
    """Told of everything the planner does; does nothing.  Subclass it to follow along."""

    def on_step(self, step: Step) -> None:
        """Follow the first pass: an action was chosen."""

    def on_walls(self, incumbent: Incumbent) -> None:
        """Follow the search: more walls have been built."""
