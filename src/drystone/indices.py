"""The indices of one action (§3.5; DESIGN 4.5)."""

import math
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask, rotation, turned_boxes
from drystone.model.landscape import Box, Landscape
from drystone.model.pose import PosedStone

NO_JOINT = 0.5
"""IWR of a stone on the ground, or with nothing below."""


@dataclass(frozen=True)
class Indices:
    """Indices of an action: of the stabilised pose on the landscape before it (LLC: after it).

    SF to IS are those of Eq. 3 to Eq. 10; NHR is best at 0, the others at 1.
    """

    SF: float
    LFR: float
    GDS: float
    NHR: float
    IWR: float
    IS: float
    LLC: float | None  # Eq. 11; None when the wall would not stand
    boundary: bool  # a stone at an end of the wall, where IS stands in for IWR

    @property
    def third(self) -> float:
        """IS for a boundary stone, IWR for an inner one (§3.8)."""
        return self.IS if self.boundary else self.IWR

    def as_dict(self) -> dict[str, float | None]:
        """Return the indices under their names."""
        return {name: getattr(self, name) for name in INDEX_NAMES}


INDEX_NAMES = tuple(field.name for field in fields(Indices) if field.name != "boundary")
"""Names of the indices, in the order of plan.json."""


def shape_factor(posed: PosedStone) -> float:
    """Return SF of a posed stone, in (0, 1]; 1 for an upright rectangle (Eq. 3).

    Its area over that of the bounding box of its turned outline, without resampling.
    """
    turns = np.array([rotation(posed.angle_deg)])
    left, bottom, right, top = turned_boxes(posed.stone.hull, turns)[0].tolist()
    return float(posed.stone.area_px / ((right - left) * (top - bottom)))


def local_filling_ratio_at(landscape: Landscape, posed: PosedStone, row: int, col: int) -> float:
    """Return LFR of a stone at a position, in [0, 1]; 1 where the rays sweep nothing (Eq. 4).

    Counted are the pixels of the site outside the stone that lie left of it in one of its rows or
    below it in one of its columns; rays pass through stones; wedges count as filled.  The stone is
    in the view of the landscape; row and column are those of its mask's top-left corner.
    """
    return float(landscape.rays.filled_share(posed.silhouette, np.array([[row, col]]))[0])


def swept_pixels(landscape: Landscape, posed: PosedStone, row: int, col: int) -> Mask:
    """Return the pixels that the rays of :func:`local_filling_ratio_at` sweep (Fig. 7).

    A mask as large as the landscape.
    """
    stone = np.zeros(landscape.occupied.shape, bool)
    stone[row : row + posed.height_px, col : col + posed.width_px] = posed.mask
    left_of_it = np.logical_or.accumulate(stone[:, ::-1], axis=1)[:, ::-1]
    below_it = np.logical_or.accumulate(stone, axis=0)
    return np.asarray((left_of_it | below_it) & ~stone)


def geometrical_dice_score_at(landscape: Landscape, posed: PosedStone, row: int) -> float:
    """Return GDS of a stone at a row of its mask's top edge, in [0, 1] (Eq. 5).

    GDS = (|S n B| / A_S) (A_B / |S u B|), B the box over the full width of the wall up to the top
    of what is placed.  1: inside B; 0: outside, and before the first stone.

    For all rows at once it is :func:`drystone.kernels.spots.dice_score`, to the last bit.
    """
    mask, box_area = posed.silhouette, float(landscape.width_px * landscape.built_height_px)
    # Pixels of the stone from its row k downwards lie in B when B's top row is k rows below its.
    box_top = landscape.height_px - landscape.built_height_px
    inside = int(mask.area_from[min(max(box_top - row, 0), mask.height)])
    return (inside / posed.area_px) * (box_area / (box_area + posed.area_px - inside))


def left_neighbour(landscape: Landscape, box: Box) -> Box | None:
    """Return the nearest stone on the building side in the same course; None when there is none.

    Its rows overlap the stone's by at least half the smaller of the two heights, and it ends left
    of the stone's middle: outlines may interlock.  Of stones that end at the same place it is the
    higher one, then the first.
    """
    _, right, bottom, top = landscape.box_table
    shared = np.minimum(top, box.top) - np.maximum(bottom, box.bottom)
    level = 2 * shared >= np.minimum(top - bottom, box.height)
    beside = np.flatnonzero(level & (2 * right <= box.left + box.right))
    return max(
        (landscape.boxes[place] for place in beside.tolist()),
        key=lambda other: (other.right, other.top),
        default=None,
    )


