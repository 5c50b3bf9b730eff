"""Rotation-based stabilisation about the end of the support polyline (§3.7, Fig. 9b)."""

import math

import numpy as np

from drystone.kernels.raster import Mask, rotation
from drystone.model.pose import PosedStone
from drystone.poses import PoseBook
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.support import Support, support_polyline

Pose = tuple[PosedStone, int, int]


def rotate_to_rest(
    occupied: Mask, trial: Pose, book: PoseBook, settings: StabiliseSettings
) -> tuple[Pose, int] | None:
    """Turn an unstable stone about A, the nearer end of its support, until it rests (§3.7).

    The stone turns towards the side to which it falls, in steps of a degree.  Each step takes the
    turned stone from its source pixels, keeps point A in place to the nearest pixel, and seats it
    on the landscape again; new contacts give a new support polyline and, when that does not hold
    either, a new point A.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape.
    trial : (PosedStone, int, int)
        The stone and the row and column of its mask; overlapping nothing, supported somewhere.
    book : PoseBook
        Gives the turned stones.
    settings : StabiliseSettings
        Margin, steps and limits.

    Returns
    -------
    pose, pivots : (PosedStone, int, int), int
        The stable pose and the number of pivots; None when the stone meets the landscape before
        it rests, or a limit is reached.
    """
    pose = trial
    first_angle = trial[0].angle_deg
    for pivots in range(settings.max_pivots + 1):
        support = support_polyline(occupied, *pose)
        if support is None:
            return None
        side = _falls(support, pose, settings)
        if side == 0:
            return pose, pivots
        if pivots == settings.max_pivots:
            return None
        turned = _turn_about(occupied, pose, support, side, first_angle, book, settings)
        if turned is None:
            return None
        pose = turned
    return None


def _falls(support: Support, pose: Pose, settings: StabiliseSettings) -> int:
    posed, _, col = pose
    return support.falls(col + posed.anchor[0], settings.margin * posed.width_px)


def _turn_about(
    occupied: Mask,
    start: Pose,
    support: Support,
    side: int,
    first_angle_deg: float,
    book: PoseBook,
    settings: StabiliseSettings,
) -> Pose | None:
    """Turn about one end of the support until the stone rests or stands on something new."""
    posed, row, col = start
    x_a, row_a = (
        (support.left_x, support.left_row) if side < 0 else (support.right_x, support.right_row)
    )
    steps = math.floor(settings.max_turn_deg / settings.step_deg + 1e-9)
    for step in range(1, 2 * steps + 1):
        # Falling to the right is turning clockwise, a negative angle.
        turn_deg = -side * step * settings.step_deg
        total = posed.angle_deg + turn_deg - first_angle_deg
        total -= 360.0 * round(total / 360.0)
        if abs(total) > settings.max_turn_deg + 1e-9:
            return None
        turned = book.pose(posed.stone, posed.angle_deg + turn_deg)
        # Centroid relative to A, y up, turned with the stone.
        dx = col + posed.anchor[0] - x_a
        dy = row_a - (row + posed.height_px - posed.anchor[1])
        cos, sin = rotation(turn_deg)
        x_c, y_up = x_a + cos * dx - sin * dy, sin * dx + cos * dy
        new_col = math.floor(x_c - turned.anchor[0] + 0.5)
        new_row = math.floor(row_a - y_up + turned.anchor[1] - turned.height_px + 0.5)
        seated = seat(occupied, turned, new_row, new_col, settings.max_shift_px)
        if seated is None:
            return None
        pose = (turned, seated, new_col)
        new = support_polyline(occupied, *pose)
        if new is None:
            return None
        falls = _falls(new, pose, settings)
        pivot_x = new.left_x if side < 0 else new.right_x
        if falls != side or abs(pivot_x - x_a) > settings.new_pivot_px:
            return pose
    return None


def seat(occupied: Mask, posed: PosedStone, row: int, col: int, reach_px: int) -> int | None:
    """Return the row nearest to a given one at which a stone rests in its column.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape.
    posed : PosedStone
        The stone.
    row, col : int
        Where its mask should go.
    reach_px : int
        How far up or down it may be moved.

    Returns
    -------
    row : int or None
        None when it overlaps something, leaves the site, or hangs in the air in all these rows.
    """
    height, width = occupied.shape
    lowest = height - posed.height_px
    if col < 0 or col + posed.width_px > width:
        return None
    window = occupied[:, col : col + posed.width_px]

    def free(at: int) -> bool:
        return 0 <= at <= lowest and not np.any(window[at : at + posed.height_px] & posed.mask)

    shifts = sorted(range(-reach_px, reach_px + 1), key=lambda shift: (abs(shift), -shift))
    return next((row + s for s in shifts if free(row + s) and not free(row + s + 1)), None)
