"""Coursed rubble: irregular stones of a few course heights, enough for one wall."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from drystone.generate.layout import (
    check_room,
    check_setting,
    polygon_area,
    stones_of,
    whole_mask,
)
from drystone.kernels.polygons import Points, turn
from drystone.model.settings import typed
from drystone.model.stone import StoneSet

LOOSE_COURSE = 0.08
"""Stones are up to this share lower than their course."""

NARROWEST, WIDEST = 0.65, 1.35
"""Range of the stones' widths in a course, over their mean."""


@typed
@dataclass(frozen=True, kw_only=True)
class RubbleSettings:
    """Rubble for a wall of a given size.

    Parameters
    ----------
    count : int
        Number of stones, at least one per course.
    width_px, height_px : float
        Of the wall that they are for, at least 4 px for each course, and for each stone of one.
    area_ratio : float
        Area of all stones over the area of the wall, above 0, at most 0.95.
    courses : int
        Number of course heights.
    spread : float
        How much higher the highest course is than the lowest, over their mean; 0 ... 1.
    roughness : float
        How far corners are moved inwards at most, over the stone's height, outwards half as far;
        0 ... 0.3.
    pentagons : float
        Share of the stones that have a fifth corner, on the upper face; 0 ... 1.
    rounding : float
        How much of a side is cut away at each corner; 0 ... 0.3.
    tilt_deg : float
        Stones lie turned by up to this angle to either side; 0 ... 360.
    """

    count: int = 30
    width_px: float = 280.0
    height_px: float = 80.0
    area_ratio: float = 0.88
    courses: int = 4
    spread: float = 0.3
    roughness: float = 0.12
    pentagons: float = 0.3
    rounding: float = 0.1
    tilt_deg: float = 10.0

    def __post_init__(self) -> None:
        for ok, what in (
            (1 <= self.courses <= self.count, "there must be a stone for every course"),
            (self.height_px >= 4 * self.courses, "the courses must be 4 px high or more"),
            (
                self.width_px * self.courses >= 4 * self.count,
                "the stones must be 4 px wide or more",
            ),
            (0 < self.area_ratio <= 0.95, "area_ratio must be above 0 and at most 0.95"),
            (0 <= self.spread <= 1, "spread must be between 0 and 1"),
            (0 <= self.roughness <= 0.3, "roughness must be between 0 and 0.3"),
            (0 <= self.pentagons <= 1, "pentagons must be between 0 and 1"),
            (0 <= self.rounding <= 0.3, "rounding must be between 0 and 0.3"),
            (0 <= self.tilt_deg <= 360, "tilt_deg must be between 0 and 360"),
        ):
            check_setting(ok, what, "rubble")
        # Long stones that lie askew have large boxes.
        names = ("width_px", "height_px") + (("tilt_deg",) if self.tilt_deg else ())
        # The box about a stone of middle size that is tilted most.
        width, height = self.width_px * self.courses / self.count, self.height_px / self.courses
        tilt = math.radians(min(self.tilt_deg, 45.0))
        cos, sin = math.cos(tilt), math.sin(tilt)
        size_px = width * cos + height * sin, width * sin + height * cos
        check_room(self.count, size_px, names, "rubble")


def course_sizes(settings: RubbleSettings, rng: Generator) -> NDArray[np.float64]:
    """Draw the boxes of the stones, (count, 2) in px, course by course from the highest.

    The courses fill the height of the wall, and each is as long as it.
    """
    share = np.linspace(1 + settings.spread / 2, 1 - settings.spread / 2, settings.courses)
    heights = share * settings.height_px / settings.courses
    # High courses have fewer, wider stones, so that all have about the same proportions.
    ends = np.cumsum(1 / heights) / (1 / heights).sum()
    counts = np.diff(np.round(ends * (settings.count - settings.courses)), prepend=0) + 1
    sizes = []
    for height, count in zip(heights, counts.astype(int), strict=True):
        widths = rng.uniform(NARROWEST, WIDEST, count)
        lower = rng.uniform(0, LOOSE_COURSE, count)
        sizes.append(
            np.column_stack([widths * settings.width_px / widths.sum(), height * (1 - lower)])
        )
    return np.concatenate(sizes)


def rubble_outline(
    width_px: float, height_px: float, settings: RubbleSettings, rng: Generator
) -> Points:
    """Draw one stone about a box: four or five corners moved a little, then cut off twice.

    Counter-clockwise, convex or nearly so.
    """
    inwards = rng.uniform(-0.5, 1.0, (4, 2)) * settings.roughness * height_px
    x = np.array([0.0, width_px, width_px, 0.0]) + inwards[:, 0] * [1, -1, -1, 1]
    y = np.array([0.0, 0.0, height_px, height_px]) + inwards[:, 1] * [1, 1, -1, -1]
    corners = np.column_stack([x, y])
    ridge = rng.uniform(0.3, 0.7) * width_px
    if rng.uniform() < settings.pentagons:
        corners = np.insert(corners, 3, [ridge, height_px], axis=0)
    return _cut_corners(_cut_corners(corners, settings.rounding), settings.rounding)


@typed
def rubble_stones(settings: RubbleSettings, rng: Generator) -> StoneSet:
    """Generate coursed rubble whose total area suits a wall, in random order.

    Parameters
    ----------
    settings : RubbleSettings
        The wall and how the stones look.
    rng : Generator
        Equal states give equal stones.

    Raises
    ------
    UsageError
        E130 when the stones are too small to be drawn in one piece.

    Examples
    --------
    >>> stones = rubble_stones(RubbleSettings(), np.random.default_rng(1))
    >>> len(stones), round(stones.total_area_px / (280 * 80), 2)
    (30, 0.88)
    """
    sizes = rng.permutation(course_sizes(settings, rng))
    outlines = [rubble_outline(width, height, settings, rng) for width, height in sizes.tolist()]
    target = settings.area_ratio * settings.width_px * settings.height_px
    factor = math.sqrt(target / sum(polygon_area(outline) for outline in outlines))
    tilts = rng.uniform(-settings.tilt_deg, settings.tilt_deg, len(outlines)).tolist()
    tilted = (turn(factor * outline, tilt) for outline, tilt in zip(outlines, tilts, strict=True))
    masks = [mask for outline in tilted if (mask := whole_mask(outline)) is not None]
    whole = len(masks) == len(outlines)
    check_setting(whole, "the stones must be large enough to be one piece of pixels", "rubble")
    return stones_of(masks)


def _cut_corners(corners: Points, share: float) -> Points:
    """Replace each corner by two points on its sides (Chaikin's corner cutting)."""
    following = np.roll(corners, -1, axis=0)
    near, far = corners + share * (following - corners), following + share * (corners - following)
    return np.stack([near, far], axis=1).reshape(-1, 2)
