"""The placement rule of our own: low first, snug against the neighbours second."""

import numpy as np

from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.placement.feasible import Positions
from drystone.placement.objective import Floats
from drystone.placement.settings import PlacementSettings


def snug_objective(
    landscape: Landscape, posed: PosedStone, positions: Positions, settings: PlacementSettings
) -> Floats:
    """Return the merit of every position: minus a weighted sum of four costs, each about 0 to 1.

    Height of the stone's underside over the stone's own height; void below the stone over its
    area; void beside it, up to the neighbour on the building side, over its area; distance from
    the building side over the width of the wall.

    Eq. 12 lets a stone that stands half above the course open the next one while there is room
    beside it; here height costs more than any distance along the wall can win back.
    """
    rows, cols = positions[:, 0], positions[:, 1]
    height = posed.height_px
    span = np.arange(posed.width_px)
    under = landscape.skyline[cols[:, None] + span] - (rows[:, None] + posed.bottom + 1)
    void = np.maximum(under, 0).sum(axis=1) / posed.area_px
    underside = landscape.height_px - rows - height
    gap = _gap_beside(landscape, posed, positions) / posed.area_px
    x = cols / landscape.width_px
    cost = (
        settings.height_weight * underside / height
        + settings.void_weight * void
        + settings.gap_weight * np.minimum(gap, 1.0)
        + settings.end_weight * x
    )
    return np.asarray(-cost)


def _gap_beside(landscape: Landscape, posed: PosedStone, positions: Positions) -> Floats:
    """Return the empty pixels between a stone and what is beside it on the building side."""
    width = landscape.width_px
    x = np.arange(width)
    # Column after the last occupied one at or before each column; 0 at the building end.
    last = np.maximum.accumulate(np.where(landscape.occupied, x + 1, 0), axis=1)
    last = np.pad(last, ((0, 0), (1, 0)))
    left = np.argmax(posed.mask, axis=1)
    at = positions[:, 1, None] + left
    rows = positions[:, 0, None] + np.arange(posed.height_px)
    return np.asarray((at - last[rows, at]).sum(axis=1, dtype=float))
