"""Where a search stands: all that it goes on from, in plain data.

What is drawn depends on the seed and on the numbers of walls, so this and the inputs are enough to
find the walls again that a search would have found.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from hashlib import sha256

from drystone.planner.build import Solves
from drystone.planner.replay import identity
from drystone.search.operators import Credits
from drystone.search.packed import PackedWall, archived
from drystone.search.yard import Yard


def made_of(yard: Yard, seed: int) -> str:
    """Return a digest of what shapes a search: stones, wall, settings but the budget, and seed."""
    site, settings = yard.workshop.site, yard.settings.updated({"search": {"budget": 1}})
    stones = [identity(stone) for stone in yard.workshop.stones]
    return sha256(repr((stones, site, site.extent_px, settings, seed)).encode()).hexdigest()


@dataclass(frozen=True, eq=False)
class Link:
    """Where a chain is."""

    number: int  # of the chain
    done: int  # how many walls it has built
    now: PackedWall  # it goes on from here
    best: PackedWall
    solves: Solves  # trouble with all of them
    kept: tuple[PackedWall, ...] = ()  # the last ones that none of them beats in every figure
    known: Credits = field(default_factory=Credits)  # which changes have helped in all chains
    learnt: Credits = field(default_factory=Credits)  # and in this one since then


@dataclass(frozen=True, eq=False)
class Reached:
    """What a search has come to."""

    walls: int  # that count: the budget that repeats it
    best: PackedWall
    solves: Solves  # trouble with all of them
    kept: tuple[PackedWall, ...]  # those that none beats in every figure of merit

    @classmethod
    def of(cls, walls: Sequence[PackedWall]) -> "Reached":
        """Say what some first walls have come to."""
        first, *others = (cls(1, wall, wall.solves, archived((), [wall])) for wall in walls)
        return sum(others, first)

    def __add__(self, later: "Reached") -> "Reached":
        return Reached(
            self.walls + later.walls,
            self.best if self.best.merit >= later.best.merit else later.best,
            self.solves + later.solves,
            archived(self.kept, later.kept),
        )


@dataclass(frozen=True, eq=False)
class Chains:
    """Where the chains of a round are."""

    reached: Reached  # by the round
    links: tuple[Link, ...]
    turn: int  # how many of them have built their share since they last shared their best
    better: int  # walls of the round after which the best was last notably better
    goal: float  # the merit that is so next


@dataclass(frozen=True, eq=False)
class SearchState:
    """Where a search stands."""

    made_of: str  # all that shapes it, by which it repeats
    number: int  # of the round, from 0
    before: Reached | None  # by the rounds before it
    found: tuple[PackedWall, ...]  # its first walls, as long as there are no chains
    chains: Chains | None = None

    @property
    def reached(self) -> Reached:
        """What the search has come to."""
        own = self.chains.reached if self.chains else Reached.of(self.found)
        return own if self.before is None else self.before + own


@dataclass(frozen=True, eq=False)
class Progress(Reached):
    """What a search has come to, and where it stands."""

    # From where it goes on to the walls that it would find itself; None where the clock or the
    # budget has cut a chain short, and before there is more than the first wall.
    state: SearchState | None = None
