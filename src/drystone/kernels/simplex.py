"""Linear programs of the limit analysis that grow by a stone, from the last optimal basis (§4.1).

For n free bodies of weights w, three rows each (horizontal force, vertical force, moment)::

    sum x_j a_j + alpha live = rhs,  x_j >= 0,  alpha free,  maximise sign * alpha
    live of body i = (w_i, 0, 0),  rhs of body i = (0, w_i, 0)

The columns a_j are the edges of friction cones, the x_j forces along them.  The dual variables v
are velocities of the bodies, a mechanism; the reduced cost a_j . v of a column is the rate at
which the mechanism opens its contact.  Of a wall both directions (signs) have an optimal basis,
with its inverse.  A stone adds three rows:

1. A dual feasible basis.  The mechanism of the wall is extended to the stone by a program of three
   rows, whose columns are those of the stone, with what each takes from alpha as its cost.  It is
   solved in a tableau, phases 1 and 2.  If it has no solution, nothing holds the stone up.
   Otherwise its basis joins that of the wall, and no reduced cost is negative.
2. Parametric phase.  A parameter of the right-hand side goes from 1, where the stone weighs nothing
   and the forces of the wall are feasible, to 0.  The row that first becomes infeasible leaves, and
   a column enters by the ratio test of the dual simplex method.  Most reduced costs are 0, as most
   of a wall rests: ties are broken by secondary costs, a fixed perturbation of the costs.
3. Primal phase.  Where the mechanism of the wall cannot be extended, negative reduced costs are set
   to 0 first (costs are shifted); afterwards they count again, by the primal simplex method.

The inverse of the wall is only read: exchanges of the basis are kept as a few eta columns.  At the
end basic values and reduced costs are computed anew and checked against the equations.

The method is that of Vanderbei, Linear Programming: Foundations and Extensions (4th edition, 2014):
chapter 6 (matrix notation), sections 2.3 (phases), 3.3 and 3.4 (perturbation, Bland's rule), 5.6
(dual simplex method), 7.3 (parametric method), 8.3 (eta matrices).  Ratio tests have tolerances in
two passes (Harris, Mathematical Programming 5, 1973).

It exists compiled only.  Where it was not built, :data:`AVAILABLE` is false and HiGHS answers
instead (:mod:`drystone.statics.incremental`).
"""

from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

OPTIMAL: Final = 0
UNSTABLE: Final = 1
"""Infeasible: no alpha at all holds the bodies up."""
FAILED: Final = 2
"""Gave up: too many pivots, numerics, or alpha has no bound."""

MAX_PIVOTS: Final = 600

_fast = compiled("simplex")

AVAILABLE: Final = _fast is not None


@dataclass(frozen=True, eq=False)
class Cones:
    """Edges of friction cones: forces between two bodies, or between a body and the ground."""

    first: Ints  # (N,) body that the force acts on; never the ground
    second: Ints  # (N,) body that takes the opposite force; -1 for the ground
    # (6, N) C-contiguous: horizontal force, vertical force and moment on `first`, then the
    # same on `second`, all 0 where that is the ground
    entries: Floats


@dataclass(frozen=True, eq=False)
class Added:
    """A stone and its wedges."""

    # (k,) of the new bodies n ... n + k - 1, the stone first; positive.  There may be none
    weights: Floats
    cones: Cones  # new columns, between any bodies
    closed: Ints  # (c,) ascending columns of the wall that are there no more

    def joined(self, wall: Cones) -> Cones:
        """Return the columns of the wall that are left, then the new ones."""
        first, second, entries = wall.first, wall.second, wall.entries
        if len(self.closed):
            first, second = np.delete(first, self.closed), np.delete(second, self.closed)
            entries = np.delete(entries, self.closed, axis=1)
        new = self.cones
        return Cones(
            np.concatenate((first, new.first)),
            np.concatenate((second, new.second)),
            np.concatenate((entries, new.entries), axis=1),
        )


