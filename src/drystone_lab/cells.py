"""Figures of walls as cells of tables and as words: medians, pairs of one seed, trends."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import spearmanr

from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.table import Cell

LOWER_IS_BETTER = ("F_AH", "T_LEVEL", "E_FLUSH")
"""Figures of a wall; of all others more is better."""

LEVEL = 0.05
"""What equal chances would give less often than this is no chance."""

COVERED = 1 - LEVEL
"""Share of the draws between the ends of an interval."""

FORMATS = {"placed": ".0f", "F_SF": ".3f", "F_AV": ".1f", "F_AH": ".2f", "F_LR": ".2f"}
"""Figures of a summary, and how the ends of their ranges are written."""

COLUMNS = (
    "walls", "stones",
    *(f"{name}{end}" for name in FORMATS for end in (" median", " range")),
)  # fmt: skip
"""Names of the cells of :func:`summary`; the best of each figure is an end of its range."""

METRICS = ("F_SF", "F_AV", "F_AH", "F_LR")


def summary(outcomes: Sequence[RunOutcome]) -> tuple[Cell, ...]:
    """Return the cells of :data:`COLUMNS` of walls of the same stones; None for what none has."""
    found: list[Cell] = [len(outcomes), outcomes[0].figures["stones"]]
    for name, written in FORMATS.items():
        values = figures_of(outcomes, name)
        found.append(rounded(median_of(values)))
        found.append(f"{min(values):{written}} to {max(values):{written}}" if values else None)
    return tuple(found)


def figures_of(outcomes: Sequence[RunOutcome], name: str) -> list[float]:
    """Return a figure of the walls that have it, in their order."""
    values = (outcome.figures[name] for outcome in outcomes)
    return [float(value) for value in values if value is not None]


def placed_of(outcome: RunOutcome) -> tuple[Cell, Cell]:
    """Return how many stones a wall has, and of how many."""
    return outcome.figures["placed"], outcome.figures["stones"]


def metric_cells(figures: Mapping[str, float | None]) -> tuple[Cell, ...]:
    """Return F_SF, F_AV, F_AH and F_LR of a wall as cells of a table."""
    return tuple(rounded(figures[name]) for name in METRICS)


def rounded(value: float | None, digits: int = 4) -> float | None:
    """Return a number to the decimals that all machines agree on; an integer stays what it is."""
    return None if value is None else round(value, digits)


def in_words(figures: Mapping[str, float | None]) -> str:
    """Write F_SF, F_AV, F_AH and F_LR in a line.

    >>> in_words({"F_SF": 0.8123, "F_AV": 20.0, "F_AH": 2.345, "F_LR": None})
    'F_SF 0.812  F_AV 20.0  F_AH 2.35  F_LR -'
    """
    return "  ".join(
        f"{name} {'-' if figures[name] is None else format(figures[name], FORMATS[name])}"
        for name in METRICS
    )


def median_of(values: Iterable[float | None]) -> float | None:
    """Return the median of the values that there are; None without any.

    >>> median_of([3.0, None, 1.0]), median_of([None])
    (2.0, None)
    """
    found = [value for value in values if value is not None]
    return median(found) if found else None


def differences(first: Sequence[float | None], second: Sequence[float | None]) -> list[float]:
    """Return first minus second of the pairs that have both."""
    pairs = zip(first, second, strict=True)
    return [a - b for a, b in pairs if a is not None and b is not None]


def interval_of(values: NDArray[np.float64], statistic: Callable[..., Any]) -> tuple[float, float]:
    """Return the percentile bootstrap interval of a mean or a median.

    Values are drawn 10 000 times, with the same random numbers every time.
    """
    draws = np.random.default_rng(0).choice(values, (10_000, values.size))
    ends = [(1 - COVERED) / 2, (1 + COVERED) / 2]
    low, high = np.quantile(statistic(draws, axis=1), ends).tolist()
    return low, high


def median_difference(first: Sequence[float | None], second: Sequence[float | None]) -> str | None:
    """Return the median of first minus second and its interval, as a cell; None without a pair.

    >>> median_difference([3.0, 4.0, 9.0], [1.0, 2.5, 7.0])
    '+2 (+1.5 to +2)'
    """
    found = np.array(differences(first, second))
    if not found.size:
        return None
    low, high = interval_of(found, np.median)
    return f"{np.median(found):+.3g} ({low:+.3g} to {high:+.3g})"


SAME = 1e-9
"""Figures that differ by less are equal."""

WINS = ("figure", "better", "equal", "worse", "median difference")
"""Names of the cells of :func:`wins`."""


def wins(
    first: Sequence[float | None], second: Sequence[float | None], figure: str
) -> tuple[Cell, ...]:
    """Return how often one way is better than another, by pairs of one seed.

    Pairs with a None are left out.

    >>> wins([0.8, 0.7, None], [0.7, 0.7, 0.9], "F_SF")
    ('F_SF', 1, 1, 0, 0.05)
    """
    more = [round(each, 12) for each in differences(first, second)]
    sign = -1 if figure in LOWER_IS_BETTER else 1
    better = sum(sign * each > SAME for each in more)
    worse = sum(sign * each < -SAME for each in more)
    return figure, better, len(more) - better - worse, worse, rounded(median_of(more))


@dataclass(frozen=True)
class Trend:
    """Spearman's correlation of the ranks, and the chance of one as large without any relation."""

    rho: float
    p: float
    count: int

    @property
    def clear(self) -> bool:
        """True when chance alone would hardly give it."""
        return self.p < LEVEL

    def words(self) -> str:
        """Return it for a sentence.

        >>> Trend(-0.5, 0.012345, 24).words()
        'rho -0.50, p 0.012, n 24'
        """
        return f"rho {self.rho:.2f}, p {self.p:.2g}, n {self.count}"


def trend(pairs: Sequence[tuple[float, float | None]]) -> Trend | None:
    """Correlate the ranks of two figures; None with few pairs, or where either never changes.

    >>> trend([(1, 2.0), (2, 3.0), (3, 5.0), (4, 4.0), (5, None)])
    Trend(rho=0.8, p=0.2, count=4)
    """
    known = [(x, y) for x, y in pairs if y is not None]
    # Three ranks fall in line by chance too often.
    if len(known) < 4 or any(len({*column}) < 2 for column in zip(*known, strict=True)):
        return None
    found = spearmanr(known)
    return Trend(round(float(found.statistic), 6), float(f"{found.pvalue:.3g}"), len(known))
