"""The craft terms of an action (see :mod:`drystone.selection.scored`)."""

import math

from drystone.indices import interlocking_width_ratio, inward_slope, is_boundary, left_neighbour
from drystone.kernels.support import free_below, free_beside
from drystone.model.landscape import Landscape, view_box
from drystone.model.pose import PosedStone
from drystone.planner.stock import Rest, Stock
from drystone.selection.scored import Craft, ScoreSettings
from drystone.stabilise.stabilise import Stabilised


def action_craft(landscape: Landscape, stabilised: Stabilised, stock: Stock, rest: Rest) -> Craft:
    """Return the craft terms of a stabilised action.

    Parameters
    ----------
    landscape : Landscape
        Before the action, seen from the side from which the stone is placed.
    stabilised : Stabilised
        The action.
    stock : Stock
        Mean sizes of the stones.
    rest : Rest
        What the stones that are left could fill.
    """
    placement = stabilised.placement
    posed = landscape.view(placement.posed)
    row, col = placement.row, landscape.view_col(placement.posed, placement.col)
    box = view_box(posed, row, col, landscape.height_px)
    under = int(free_below(landscape.occupied, posed.bottom, row, col).sum())
    under -= sum(wedge.area_px for wedge in stabilised.wedges)
    left, right_width = free_beside(landscape.occupied, posed.mask, row, col)
    neighbour = left_neighbour(landscape, box)
    step = 0.0 if neighbour is None else abs(box.top - neighbour.top) / stock.mean_height_px
    if is_boundary(landscape, box, stock.narrowest_px):
        third = inward_slope(landscape, posed, col)
    else:
        third = interlocking_width_ratio(landscape, box, stock.narrowest_px)
    return Craft(
        height=(box.bottom + posed.anchor[1]) / stock.mean_height_px,
        void=under / stock.mean_area_px,
        gap=min(1.0, left / stock.mean_area_px),
        slot=int(rest.width_px[right_width]) * posed.height_px / stock.mean_area_px,
        headroom=int(rest.height_px[landscape.height_px - box.top])
        * posed.width_px
        / stock.mean_area_px,
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
    at least this and its pose.

    Parameters
    ----------
    landscape : Landscape
        Before the action, seen from the side from which the stone is placed.
    posed : PosedStone
        The stone in the same view.
    place : (int, int)
        Row and column of the top-left corner of its mask.
    stock : Stock
        Mean sizes of the stones.
    rest : Rest
        What the stones that are left could fill.
    score : ScoreSettings
        Weights.
    """
    row, col = place
    under = int(free_below(landscape.occupied, posed.bottom, row, col).sum())
    left, right_width = free_beside(landscape.occupied, posed.mask, row, col)
    bottom = landscape.height_px - row - posed.height_px
    slot = int(rest.width_px[right_width]) * posed.height_px
    headroom = int(rest.height_px[row]) * posed.width_px
    mean_area = stock.mean_area_px
    return math.fsum(
        [
            score.height * (bottom + posed.anchor[1]) / stock.mean_height_px,
            score.void * under / mean_area,
            score.gap * min(1.0, left / mean_area),
            score.slot * slot / mean_area,
            score.headroom * headroom / mean_area,
        ]
    )
