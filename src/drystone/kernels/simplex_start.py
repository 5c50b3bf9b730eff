"""Where a tilt with a stone starts: the mechanism of the wall, extended to the stone.

The twin of `compiled/simplex_start.pyx`; see :mod:`drystone.kernels.simplex`.
"""

from typing import Final

import numpy as np

from drystone.kernels.simplex_choice import LARGE_PIVOT, entering
from drystone.kernels.simplex_small import FOUND, NO_FORCES, SmallAnswer, solve_small
from drystone.kernels.simplex_state import State
from drystone.kernels.simplex_types import ALPHA, ARTIFICIAL, FAILED, UNSTABLE, Floats

GOING_ON: Final = -1
"""Status of what has not ended."""

START_PIVOT: Final = 1e-7


def start(state: State) -> int:
    """Begin with rates that are not below 0, or make them so by force."""
    wall = len(state.tilt.weights) > 0
    if not state.added.weights.size and not wall:
        return FAILED
    mechanism = _begin(state)
    if not state.added.weights.size:
        return GOING_ON
    small = _small_program(state)
    if small.status == NO_FORCES and state.falls(_extended(state, small.fall, mechanism)):
        return UNSTABLE
    if small.status == FOUND and _take_over(state, small):
        return GOING_ON
    if not wall:
        return FAILED
    state.restarts += 1
    state.reopen()
    _begin(state)
    return GOING_ON


def _begin(state: State) -> Floats:
    """Clear the basis of the wall of closed columns; return the mechanism that it then has."""
    if not state.inverse.old:
        return np.zeros(len(state.rhs))
    _expel_closed(state)
    mechanism = state.inverse.row(state.alpha_place)
    state.rates[state.old_columns :] = state.opening(mechanism, state.old_columns)
    return mechanism


def _expel_closed(state: State) -> None:
    """Exchange what is closed for other columns of the wall, or for an artificial force."""
    closed = (state.heads >= 0) & state.fixed
    for place in np.flatnonzero(closed).tolist():
        row = state.inverse.row(place)
        slopes = state.slopes(row)
        slopes[state.old_columns :] = 0.0
        falling = slopes if state.levels[place] > 0.0 else -slopes
        number = entering(falling, state.rates, state.ties, LARGE_PIVOT)
        if number >= 0:
            state.dual_step(place, slopes, number, state.column(number))
            continue
        force = int(np.argmax(np.abs(row[: state.inverse.old])))
        column = state.inverse.times(np.array([force]), np.ones(1))
        state.exchange(place, column, ARTIFICIAL - force)


def _small_program(state: State) -> SmallAnswer:
    """Solve for the forces on the new bodies, with alpha eliminated.

    On a wall alpha is eliminated by the row in which it is basic: a column costs what it takes
    from alpha, and one more column takes 1 from alpha and does nothing else.  Without a wall it
    is eliminated by the first row.
    """
    old, count = state.inverse.old, len(state.open) - state.old_columns
    columns = np.zeros((len(state.rhs) - old, count))
    at = state.at[:, state.old_columns :] - 3 - old
    entries = state.cones.entries[:, state.old_columns :]
    for rows, values in zip(at, entries, strict=True):
        new = np.flatnonzero(rows >= 0)
        columns[rows[new], new] = values[new]
    live, rhs = state.live[old:], state.levels[old:]
    if old:
        costs = state.rates[state.old_columns :]
        columns[::3] -= live[::3, None] * costs
        return solve_small(np.column_stack((columns, -live)), rhs, np.append(costs, 1.0))
    costs = columns[0] / live[0]
    columns[3::3] -= live[3::3, None] * costs
    return solve_small(columns[1:], rhs[1:], costs)


def _extended(state: State, fall: Floats, mechanism: Floats) -> Floats:
    """Extend a fall of the new bodies: on the whole of it the live load does no work."""
    old = state.inverse.old
    if old:
        work = np.cumsum(state.live[old:] * fall)[-1]
        return np.concatenate((-work * mechanism[:old], fall))
    fall = np.concatenate((np.zeros(1), fall))
    fall[0] = -np.cumsum(state.live * fall)[-1] / state.live[0]
    return fall


def _take_over(state: State, small: SmallAnswer) -> bool:
    """Put the basis of the small program into the places of the artificial forces."""
    wall = state.inverse.old > 0
    columns = len(state.open) - state.old_columns
    if not wall:
        state.alpha_place = _take(state, state.inverse.applied(state.live), ALPHA)
        if state.alpha_place < 0:
            return False
    for head in small.heads.tolist():
        number = state.old_columns + head
        if head < columns and _take(state, state.column(number), number) < 0:
            return False
    old = slice(state.old_columns)
    if wall and columns in small.heads:
        if not _take_bearing(state):
            return False
        state.rates[old] = 0.0
    elif wall:
        state.rates[old] *= small.costs[columns]
    state.rates[state.old_columns :] = small.costs[:columns]
    basic = state.basic()
    state.rates[basic] = 0.0
    state.ties[basic] = 0.0
    return True


def _take_bearing(state: State) -> bool:
    """Let a column of the wall bear what is left: the new bodies move and the wall rests."""
    old = slice(state.old_columns)
    slopes = np.where(state.open[old], state.rates[old], 0.0)
    number = entering(slopes, np.zeros(len(slopes)), state.ties[old], LARGE_PIVOT)
    if number < 0 or _take(state, state.column(number), number) < 0:
        return False
    state.ties[old] -= max(state.ties[number], 0.0) / slopes[number] * slopes
    return True


def _take(state: State, column: Floats, head: int) -> int:
    """Exchange the artificial force on a new body that gives the largest pivot; -1 if none."""
    old = state.inverse.old
    size = np.where(state.fixed[old:], np.abs(column[old:]), 0.0)
    place = old + int(np.argmax(size))
    if not size[place - old] > START_PIVOT:
        return -1
    state.exchange(place, column, head)
    return place
