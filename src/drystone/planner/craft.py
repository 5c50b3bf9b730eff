"""The craft terms of an action (see :mod:`drystone.selection.scored`)."""

from drystone.indices.interlocking import interlocking_width_ratio
from drystone.indices.inward_slope import inward_slope, is_boundary
from drystone.indices.neighbour_height import left_neighbour
from drystone.kernels.columns import free_below, free_beside
from drystone.model.landscape import Landscape, view_box
from drystone.planner.stock import Rest, Stock
from drystone.selection.scored import Craft
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
