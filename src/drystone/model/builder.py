"""What a builder misses by: the errors that walls are judged under (DESIGN 4.10)."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from drystone.kernels.polygons import Points, area_and_centroid
from drystone.kernels.raster import turn

ROBOT, BETWEEN, HAND = 0.015, 0.02, 0.03
"""Precision p of a good robot, of what walls of a search are rehearsed with, and of a hand."""

WEDGE_SHARE = 1 / 3
"""Errors of a wedge over those of a stone: it is small, and cut to its place."""

MODES = np.arange(2, 7)
"""Waves around an outline; 0 would change its size, 1 only shift it."""

LONGEST_EDGE = 0.12
"""Edges are cut into pieces no longer than this, over the size, so that errors bend them too."""

DEEPEST = 0.5
"""No outline comes nearer to the centroid by more than this share of its distance."""


@dataclass(frozen=True, kw_only=True)
class BuilderErrors:
    """Standard deviations of what a builder misses by; lengths in the unit of the wall."""

    placement: float  # along the wall
    angle_deg: float
    outline: float  # of the distance from the centroid, all around

    @classmethod
    def of_precision(cls, precision: float, mean_size: float) -> "BuilderErrors":
        """Return the errors of a precision p: 0.015 is a good robot, 0.03 a hand.

        `mean_size` is the mean over the stones of the root of their area.

        Examples
        --------
        >>> BuilderErrors.of_precision(HAND, mean_size=100.0)
        BuilderErrors(placement=3.0, angle_deg=2.0, outline=1.5)
        """
        return cls(
            placement=precision * mean_size,
            angle_deg=100 * precision * 2 / 3,
            outline=0.5 * precision * mean_size,
        )

    def times(self, share: float) -> "BuilderErrors":
        """Return errors of a share of these."""
        return BuilderErrors(
            placement=share * self.placement,
            angle_deg=share * self.angle_deg,
            outline=share * self.outline,
        )

    def built(self, corners: Points, rng: np.random.Generator) -> "Built":
        """Return a block as it is, and where it is put, for one that was seen and planned.

        The same numbers are drawn whatever the errors, so twice the errors move it twice as far.
        """
        _, x, y = area_and_centroid(corners)
        outline = misjudged(corners - (x, y), self.outline, rng)
        shift, angle = rng.standard_normal(2).tolist()
        return Built(outline, x + self.placement * shift, y, self.angle_deg * angle)


@dataclass(frozen=True, eq=False)
class Built:
    """A block somewhere in a wall."""

    outline: Points  # (n, 2): as planned, not turned further, about its centroid
    x: float  # of the centroid, wall frame
    y: float
    angle_deg: float  # by which it is turned from the plan

    @cached_property
    def corners(self) -> Points:
        """Corners in the wall frame, (n, 2)."""
        return np.asarray(turn(self.outline, self.angle_deg) + (self.x, self.y))  # noqa: RUF005

    @cached_property
    def size(self) -> float:
        """Root of its area."""
        return math.sqrt(area_and_centroid(self.outline)[0])


def misjudged(outline: Points, sigma: float, rng: np.random.Generator) -> Points:
    """Return an outline about its centroid as it really is: a smooth error of what was seen.

    The error is along the way from the centroid, of Fourier modes 2 to 6 over the polar angle with
    equal weights; `sigma` is its standard deviation at any angle.
    """
    waves = rng.standard_normal((2, len(MODES))) * sigma / math.sqrt(len(MODES))
    if not sigma:
        return outline
    fine = _refined(outline, LONGEST_EDGE * math.sqrt(area_and_centroid(outline)[0]))
    radius = np.hypot(*fine.T)
    angle = np.arctan2(fine[:, 1], fine[:, 0])[:, None] * MODES
    error = (np.cos(angle) * waves[0] + np.sin(angle) * waves[1]).sum(axis=1)
    error = np.maximum(error / np.maximum(radius, 1e-9), -DEEPEST)
    for share in (1.0, 0.5, 0.25):
        moved = fine * (1.0 + share * error)[:, None]
        # Only an outline that is not seen whole from its centroid may come to cross itself.
        if shapely.is_valid(shapely.Polygon(moved)):
            _, x, y = area_and_centroid(moved)
            return np.asarray(moved - (x, y))
    return outline


def _refined(outline: Points, longest: float) -> Points:
    """Return an outline with corners added so that no edge is longer."""
    after = np.roll(outline, -1, axis=0)
    counts = np.maximum(1, np.ceil(np.hypot(*(after - outline).T) / longest)).astype(int)
    pieces = [
        a + (b - a) * (np.arange(count) / count)[:, None]
        for a, b, count in zip(outline, after, counts, strict=True)
    ]
    return np.concatenate(pieces)
