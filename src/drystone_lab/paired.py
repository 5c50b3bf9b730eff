"""Medians of results, and what two methods differ by, from pairs of results with the same seed."""

from collections.abc import Callable, Iterable, Sequence
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

LOWER_IS_BETTER = ("F_AH", "T_LEVEL", "E_FLUSH")
"""Figures of a wall; of all others more is better."""

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

    Values are drawn 10 000 times, with the same random numbers every time.
    """
    draws = np.random.default_rng(0).choice(values, (10_000, values.size))
    ends = [(1 - COVERED) / 2, (1 + COVERED) / 2]
    low, high = np.quantile(statistic(draws, axis=1), ends).tolist()
    return low, high


def median_difference(first: Sequence[float | None], second: Sequence[float | None]) -> str | None:
    """Return the median of first minus second and its interval, as a cell of a table.

    Pairs with a None are left out; None without any.

    >>> median_difference([3.0, 4.0, 9.0], [1.0, 2.5, 7.0])
    '+2 (+1.5 to +2)'
    """
    pairs = zip(first, second, strict=True)
    found = np.array([a - b for a, b in pairs if a is not None and b is not None])
    if not found.size:
        return None
    low, high = interval_of(found, np.median)
    return f"{np.median(found):+.3g} ({low:+.3g} to {high:+.3g})"
