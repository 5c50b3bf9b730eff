"""All figures of merit of a wall at once (§5.2, DESIGN 5)."""

import math
from collections.abc import Collection
from dataclasses import dataclass

from drystone.errors import UsageError
from drystone.metrics.frame import frame_wall
from drystone.metrics.paths import horizontal_arrangement, joint_mask, vertical_arrangement
from drystone.metrics.shape import flush_deviation, level_deviation, stone_sizes
from drystone.model.wall import Labels, picture_of_ids

MOST_PX = 200_000_000
"""Of the picture that is measured, with what is missing of the wall at its ends."""


@dataclass(frozen=True)
class WallMetrics:
    """Figures of merit of a wall at the resolution of its image.

    Parameters
    ----------
    F_SF : float
        Filling, the area of the stones over that of the wall, higher is better (Eq. 25): 0 to 1,
        more only when stones overlap or leave the wall.
    F_AV : float or None
        Vertical arrangement in percent, higher is better (Eq. 27); None in an image too narrow
        for the path starts (20 px with its padding).
    F_AH : float or None
        Horizontal arrangement in percent, lower is better (Eq. 26); None in one too low.
    F_LR : float or None
        Lateral resistance over mu, higher is better (Eq. 28); None when it was not computed or
        the wall has none.
    T_LEVEL, E_FLUSH : float
        Unevenness of the top and of the ends in stone heights and widths, lower is better.
    stones : int
        Number of stones, wedges left out.
    width, height : float
        Of the wall that `F_SF` refers to, px.
    """

    F_SF: float
    F_AV: float | None
    F_AH: float | None
    F_LR: float | None
    T_LEVEL: float
    E_FLUSH: float
    stones: int
    width: float
    height: float


def measure_labels(
    labels: Labels,
    *,
    wall_px: tuple[float, float] | None = None,
    wedge_ids: Collection[int] = frozenset(),
    stone_area_px: float | None = None,
    lateral_resistance: float | None = None,
) -> WallMetrics:
    """Measure any wall, ours or a mason's, from its image of labels.

    Parameters
    ----------
    labels : (h, w) integer array
        0 where nothing is, row 0 at the top.
    wall_px : (float, float), optional
        Width and height of the wall that was to be built, px of the image; by default the
        bounding box of the stones.
    wedge_ids : collection of int
        Labels that are wedges: left out of `F_SF`, of the mean sizes and of the count, a stone
        like any other for joints, top and ends.  Those without a pixel, as thin wedges on outlines
        may be, change nothing.
    stone_area_px : float, optional
        Area of the stones when it is known better than from the pixels, as in plans: nearest
        sampling changes a mask by up to 3.5 %, and a search would pick the larger ones.
    lateral_resistance : float, optional
        F_LR of the wall (:attr:`drystone.statics.result.LateralResistance.value`); statics of a
        plan comes from outlines, which are not in the image.

    Raises
    ------
    LabelImageError
        E104 when there is no stone in the image; E301 when the array is no picture of ids.
    UsageError
        E121 when `wall_px` is no width and height, positive and finite, or fills the memory; E138
        when the area of the stones or F_LR is below 0 or not finite.

    Examples
    --------
    >>> import numpy as np
    >>> wall = np.repeat(np.repeat([[1, 1, 2], [3, 4, 4]], 10, axis=0), 20, axis=1)
    >>> metrics = measure_labels(wall.astype(np.uint32))
    >>> metrics.F_SF, metrics.T_LEVEL, metrics.E_FLUSH, metrics.stones
    (1.0, 0.0, 0.0, 4)
    """
    known = {"stone_area_px": stone_area_px, "lateral_resistance": lateral_resistance}
    for name, value in known.items():
        if value is not None and not 0 <= value < math.inf:
            what = f"it must be finite and 0 or more, not {value}."
            raise UsageError("E138", what, where=name, cure="Leave it out where it is not known.")
    sides: tuple[float, ...] = (1.0, 1.0) if wall_px is None else wall_px
    if len(sides) != 2 or not all(0 < side < math.inf for side in sides):
        what = f"a wall of {' x '.join(f'{side:g}' for side in sides)} px has no room."
        cure = "Give a wall with a positive, finite width and height."
        raise UsageError("E121", what, where="--wall", cure=cure)
    labels = picture_of_ids(labels)
    if wall_px is not None and wall_px[0] * labels.shape[0] > MOST_PX:
        raise UsageError(
            "E121",
            f"a wall of {wall_px[0]:g} x {wall_px[1]:g} px is too wide for its picture of "
            f"{labels.shape[1]} x {labels.shape[0]} px.",
            where="--wall",
            cure="Give the wall in px of the picture that is measured.",
        )
    frame = frame_wall(labels, None if wall_px is None else wall_px[0])
    if wall_px is None:
        wall_px = (float(frame.labels.shape[1]), float(frame.labels.shape[0]))
    sizes = stone_sizes(frame.labels, wedge_ids)
    area_px = sizes.area_px if stone_area_px is None else stone_area_px
    joint = joint_mask(frame.labels)
    return WallMetrics(
        F_SF=area_px / (wall_px[0] * wall_px[1]),
        F_AV=vertical_arrangement(joint),
        F_AH=horizontal_arrangement(joint),
        F_LR=lateral_resistance,
        T_LEVEL=level_deviation(frame.labels, sizes.mean_height_px),
        E_FLUSH=flush_deviation(frame, sizes.mean_width_px),
        stones=sizes.count,
        width=wall_px[0],
        height=wall_px[1],
    )
