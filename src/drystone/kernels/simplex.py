"""Linear programs of the limit analysis that grow by a stone, from the last optimal basis (§4.1).

For n free bodies of weights w, three rows each (horizontal force, vertical force, moment)::

    sum x_j a_j + alpha live = rhs,  x_j >= 0,  alpha free,  maximise sign * alpha
    live of body i = (w_i, 0, 0),  rhs of body i = (0, w_i, 0)

A wall keeps an optimal basis for each tilt, with its inverse.  A stone adds three rows:

1. The mechanism of the wall is extended to the stone.  That takes a linear program of three rows,
   whose columns are those of the stone, with what each takes from alpha as its cost; if it has no
   solution, nothing holds the stone up.  Its basis joins that of the wall, and no rate at which a
   contact opens is below 0: alpha can only be less.
2. The stone is let down: the forces go in a straight line from those of the wall, where the stone
   weighs nothing, to those that the basis needs.  What would pull on the way leaves the basis,
   and the contact of the smallest ratio of opening rate to slope enters (dual simplex method with
   a parametric right-hand side).  Most rates are 0, as most of a wall rests: among equals, fixed
   and arbitrary second costs decide.
3. Where the mechanism of the wall cannot be extended, the rates below 0 are set to 0 first; after
   the stone is down they count again (primal simplex method).

The inverse of the wall is only read.  What exchanges do to it is a factor that differs from the
identity in a few columns.  At the end forces and mechanism are computed anew, and the equations
are checked; see :mod:`drystone.kernels.simplex_state` for the tolerances.

Both kernels do the same operations in the same order: their results are equal, bit by bit.
"""

from dataclasses import replace

import numpy as np

from drystone.kernels.backend import compiled
from drystone.kernels.simplex_growth import grown_from, grown_tilt_numpy, solve_added_numpy
from drystone.kernels.simplex_types import (
    FAILED,
    OPTIMAL,
    UNSTABLE,
    Added,
    Answer,
    Basis,
    Cones,
    Tilt,
)

__all__ = [
    "FAILED", "OPTIMAL", "UNSTABLE", "Added", "Answer", "Cones", "Tilt",
    "empty_tilt", "grown_tilt", "solve_added",
]  # fmt: skip

MAX_PIVOTS = 600

_fast = compiled("simplex")


def empty_tilt(sign: int) -> Tilt:
    """Return the tilt of no bodies and no columns; the first stone starts from it.

    Parameters
    ----------
    sign : int
        1 for the greatest alpha, -1 for the least.

    Examples
    --------
    A square stone on two points of the ground, with a friction of 1, slides at its weight; both
    edges of the cones at its corners push up, and one of them to the left.

    >>> entries = np.array([[1.0, -1, 1, -1], [1, 1, 1, 1], [0, -1, 1, 0]])
    >>> cones = Cones(
    ...     np.zeros(4, np.int32),
    ...     np.full(4, -1, np.int32),
    ...     np.concatenate((entries, np.zeros((3, 4)))),
    ... )
    >>> stone = Added(np.ones(1), cones, np.empty(0, np.int32))
    >>> answer = solve_added(empty_tilt(1), stone)
    >>> answer.alpha, answer.forces.tolist()
    (1.0, [0.0, 0.0, 0.0, 1.0])
    """
    nothing, none = np.empty(0), np.empty(0, np.int32)
    cones = Cones(none, none, np.empty((6, 0)))
    table = np.empty((0, 0))
    basis = Basis(1.0, -1, none, nothing, table, table, nothing, nothing)
    return _native(Tilt(sign, nothing, cones, sign * np.inf, nothing, nothing, basis))


def solve_added(tilt: Tilt, added: Added, max_pivots: int = MAX_PIVOTS) -> Answer:
    """Solve one tilt of the wall with a stone; nothing changes.

    The answer depends on the tilt and the stone alone.  Threads may ask at the same time.

    Parameters
    ----------
    tilt : Tilt
        Of the wall.
    added : Added
        The stone and its wedges.
    max_pivots : int
        Gives up after so many.  Candidates at 60 stones need 10, those that change the mechanism
        of a wall of 100 up to 300.
    """
    if _fast is None:
        return solve_added_numpy(tilt, added, max_pivots)
    return Answer(*tilt.native.solve_added(added, max_pivots))


def grown_tilt(tilt: Tilt, added: Added, answer: Answer) -> Tilt:
    """Return the tilt of the wall with the stone.

    Parameters
    ----------
    tilt : Tilt
        Of the wall.
    added : Added
        The stone and its wedges.
    answer : Answer
        What :func:`solve_added` says of them; OPTIMAL.

    Notes
    -----
    It goes the way to the answer once more, so that answers need not keep their basis.
    """
    if answer.status != OPTIMAL:
        raise ValueError("only an optimal answer makes a tilt")
    if _fast is None:
        return grown_tilt_numpy(tilt, added, answer)
    return _native(
        grown_from(tilt, added, answer, Basis(*tilt.native.grown(added, answer.pivots + 1)))
    )


def _native(tilt: Tilt) -> Tilt:
    return tilt if _fast is None else replace(tilt, native=_fast.Wall(tilt))
