"""What two methods differ by, from pairs of results with the same seed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

RESAMPLES = 10_000
"""Draws of the bootstrap."""

COVERED = 0.95
"""Share of the draws between the ends of an interval."""


@dataclass(frozen=True)
class Difference:
    """What one method has more than another."""

    median: float  # Of the differences of all pairs
    low: float  # low, high: Ends of its interval
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
    """Return the median difference between pairs, with its percentile bootstrap interval.

    >>> median_difference([3.0, 4.0, 9.0], [1.0, 2.0, 7.0])
    Difference(median=2.0, low=2.0, high=2.0, pairs=3)
    """
    pairs = zip(first, second, strict=True)
    found = np.array([a - b for a, b in pairs if a is not None and b is not None])
    if not found.size:
        return None
    rng = np.random.default_rng(0)
    medians = np.median(rng.choice(found, (RESAMPLES, found.size)), axis=1)
    low, high = np.quantile(medians, [(1 - COVERED) / 2, (1 + COVERED) / 2]).tolist()
    return Difference(float(np.median(found)), low, high, found.size)
