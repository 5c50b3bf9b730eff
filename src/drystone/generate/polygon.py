"""Noisy polygons as in Thangavelu et al. (2018), the paper's first series of §5.3."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

import numpy as np
import shapely
from numpy.random import Generator
from scipy.spatial import ConvexHull

from drystone.generate.layout import (
    accepted,
    check_room,
    check_setting,
    polygon_area,
    stones_of,
    whole_mask,
)
from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask
from drystone.model.settings import typed
from drystone.model.stone import StoneSet

SMALLEST_SHARE = 0.1
"""Polygons with less than this share of the brick's area are splinters and rejected."""


@typed
@dataclass(frozen=True, kw_only=True)
class PolygonSettings:
    """Bricks of a running bond whose corners are moved at random.

    Parameters
    ----------
    count : int
        Number of stones.
    width_px, height_px : float
        Of the brick before noise, at least 4 px.
    noise : float
        Standard deviation of each coordinate of a corner over the brick's shorter side: 0.1 ... 0.8
        for the paper's sets of 10 ... 80 %.  At most 2.
    convex : bool
        Take the convex hull of the moved corners, as all published stones are convex; else keep
        the polygon of six corners itself.
    """

    count: int = 28
    width_px: float = 130.0
    height_px: float = 90.0
    noise: float = 0.2
    convex: bool = True

    def __post_init__(self) -> None:
        check_setting(self.count >= 1, "count must be at least 1", "polygon")
        side = min(self.width_px, self.height_px)
        check_setting(side >= 4, "width and height must be 4 px or more", "polygon")
        check_setting(0 <= self.noise <= 2, "noise must be between 0 and 2", "polygon")
        size_px = self.width_px, self.height_px
        check_room(self.count, size_px, ("width_px", "height_px", "count"), "polygon")


def noisy_polygon(settings: PolygonSettings, rng: Generator) -> Points | None:
    """Draw one brick with moved corners.

    A brick of a running bond has six corners: its own four and, in the middle of each bed face,
    the head joint of the next course.  Counter-clockwise when convex; None for a splinter or a
    polygon that crosses itself.
    """
    width, height = settings.width_px, settings.height_px
    x = np.array([0.0, width / 2, width, width, width / 2, 0.0])
    y = np.array([0.0, 0.0, 0.0, height, height, height])
    deviation = settings.noise * min(width, height)
    corners = np.column_stack([x, y]) + rng.normal(0.0, deviation, (6, 2))
    if settings.convex:
        corners = corners[ConvexHull(corners).vertices]
    elif not shapely.LinearRing(corners).is_simple:
        return None
    splinter = polygon_area(corners) < SMALLEST_SHARE * width * height
    return None if splinter else corners


@typed
def polygon_stones(settings: PolygonSettings, rng: Generator) -> StoneSet:
    """Generate noisy polygons, each of them simple and in one piece.

    The stones of a set have the area of the brick on average, whatever the noise: hulls of moved
    corners grow with it, those of the published sets do not.

    Parameters
    ----------
    settings : PolygonSettings
        Size and noise.
    rng : Generator
        Equal states give equal stones.

    Raises
    ------
    UsageError
        E130 when the settings leave no stone in one piece.

    Examples
    --------
    >>> stones = polygon_stones(PolygonSettings(count=3, noise=0.0), np.random.default_rng(1))
    >>> [stone.area_px for stone in stones]
    [11700, 11700, 11700]
    """

    def drawn() -> Points:
        return accepted((noisy_polygon(settings, rng) for _ in count()), "polygon")

    def whole(i: int, factor: float) -> Iterator[Mask | None]:
        while True:
            yield whole_mask(factor * outlines[i])
            outlines[i] = drawn()  # it breaks into pieces of pixels when it is reduced

    outlines = [drawn() for _ in range(settings.count)]
    areas: list[float] = []
    while areas != (kept := [polygon_area(outline) for outline in outlines]):
        areas = kept
        factor = math.sqrt(settings.width_px * settings.height_px / np.mean(areas))
        masks = [accepted(whole(i, factor), "polygon") for i in range(settings.count)]
        if settings.convex:  # few hulls break: a set changes by 1 %
            break
    return stones_of(masks)
