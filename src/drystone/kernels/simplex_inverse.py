"""The inverse of a basis that a stone borders and a few exchanges change.

The twin of `compiled/simplex_inverse.pyx`; see :mod:`drystone.kernels.simplex`.
"""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.simplex_choice import added_up
from drystone.kernels.simplex_types import Basis, Floats

SINGULAR = 1e-10


class BorderedInverse:
    """Inverse of a basis of the wall with new bodies; the inverse of the wall is only read.

    With the new rows last, their artificial forces basic, and the live load of the new bodies
    where alpha is basic, the basis is ``[[B, 0], [C, I]]``.  Exchanges multiply its inverse from
    the left by a matrix that differs from I in a few columns: those are kept, one for each place
    that was ever exchanged.

    Parameters
    ----------
    basis : Basis
        Of the wall.
    live : (3 k,) float array
        Live load on the new bodies, signed: the rows of alpha.
    """

    def __init__(self, basis: Basis, live: Floats) -> None:
        self.rows, self.cols, self.levels = basis.rows, basis.cols, basis.levels
        self.old, self.new = len(basis.heads), len(live)
        self.alpha_place = basis.alpha_place
        self.live = live
        self.size = self.old + self.new
        # Places of new rows come first, then that of alpha: the border needs them.
        places = [*range(self.old, self.size), *([basis.alpha_place] if self.old else [])]
        self.places = np.array(places, np.intp)
        self.slot = np.full(self.size, -1, np.intp)
        self.slot[self.places] = np.arange(len(places))
        self.changed = np.zeros((len(places) + 8, self.size))
        self.changed[np.arange(len(places)), self.places] = 1.0

    @property
    def count(self) -> int:
        """Number of places whose column of the left factor is kept."""
        return len(self.places)

    def row(self, place: int) -> Floats:
        """Return a row of the inverse."""
        factors = self.changed[: self.count, place].copy()
        found = np.zeros(self.size)
        if self.old:
            for i in range(0, self.new, 3):
                factors[self.new] -= self.live[i] * factors[i]
            own = self.places[self.new :]
            found[: self.old] = added_up(factors[self.new :, None] * self.rows[own])
            if self.slot[place] < 0:
                found[: self.old] += self.rows[place]
        found[self.old :] = factors[: self.new]
        return found

    def table(self) -> Floats:
        """Return all rows of the inverse."""
        factors = self.changed[: self.count].copy()
        found = np.zeros((self.size, self.size))
        if self.old:
            for i in range(0, self.new, 3):
                factors[self.new] -= self.live[i] * factors[i]
            for factor, place in zip(factors[self.new :], self.places[self.new :], strict=True):
                found[:, : self.old] += factor[:, None] * self.rows[place]
            own = np.flatnonzero(self.slot < 0)
            found[own, : self.old] += self.rows[own]
        found[:, self.old :] = factors[: self.new].T
        return found

    def applied(self, vector: Floats) -> Floats:
        """Return the product with the left factor of ``(inverse of the wall, new rows)``.

        Parameters
        ----------
        vector : (M,) float array
            The inverse of the wall times the old rows of what is asked for, and its new rows.
        """
        terms = np.empty((self.count + 1, self.size))
        terms[0] = vector
        if self.old:
            for i in range(0, self.new, 3):
                terms[0, self.old + i] -= self.live[i] * vector[self.alpha_place]
        at = terms[0, self.places]
        terms[0, self.places] = 0.0
        np.multiply(at[:, None], self.changed[: self.count], out=terms[1:])
        return added_up(terms)

    def times(self, rows: NDArray[np.intp], entries: Floats) -> Floats:
        """Return the inverse times a column with a few entries, in the rows given."""
        vector = np.zeros(self.size)
        old = rows < self.old
        if old.any():
            vector[: self.old] = added_up(entries[old, None] * self.cols[rows[old]])
        vector[rows[~old]] = entries[~old]
        return self.applied(vector)

    def times_all(self, rest: Floats) -> Floats:
        """Return the inverse times any vector."""
        vector = rest.copy()
        if self.old:
            vector[: self.old] = added_up(rest[: self.old, None] * self.cols)
        return self.applied(vector)

    def exchange(self, place: int, column: Floats) -> None:
        """Put another column into a place; `column` is the inverse times it."""
        if self.slot[place] < 0:
            self.slot[place] = self.count
            self.places = np.append(self.places, place)
            if self.count > len(self.changed):
                self.changed = np.concatenate((self.changed, np.zeros_like(self.changed)))
            self.changed[self.count - 1] = 0.0
            self.changed[self.count - 1, place] = 1.0
        kept = self.changed[: self.count]
        factors = kept[:, place] / column[place]
        kept -= factors[:, None] * column
        kept[:, place] = factors


def inverted(matrix: Floats) -> Floats | None:
    """Return the inverse of a square matrix; None when it has none.

    Gauss-Jordan with exchanges of rows, one row operation after the other: the libraries for it
    differ from machine to machine in the last bits.
    """
    work = matrix.copy()
    size = len(work)
    swaps = []
    for step in range(size):
        place = step + int(np.argmax(np.abs(work[step:, step])))
        pivot = work[place, step]
        if not abs(pivot) > SINGULAR:
            return None
        swaps.append(place)
        work[[step, place]] = work[[place, step]]
        row = work[step].copy()
        row[step] = 1.0
        row /= pivot
        factors = work[:, step].copy()
        factors[step] = 0.0
        work[:, step] = 0.0
        work -= factors[:, None] * row
        work[step] = row
    for step in reversed(range(size)):
        work[:, [step, swaps[step]]] = work[:, [swaps[step], step]]
    return work
