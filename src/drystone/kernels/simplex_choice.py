"""Choices of the simplex method, with rules for ties that leave nothing to chance.

The twin of `compiled/simplex_choice.pyx`; see :mod:`drystone.kernels.simplex`.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.simplex_types import Floats

Flags = NDArray[np.bool_]

INFEASIBLE: Final = 1e-10
"""Smallest force, in weights, by which a level has to be out of bounds to leave the basis."""
LARGE_PIVOT: Final = 1e-6
SMALL_PIVOT: Final = 1e-9
"""Pivots are larger than the first, or than the second where there are none or they led astray:
what is not looked at can leave its bounds by a millionth of a step."""
SLACK: Final = 1e-10
TIE_SLACK: Final = 1e-1
"""What a ratio may be missed by, so that a large pivot can be taken."""

PLACE_SEED: Final = 1 << 28
START_SEED: Final = 1 << 29
"""Where the numbers for places in the basis and for the start begin; columns begin at 0."""


def scattered(seed: int, count: int) -> Floats:
    """Return fixed numbers in [0, 1) without pattern, the same ones on every machine.

    Parameters
    ----------
    seed : int
        Number of the first one.
    count : int
        How many.

    Notes
    -----
    The finaliser of SplitMix64 (Steele, Lea & Flood, 2014) of the number of the number.
    """
    bits = np.arange(seed + 1, seed + 1 + count, dtype=np.uint64)
    bits *= np.uint64(0x9E3779B97F4A7C15)
    bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    bits ^= bits >> np.uint64(31)
    return np.asarray((bits >> np.uint64(11)) * 2.0**-53, np.float64)


def added_up(terms: Floats) -> Floats:
    """Return the sum of the rows of a table, one after the other."""
    if terms.shape[1] > 1:
        return np.asarray(terms.sum(axis=0))
    return np.asarray(np.cumsum(terms, axis=0)[-1])  # NumPy sums a single column in another order


def leaving(levels: Floats, steps: Floats, fixed: Flags, alpha_place: int) -> int:
    """Return the place that stays out of bounds longest as the stone is let down; -1 if none is.

    Parameters
    ----------
    levels : (M,) float array
        What is basic; to be not below 0, or 0 where it is fixed.
    steps : (M,) float array
        ``levels + m * steps`` is within bounds for m = 1; the stone is let down as m goes to 0.
    fixed : (M,) bool array
        Places of columns that are closed and of artificial forces.
    alpha_place : int
        Alpha has no bounds.
    """
    excess = np.where(fixed, np.abs(levels), -levels)
    excess[alpha_place] = 0.0
    out = excess > INFEASIBLE
    towards = np.where(fixed & (levels > 0.0), -steps, steps)
    reach = np.full(len(levels), 1e30)
    np.divide(excess, towards, out=reach, where=towards > 1e-14)
    reach[~out] = 0.0
    place = int(np.argmax(reach))
    return place if out[place] else -1


def entering(slopes: Floats, rates: Floats, ties: Floats, pivot: float) -> int:
    """Return the column with the smallest ratio of rate to slope, then of tie cost; -1 if none.

    Two ratio tests with tolerances (Harris, 1973), one for the costs and one among those that
    are equal; of what is left the largest slope, which is the pivot, then the first column.

    Parameters
    ----------
    slopes : (N,) float array
        What the rates lose; only positive ones count.
    rates, ties : (N,) float arrays
        Reduced costs and second reduced costs.
    pivot : float
        Slopes are to be larger.
    """
    columns = np.flatnonzero(slopes > pivot)
    if not columns.size:
        return -1
    slope = slopes[columns]
    chosen = _within(slope, rates[columns], SLACK)
    columns, slope = columns[chosen], slope[chosen]
    chosen = _within(slope, ties[columns], TIE_SLACK)
    columns, slope = columns[chosen], slope[chosen]
    return int(columns[np.argmax(slope)])


def _within(slope: Floats, costs: Floats, slack: float) -> Flags:
    """Say which ratios of costs to slope are not above the least one of costs plus slack."""
    costs = np.maximum(costs, 0.0)
    ratios = (costs + slack) / slope
    first = int(np.argmin(ratios))
    chosen = np.asarray(costs <= ratios[first] * slope)
    chosen[first] = True  # also where it is so large that the slack is lost
    return chosen


def blocking(
    column: Floats, levels: Floats, ties: Floats, fixed: Flags, alpha_place: int, pivot: float
) -> int:
    """Return the place that a growing column empties first; -1 if it can grow for ever.

    Parameters
    ----------
    column : (M,) float array
        What the levels lose.
    levels, ties : (M,) float arrays
        Levels, and second levels that choose among equals.
    fixed : (M,) bool array
        Places that cannot change at all.
    alpha_place : int
        Alpha has no bounds.
    pivot : float
        What is emptied is emptied faster.
    """
    stuck = np.flatnonzero(fixed & (np.abs(column) > pivot))
    if stuck.size:
        return int(stuck[np.argmax(np.abs(column[stuck]))])
    falling = (column > pivot) & ~fixed
    falling[alpha_place] = False
    places = np.flatnonzero(falling)
    if not places.size:
        return -1
    slope = column[places]
    chosen = _within(slope, levels[places], SLACK)
    places, slope = places[chosen], slope[chosen]
    chosen = _within(slope, ties[places], TIE_SLACK)
    places, slope = places[chosen], slope[chosen]
    return int(places[np.argmax(slope)])