def neighbour_height_ratio(
    box: Box, neighbour: Box | None, course_height_px: float | None
) -> float:
    """Return NHR, 0 or larger; 0 is best (Eq. 6-8).

    The first stone of a course has no :func:`left_neighbour` and is compared with the mean height
    of the other candidates; None when there are none.
    """
    if neighbour is not None:
        return abs(box.top - neighbour.top) / box.height
    if course_height_px is None:
        return 0.0
    return abs(box.height - course_height_px) / box.height


def joints_below(landscape: Landscape, box: Box, end_px: float) -> tuple[Box | None, Box | None]:
    """Return the stones below1 and below2 of Eq. 9 (Fig. 7); None where there is none.

    below1 is the stone whose top right corner is closest to the box's bottom left corner, below2
    the one whose top left corner is closest to its bottom right corner, both among the stones
    whose top is not above the stone's vertical centre; of equals the first.  A corner no farther
    than `end_px` from the far end of the wall is none.
    """
    left, right, _, top = landscape.box_table
    below = 2 * top <= box.top + box.bottom
    rise = (top - box.bottom) ** 2
    last = landscape.width_px - end_px

    def nearest(counts: Mask, away_squared: NDArray[np.int64]) -> Box | None:
        places = np.flatnonzero(below & counts)
        return landscape.boxes[places[np.argmin(away_squared[places])]] if places.size else None

    return (
        nearest(right < last, (right - box.left) ** 2 + rise),
        nearest(left > end_px, (left - box.right) ** 2 + rise),
    )


def interlocking_width_ratio(landscape: Landscape, box: Box, end_px: float) -> float:
    """Return IWR in [0, 1]; high where head joints are far from those of the course below (Eq. 9).

    Each term is the horizontal distance from the stone's end to the joint below
    (:func:`joints_below`) over the width of the stone that ends there; IWR is the mean of the
    terms that exist, each clipped to [0, 1].  A corner no farther than `end_px` from the wall's
    end is that end, not a joint.
    """
    if box.bottom == 0:
        return NO_JOINT
    below1, below2 = joints_below(landscape, box, end_px)
    terms = []
    if below1 is not None:
        terms.append(min(1.0, abs(box.left - below1.right) / below1.width))
    if below2 is not None:
        terms.append(min(1.0, abs(box.right - below2.left) / below2.width))
    return sum(terms) / len(terms) if terms else NO_JOINT


def peak_columns(posed: PosedStone) -> tuple[int, int] | None:
    """Return the columns of the highest points of the left and the right half of a stone.

    The halves are split at the centroid; of equal heights the outermost is taken.  None when one
    half has no column.
    """
    top: list[int] = posed.top.tolist()
    x_c = posed.anchor[0]
    # Column k is centred at k + 1/2; one exactly at the centroid belongs to both halves, as x_c
    # does in Eq. 10.
    left_half = top[: max(0, math.floor(x_c + 0.5))]
    right_half = top[max(0, math.ceil(x_c - 0.5)) :]
    if not (left_half and right_half):
        return None
    left = left_half.index(min(left_half))
    return left, len(top) - 1 - right_half[::-1].index(min(right_half))


def inward_slope(landscape: Landscape, posed: PosedStone, col: int) -> float:
    """Return IS in [-1, 1], positive when the top falls towards the middle of the wall (Eq. 10).

    The slope is that between the highest points of the halves (:func:`peak_columns`) of a stone in
    the landscape's view, whose mask has its left edge at a column.
    """
    peaks = peak_columns(posed)
    if peaks is None or peaks[0] == peaks[1]:
        return 0.0
    left, right = peaks
    # Rows count downwards: a smaller row is higher.
    slope = int(posed.top[right] - posed.top[left]) / (left - right)
    centre = col + posed.anchor[0] - landscape.width_px / 2
    side = (centre > 0) - (centre < 0)
    return min(1.0, max(-1.0, slope * side))


def is_boundary(landscape: Landscape, box: Box, narrowest_px: float) -> bool:
    """Say whether a stone is nearer to an end of the wall than the narrowest stone is wide."""
    return min(box.left, landscape.width_px - box.right) < narrowest_px
