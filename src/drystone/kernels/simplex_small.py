"""The small program of a new stone: how it stands on a wall that moves as it would without it.

The twin of `compiled/simplex_small.pyx`; see :mod:`drystone.kernels.simplex`.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from drystone.kernels.simplex_choice import START_SEED, Flags, added_up, scattered
from drystone.kernels.simplex_types import Floats, Ints

FOUND: Final = 0
NO_FORCES: Final = 1
NO_BOUND: Final = 2
LOST: Final = 3

ENTERS: Final = -1e-11
PIVOT: Final = 1e-9
ARTIFICIAL_PIVOT: Final = 1e-7
HELD_UP: Final = 1e-9
LIFT: Final = 1e-6


@dataclass(frozen=True, eq=False)
class SmallAnswer:
    """Answer to: minimise costs . x for columns x = rhs, x >= 0.

    Parameters
    ----------
    status : int
        FOUND, NO_FORCES (no x at all), NO_BOUND or LOST (gave up).
    heads : (R,) int array
        What is basic in each row: a column, or the number of columns for an artificial force.
    costs : (C,) float array
        Reduced costs.
    fall : (R,) float array
        For NO_FORCES: w with w . column >= 0 for all columns and w . rhs < 0.
    """

    status: int
    heads: Ints
    costs: Floats
    fall: Floats


def solve_small(columns: Floats, rhs: Floats, costs: Floats) -> SmallAnswer:
    """Solve a small linear program by the primal simplex method on a whole tableau.

    Parameters
    ----------
    columns : (R, C) float array
        A few rows.
    rhs : (R,) float array
        Right-hand side.
    costs : (C,) float array
        Costs.
    """
    rows, count = columns.shape
    # A little of every column on the right-hand side: no ties, and no x is lost by it.
    lift = LIFT * (0.5 + scattered(START_SEED, count))
    lifted = added_up(np.concatenate((rhs[None], lift[:, None] * columns.T))) if rows else rhs
    flip = np.where(lifted < 0.0, -1.0, 1.0)
    tableau = np.zeros((rows + 2, count + rows + 1))
    tableau[:rows, :count] = flip[:, None] * columns
    tableau[np.arange(rows), count + np.arange(rows)] = 1.0
    tableau[:rows, -1] = flip * lifted
    for row in tableau[:rows]:
        tableau[rows, :count] -= row[:count]
        tableau[rows, -1] -= row[-1]
    tableau[rows + 1, :count] = costs
    heads = np.full(rows, count, np.int32)
    status = _improve(tableau, heads, count)
    missing, reduced = tableau[rows], tableau[rows + 1, :count]
    if status == FOUND and -missing[-1] > HELD_UP:
        status = NO_FORCES
    # The artificial forces cost 1 each, and their reduced costs are 1 - y.
    fall = (missing[count : count + rows] - 1.0) * flip
    return SmallAnswer(status, heads, reduced, fall)


def _improve(tableau: Floats, heads: Ints, count: int) -> int:
    """Pivot until no column improves the artificial forces or, as they are gone, the costs."""
    rows = len(heads)
    patience = 20 + 10 * rows
    for step in range(6 * patience):
        column = _next_column(tableau, rows, count, first=step > patience)
        if column < 0:
            return FOUND
        row = _next_row(tableau[:rows, column], tableau[:rows, -1], heads == count)
        if row < 0:
            return NO_BOUND
        _pivot(tableau, row, column)
        heads[row] = column
    return LOST


def _next_column(tableau: Floats, rows: int, count: int, *, first: bool) -> int:
    """Return the column of the steepest descent, or the first one that descends; -1 if none."""
    costs = tableau[rows, :count]
    if not (costs < ENTERS).any():
        if -tableau[rows, -1] > HELD_UP:
            return -1
        costs = np.where(costs <= -ENTERS, tableau[rows + 1, :count], 0.0)
    descends = costs < ENTERS
    if not descends.any():
        return -1
    return int(np.argmax(descends) if first else np.argmin(costs))


def _next_row(column: Floats, levels: Floats, artificial: Flags) -> int:
    """Return the row that is emptied first, the largest pivot among equals; -1 if none is."""
    levels = np.maximum(levels, 0.0)
    stuck = artificial & (levels <= HELD_UP) & (np.abs(column) > ARTIFICIAL_PIVOT)
    if stuck.any():
        return int(np.argmax(np.where(stuck, np.abs(column), 0.0)))
    falling = np.flatnonzero(column > PIVOT)
    if not falling.size:
        return -1
    slope, level = column[falling], levels[falling]
    least = ((level + 1e-12) / slope).min()
    return int(falling[np.argmax(np.where(level <= least * slope, slope, 0.0))])


def _pivot(tableau: Floats, row: int, column: int) -> None:
    tableau[row] /= tableau[row, column]
    factors = tableau[:, column].copy()
    factors[row] = 0.0
    tableau -= factors[:, None] * tableau[row]
