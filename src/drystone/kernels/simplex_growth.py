"""Answers and tilts from the last basis of the simplex method.

The twin of `compiled/simplex_growth.pyx`; see :mod:`drystone.kernels.simplex`.
"""

from typing import Final

import numpy as np

from drystone.kernels.simplex_choice import added_up, scattered
from drystone.kernels.simplex_inverse import inverted
from drystone.kernels.simplex_solve import solve
from drystone.kernels.simplex_state import State, joined
from drystone.kernels.simplex_types import (
    ARTIFICIAL,
    OPTIMAL,
    UNSTABLE,
    Added,
    Answer,
    Basis,
    Cones,
    Floats,
    Tilt,
)

ERROR: Final = 1e-11
"""Of the inverse times the basis; above it the inverse is made anew."""


def solve_added_numpy(tilt: Tilt, added: Added, max_pivots: int) -> Answer:
    """Twin of :func:`drystone.kernels.simplex.solve_added`."""
    state = State(tilt, added)
    return _answer(state, solve(state, max_pivots))


def grown_tilt_numpy(tilt: Tilt, added: Added, answer: Answer) -> Tilt:
    """Twin of :func:`drystone.kernels.simplex.grown_tilt`, but for what is native to that."""
    state = State(tilt, added)
    solve(state, answer.pivots + 1)
    return grown_from(tilt, added, answer, _basis(state))


def grown_from(tilt: Tilt, added: Added, answer: Answer, basis: Basis) -> Tilt:
    """Return the tilt of the wall with the stone, which has ended with a basis."""
    cones = joined(tilt.cones, added.cones)
    if len(added.closed):
        stay = np.ones(len(cones.first), bool)
        stay[added.closed] = False
        cones = Cones(
            cones.first[stay], cones.second[stay], np.ascontiguousarray(cones.entries[:, stay])
        )
    weights = np.concatenate((tilt.weights, added.weights))
    return Tilt(tilt.sign, weights, cones, answer.alpha, answer.forces, answer.velocity, basis)


def _answer(state: State, status: int) -> Answer:
    empty = np.empty(0)
    alpha, forces, velocity = np.nan, empty, empty
    if status == OPTIMAL:
        alpha = float(state.tilt.sign * state.levels[state.alpha_place])
        forces = np.zeros(len(state.open))
        forces[state.basic()] = state.levels[state.heads >= 0] * state.unit
        forces = forces[state.open]
        velocity = state.velocity / state.unit
    elif status == UNSTABLE:
        velocity = state.fall
    return Answer(status, alpha, forces, velocity, state.pivots, state.restarts)


def _basis(state: State) -> Basis:
    rows = state.inverse.table()
    cols = np.ascontiguousarray(rows.T)
    if not _error(state, cols) <= ERROR:
        anew = inverted(state.matrix())
        rows = rows if anew is None else anew
        cols = np.ascontiguousarray(rows.T)
    basic = state.basic()
    rates = np.maximum(state.opening(rows[state.alpha_place]), 0.0)
    rates[basic] = 0.0
    number = np.cumsum(state.open) - 1
    heads = state.heads.copy()
    heads[heads >= 0] = number[basic]
    ties = 1.0 + scattered(0, int(state.open.sum()))
    ties[number[basic]] = 0.0
    return Basis(
        unit=state.unit,
        alpha_place=state.alpha_place,
        heads=heads.astype(np.int32),
        levels=added_up(state.rhs[:, None] * cols),
        rows=rows,
        cols=cols,
        rates=rates[state.open],
        ties=ties,
    )


def _error(state: State, cols: Floats) -> float:
    """Return how far the inverse times the basis is from 1."""
    lines = np.concatenate((np.zeros((3, len(cols))), cols))
    product = np.zeros_like(cols)
    columns = np.flatnonzero(state.heads >= 0)
    basic = state.heads[columns]
    for rows, entries in zip(state.at[:, basic], state.cones.entries[:, basic], strict=True):
        product[columns] += entries[:, None] * lines[rows]
    product[state.alpha_place] = added_up(state.live[:, None] * cols)
    artificial = np.flatnonzero(state.heads <= ARTIFICIAL)
    product[artificial] = cols[ARTIFICIAL - state.heads[artificial]]
    product[np.diag_indices(len(cols))] -= 1.0
    return float(np.abs(product).max(initial=0.0))
