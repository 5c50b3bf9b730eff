"""Rotation first, wedging second (§3.7)."""

from dataclasses import dataclass

from drystone.kernels.raster import Mask
from drystone.model.placement import Placement, Side, Wedge
from drystone.poses import PoseBook
from drystone.stabilise.rotate import rotate_to_rest
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.support import Pose, falling_side, support_polyline
from drystone.stabilise.wedge import wedge_sizes_px, wedge_under


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


@dataclass(frozen=True, eq=False)
class Outcome:
    """What became of a stone that falls.

    Parameters
    ----------
    stabilised : Stabilised or None
        None when it cannot be made stable.
    depth : int
        Rows of the landscape, from the top, that were looked at: in another landscape that is the
        same so far down the outcome is the same.
    """

    stabilised: Stabilised | None
    depth: int


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
    falls = falls_to(occupied, trial, settings)
    if falls is None:
        return None
    if falls == 0:
        return Stabilised(Placement(*trial, side))
    return make_stable(occupied, trial, side, book, wedges, settings).stabilised


def falls_to(occupied: Mask, trial: Pose, settings: StabiliseSettings) -> int | None:
    """Say to which side a stone falls: -1 left, +1 right, 0 stable; None when nothing supports."""
    support = support_polyline(occupied, *trial)
    return None if support is None else falling_side(support, trial, settings)


def make_stable(
    occupied: Mask,
    trial: Pose,
    side: Side,
    book: PoseBook,
    wedges: WedgeStock,
    settings: StabiliseSettings,
) -> Outcome:
    """Turn a stone that falls, or wedge it.

    Parameters
    ----------
    occupied, trial, side, book, wedges, settings
        As for :func:`stabilise`.
    """
    posed, row, col = trial
    depth = row + posed.height_px + 1
    if settings.method in ("both", "rotation"):
        rotation = rotate_to_rest(occupied, trial, book, settings)
        depth = max(depth, rotation.depth)
        if rotation.pose is not None:
            placement = Placement(*rotation.pose, side, rotation_moves=rotation.pivots)
            return Outcome(Stabilised(placement), depth)
    if settings.method in ("both", "wedge"):
        deepest = row + posed.height_px + wedge_sizes_px(wedges.mean_height_px, settings)[1] + 1
        depth = max(depth, deepest)
        cut = _wedges_under(occupied[:deepest], trial, wedges, settings)
        if cut is not None:
            return Outcome(Stabilised(Placement(posed, row, col, side), cut), depth)
    return Outcome(None, depth)


def _wedges_under(
    occupied: Mask, trial: Pose, stock: WedgeStock, settings: StabiliseSettings
) -> tuple[Wedge, ...] | None:
    """Cut a wedge on the side to which the stone falls, then on the other when it falls there.

    The second is for a support too narrow for both margins.
    """
    first = wedge_under(occupied, trial, stock.next_id, stock.mean_height_px, settings)
    if first is None:
        return None
    scene = occupied.copy()
    scene[first.window] |= first.mask
    if falls_to(scene, trial, settings) == 0:
        return (first,)
    second = wedge_under(scene, trial, stock.next_id + 1, stock.mean_height_px, settings)
    if second is None:
        return None
    scene[second.window] |= second.mask
    return (first, second) if falls_to(scene, trial, settings) == 0 else None
