"""Medians of results, and what two methods differ by, from pairs of results with the same seed."""

from collections.abc import Callable, Iterable, Sequence
from statistics import median
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

LOWER_IS_BETTER = ("F_AH", "T_LEVEL", "E_FLUSH")
"""Figures of a wall; of all others more is better."""

RESAMPLES = 10_000
"""Draws of the bootstrap."""

COVERED = 0.95
"""Share of the draws between the ends of an interval."""


def median_of(values: Iterable[float | None]) -> float | None:
    """Return the median of the values that there are; None without any.

    >>> median_of([3.0, None, 1.0]), median_of([None])
    (2.0, None)
    """
    found = [value for value in values if value is not None]
    return median(found) if found else None


def interval_of(values: NDArray[np.float64], statistic: Callable[..., Any]) -> tuple[float, float]:
    """Return the percentile bootstrap interval of a mean or a median.

    Values are drawn with the same random numbers every time.
    """
    draws = np.random.default_rng(0).choice(values, (RESAMPLES, values.size))
    ends = [(1 - COVERED) / 2, (1 + COVERED) / 2]
    low, high = np.quantile(statistic(draws, axis=1), ends).tolist()
    return low, high


class Difference(NamedTuple):
    """What one method has more than another: the median of all pairs, and its interval."""

    median: float
    low: float
    high: float
    pairs: int

    def text(self) -> str:
        """Return it as a cell of a table.

        >>> Difference(0.25, -0.5, 1.0, 6).text()
        '+0.25 (-0.5 to +1)'
        """
        return f"{self.median:+.3g} ({self.low:+.3g} to {self.high:+.3g})"


def median_difference(
    first: Sequence[float | None], second: Sequence[float | None]
) -> Difference | None:
    """Return the median of first minus second; pairs with a None are left out, None without any.

    >>> median_difference([3.0, 4.0, 9.0], [1.0, 2.0, 7.0])
    Difference(median=2.0, low=2.0, high=2.0, pairs=3)
    """
    pairs = zip(first, second, strict=True)
    found = np.array([a - b for a, b in pairs if a is not None and b is not None])
    if not found.size:
        return None
    return Difference(float(np.median(found)), *interval_of(found, np.median), found.size)
