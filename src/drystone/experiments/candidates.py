"""Suite "candidates": every answer of the growing analysis against a fresh linprog."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import chain

import numpy as np

from drystone.experiments.benchmark_walls import coursed_labels, irregular_labels
from drystone.experiments.fresh_linprog import TOLERANCE, fresh_linprog
from drystone.experiments.growing_walls import Pattern, built_up
from drystone.experiments.table import BenchSettings, Cell, Table
from drystone.model.wall import Labels
from drystone.statics.incremental import IncrementalAnalysis, incremental_analysis
from drystone.statics.lp.program import units_of
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitResult

AGREED = 1e-9
"""Largest difference of load multipliers that counts as none."""

COLUMNS = (
    "walls", "candidates", "stand", "same status", "certified", "solved cold", "difference",
    "solvers", "verdict",
)  # fmt: skip

Maker = Callable[[np.random.Generator, int], Labels]


@dataclass(frozen=True)
class Family:
    """Walls of one kind, and when they are asked about.

    Parameters
    ----------
    name : str
        For people.
    make : callable
        Makes the label image of one, from a generator and a number of stones.
    walls : int
        How many.
    stones : int
        Of each.
    first, every : int
        All candidates are asked about when there are `first` stones, and from then on at every
        so many.
    """

    name: str
    make: Maker
    walls: int
    stones: int
    first: int = 0
    every: int = 1


FAMILIES = (
    Family("coursed, up to 60", coursed_labels, 6, 60),
    Family("irregular, up to 60", irregular_labels, 6, 60),
    Family("coursed, 100 to 200", coursed_labels, 1, 200, 100, 25),
    Family("irregular, 100 to 200", irregular_labels, 1, 200, 100, 25),
    Family("coursed, 250 and 300", coursed_labels, 1, 300, 250, 50),
    Family("irregular, 250 and 300", irregular_labels, 1, 300, 250, 50),
)
QUICK = (
    Family("coursed, up to 8", coursed_labels, 1, 8),
    Family("irregular, up to 8", irregular_labels, 1, 8),
)


@dataclass
class Tally:
    """What was found."""

    candidates: int = 0
    standing: int = 0
    same: int = 0
    certified: int = 0
    cold: int = 0
    difference: float = 0.0
    solvers: set[str] = field(default_factory=set)


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Ask about thousands of candidates.

    Parameters
    ----------
    settings : BenchSettings
        `seed` of the walls; `quick` for two walls of 8 stones.
    """
    families = QUICK if settings.quick else FAMILIES
    return (
        Table(
            "Candidates: the growing analysis against a fresh linprog for each tilt",
            COLUMNS,
            tuple(_row(family, settings.seed) for family in families),
            (
                "Candidates are all stones that touch the wall, stable or not; the same with one"
                " contact less, and two stones at once.",
                f"linprog runs with tolerances of {TOLERANCE:g}; a difference of alpha above"
                f" {AGREED:g}, another status, or an answer without a certificate is a miss.",
                "Solved cold: a warm answer had no certificate, and all was solved from the start.",
            ),
        ),
    )


def _row(family: Family, seed: int) -> tuple[Cell, ...]:
    tally = Tally()
    for wall in range(family.walls):
        rng = np.random.default_rng([seed, wall])
        pattern = Pattern.of(family.make(rng, family.stones))
        for analysis in _asked(family, pattern):
            for model in _candidates(pattern, analysis.model, rng):
                _compare(analysis, model, tally)
    passed = tally.same == tally.certified == tally.candidates and tally.difference <= AGREED
    return (
        family.name, tally.candidates, tally.standing, tally.same, tally.certified, tally.cold,
        tally.difference, ", ".join(sorted(tally.solvers)), "pass" if passed else "miss",
    )  # fmt: skip


def _asked(family: Family, pattern: Pattern) -> Iterator[IncrementalAnalysis]:
    """Return the wall at every step that is asked about, before the first stone too."""
    nothing = incremental_analysis(
        RigidBlockModel((), (), pattern.whole.mu), units_of(pattern.whole)
    )
    for count, analysis in enumerate(chain([nothing], built_up(pattern, nothing))):
        if count > family.stones:
            break
        if count >= family.first and (count - family.first) % family.every == 0:
            yield analysis


def _candidates(
    pattern: Pattern, built: RigidBlockModel, rng: np.random.Generator
) -> Iterator[RigidBlockModel]:
    stones = pattern.next_stones(built)
    for stone in stones:
        yield pattern.with_stones(built, (stone,))
    if built.interfaces and stones:
        gone = int(rng.integers(len(built.interfaces)))
        yield pattern.with_stones(built, (stones[int(rng.integers(len(stones)))],), (gone,))
    if len(stones) > 1:
        first = int(rng.integers(len(stones) - 1))
        yield pattern.with_stones(built, stones[first : first + 2])


def _compare(analysis: IncrementalAnalysis, model: RigidBlockModel, tally: Tally) -> None:
    grown = analysis.resistance_with(model)
    ends = (grown.resistance.left, grown.resistance.right)
    expected = fresh_linprog(model)
    stands = expected is not None and expected[0] <= AGREED and expected[1] >= -AGREED
    tally.candidates += 1
    tally.standing += stands
    tally.same += all(end.success == stands for end in ends)
    tally.certified += all(map(_is_certified, ends))
    tally.cold += grown.solved_cold
    tally.solvers |= {end.solver for end in ends}
    if stands and expected is not None and grown.resistance.stable:
        for end, sought in zip(ends, (-expected[0], expected[1]), strict=True):
            assert end.alpha is not None  # noqa: S101 - it stands
            tally.difference = max(tally.difference, abs(end.alpha - max(0.0, sought)))


def _is_certified(end: LimitResult) -> bool:
    return end.certificate is not None and end.certificate.holds
