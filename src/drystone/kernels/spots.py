"""The best of many positions by the rules of placement (§3.6)."""

from typing import NamedTuple

import numpy as np

from drystone.kernels.backend import compiled
from drystone.kernels.lowering import Positions
from drystone.kernels.merits import Floats, SnugWeights, eq12_merits, snug_merits
from drystone.kernels.rays import RaySums
from drystone.kernels.silhouette import Ints, Silhouette

UNITS = 1e12
"""Merits are compared in units of 1 / UNITS: rounding must not decide between equal places."""

_fast = compiled("spots")


class Place(NamedTuple):
    """A position and what it is worth.

    Parameters
    ----------
    merit : float
        In units of 1 / :data:`UNITS`, a whole number.
    row, col : int
        Top-left corner of the mask.
    """

    merit: float
    row: int
    col: int


def best_by_eq12(
    positions: Positions,
    mask: Silhouette,
    rays: RaySums,
    built_height: int,
    anchor_x: float,
    beta: float,
    tries: int,
) -> list[Place]:
    """Return the positions of the largest merit by Eq. 12, the best first.

    Parameters
    ----------
    positions, mask, rays, built_height, anchor_x, beta
        As for :func:`~drystone.kernels.merits.eq12_merits`; positions by row, then column.
    tries : int
        How many are wanted at most.  Of equal ones the lower comes first, then the one further
        to the left.
    """
    if _fast is None:
        return best_by_eq12_numpy(positions, mask, rays, built_height, anchor_x, beta, tries)
    found = _fast.best_by_eq12(positions, mask, rays, built_height, anchor_x, beta, tries)
    return [Place(*place) for place in found]


def best_by_eq12_numpy(
    positions: Positions,
    mask: Silhouette,
    rays: RaySums,
    built_height: int,
    anchor_x: float,
    beta: float,
    tries: int,
) -> list[Place]:
    """Twin of :func:`best_by_eq12`."""
    merits = eq12_merits(positions, mask, rays, built_height, anchor_x, beta)
    return best(merits, positions, tries)


def best_by_height(
    positions: Positions, mask: Silhouette, rays: RaySums, tries: int
) -> list[Place]:
    """Return the lowest positions; of equal ones the best filled, then the one further left.

    Parameters
    ----------
    positions, mask, rays, tries
        As for :func:`best_by_eq12`; the merit is the filled share of the rays.
    """
    if _fast is None:
        return best_by_height_numpy(positions, mask, rays, tries)
    return [Place(*place) for place in _fast.best_by_height(positions, mask, rays, tries)]


def best_by_height_numpy(
    positions: Positions, mask: Silhouette, rays: RaySums, tries: int
) -> list[Place]:
    """Twin of :func:`best_by_height`."""
    return best(rays.filled_share(mask, positions), positions, tries, lowest_first=True)


def best_by_snugness(
    positions: Positions,
    mask: Silhouette,
    top: Ints,
    rays: RaySums,
    weights: SnugWeights,
    tries: int,
) -> list[Place]:
    """Return the positions of the largest merit by :func:`snug_merits`, the best first.

    Parameters
    ----------
    positions, mask, top, rays, weights
        As for :func:`~drystone.kernels.merits.snug_merits`; positions by row, then column.
    tries : int
        As for :func:`best_by_eq12`.
    """
    if _fast is None:
        return best_by_snugness_numpy(positions, mask, top, rays, weights, tries)
    found = _fast.best_by_snugness(positions, mask, top, rays, weights, tries)
    return [Place(*place) for place in found]


def best_by_snugness_numpy(
    positions: Positions,
    mask: Silhouette,
    top: Ints,
    rays: RaySums,
    weights: SnugWeights,
    tries: int,
) -> list[Place]:
    """Twin of :func:`best_by_snugness`."""
    return best(snug_merits(positions, mask, top, rays, weights), positions, tries)


def best(
    merits: Floats, positions: Positions, tries: int, *, lowest_first: bool = False
) -> list[Place]:
    """Return the positions of the largest merits; of equal ones the lowest, then the leftmost.

    Parameters
    ----------
    merits : (n,) float array
        Of the positions.
    positions : (n, 2) int array
        Row and column.
    tries : int
        How many are wanted at most.
    lowest_first : bool
        The lowest, and of equal ones those of the largest merit.

    Examples
    --------
    >>> best(np.array([0.1, 0.3, 0.1]), np.array([[1, 2], [1, 5], [2, 7]]), 2)
    [Place(merit=300000000000.0, row=1, col=5), Place(merit=100000000000.0, row=2, col=7)]
    """
    rows, cols, units = positions[:, 0], positions[:, 1], np.rint(merits * UNITS)
    keys = (cols, -units, -rows) if lowest_first else (cols, -rows, -units)
    order = np.lexsort(keys)[:tries]
    table = zip(units[order].tolist(), rows[order].tolist(), cols[order].tolist(), strict=True)
    return [Place(*place) for place in table]
