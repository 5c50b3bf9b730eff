"""What a pose costs wherever it goes."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from drystone.model.pose import PosedStone
from drystone.planner.stock import Stock
from drystone.selection.scored import PIN_BONUS, ScoreSettings


def pose_cost(posed: PosedStone, stock: Stock, score: ScoreSettings) -> float:
    """Return what a pose costs wherever it goes."""
    upright = max(0.0, 1.0 - posed.width_px / posed.height_px)
    return math.fsum(
        [
            score.roughness * posed.top_roughness_px / stock.mean_height_px,
            score.upright * upright,
            -score.area * posed.area_px / stock.mean_area_px,
            -score.thickness * min(posed.width_px, posed.height_px) / stock.mean_height_px,
        ]
    )


class PoseCosts:
    """Costs of poses by the weights that were asked for last, each worked out once.

    Parameters
    ----------
    stock : Stock
        Sizes of the stones.
    pinned : frozenset of int
        Ids of stones that earn a bonus, as they shall be in the wall.
    """

    def __init__(self, stock: Stock, pinned: frozenset[int] = frozenset()) -> None:
        self._stock = stock
        self._pinned = pinned
        self._known: tuple[ScoreSettings, dict[tuple[int, float], float]] = (ScoreSettings(), {})

    def of(self, poses: Sequence[PosedStone], score: ScoreSettings) -> NDArray[np.float64]:
        """Return :func:`pose_cost` of candidate poses."""
        weights, known = self._known  # one object: another thread may ask for other weights
        if weights != score:
            known = {}
            self._known = score, known
        costs = np.empty(len(poses))
        for at, posed in enumerate(poses):
            key = posed.stone.id, posed.angle_deg
            cost = known.get(key)
            if cost is None:
                bonus = PIN_BONUS if posed.stone.id in self._pinned else 0.0
                cost = known[key] = pose_cost(posed, self._stock, score) - bonus
            costs[at] = cost
        return costs
