"""Rotation first, wedging second (§3.7)."""

from dataclasses import dataclass

from drystone.kernels.raster import Mask
from drystone.model.placement import Placement, Side, Wedge
from drystone.poses import PoseBook
from drystone.stabilise.rotate import Pose, rotate_to_rest
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.support import support_polyline
from drystone.stabilise.wedge import wedge_under


@dataclass(frozen=True, eq=False)
class Stabilised:
    """A stable placement with the wedges that make it so.

    Parameters
    ----------
    placement : Placement
        The stone.
    wedges : tuple of Wedge
        Empty when the stone rests by itself.
    """

    placement: Placement
    wedges: tuple[Wedge, ...] = ()


@dataclass(frozen=True)
class WedgeStock:
    """What cutting a wedge needs to know of the whole.

    Parameters
    ----------
    next_id : int
        Id of the next wedge.
    mean_height_px : float
        Mean height of the stones of the set in their initial poses, working px.
    """

    next_id: int
    mean_height_px: float


def stabilise(
    occupied: Mask,
    trial: Pose,
    side: Side,
    book: PoseBook,
    wedges: WedgeStock,
    settings: StabiliseSettings,
) -> Stabilised | None:
    """Return a stable placement from a trial one; None when it cannot be made stable (§3.7).

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape without the stone.
    trial : (PosedStone, int, int)
        The stone and the row and column of its mask.
    side : {"left", "right"}
        End of the wall from which it is placed.
    book : PoseBook
        Gives turned stones.
    wedges : WedgeStock
        For cutting wedges.
    settings : StabiliseSettings
        Which methods, with which limits.
    """
    posed, row, col = trial
    support = support_polyline(occupied, posed, row, col)
    if support is None:
        return None
    if support.falls(col + posed.anchor[0], settings.margin * posed.width_px) == 0:
        return Stabilised(Placement(posed, row, col, side))
    if settings.method in ("both", "rotation"):
        rotated = rotate_to_rest(occupied, trial, book, settings)
        if rotated is not None:
            (turned, row, col), pivots = rotated
            return Stabilised(Placement(turned, row, col, side, rotation_moves=pivots))
    if settings.method in ("both", "wedge"):
        cut = _wedges_under(occupied, trial, wedges, settings)
        if cut is not None:
            return Stabilised(Placement(posed, trial[1], trial[2], side), cut)
    return None


def _wedges_under(
    occupied: Mask, trial: Pose, stock: WedgeStock, settings: StabiliseSettings
) -> tuple[Wedge, ...] | None:
    """Cut a wedge on the side to which the stone falls, then on the other when it falls there.

    The second is for a support too narrow for both margins.
    """
    posed, row, col = trial
    scene = occupied.copy()
    cut: list[Wedge] = []
    for wedge_id in (stock.next_id, stock.next_id + 1):
        wedge = wedge_under(scene, trial, wedge_id, stock.mean_height_px, settings)
        if wedge is None:
            return None
        scene[wedge.window] |= wedge.mask
        cut.append(wedge)
        support = support_polyline(scene, posed, row, col)
        margin_px = settings.margin * posed.width_px
        if support is not None and support.falls(col + posed.anchor[0], margin_px) == 0:
            return tuple(cut)
    return None
