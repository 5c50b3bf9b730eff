"""Generated walls that are built stone by stone, and what may come next on them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from drystone.contacts.blocks import model_from_labels
from drystone.model.wall import Labels
from drystone.statics.incremental import IncrementalAnalysis
from drystone.statics.model import GROUND, Block, RigidBlockModel


@dataclass(frozen=True, eq=False)
class Pattern:
    """All stones of a wall where they will lie.

    Parameters
    ----------
    whole : RigidBlockModel
        The wall when it is finished.
    stones : tuple of Block
        From below, and from the left.
    """

    whole: RigidBlockModel
    stones: tuple[Block, ...]

    @classmethod
    def of(cls, labels: Labels) -> "Pattern":
        """Take the pattern of a label image."""
        whole = model_from_labels(labels).model
        stones = sorted(whole.blocks, key=lambda block: (block.centroid[1], block.centroid[0]))
        return cls(whole, tuple(stones))

    def with_stones(
        self, built: RigidBlockModel, stones: Sequence[Block], closed: tuple[int, ...] = ()
    ) -> RigidBlockModel:
        """Return what is built with some more stones.

        Parameters
        ----------
        built : RigidBlockModel
            Some stones of the wall.
        stones : sequence of Block
            Others.
        closed : tuple of int
            Ascending positions in ``built.interfaces`` of those that are there no more.
        """
        new = {stone.id for stone in stones}
        there = {GROUND, *new, *(block.id for block in built.blocks)}
        touching = (i for i in self.whole.interfaces if new & {i.block, i.other})
        interfaces = tuple(i for i in touching if {i.block, i.other} <= there)
        return built.with_added(tuple(stones), interfaces, closed)

    def next_stones(self, built: RigidBlockModel) -> list[Block]:
        """Return the stones that touch what is built or the ground, and are not built yet."""
        there = {GROUND, *(block.id for block in built.blocks)}
        near: set[int] = set()
        for interface in self.whole.interfaces:
            ends = {interface.block, interface.other}
            if ends & there:
                near |= ends - there
        return [stone for stone in self.stones if stone.id in near]


def built_up(pattern: Pattern, analysis: IncrementalAnalysis) -> Iterator[IncrementalAnalysis]:
    """Build with the stones of a pattern from below, leaving out those that fall.

    Parameters
    ----------
    pattern : Pattern
        The stones.
    analysis : IncrementalAnalysis
        Of nothing.

    Yields
    ------
    analysis : IncrementalAnalysis
        After each stone that was placed.
    """
    for stone in pattern.stones:
        model = pattern.with_stones(analysis.model, (stone,))
        if analysis.resistance_with(model).resistance.stable:
            analysis = analysis.extended(model)
            yield analysis
