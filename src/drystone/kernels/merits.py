"""What a place is worth by the rules of placement: numbers in, numbers out (Eq. 5, 12, 13)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.lowering import Positions
from drystone.kernels.rays import RaySums
from drystone.kernels.silhouette import Ints, Silhouette

Floats = NDArray[np.float64]


class SnugWeights(NamedTuple):
    """Weights of the costs of :func:`snug_merits`."""

    height: float
    void: float
    gap: float
    end: float


def dice_score(inside: Ints, area: int, box_area: float) -> Floats:
    """Return GDS for areas of a stone inside the box B (Eq. 5).

    Parameters
    ----------
    inside : (n,) int array
        How much of the stone is inside B.
    area, box_area : int, float
        Area of the stone and of B.

    Examples
    --------
    >>> dice_score(np.array([0, 8, 16]), 16, 80.0).round(3).tolist()
    [0.0, 0.455, 1.0]
    """
    return np.asarray((inside / area) * (box_area / (box_area + area - inside)))


def threshold(x: Floats, beta: float) -> Floats:
    """Return H(x, beta): x where it is larger than beta, otherwise 0 (Eq. 13).

    Examples
    --------
    >>> threshold(np.array([0.7, 0.8]), 0.7)
    array([0. , 0.8])
    """
    return np.where(x > beta, x, 0.0)


def eq12_merits(
    positions: Positions,
    mask: Silhouette,
    rays: RaySums,
    built_height: int,
    anchor_x: float,
    beta: float,
) -> Floats:
    """Return LFR + H(GDS, beta) - x_c / w for every position (Eq. 12a).

    Parameters
    ----------
    positions : (n, 2) int array
        Row and column of the mask's top-left corner.
    mask : Silhouette
        Of the stone.
    rays : RaySums
        Of the landscape.
    built_height : int
        Height of what is built, and of the box B of Eq. 5.
    anchor_x : float
        The stone's centroid from the left edge of its mask.
    beta : float
        Threshold of Eq. 13.
    """
    filling = rays.filled_share(mask, positions)
    from_row = np.clip(rays.height - built_height - positions[:, 0], 0, mask.height)
    dice = dice_score(
        mask.area_from[from_row], int(mask.area_from[0]), float(rays.width * built_height)
    )
    x_c = positions[:, 1] + anchor_x
    return np.asarray(filling + threshold(dice, beta) - x_c / rays.width)


def snug_merits(
    positions: Positions, mask: Silhouette, top: Ints, rays: RaySums, weights: SnugWeights
) -> Floats:
    """Return minus a weighted sum of four costs, each about 0 to 1, for every position.

    Height of the mask's underside over its own height; void below it over its area; void beside
    it, up to what is to its left, over its area, at most 1; distance from the left end over the
    width of the landscape.

    Parameters
    ----------
    positions, mask
        As for :func:`eq12_merits`.
    top : (w,) int array
        From :func:`~drystone.kernels.lowering.skyline`.
    rays : RaySums
        Of the landscape.
    weights : SnugWeights
        Of the costs.
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
