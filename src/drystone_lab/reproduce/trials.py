"""Walls of several seeds by several ways to build them, done together."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from drystone.model.wall import Wall
from drystone_lab.reproduce.base import PaperWall
from drystone_lab.reproduce.item import Context
from drystone_lab.runs.changes import Changes
from drystone_lab.runs.outcome import Outcome
from drystone_lab.runs.spec import RunSpec

BASE: Changes = ()
"""What replaces the paper's settings: nothing."""


@dataclass(frozen=True, eq=False)
class Trials:
    """Walls of one set of stones that differ in their seeds.

    Parameters
    ----------
    wall : PaperWall
        Stones and size.
    way : str
        How they were built.
    specs, outcomes : tuple
        Runs and what came out of them, in the order of the seeds.
    """

    wall: PaperWall
    way: str
    specs: tuple[RunSpec, ...]
    outcomes: tuple[Outcome, ...]

    def values(self, figure: str) -> tuple[float | None, ...]:
        """Return a figure of all of them; None where a wall has none."""
        found = (outcome.figures[figure] for outcome in self.outcomes)
        return tuple(None if value is None else float(value) for value in found)

    def drawn(self, context: Context, which: int = 0) -> tuple[Wall, Mapping[int, int]]:
        """Return one of the walls, built again, and the clusters of its stones."""
        outcome = self.outcomes[which]
        return outcome.wall(self.specs[which], context.data), outcome.clusters


def run_trials(
    context: Context,
    walls: Sequence[PaperWall],
    ways: Mapping[str, Changes],
    seeds: Sequence[int],
) -> tuple[Trials, ...]:
    """Build walls of every set, by every way, from every seed.

    Parameters
    ----------
    context : Context
        Does the runs.
    walls : sequence of PaperWall
        The sets.
    ways : mapping of str to changes
        Settings that replace the paper's, by name of the way.
    seeds : sequence of int
        The same for all, so that walls of one seed can be compared.

    Returns
    -------
    tuple of Trials
        Of the first set by every way, then of the next.
    """
    asked = [
        (wall, way, tuple(wall.run(seed, *changes) for seed in seeds))
        for wall in walls
        for way, changes in ways.items()
    ]
    outcomes = iter(context.run([spec for *_, specs in asked for spec in specs]))
    return tuple(
        Trials(wall, way, specs, tuple(next(outcomes) for _ in specs)) for wall, way, specs in asked
    )


def all_specs(trials: Sequence[Trials]) -> tuple[RunSpec, ...]:
    """Return the runs of all trials."""
    return tuple(spec for each in trials for spec in each.specs)


def seeds_of(context: Context, full: int, quick: int) -> range:
    """Return as many seeds as the version of the item has, from that of the context on."""
    return range(context.seed, context.seed + (quick if context.quick else full))


def at_hand(context: Context, walls: Sequence[PaperWall]) -> tuple[PaperWall, ...]:
    """Return the walls whose stones are there."""
    return tuple(wall for wall in walls if wall.source.is_there(context.data))
