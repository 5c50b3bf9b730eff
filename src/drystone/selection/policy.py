"""What a policy is: it chooses one of the actions that are possible in a step.

A policy sees values only, never the planner's own objects, so policies can be compared with each
other, and one of another package (:mod:`drystone.selection.policies.registry`) cannot change a
wall but by its choice.
"""

import operator
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from drystone.errors import UsageError
from drystone.indices import Indices
from drystone.model.placement import Side
from drystone.model.plan import Point


@dataclass(frozen=True, kw_only=True)
class Offer:
    """An action that a policy may choose: a stone at rest in its place, in a wall that stands.

    Lengths are working px, areas their squares; places are in the wall frame, x to the right from
    the wall's left end, y up from the ground.
    """

    stone_id: int
    angle_deg: float  # of the trial pose, counter-clockwise from the source image
    turned_deg: float  # how far it turned from there until it rested, in [0, 180]
    side: Side  # end of the wall from which it is placed
    indices: Indices  # Eq. 3 to 11; LLC is positive
    area_px: float
    left_px: float  # box of the stone in its place
    bottom_px: float
    right_px: float
    top_px: float
    centroid_px: Point  # of the stone in its place
    # The leftmost and the rightmost of the points that bear the stone from below (the line AB of
    # §3.7), the same twice when there is one; None when there is none.
    support_px: tuple[Point, Point] | None
    touches: tuple[int, ...] = ()  # ids of the stones that it touches, without wedges and ground
    wedges: int  # how many wedges hold it
    wall_width_px: int
    wall_height_px: int

    @property
    def width_px(self) -> float:
        """Width of its box."""
        return self.right_px - self.left_px

    @property
    def support_width_px(self) -> float:
        """Horizontal length of its support; 0 when nothing bears it from below."""
        if self.support_px is None:
            return 0.0
        (left, _), (right, _) = self.support_px
        return right - left

    @property
    def from_end_px(self) -> float:
        """Distance from the end of the wall from which it is placed."""
        return self.left_px if self.side == "left" else self.wall_width_px - self.right_px


class Policy(Protocol):
    """Chooses the action of a step."""

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int | None:
        """Return the position of the action to take; None to take none of them.

        The choice may depend on the arguments only, or a plan does not repeat.

        Parameters
        ----------
        candidates : sequence of Offer
            At least one, those of both sides when the wall is built from both ends; always in
            the same order.
        rng : numpy.random.Generator
            Of this attempt at this step, from the plan's seed.
        """
        ...


def choice_of(
    name: str, policy: Policy, candidates: Sequence[Offer], rng: np.random.Generator
) -> int | None:
    """Return what a policy chooses; None when there is nothing to choose from, or it takes none.

    UsageError (E147): it, which may be of another package, raised an error, or returned what is
    neither None nor a position.
    """
    if not candidates:
        return None
    try:
        chosen = policy.choose(tuple(candidates), rng)
    except (Exception, SystemExit) as error:
        raise broken(name, f"raised {type(error).__name__}: {error}") from error
    if chosen is None:
        return None
    try:
        position = -1 if isinstance(chosen, bool | np.bool_) else operator.index(chosen)
    except TypeError:
        position = -1
    if not 0 <= position < len(candidates):
        wanted = f"not None nor a position from 0 to {len(candidates) - 1}"
        raise broken(name, f"returned {chosen!r}, which is {wanted}")
    return position


def broken(name: str, what: str) -> UsageError:
    """Return the error (E147) of a policy that cannot be used."""
    cure = "Choose another policy, or tell who made it."
    return UsageError("E147", f"the policy {name!r} {what}.", where="--policy", cure=cure)
