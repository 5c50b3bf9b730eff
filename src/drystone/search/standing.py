"""Where a search stands: all that it goes on from, in plain data.

What is drawn depends on the seed and on the numbers of walls, so this and the inputs are enough to
find the walls again that a search would have found.
"""

from dataclasses import dataclass, field

from drystone.planner.solves import Solves
from drystone.search.operators import Credits
from drystone.search.packed import Packed


@dataclass(frozen=True, eq=False)
class PackedLink:
    """Where a chain is (:class:`drystone.search.chain.Link`)."""

    number: int
    done: int
    now: Packed
    best: Packed
    solves: Solves
    kept: tuple[Packed, ...] = ()
    known: Credits = field(default_factory=Credits)
    learnt: Credits = field(default_factory=Credits)


@dataclass(frozen=True, eq=False)
class Reached:
    """What a search has come to."""

    walls: int  # How many walls it has built that count: the budget that repeats it
    best: Packed  # The best of them
    solves: Solves  # What trouble there was with all of them
    # Those that none beats in every figure of merit (:mod:`drystone.search.archive`)
    kept: tuple[Packed, ...]


@dataclass(frozen=True, eq=False)
class Chains:
    """Where the chains of a round are."""

    reached: Reached  # By the round
    links: tuple[PackedLink, ...]  # Of every chain
    turn: int  # How many of them have built their share since they last shared their best
    better: int  # Walls of the round after which the best was last notably better
    goal: float  # The merit that is so next


@dataclass(frozen=True, eq=False)
class Standing:
    """Where a search stands."""

    number: int  # Of the round, from 0
    before: Reached | None  # By the rounds before it
    found: tuple[Packed, ...]  # Its first walls, as long as there are no chains
    chains: Chains | None = None  # What they have become

    @property
    def walls(self) -> int:
        """How many walls the search has built."""
        before = self.before.walls if self.before else 0
        return before + (self.chains.reached.walls if self.chains else len(self.found))


@dataclass(frozen=True, eq=False)
class Progress(Reached):
    """What a search has come to, and where it stands."""

    # From where it goes on to the walls that it would find itself; None where the clock or the
    # budget has cut a chain short, and before there is more than the first wall
    standing: Standing | None = None
