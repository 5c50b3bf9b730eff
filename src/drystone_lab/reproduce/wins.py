"""How often one way to build is better than another, wall by wall from the same seeds."""

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from drystone_lab.reproduce.summary import METRICS, rounded
from drystone_lab.reproduce.trials import Trials
from drystone_lab.table import Cell

LOWER_IS_BETTER = ("F_AH", "T_LEVEL", "E_FLUSH")

SAME = 1e-9
"""Figures that differ by less are equal."""

COLUMNS = ("figure", "better", "equal", "worse", "median difference")


@dataclass(frozen=True)
class Wins:
    """Pairs of walls, the first against the second.

    Parameters
    ----------
    better, equal, worse : int
        How many.
    median_difference : float or None
        First minus second; None without a pair.
    """

    better: int
    equal: int
    worse: int
    median_difference: float | None

    @property
    def pairs(self) -> int:
        """How many there are."""
        return self.better + self.equal + self.worse

    @property
    def is_majority(self) -> bool:
        """True when the first is better in more than half of all pairs."""
        return 2 * self.better > self.pairs

    def cells(self, figure: str) -> tuple[Cell, ...]:
        """Return the cells of :data:`COLUMNS`."""
        return figure, self.better, self.equal, self.worse, rounded(self.median_difference)


def wins(first: Sequence[float | None], second: Sequence[float | None], figure: str) -> Wins:
    """Compare figures in pairs; those with a None are left out.

    Examples
    --------
    >>> wins([0.8, 0.7, None], [0.7, 0.7, 0.9], "F_SF")
    Wins(better=1, equal=1, worse=0, median_difference=0.05)
    """
    pairs = zip(first, second, strict=True)
    more = [round(a - b, 12) for a, b in pairs if a is not None and b is not None]
    sign = -1 if figure in LOWER_IS_BETTER else 1
    better = sum(sign * each > SAME for each in more)
    worse = sum(sign * each < -SAME for each in more)
    return Wins(better, len(more) - better - worse, worse, median(more) if more else None)


def wins_of(first: Sequence[Trials], second: Sequence[Trials], figure: str) -> Wins:
    """Compare all walls of some trials with those of others, of the same sets and seeds."""
    ours = [value for each in first for value in each.values(figure)]
    others = [value for each in second for value in each.values(figure)]
    return wins(ours, others, figure)


def by_way(trials: Sequence[Trials], way: str) -> list[Trials]:
    """Return the trials of one way, in the order of the sets."""
    return [each for each in trials if each.way == way]


def wins_rows(
    trials: Sequence[Trials], way: str, others: Sequence[str]
) -> tuple[tuple[Cell, ...], ...]:
    """Return rows of the other way and :data:`COLUMNS`: one way against others, by figure."""
    ours = by_way(trials, way)
    return tuple(
        (other, *wins_of(ours, by_way(trials, other), figure).cells(figure))
        for other in others
        for figure in METRICS
    )
