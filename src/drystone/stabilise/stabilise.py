"""Rotation first, wedging second: a small stone under the free side (§3.7, Fig. 9c)."""

import math
from dataclasses import dataclass

from drystone.kernels.raster import Mask
from drystone.kernels.support import gap_filling
from drystone.model.placement import Placement, Side, Wedge
from drystone.model.wall import Group
from drystone.poses import PoseBook
from drystone.stabilise.rotate import rotate_to_rest
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.support import Pose, falling_side, support_polyline


@dataclass(frozen=True)
class WedgeStock:
    """What cutting a wedge needs to know of the whole."""

    next_id: int
    mean_height_px: float  # mean height of the stones of the set in their initial poses, working px


@dataclass(frozen=True, eq=False)
class Outcome:
    """What became of a stone that falls."""

    stabilised: Group | None  # None when it cannot be made stable
    # rows of the landscape, from the top, that were looked at: in another landscape that is
    # the same so far down the outcome is the same
    depth: int


def stabilise(
    occupied: Mask,
    trial: Pose,
    side: Side,
    book: PoseBook,
    wedges: WedgeStock,
    settings: StabiliseSettings,
) -> Group | None:
    """Return a stable placement from a trial one; None when it cannot be made stable (§3.7).

    `occupied` is the landscape without the stone.
    """
    falls = falls_to(occupied, trial, settings)
    if falls is None:
        return None
    if falls == 0:
        return Group(Placement(*trial, side))
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
    """Turn a stone that falls, or wedge it; arguments as for :func:`stabilise`."""
    posed, row, col = trial
    depth = row + posed.height_px + 1
    if settings.method in ("both", "rotation"):
        rotation = rotate_to_rest(occupied, trial, book, settings)
        depth = max(depth, rotation.depth)
        if rotation.pose is not None:
            placement = Placement(*rotation.pose, side, rotation_moves=rotation.pivots)
            return Outcome(Group(placement), depth)
    if settings.method in ("both", "wedge"):
        deepest = row + posed.height_px + wedge_sizes_px(wedges.mean_height_px, settings)[1] + 1
        depth = max(depth, deepest)
        cut = _wedges_under(occupied[:deepest], trial, wedges, settings)
        if cut is not None:
            return Outcome(Group(Placement(posed, row, col, side), cut), depth)
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


def wedge_sizes_px(mean_height_px: float, settings: StabiliseSettings) -> tuple[int, int]:
    """Return the smallest height and width, and the largest height, of a wedge in whole px."""
    smallest = settings.min_wedge_px
    return smallest, math.floor(max(smallest, settings.max_wedge_height * mean_height_px))


def wedge_under(
    occupied: Mask, pose: Pose, wedge_id: int, mean_height_px: float, settings: StabiliseSettings
) -> Wedge | None:
    """Cut the wedge that keeps an unstable stone where it is (§3.7, Fig. 9c); None when none does.

    The free side is the part of the stone beyond the end of its support to which it falls.  It is
    lowered in thought until it touches; how far gives the wedge's height, the columns that touch
    then give its width.  Only columns far enough out to bring the centre of mass inside the new
    support count.  The wedge is the gap itself in those columns, so it touches the stone above
    and what is below all along.
    """
    posed, row, col = pose
    support = support_polyline(occupied, posed, row, col)
    side = 0 if support is None else falling_side(support, pose, settings)
    if side == 0:
        return None
    sizes = wedge_sizes_px(mean_height_px, settings)
    # The columns whose support would bring the centre of mass inside, first and end.
    x_c, margin = col + posed.anchor[0], settings.margin * posed.width_px
    if side > 0:  # the right edge of a column at the centre of mass, or beyond it by the margin
        columns = max(0, math.ceil(x_c + margin) - 1 - col), posed.width_px
    else:  # a narrow stone may have none: its centre of mass is nearer to the end than the margin
        columns = 0, max(0, min(posed.width_px, math.floor(x_c - margin) + 1 - col))
    filling = gap_filling(occupied, posed.mask, row, col, columns, sizes)
    # Between sloping faces a wedge may be higher than each of its columns.
    if filling is None or filling[0].shape[0] > sizes[1]:
        return None
    return Wedge(wedge_id, posed.stone.id, *filling)