@dataclass(frozen=True, eq=False)
class Answer:
    """How the program of a wall with a stone ended, in one direction."""

    status: int  # OPTIMAL, UNSTABLE or FAILED
    alpha: float  # load multiplier; NaN unless the status is OPTIMAL
    # (columns,) one a column: those of the wall that are left, in order, then the new ones.
    # Not below 0 but for rounding (1e-9 of a weight).  Empty unless the status is OPTIMAL
    forces: Floats
    # (3 (n + k),) with a . v >= 0 for every column a.  OPTIMAL: the mechanism v, sign live . v = 1;
    # by duality alpha = sign rhs . v.  UNSTABLE: a fall, live . v = 0 and rhs . v < 0; only the
    # direction counts.  FAILED: empty
    velocity: Floats
    pivots: int  # exchanges of the basis, without those of the tableau of the stone
    restarts: int  # how often a start, or an inverse that had lost its digits, had to be given up


@dataclass(frozen=True, eq=False)
class Basis:
    """An optimal basis of m = 3 n rows, with its inverse; forces in a unit of their own."""

    unit: float  # unit of forces, a power of two, so that it costs no digit
    alpha_row: int  # where alpha is basic; -1 when there are no bodies
    # (m,) what is basic in each row: a column, -1 for alpha, -2 - i for the artificial
    # variable of row i
    basic: Ints
    values: Floats  # (m,) basic values; that of alpha is sign times alpha
    # (m, m) the inverse and its transpose, both C-contiguous: a pivot row needs rows of the
    # inverse, a pivot column those of the transpose
    inverse: Floats
    transposed: Floats
    reduced_costs: Floats  # (N,) rate at which the mechanism opens each column, a . v; 0 if basic
    secondary_costs: Floats  # (N,) reduced costs of the perturbation: positive, 0 if basic


@dataclass(frozen=True, eq=False)
class Optimum:
    """The program of a wall, solved in one direction, ready for one more stone; immutable."""

    sign: int  # 1 for the greatest alpha, -1 for the least
    weights: Floats  # (n,)
    cones: Cones  # all columns
    alpha: float  # load multiplier; sign times infinity when there are no bodies
    forces: Floats  # (N,) one a column
    velocity: Floats  # (3 n,) the mechanism; see Answer
    basis: Basis  # where the next stone starts from
    _program: Any = field(init=False, repr=False)

    def __post_init__(self) -> None:
        # The same once more as C pointers, with scratch memory for those who ask.
        object.__setattr__(self, "_program", _fast.Program(self) if _fast else None)

    @classmethod
    def of_nothing(cls, sign: int) -> "Optimum":
        """Return that of no bodies and no columns; the first stone starts from it."""
        nothing, none, table = np.empty(0), np.empty(0, np.int32), np.empty((0, 0))
        cones = Cones(none, none, np.empty((6, 0)))
        basis = Basis(1.0, -1, none, nothing, table, table, nothing, nothing)
        return cls(sign, nothing, cones, sign * np.inf, nothing, nothing, basis)

    def solved_with(self, added: Added, max_pivots: int = MAX_PIVOTS) -> Answer:
        """Solve the program of the wall with a stone; nothing changes.

        The answer depends on the wall and the stone alone.  Threads may ask at the same time.
        Candidates at 60 stones need 10 pivots, those that change the mechanism of a wall of 100 up
        to 300.
        """
        return Answer(*self._program.solve_added(added, max_pivots))

    def extended(self, added: Added, answer: Answer) -> "Optimum":
        """Return the optimum of the wall with a stone, of which the answer is OPTIMAL.

        It goes the way to the answer once more, so that answers need not keep their basis.
        """
        if answer.status != OPTIMAL:
            raise ValueError("only an optimal answer can be built on")
        basis = Basis(*self._program.basis_with(added, answer.pivots + 1))
        weights = np.concatenate((self.weights, added.weights))
        cones = added.joined(self.cones)
        return Optimum(
            self.sign, weights, cones, answer.alpha, answer.forces, answer.velocity, basis
        )
