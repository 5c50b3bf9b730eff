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
class Round:
    """What a round of rework came to (:mod:`drystone.planner.rework`).

    Parameters
    ----------
    number, rounds : int
        Of how many.
    stones : int
        Placed in the best wall so far.
    merit : float
        Of the best wall so far.
    """

    number: int
    rounds: int
    stones: int
    merit: float


class Callbacks:
    """Told of everything the planner does; does nothing.  Subclass it to follow along."""

    def on_step(self, step: Step) -> None:
        """Follow the first pass: an action was chosen."""

    def on_round(self, round_: Round) -> None:
        """Follow the rework: a round is over."""
