"""What methods came to on walls."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from types import MappingProxyType

from drystone_lab.runs.outcome import Outcome
from drystone_lab.walls import Target

PLACED = "placed"
SHAKE = "PGA"

HIGHER_IS_BETTER: Mapping[str, bool] = MappingProxyType(
    {PLACED: True, "F_SF": True, "F_AV": True, "F_AH": False, "F_LR": True, SHAKE: True}
)
"""The figures that are compared: share of the stones that is placed, the paper's four, and the
amplitude that a wall stands on a shaking table, in g, where it was shaken."""

FIGURES = tuple(name for name in HIGHER_IS_BETTER if name != SHAKE)
"""Of walls that were not shaken."""

DECIMALS = 9
"""Values that agree so far are equal: they differ by rounding errors of sums."""


@dataclass(frozen=True, eq=False)
class Result:
    """A wall that a method built.

    Parameters
    ----------
    wall : Target
        What was to be built.
    method : str
        Name of the method.
    seed : int
        Of the plan.
    figures : dict of str to float or None
        By the names of :data:`HIGHER_IS_BETTER`; None where a figure is not defined, such as F_LR
        of a wall that could not be analysed.
    seconds : float
        From the stones to the last step.
    """

    wall: Target
    method: str
    seed: int
    figures: Mapping[str, float | None]
    seconds: float

    @classmethod
    def of(cls, wall: Target, method: str, seed: int, outcome: Outcome) -> "Result":
        """Take the figures of an outcome."""
        found = outcome.figures
        figures: dict[str, float | None] = {name: found[name] for name in FIGURES[1:]}
        placed, stones = found["placed"], found["stones"]
        figures[PLACED] = None if placed is None or not stones else placed / stones
        return cls(wall, method, seed, figures, outcome.times["wall"])


@dataclass(frozen=True, eq=False)
class Results:
    """Results of every method on every wall with every seed.

    Parameters
    ----------
    all : tuple of Result
        Of each method on each wall for the same seeds.
    """

    all: tuple[Result, ...]

    @property
    def walls(self) -> tuple[Target, ...]:
        """Walls, in order."""
        return tuple(dict.fromkeys(result.wall for result in self.all))

    @property
    def methods(self) -> tuple[str, ...]:
        """Methods, in order."""
        return tuple(dict.fromkeys(result.method for result in self.all))

    @property
    def figures(self) -> tuple[str, ...]:
        """Figures that walls have."""
        shaken = any(SHAKE in result.figures for result in self.all)
        return (*FIGURES, SHAKE) if shaken else FIGURES

    def of(self, method: str, wall: Target | None = None) -> tuple[Result, ...]:
        """Return the results of a method on a wall or on all, in one order for all methods."""
        found = [r for r in self.all if r.method == method and wall in (None, r.wall)]
        order = {known: number for number, known in enumerate(self.walls)}
        return tuple(sorted(found, key=lambda result: (order[result.wall], result.seed)))

    def values(
        self, method: str, figure: str, wall: Target | None = None
    ) -> tuple[float | None, ...]:
        """Return a figure of the results of a method, as :meth:`of` orders them."""
        return tuple(result.figures[figure] for result in self.of(method, wall))

    def counting(self, one: str, other: str) -> tuple[bool, ...]:
        """Say which results of two methods, as :meth:`of` orders them, count as pairs.

        On a wall where neither method depends on the seed all pairs are copies of one, which
        counts once: they are no more evidence than it.
        """
        counts: list[bool] = []
        pairs = zip(self.of(one), self.of(other), strict=True)
        for _, group in groupby(pairs, key=lambda pair: pair[0].wall):
            figures = [(_rounded(first), _rounded(second)) for first, second in group]
            copies = len(set(figures)) == 1
            counts += [number == 0 or not copies for number in range(len(figures))]
        return tuple(counts)


def _rounded(result: Result) -> tuple[float | None, ...]:
    """Return the figures without the rounding errors of sums."""
    figures = (result.figures[name] for name in sorted(result.figures))
    return tuple(None if value is None else round(value, DECIMALS) for value in figures)


def best_of(values: Sequence[float], figure: str) -> float:
    """Return the best of at least one value of a figure."""
    return max(values) if HIGHER_IS_BETTER[figure] else min(values)
