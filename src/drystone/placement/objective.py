"""The objective of the paper, for all feasible positions at once (Eq. 12-13)."""

import numpy as np
from numpy.typing import NDArray

from drystone.indices.dice_score import geometrical_dice_score
from drystone.indices.local_filling import local_filling_ratio
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.placement.feasible import Positions

Floats = NDArray[np.float64]


def threshold(x: Floats, beta: float) -> Floats:
    """Return H(x, beta): x where it is larger than beta, otherwise 0 (Eq. 13).

    Examples
    --------
    >>> threshold(np.array([0.7, 0.8]), 0.7)
    array([0. , 0.8])
    """
    return np.where(x > beta, x, 0.0)


def eq12_objective(
    landscape: Landscape, posed: PosedStone, positions: Positions, beta: float
) -> Floats:
    """Return LFR + H(GDS, beta) - x_c / w for every position (Eq. 12a).

    Parameters
    ----------
    landscape : Landscape
        What is built, in its view.
    posed : PosedStone
        The stone, in the same view.
    positions : (n, 2) int array
        Feasible positions.
    beta : float
        Threshold of Eq. 13.
    """
    filling = local_filling_ratio(landscape, posed, positions)
    dice = geometrical_dice_score(landscape, posed, positions[:, 0])
    x_c = positions[:, 1] + posed.anchor[0]
    return np.asarray(filling + threshold(dice, beta) - x_c / landscape.width_px)
