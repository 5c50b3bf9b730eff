"""What the simplex kernel of the limit analysis takes and gives (§4.1)."""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

OPTIMAL: Final = 0
UNSTABLE: Final = 1
"""No alpha at all holds the bodies up."""
FAILED: Final = 2
"""Gave up: too many pivots, numerics, or alpha has no bound."""

ALPHA: Final = -1
"""What is basic in a place: a column, alpha, or ``ARTIFICIAL - i``, an unknown force in row i."""
ARTIFICIAL: Final = -2


@dataclass(frozen=True, eq=False)
class Cones:
    """Edges of friction cones: forces between two bodies, or between a body and the ground.

    Parameters
    ----------
    first : (N,) int32 array
        Body that the force acts on; never the ground.
    second : (N,) int32 array
        Body that takes the opposite force; -1 for the ground.
    entries : (6, N) float64 array
        C-contiguous: horizontal force, vertical force and moment on `first`, then the same on
        `second`, all 0 where that is the ground.
    """

    first: Ints
    second: Ints
    entries: Floats


@dataclass(frozen=True, eq=False)
class Added:
    """A stone and its wedges.

    Parameters
    ----------
    weights : (k,) float64 array
        Of the new bodies n ... n + k - 1, the stone first; positive.  There may be none.
    cones : Cones
        New columns, between any bodies.
    closed : (c,) int32 array
        Ascending columns of the wall that are there no more.
    """

    weights: Floats
    cones: Cones
    closed: Ints


@dataclass(frozen=True, eq=False)
class Answer:
    """How one tilt of the wall with a stone ended.

    Parameters
    ----------
    status : int
        OPTIMAL, UNSTABLE or FAILED.
    alpha : float
        Load multiplier; NaN unless the status is OPTIMAL.
    forces : (columns,) float array
        One a column: those of the wall that are left, in order, then the new ones.  Not below 0
        but for rounding (1e-9 of a weight).  Empty unless the status is OPTIMAL.
    velocity : (3 (n + k),) float array
        OPTIMAL: the mechanism v, with a . v >= 0 for every column a and sign live . v = 1; by
        duality alpha = sign rhs . v.
        UNSTABLE: a fall, with a . v >= 0 for every column, live . v = 0 and rhs . v < 0; only the
        direction counts.  FAILED: empty.
    pivots : int
        Exchanges of the basis, without those of the small program of the start.
    restarts : int
        How often a start, or an inverse that had lost its digits, had to be given up.
    """

    status: int
    alpha: float
    forces: Floats
    velocity: Floats
    pivots: int
    restarts: int


@dataclass(frozen=True, eq=False)
class Basis:
    """An optimal basis of m = 3 n unknowns, with its inverse; forces in a unit of their own.

    Parameters
    ----------
    unit : float
        Unit of forces, a power of two, so that it costs no digit.
    alpha_place : int
        Where alpha is basic; -1 when there are no bodies.
    heads : (m,) int32 array
        What is basic in each place; see `ALPHA`.
    levels : (m,) float64 array
        Values of what is basic; that of alpha is sign times alpha.
    rows, cols : (m, m) float64 arrays
        The inverse and its transpose, both C-contiguous: a basis needs its rows, a new column
        those of the transpose.
    rates : (N,) float64 array
        Rate at which the mechanism opens each column, a . v: its reduced cost; 0 if basic.
    ties : (N,) float64 array
        Second reduced costs, which choose among equals: positive, 0 if basic.
    """

    unit: float
    alpha_place: int
    heads: Ints
    levels: Floats
    rows: Floats
    cols: Floats
    rates: Floats
    ties: Floats


@dataclass(frozen=True, eq=False)
class Tilt:
    """One tilt of a wall, solved, ready for one more stone; nothing in it changes.

    Parameters
    ----------
    sign : int
        1 for the greatest alpha, -1 for the least.
    weights : (n,) float64 array
        Of the bodies.
    cones : Cones
        All columns.
    alpha : float
        Load multiplier; sign times infinity when there are no bodies.
    forces : (N,) float64 array
        One a column.
    velocity : (3 n,) float64 array
        The mechanism; see :class:`Answer`.
    basis : Basis
        Where the next stone starts from.
    native : Wall of the compiled kernel, or None
        The same for the compiled kernel, with scratch memory for those who ask.
    """

    sign: int
    weights: Floats
    cones: Cones
    alpha: float
    forces: Floats
    velocity: Floats
    basis: Basis
    native: Any = None
