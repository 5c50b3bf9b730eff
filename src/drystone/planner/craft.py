"""The craft terms of an action and of a pose (see :mod:`drystone.selection.scored`)."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from drystone.indices import interlocking_width_ratio, inward_slope, is_boundary, left_neighbour
from drystone.kernels.support import free_below, free_beside
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.model.wall import Group
from drystone.planner.stock import Rest, Stock
from drystone.selection.scored import PIN_BONUS, Craft, ScoreSettings


def action_craft(landscape: Landscape, stabilised: Group, stock: Stock, rest: Rest) -> Craft:
    """Return the craft terms of a stabilised action.

    The landscape is that before the action, seen from the side from which the stone is placed.
    """
    posed, box = landscape.view(stabilised.placement.posed), landscape.box(stabilised.placement)
    at = stabilised.placement.row, box.left
    wedges_px = sum(wedge.area_px for wedge in stabilised.wedges)
    neighbour = left_neighbour(landscape, box)
    step = 0.0 if neighbour is None else abs(box.top - neighbour.top) / stock.mean_height_px
    if is_boundary(landscape, box, stock.narrowest_px):
        third = inward_slope(landscape, posed, box.left)
    else:
        third = interlocking_width_ratio(landscape, box, stock.narrowest_px)
    return Craft(
        **_room(landscape, posed, at, stock, rest, wedges_px),
        step=step,
        roughness=posed.top_roughness_px / stock.mean_height_px,
        upright=max(0.0, 1.0 - posed.width_px / posed.height_px),
        joint=1.0 - third,
        area=posed.area_px / stock.mean_area_px,
        thickness=min(posed.width_px, posed.height_px) / stock.mean_height_px,
    )


def place_cost(
    landscape: Landscape,
    posed: PosedStone,
    place: tuple[int, int],
    stock: Stock,
    rest: Rest,
    score: ScoreSettings,
) -> float:
    """Return the weighted craft costs of a place that are quickly found, before stabilising.

    They are those of :func:`action_craft` but for what the pose itself costs, the step to the
    neighbour and the joint, none of which is below 0: a stone that stays there by itself costs
    at least this and its pose.  `posed` is the stone in the view of the landscape, `place` the row
    and column of the top-left corner of its mask.
    """
    terms = _room(landscape, posed, place, stock, rest)
    return math.fsum(getattr(score, name) * term for name, term in terms.items())


def _room(
    landscape: Landscape,
    posed: PosedStone,
    place: tuple[int, int],
    stock: Stock,
    rest: Rest,
    wedges_px: int = 0,
) -> dict[str, float]:
    """Return the terms of :class:`Craft` that a place has, by their names."""
    row, col = place
    bottom = landscape.height_px - row - posed.height_px
    under = int(free_below(landscape.occupied, posed.bottom, row, col).sum()) - wedges_px
    left, right_width = free_beside(landscape.occupied, posed.mask, row, col)
    return {
        "height": (bottom + posed.anchor[1]) / stock.mean_height_px,
        "void": under / stock.mean_area_px,
        "gap": min(1.0, left / stock.mean_area_px),
        "slot": int(rest.width_px[right_width]) * posed.height_px / stock.mean_area_px,
        "headroom": int(rest.height_px[row]) * posed.width_px / stock.mean_area_px,
    }


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
    """Costs of poses by the weights that were asked for last; pinned stones earn a bonus."""

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
