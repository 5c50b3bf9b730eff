"""The state of the simplex method on the program of a wall with a stone.

The twin of `compiled/simplex_state.pyx`; see :mod:`drystone.kernels.simplex`.
"""

from dataclasses import replace
from math import frexp
from typing import Final

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.simplex_choice import LARGE_PIVOT, PLACE_SEED, added_up, scattered
from drystone.kernels.simplex_inverse import BorderedInverse, inverted
from drystone.kernels.simplex_types import ALPHA, ARTIFICIAL, Added, Cones, Floats, Tilt

Places = NDArray[np.intp]

FAULTLESS: Final = 1e-11
"""Larger errors of the forces on a body, in weights, are corrected once."""
RESIDUAL: Final = 1e-10
INADMISSIBLE: Final = 1e-10
"""Largest errors of an answer: of forces on a body, of velocities over the largest one."""
VIOLATION: Final = 2e-10
"""Largest force by which an answer may be out of bounds."""
FALL: Final = 1e-9
"""Largest rate at which a fall may close a contact, over its largest velocity."""
LITTLE: Final = 1e-2
"""Of a weight: about what all levels are lifted by while the stone is let down."""


class State:
    """A basis of the program, what follows from it, and what led to it.

    Parameters
    ----------
    tilt : Tilt
        Of the wall; not changed.
    added : Added
        The stone.
    """

    def __init__(self, tilt: Tilt, added: Added) -> None:
        _check(tilt, added)
        self.tilt, self.added = tilt, added
        self.unit = unit_of(tilt, added)
        weights = np.concatenate((tilt.weights, added.weights)) / self.unit
        self.rhs = np.zeros(3 * len(weights))
        self.rhs[1::3] = weights
        self.live = np.zeros(3 * len(weights))
        self.live[::3] = tilt.sign * weights
        self.cones = joined(tilt.cones, added.cones)
        self.at = rows_of(self.cones)
        self.old_columns = len(tilt.cones.first)
        self.open = np.ones(len(self.cones.first), bool)
        self.open[added.closed] = False
        self.pivots = self.restarts = 0
        self.renewed = False
        self.pivot = LARGE_PIVOT
        self.speed = 1.0
        self.fall = np.empty(0)
        self.reopen()

    def reopen(self) -> None:
        """Begin with the basis of the wall, bordered by artificial forces on the new bodies."""
        basis = self.tilt.basis
        old = len(basis.heads)
        more = len(self.open) - self.old_columns
        artificial = ARTIFICIAL - np.arange(old, len(self.rhs))
        self.inverse = BorderedInverse(basis, self.live[old:])
        self.alpha_place = basis.alpha_place
        self.heads = np.concatenate((basis.heads.astype(np.intp), artificial))
        self.fixed = self.heads <= ARTIFICIAL
        self.fixed[self.heads >= 0] = ~self.open[self.basic()]
        self.levels = np.concatenate((basis.levels, self.rhs[old:]))
        if old:
            self.levels[old:] -= self.live[old:] * basis.levels[basis.alpha_place]
        # A stone without weight changes nothing.
        self.reference = np.concatenate((basis.levels, np.zeros(len(artificial))))
        self.steps = np.zeros(len(self.levels))
        self.rates = np.concatenate((basis.rates, np.zeros(more)))
        self.ties = np.concatenate((basis.ties, 1.0 + scattered(self.old_columns, more)))

    def basic(self) -> Places:
        """Return the columns that are basic."""
        return self.heads[self.heads >= 0]

    def opening(self, velocity: Floats, first: int = 0) -> Floats:
        """Return the rates at which a motion opens the columns, from a number on."""
        moving = np.concatenate((np.zeros(3), velocity))
        return added_up(moving[self.at[:, first:]] * self.cones.entries[:, first:])

    def slopes(self, row: Floats) -> Floats:
        """Return the products of a row of the inverse with what may enter the basis."""
        slopes = self.opening(row)
        slopes[self.basic()] = 0.0
        slopes[~self.open] = 0.0
        return slopes

    def column(self, number: int) -> Floats:
        """Return the inverse times a column."""
        rows = self.at[:, number] - 3
        moves = rows >= 0
        return self.inverse.times(rows[moves], self.cones.entries[moves, number])

    def exchange(self, place: int, column: Floats, head: int) -> None:
        """Put something into a place of the basis; `column` is the inverse times it."""
        self.inverse.exchange(place, column)
        _exchange(self.levels, place, column)
        _exchange(self.steps, place, column)
        self.heads[place] = head
        self.fixed[place] = head <= ARTIFICIAL
        self.pivots += 1

    def dual_step(self, place: int, slopes: Floats, number: int, column: Floats) -> None:
        """Put a column into a place of the basis and keep all rates from falling below 0."""
        head = int(self.heads[place])
        _reduce(self.rates, number, slopes, head)
        _reduce(self.ties, number, slopes, head)
        self.exchange(place, column, number)

    def set_steps(self) -> None:
        """Let the levels come from a state within bounds, with a little more everywhere."""
        little = LITTLE * (0.1 + scattered(PLACE_SEED, len(self.levels)))
        start = np.maximum(self.reference, 0.0) + little
        self.steps = np.where(self.fixed, -self.levels, start - self.levels)
        self.steps[self.alpha_place] = 0.0

    def take_rates(self) -> bool:
        """Compute the mechanism and its rates; False when the inverse has lost its digits."""
        self.velocity = self.inverse.row(self.alpha_place)
        self.speed = max(1.0, float(np.abs(self.velocity).max()))
        self.rates = self.opening(self.velocity)
        basic = self.basic()
        drift = float(np.abs(self.rates[basic]).max(initial=0.0))
        self.rates[basic] = 0.0
        self.rates[~self.open] = 0.0
        return drift <= INADMISSIBLE * self.speed

    def take_levels(self) -> bool:
        """Compute the levels; False when the inverse has lost its digits."""
        old = self.inverse.old
        self.levels = self.inverse.applied(np.concatenate((self.inverse.levels, self.rhs[old:])))
        rest = self.unbalanced()
        if not np.abs(rest).max() <= FAULTLESS:
            self.levels += self.inverse.times_all(rest)
            rest = self.unbalanced()
        return bool(np.abs(rest).max() <= RESIDUAL)

    def unbalanced(self) -> Floats:
        """Return what is missing from the equations."""
        columns = self.heads >= 0
        basic = self.heads[columns]
        shares = self.cones.entries[:, basic] * self.levels[columns]
        total = np.bincount(
            self.at[:, basic].T.ravel(), shares.T.ravel(), minlength=3 + len(self.rhs)
        )
        held = self.live * self.levels[self.alpha_place] + total[3:]
        artificial = np.flatnonzero(self.heads <= ARTIFICIAL)
        held[ARTIFICIAL - self.heads[artificial]] += self.levels[artificial]
        return np.asarray(self.rhs - held)

    def within_bounds(self) -> bool:
        """Say whether no level is out of bounds by more than rounding."""
        excess = np.where(self.fixed, np.abs(self.levels), -self.levels)
        excess[self.alpha_place] = 0.0
        return bool((excess <= VIOLATION).all())

    def admissible(self) -> bool:
        """Say whether the mechanism closes no contact by more than rounding."""
        return bool((self.rates >= -INADMISSIBLE * self.speed).all())

    def falls(self, velocity: Floats) -> bool:
        """Say whether a motion proves that nothing holds the bodies up; then keep it."""
        largest = np.abs(velocity).max()
        closes = -self.opening(velocity)[self.open].min(initial=0.0)
        work = abs(np.cumsum(self.live * velocity)[-1])
        fall = -np.cumsum(self.rhs * velocity)[-1]
        proves = max(closes, work) <= FALL * largest and fall > max(closes, work)
        if proves:
            self.fall = velocity
        return bool(proves)

    def renewed_inverse(self) -> bool:
        """Make the inverse from its basis, once; False when there is none or it was made."""
        rows = None if self.renewed else inverted(self.matrix())
        if rows is None:
            return False
        self.renewed = True
        self.restarts += 1
        cols = np.ascontiguousarray(rows.T)
        basis = replace(
            self.tilt.basis,
            alpha_place=self.alpha_place,
            heads=self.heads.astype(np.int32),
            levels=added_up(self.rhs[:, None] * cols),
            rows=rows,
            cols=cols,
        )
        self.inverse = BorderedInverse(basis, np.empty(0))
        return True

    def matrix(self) -> Floats:
        """Return the basis as a matrix, its columns side by side."""
        matrix = np.zeros((len(self.heads), 3 + len(self.heads)))
        for place, head in enumerate(self.heads.tolist()):
            if head >= 0:
                matrix[place, self.at[:, head]] = self.cones.entries[:, head]
            elif head == ALPHA:
                matrix[place, 3:] = self.live
            else:
                matrix[place, 3 + ARTIFICIAL - head] = 1.0
        return np.ascontiguousarray(matrix[:, 3:].T)


