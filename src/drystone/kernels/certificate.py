"""Forces and mechanisms of the limit analysis against every row and every column (§4.1).

The program is that of :mod:`drystone.kernels.simplex`, its columns a_j in two parts: those of a
wall, and those that a stone adds.  Nothing that a solver says of its answer is used.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.simplex import Added, Cones

Floats = NDArray[np.float64]

_fast = compiled("certificate")


class Figures(NamedTuple):
    """What an answer is worth.

    Parameters
    ----------
    residual : float
        Largest entry of sum x_j a_j + alpha live - rhs.
    violation : float
        By how much a force x_j is below 0 at most.
    total : float
        Sum of abs(x_j).
    largest : float
        Largest entry of the velocity v.
    inadmissible : float
        By how much some a_j . v is below 0 at most.
    live, rhs : float
        live . v and rhs . v.
    """

    residual: float
    violation: float
    total: float
    largest: float
    inadmissible: float
    live: float
    rhs: float


def figures(
    wall: Cones,
    weights: Floats,
    added: Added,
    alpha: float,
    forces: Floats,
    velocity: Floats,
) -> Figures:
    """Measure the forces and the mechanism of one answer.

    Parameters
    ----------
    wall : Cones
        Columns of the wall.
    weights : (n,) float64 array
        Of its bodies.
    added : Added
        What a stone adds, and which columns are gone.
    alpha : float
        Load multiplier of the forces.
    forces : (columns,) float64 array
        Of the columns of the wall that are left, then of the new ones; empty for a mechanism
        alone, the first three figures are then 0.
    velocity : (3 (n + k),) float64 array
        Of all bodies.

    Returns
    -------
    Figures
        NaN wherever anything that counts is no number.

    Raises
    ------
    ValueError
        When vectors have another size than the program.

    Examples
    --------
    A body of weight 1 on a point below its centroid, without friction, pushed by a quarter of it.

    >>> def cones(columns: int) -> Cones:
    ...     bodies = np.zeros(columns, np.int32)
    ...     return Cones(bodies, bodies - 1, np.eye(6)[:, [1] * columns])
    >>> nothing = Added(np.empty(0), cones(0), np.empty(0, np.int32))
    >>> sideways = np.array([1.0, 0.0, 0.0])
    >>> found = figures(cones(1), np.ones(1), nothing, 0.25, np.ones(1), sideways)
    >>> found.residual, found.inadmissible, found.live
    (0.25, 0.0, 1.0)
    """
    new = added.cones
    columns = len(wall.first) - len(added.closed) + len(new.first)
    if len(forces) not in (0, columns) or len(velocity) != 3 * (len(weights) + len(added.weights)):
        raise ValueError("forces or velocities of another program")
    if _fast is None:
        with np.errstate(all="ignore"):  # what is no number is told by the figures
            return figures_numpy(wall, weights, added, alpha, forces, velocity)
    return Figures(
        *_fast.figures(
            wall.first, wall.second, wall.entries, weights,
            new.first, new.second, new.entries, added.weights, added.closed,
            alpha, forces, velocity,
        )
    )  # fmt: skip


def figures_numpy(
    wall: Cones,
    weights: Floats,
    added: Added,
    alpha: float,
    forces: Floats,
    velocity: Floats,
) -> Figures:
    """Twin of :func:`figures`; every sum goes from the first term to the last."""
    stays = np.ones(len(wall.first), bool)
    stays[added.closed] = False
    first = np.concatenate((wall.first[stays], added.cones.first))
    second = np.concatenate((wall.second[stays], added.cones.second))
    entries = np.concatenate((wall.entries[:, stays], added.cones.entries), axis=1)
    weights = np.concatenate((weights, added.weights))
    moving = np.concatenate((velocity.reshape(-1, 3), np.zeros((1, 3)))).T  # last: the ground
    power = _work(entries[:3], moving[:, first]) + _work(entries[3:], moving[:, second])
    return Figures(
        *(_balance(first, second, entries, weights, alpha, forces) if len(forces) else (0.0,) * 3),
        _largest(np.abs(velocity)),
        _largest(-power),
        _sum(weights * moving[0, :-1]),
        _sum(weights * moving[1, :-1]),
    )


def _balance(
    first: NDArray[np.int32],
    second: NDArray[np.int32],
    entries: Floats,
    weights: Floats,
    alpha: float,
    forces: Floats,
) -> tuple[float, float, float]:
    """Return residual, violation and total; columns that carry nothing are left out."""
    carry = forces != 0.0
    bodies = np.column_stack((first, second))[carry].ravel()
    bodies[bodies < 0] = len(weights)
    shares = (forces * entries)[:, carry]
    left = np.empty((3, len(weights)))
    for k in range(3):
        left[k] = np.bincount(bodies, shares[k::3].T.ravel(), len(weights) + 1)[:-1]
    left[0] += alpha * weights
    left[1] -= weights
    return _largest(np.abs(left)), _largest(-forces), _sum(np.abs(forces))


def _work(force: Floats, velocity: Floats) -> Floats:
    work: Floats = force[0] * velocity[0] + force[1] * velocity[1] + force[2] * velocity[2]
    return work


def _largest(values: Floats) -> float:
    """Return the largest value above 0; NaN when there is one."""
    return float(values.max(initial=0.0)) + 0.0  # never -0.0


def _sum(values: Floats) -> float:
    return float(np.cumsum(values)[-1]) if len(values) else 0.0
