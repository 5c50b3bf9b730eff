"""Trial placement and stabilisation of candidates (Algorithm 1, lines 8-15)."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from drystone.model.landscape import Landscape
from drystone.model.placement import Side
from drystone.model.pose import PosedStone
from drystone.model.wall import Group
from drystone.placement.best import Spot, best_spots
from drystone.placement.feasible import can_be_lowered
from drystone.planner.build import Build, Proposal
from drystone.planner.craft import action_craft, place_cost
from drystone.planner.profile import Profile
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Rest
from drystone.planner.workshop import Workshop
from drystone.selection.scored import PIN_BONUS, craft_cost

TOGETHER = 16
"""So many trials are stabilised before it is looked whether these are enough."""

SPARE = 2
"""So many times the proposals that selection analyses are found: some walls do not stand."""

Key = tuple[int, float, Side]
"""A trial: stone, angle of its first pose, side."""

Apply = Callable[[Callable[[Any], Any], Sequence[Any]], list[Any]]
"""Applies a function to all items, in their order."""


def one_by_one(work: Callable[[Any], Any], items: Sequence[Any]) -> list[Any]:
    """Do work one item after the other."""
    return [work(item) for item in items]


@dataclass(frozen=True, eq=False)
class StoneTrial:
    """What is to be tried: one stone, from one side."""

    # the stone as it may be turned for the trial; the placement rule picks one
    poses: tuple[PosedStone, ...]
    landscape: Landscape  # what is built, seen from the side

    @property
    def key(self) -> Key:
        """What tells it from the others of a step."""
        return self.poses[0].stone.id, self.poses[0].angle_deg, self.landscape.side


@dataclass(frozen=True, eq=False)
class Proposer(ABC):
    """Places and stabilises candidates on one state of construction; remembers what it tried."""

    workshop: Workshop
    settings: PlannerSettings
    build: Build
    profile: Profile
    # By trial, what was found of it; how many there are is how many candidates were looked at.
    tried: dict[Key, Any] = field(default_factory=dict, init=False)

    @abstractmethod
    def proposals(self, trials: Sequence[StoneTrial], apply: Apply) -> Iterator[list[Proposal]]:
        """List where the stones of some trials, which are compared with each other, could stand.

        Proposals come in batches: whoever can use none of one batch asks for the next.  `apply`
        does independent work, on several threads if there are any.
        """

    @cached_property
    def rest(self) -> Rest:
        """What the stones that are left could fill."""
        return self.workshop.rest(self.build)

    def _cost(self, trial: StoneTrial, stabilised: Group) -> float:
        """Return the weighted craft cost of an action; 0 when no choice depends on it."""
        settings = self.settings
        if settings.selection_rule != "score" and not settings.placement.compare:
            return 0.0
        with self.profile.part("indices"):
            craft = action_craft(trial.landscape, stabilised, self.workshop.stock, self.rest)
        bonus = PIN_BONUS if trial.poses[0].stone.id in settings.pin else 0.0
        return craft_cost(craft, settings.score) - bonus


@dataclass(frozen=True, eq=False)
class Spotted:
    """Where the stone of a trial could be put, before it is made stable."""

    trial: StoneTrial
    spots: tuple[Spot, ...]  # the best places by the placement rule, best first
    # where selection goes by cost: what the best of them costs at least, while the stone need
    # not be turned there; infinite when there is none
    promise: float


@dataclass(frozen=True, eq=False)
class RasterProposer(Proposer):
    """Stones are their pixels at the working resolution.

    Where selection goes by cost, the stones that promise to be cheapest are stabilised first, and
    others only while they promise less than enough of those cost; Algorithm 2 compares all.
    """

    _proposed: dict[Key, Proposal | None] = field(default_factory=dict, init=False)

    def proposals(self, trials: Sequence[StoneTrial], apply: Apply) -> Iterator[list[Proposal]]:
        """See :class:`Proposer`."""
        new = [trial for trial in trials if trial.key not in self.tried]
        found = apply(self.spotted, new)
        self.tried.update(zip([trial.key for trial in new], found, strict=True))
        mine = [self.tried[trial.key] for trial in trials]
        if self.settings.selection_rule == "score":
            yield from self._by_promise(mine, apply)
        else:
            yield self._all(mine, apply)

    def _by_promise(self, spotted: Sequence[Spotted], apply: Apply) -> Iterator[list[Proposal]]:
        """List the cheapest proposals, then the next ones, and so on."""
        order = sorted(
            (one for one in spotted if one.spots),
            key=lambda one: (round(one.promise, 12), one.trial.key[::2]),
        )
        wanted, batch = SPARE * self.settings.score.analysed, []
        for start in range(0, len(order), TOGETHER):
            batch += self._all(order[start : start + TOGETHER], apply)
            later = order[start + TOGETHER : start + TOGETHER + 1]
            promised = later[0].promise if later else math.inf
            if sum(proposal.cost <= promised for proposal in batch) >= wanted or not later:
                yield batch
                batch = []

    def _all(self, spotted: Sequence[Spotted], apply: Apply) -> list[Proposal]:
        """Make the stones of some trials stable; of each that can be, return the best placement."""
        new = [one for one in spotted if one.trial.key not in self._proposed]
        found = apply(self.stabilised, new)
        self._proposed.update(zip([one.trial.key for one in new], found, strict=True))
        mine = (self._proposed[one.trial.key] for one in spotted)
        return [proposal for proposal in mine if proposal is not None]

    def spotted(self, trial: StoneTrial) -> Spotted:
        """Return where the stone of a trial could be put, and what that promises."""
        landscape, settings = trial.landscape, self.settings
        with self.profile.part("placement"):
            views = [landscape.view(posed) for posed in trial.poses]
            spots = best_spots(landscape, views, settings.placement)
        if settings.selection_rule != "score" or not spots:
            return Spotted(trial, tuple(spots), math.inf)
        with self.profile.part("indices"):
            constants = self.workshop.costs.of(trial.poses, settings.score)
            stock, rest, score = self.workshop.stock, self.rest, settings.score
            costs = [
                constants[spot.pose]
                + place_cost(landscape, views[spot.pose], (spot.row, spot.col), stock, rest, score)
                for spot in spots
            ]
        return Spotted(trial, tuple(spots), float(min(costs)))

    def stabilised(self, spotted: Spotted) -> Proposal | None:
        """Return the best stable placement of a stone; None when there is none (lines 8-15).

        Of the best positions by the placement rule, the first at which the stone can be made
        stable is taken; with `tries` = 1 that is the paper's single trial.  With `compare` = True
        all of them are stabilised, and the one of the least craft cost is taken.
        """
        trial, build = spotted.trial, self.build
        landscape = trial.landscape
        best: Proposal | None = None
        for spot in spotted.spots:
            posed = trial.poses[spot.pose]
            with self.profile.part("stabilisation"):
                stabilised = self.workshop.memory.stabilise(
                    build.wall.occupied,
                    (posed, spot.row, landscape.view_col(posed, spot.col)),
                    landscape.side,
                    self.workshop.next_wedge(build),
                )
            if stabilised is None or not self._reached(landscape, stabilised):
                continue
            cost = self._cost(trial, stabilised)
            proposal = Proposal(stabilised, posed.angle_deg, cost=cost)
            if not self.settings.placement.compare:
                return proposal
            if best is None or proposal.cost < best.cost - 1e-12:
                best = proposal
        return best

    def _reached(self, landscape: Landscape, stabilised: Group) -> bool:
        """Say whether a stone that was turned can still be put where it is."""
        settings = self.settings.placement
        if settings.reach == "any":
            return True
        placement = stabilised.placement
        view, col = landscape.view(placement.posed), landscape.box(placement).left
        return can_be_lowered(landscape, view, placement.row, col, settings.clearance_px)
