"""Rotation about an end of the support first, wedging of the free side second (§3.7, Fig. 9)."""

import math
from dataclasses import dataclass

from drystone.kernels.raster import Mask, rotation
from drystone.kernels.support import gap_filling, resting_place, support_ends
from drystone.model.placement import Placement, Side, Wedge
from drystone.model.pose import PosedStone
from drystone.model.wall import Group
from drystone.poses import PoseBook
from drystone.stabilise.settings import StabiliseSettings

Pose = tuple[PosedStone, int, int]
"""A turned stone, and the row and column of its mask's top-left corner."""


@dataclass(frozen=True)
class Support:
    """The ends of the support polyline, in image coordinates (x right, rows downwards)."""

    # x of A and B: the outer edges of the outermost supporting pixels
    left_x: int
    right_x: int
    # rows of the edges on which they stand
    left_row: int
    right_row: int


def support_polyline(occupied: Mask, posed: PosedStone, row: int, col: int) -> Support | None:
    """Return the support polyline of a stone at a position; None when nothing supports it.

    A pixel supports where the stone moved down by one would overlap a stone, a wedge or the
    ground; a touch at the side carries nothing (DESIGN 4.6).  The ends of the wall carry nothing.
    `occupied` is the landscape without the stone.
    """
    ends = support_ends(occupied, posed.mask, row, col)
    return None if ends is None else Support(*ends)


def falling_side(support: Support, pose: Pose, settings: StabiliseSettings) -> int:
    """Say to which side a stone on its support falls: -1 left, +1 right, 0 when it is stable.

    Stable: the centre of mass projects inside AB, at least by the margin (0 in the paper) from
    both ends; of a support too short for both margins the nearer end decides.
    """
    posed, _, col = pose
    x_c = col + posed.anchor[0]
    from_left, from_right = x_c - support.left_x, support.right_x - x_c
    if min(from_left, from_right) >= settings.margin * posed.width_px:
        return 0
    return -1 if from_left < from_right else 1


@dataclass(frozen=True, eq=False)
class Rotation:
    """What became of a stone that was turned."""

    # where it rests; None when it meets the landscape before it does, or a limit is reached
    pose: Pose | None
    pivots: int  # how many points it was turned about
    # rows of the landscape, from the top, that were looked at: what is further down has no say
    depth: int


def rotate_to_rest(
    occupied: Mask, trial: Pose, book: PoseBook, settings: StabiliseSettings
) -> Rotation:
    """Turn an unstable stone about A, the nearer end of its support, until it rests (§3.7).

    The stone turns towards the side to which it falls, in steps of a degree.  Each step takes the
    turned stone from its source pixels, keeps point A in place to the nearest pixel, and seats it
    on the landscape again; new contacts give a new support polyline and, when that does not hold
    either, a new point A.  At first it overlaps nothing, and is supported somewhere.
    """
    pose, depth = trial, trial[1] + trial[0].height_px + 1
    support = support_polyline(occupied, *trial)
    if support is None:
        return Rotation(None, 0, depth)
    for pivots in range(settings.max_pivots):
        side = falling_side(support, pose, settings)
        if side == 0:
            return Rotation(pose, pivots, depth)
        end, seen = _turn_about(occupied, pose, support, side, trial[0].angle_deg, book, settings)
        depth = max(depth, seen)
        if end is None:
            return Rotation(None, pivots, depth)
        pose, support = end
    rests = falling_side(support, pose, settings) == 0
    return Rotation(pose if rests else None, settings.max_pivots, depth)


def _turn_about(
    occupied: Mask,
    start: Pose,
    support: Support,
    side: int,
    first_angle_deg: float,
    book: PoseBook,
    settings: StabiliseSettings,
) -> tuple[tuple[Pose, Support] | None, int]:
    """Turn about one end of the support until the stone rests or stands on something new.

    Where it stands then, if it does; and the rows looked at.
    """
    posed, row, col = start
    x_a, row_a = (
        (support.left_x, support.left_row) if side < 0 else (support.right_x, support.right_row)
    )
    # Centroid relative to A, y up.
    dx = col + posed.anchor[0] - x_a
    dy = row_a - (row + posed.height_px - posed.anchor[1])
    depth, reach = 0, settings.max_shift_px
    steps = math.floor(settings.max_turn_deg / settings.step_deg + 1e-9)
    for step in range(1, 2 * steps + 1):
        # Falling to the right is turning clockwise, a negative angle.
        turn_deg = -side * step * settings.step_deg
        total = posed.angle_deg + turn_deg - first_angle_deg
        total -= 360.0 * round(total / 360.0)
        if abs(total) > settings.max_turn_deg + 1e-9:
            break
        turned = book.pose(posed.stone, posed.angle_deg + turn_deg)
        height, (anchor_x, anchor_y) = turned.height_px, turned.anchor
        cos, sin = rotation(turn_deg)
        x_c, y_up = x_a + cos * dx - sin * dy, sin * dx + cos * dy
        new_col = math.floor(x_c - anchor_x + 0.5)
        new_row = math.floor(row_a - y_up + anchor_y - height + 0.5)
        depth = max(depth, new_row + reach + height + 1)
        place = resting_place(occupied, turned.mask, new_row, new_col, reach)
        if place is None:
            break
        new, pose = Support(*place[1]), (turned, place[0], new_col)
        pivot_x = new.left_x if side < 0 else new.right_x
        moved = abs(pivot_x - x_a) > settings.new_pivot_px
        if moved or falling_side(new, pose, settings) != side:
            return (pose, new), depth
    return None, depth


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
    """Turn a stone that falls, or wedge it (§3.7); `occupied` is the landscape without it."""
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
    scene, cut = occupied.copy(), list[Wedge]()
    for number in (stock.next_id, stock.next_id + 1):
        wedge = wedge_under(scene, trial, number, stock.mean_height_px, settings)
        if wedge is None:
            return None
        cut.append(wedge)
        scene[wedge.window] |= wedge.mask
        if falls_to(scene, trial, settings) == 0:
            return tuple(cut)
    return None


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
    side = falls_to(occupied, pose, settings)
    if not side:
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
