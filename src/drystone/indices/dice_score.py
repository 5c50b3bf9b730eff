"""GDS: how much a stone fills the part of the wall that is begun (Eq. 5)."""

from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone


def geometrical_dice_score_at(landscape: Landscape, posed: PosedStone, row: int) -> float:
    """Return GDS of a stone at a row, in [0, 1] (Eq. 5).

    GDS = (|S n B| / A_S) (A_B / |S u B|), B the box over the full width of the wall up to the top
    of what is placed.  1: inside B; 0: outside, and before the first stone.

    For all rows at once it is :func:`drystone.kernels.merits.dice_score`, to the last bit.

    Parameters
    ----------
    landscape : Landscape
        Before the stone is placed.
    posed : PosedStone
        The stone.
    row : int
        Row of the mask's top edge.
    """
    mask, box_area = posed.silhouette, float(landscape.width_px * landscape.built_height_px)
    # Pixels of the stone from its row k downwards lie in B when B's top row is k rows below its.
    box_top = landscape.height_px - landscape.built_height_px
    inside = int(mask.area_from[min(max(box_top - row, 0), mask.height)])
    return (inside / posed.area_px) * (box_area / (box_area + posed.area_px - inside))
