"""What places are worth by the rules of placement, and the best of many (§3.6; Eq. 5, 12, 13)."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.lowering import Positions
from drystone.kernels.rays import RaySums
from drystone.kernels.silhouette import Ints, Silhouette

Floats = NDArray[np.float64]

UNITS = 1e12
"""Merits are compared in units of 1 / UNITS: rounding must not decide between equal places."""

GUESSES = 16
"""So many places more than are wanted are counted first; they tell which others can be as good."""


class Place(NamedTuple):
    """A position and what it is worth: a whole number of units."""

    merit: float
    row: int  # of the top-left corner of the mask
    col: int


class Eq12(NamedTuple):
    """What Eq. 12 depends on beside the position."""

    built_height: int  # of the box B of Eq. 5, as high as what is built
    anchor_x: float  # of the stone's centroid, from the left edge of its mask
    beta: float


class SnugWeights(NamedTuple):
    """Weights of the costs of :func:`snug_merits`."""

    height: float
    void: float
    gap: float
    end: float


def dice_score(inside: Ints, area: int, box_area: float) -> Floats:
    """Return GDS (n,) of a stone, of whose area so much is inside the box B (Eq. 5)."""
    return np.asarray((inside / area) * (box_area / (box_area + area - inside)))


def threshold(x: Floats, beta: float) -> Floats:
    """Return H(x, beta): x where it is larger than beta, otherwise 0 (Eq. 13)."""
    return np.where(x > beta, x, 0.0)


def eq12_merits(positions: Positions, mask: Silhouette, rays: RaySums, eq12: Eq12) -> Floats:
    """Return LFR + H(GDS, beta) - x_c / w for every position (Eq. 12a)."""
    dice, end = _terms(positions, mask, rays, eq12)
    return np.asarray(rays.filled_share(mask, positions) + dice - end)


def _terms(
    positions: Positions, mask: Silhouette, rays: RaySums, eq12: Eq12
) -> tuple[Floats, Floats]:
    """Return H(GDS, beta) and x_c / w, for which no ray is counted."""
    from_row = np.clip(rays.height - eq12.built_height - positions[:, 0], 0, mask.height)
    box_area = float(rays.width * eq12.built_height)
    dice = dice_score(mask.area_from[from_row], int(mask.area_from[0]), box_area)
    return threshold(dice, eq12.beta), (positions[:, 1] + eq12.anchor_x) / rays.width


def snug_merits(
    positions: Positions, mask: Silhouette, top: Ints, rays: RaySums, weights: SnugWeights
) -> Floats:
    """Return minus a weighted sum of four costs, each about 0 to 1, for every position.

    Height of the mask's underside over its own height; void below it, down to the skyline `top`,
    over its area; void beside it, up to what is to its left, over its area, at most 1; distance
    from the left end over the width of the landscape.
    """
    rows, cols = positions[:, :1], positions[:, 1:]
    under = top[cols + np.arange(mask.width)].astype(np.int64) - (rows + mask.bottom + 1)
    area = int(mask.area_from[0])
    void = np.maximum(under, 0).sum(axis=1) / area
    gap = rays.empty_beside(mask, positions) / area
    underside = rays.height - rows[:, 0] - mask.height
    cost = (
        weights.height * underside / mask.height
        + weights.void * void
        + weights.gap * np.minimum(gap, 1.0)
        + weights.end * (cols[:, 0] / rays.width)
    )
    return np.asarray(-cost)


def best_by_eq12(
    positions: Positions, mask: Silhouette, rays: RaySums, eq12: Eq12, tries: int
) -> list[Place]:
    """Return the positions of the largest merits (Eq. 12a), the best first, so many at most.

    They are :func:`eq12_merits`; rays are counted only where the largest can be.

    Of equal ones the lower comes first, then the one further to the left.
    """
    dice, end = _terms(positions, mask, rays, eq12)
    return _best_of_most(
        1.0 + dice - end,
        lambda some: rays.filled_share(mask, positions[some]) + dice[some] - end[some],
        positions,
        tries,
    )


def best_by_height(
    positions: Positions, mask: Silhouette, rays: RaySums, tries: int
) -> list[Place]:
    """Return the lowest positions; of equal ones the best filled, then the one further left.

    Positions are by row, then column.
    """
    lowest = positions[positions[:, 0] >= np.min(positions[-tries:, 0], initial=rays.height)]
    return best(rays.filled_share(mask, lowest), lowest, tries, lowest_first=True)


def best_by_snugness(
    positions: Positions,
    mask: Silhouette,
    top: Ints,
    rays: RaySums,
    weights: SnugWeights,
    tries: int,
) -> list[Place]:
    """Return the positions of the largest :func:`snug_merits`, as :func:`best_by_eq12`."""
    underside = rays.height - positions[:, 0] - mask.height
    most = -(
        weights.height * underside / mask.height + weights.end * (positions[:, 1] / rays.width)
    )
    if min(weights.void, weights.gap) < 0.0:
        most = np.full(len(positions), np.inf)
    return _best_of_most(
        most,
        lambda some: snug_merits(positions[some], mask, top, rays, weights),
        positions,
        tries,
    )


def _best_of_most(
    most: Floats, worth: Callable[[NDArray[np.intp]], Floats], positions: Positions, tries: int
) -> list[Place]:
    """Return the best positions, of which is known what each is worth at most.

    Only those are counted that can be among the best.  What is worth most goes through the same
    operations in the same order as a merit, so rounding does not make it less.
    """
    most = np.rint(most * UNITS)
    order = np.argsort(-most)
    some = order[: tries + GUESSES]
    merits = worth(some)
    if len(some) < len(order):
        least = np.partition(np.rint(merits * UNITS), -tries)[-tries]
        if most[order[len(some)]] >= least:
            some = np.flatnonzero(most >= least)
            merits = worth(some)
    return best(merits, positions[some], tries)


def best(
    merits: Floats, positions: Positions, tries: int, *, lowest_first: bool = False
) -> list[Place]:
    """Return the positions of the largest merits; of equal ones the lowest, then the leftmost.

    With `lowest_first` the lowest, and of equal ones those of the largest merit.
    """
    rows, cols, units = positions[:, 0], positions[:, 1], np.rint(merits * UNITS)
    keys = (cols, -units, -rows) if lowest_first else (cols, -rows, -units)
    order = np.lexsort(keys)[:tries]
    table = zip(units[order].tolist(), rows[order].tolist(), cols[order].tolist(), strict=True)
    return [Place(*place) for place in table]