def _exchange(levels: Floats, place: int, column: Floats) -> None:
    """Let what enters a place bring it to 0."""
    step = levels[place] / column[place]
    levels -= step * column
    levels[place] = step


def _reduce(costs: Floats, number: int, slopes: Floats, head: int) -> None:
    """Bring the costs of a column that enters to 0; `head` leaves."""
    step = max(costs[number], 0.0) / slopes[number]
    costs -= step * slopes
    costs[number] = 0.0
    if head >= 0:
        costs[head] = -step


def _check(tilt: Tilt, added: Added) -> None:
    """Raise ValueError for arrays that do not fit together."""
    cones, count, bodies = added.cones, len(added.cones.first), tilt.weights.size
    bodies += added.weights.size
    if len(cones.second) != count or cones.entries.shape != (6, count):
        raise ValueError("the arrays of the columns have different lengths")
    closed = (added.closed < 0) | (added.closed >= len(tilt.cones.first))
    if closed.any():
        raise ValueError(f"there is no column {added.closed[closed][0]} to close")
    if (np.diff(added.closed) <= 0).any():
        raise ValueError("the columns to close are not in ascending order")
    lost = (cones.first < 0) | (cones.first >= bodies)
    lost |= (cones.second < -1) | (cones.second >= bodies)
    if lost.any():
        raise ValueError(f"column {int(np.argmax(lost))} is between bodies that are not there")


def unit_of(tilt: Tilt, added: Added) -> float:
    """Return the unit of forces: about the weight of the first stone."""
    if len(tilt.weights) or not len(added.weights):
        return tilt.basis.unit
    return 2.0 ** frexp(float(added.weights[0]))[1]


def joined(cones: Cones, more: Cones) -> Cones:
    """Return both, one after the other."""
    return Cones(
        np.concatenate((cones.first, more.first)),
        np.concatenate((cones.second, more.second)),
        np.concatenate((cones.entries, more.entries), axis=1),
    )


def rows_of(cones: Cones) -> Places:
    """Return the six rows of each column, counted from 3: the first three are the ground's."""
    bodies = np.stack((cones.first, cones.second)).astype(np.intp)
    return (3 * (bodies[:, None, :] + 1) + np.arange(3)[None, :, None]).reshape(6, -1)
