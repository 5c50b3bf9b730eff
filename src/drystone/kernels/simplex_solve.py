"""One tilt of a wall with a stone, from the optimal basis of the wall.

The twin of the first half of `compiled/simplex.pyx`; see :mod:`drystone.kernels.simplex`.
"""

from typing import Final

import numpy as np

from drystone.kernels.simplex_choice import (
    LARGE_PIVOT,
    PLACE_SEED,
    SMALL_PIVOT,
    blocking,
    entering,
    leaving,
    scattered,
)
from drystone.kernels.simplex_start import GOING_ON, start
from drystone.kernels.simplex_state import State
from drystone.kernels.simplex_types import FAILED, OPTIMAL, UNSTABLE

LOST: Final = -2
"""Status where the inverse has lost its digits."""

ROUNDS: Final = 6
DRIFT: Final = 1e-8
"""By which a pivot may differ between its row and its column."""


def solve(state: State, max_pivots: int) -> int:
    """Run to the end and return the status."""
    status = start(state)
    for _ in range(ROUNDS):
        if status != GOING_ON:
            break
        status = _round(state, max_pivots)
        if status == LOST:
            sound = state.renewed_inverse() and state.take_levels() and state.take_rates()
            status = GOING_ON if sound else FAILED
    return FAILED if status == GOING_ON else status


def _round(state: State, max_pivots: int) -> int:
    """Bring the levels within bounds, then make the mechanism admissible, then look at both."""
    status = _let_down(state, max_pivots)
    if status != GOING_ON:
        return status
    if not (state.take_levels() and state.take_rates()):
        return LOST
    state.pivot = SMALL_PIVOT
    if not state.within_bounds():
        return GOING_ON
    if state.admissible():
        return OPTIMAL
    return _make_admissible(state, max_pivots)


def _let_down(state: State, max_pivots: int) -> int:
    """Give the stone its weight little by little: the dual simplex method.

    Rates below 0 count as 0: that shifts costs, for :func:`_make_admissible` to put right.
    """
    state.set_steps()
    state.rates = np.maximum(state.rates, 0.0)
    while True:
        place = leaving(state.levels, state.steps, state.fixed, state.alpha_place)
        if place < 0:
            state.reference = state.levels.copy()
            return GOING_ON
        if state.pivots >= max_pivots:
            return FAILED
        row = state.inverse.row(place)
        slopes = state.slopes(row)
        above = state.levels[place] > 0.0
        falling = slopes if above else -slopes
        number = entering(falling, state.rates, state.ties, LARGE_PIVOT)
        if number < 0:
            if state.falls(-row if above else row):
                return UNSTABLE
            number = entering(falling, state.rates, state.ties, SMALL_PIVOT)
        if number < 0:
            return LOST
        column = state.column(number)
        if not abs(column[place] - slopes[number]) <= DRIFT * (1.0 + abs(slopes[number])):
            return LOST
        state.dual_step(place, slopes, number, column)


def _make_admissible(state: State, max_pivots: int) -> int:
    """Exchange columns that the mechanism closes: the primal simplex method."""
    ties = 0.5 + scattered(PLACE_SEED, len(state.levels))
    while not state.admissible():
        if state.pivots >= max_pivots:
            return FAILED
        number = int(np.argmin(state.rates))
        column = state.column(number)
        place = blocking(column, state.levels, ties, state.fixed, state.alpha_place, state.pivot)
        if place < 0:
            return FAILED
        step = max(ties[place], 0.0) / column[place]
        ties -= step * column
        ties[place] = step
        state.exchange(place, column, number)
        if not state.take_rates():
            return LOST
    state.reference = state.levels.copy()
    return GOING_ON
