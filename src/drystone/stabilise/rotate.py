"""Rotation-based stabilisation about the end of the support polyline (§3.7, Fig. 9b)."""

import math
from dataclasses import dataclass

from drystone.kernels.raster import Mask, rotation
from drystone.kernels.support import resting_place
from drystone.poses import PoseBook
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.support import Pose, Support, falling_side, support_polyline


@dataclass(frozen=True, eq=False)
class Rotation:
    """What became of a stone that was turned."""

    # where it rests; None when it meets the landscape before it does, or a limit is reached
    pose: Pose | None
    pivots: int  # how many points it was turned about
    # rows of the landscape, from the top, that were looked at: what is further down has no
    # say
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
