"""What a builder misses by: the errors that walls are judged under (DESIGN 4.10)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.special import ndtri

from drystone.kernels.as_built import Built
from drystone.kernels.polygons import Points, area_and_centroid
from drystone.kernels.profiles import Floats
from drystone.model.outlines import Outlined

ROBOT, HAND = 0.015, 0.03
"""Precision p of a good robot, and of a hand."""

MODES = np.arange(2, 7)
"""Waves around an outline; 0 would change its size, 1 only shift it."""

NUMBERS = 2 * len(MODES) + 2
"""What is drawn for a block: cosines and sines of its waves, its shift and its turn."""

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
        return BuilderErrors(**{name: share * value for name, value in vars(self).items()})

    def all_built(self, corners: Points, numbers: Floats) -> list[Built]:
        """Return a block as it may be, and where it is put, for one that was seen and planned.

        Errors are `numbers` of standard deviation 1, (n, :data:`NUMBERS`), of the block as it lies
        in the wall, however its photograph was turned.
        """
        area, x, y = area_and_centroid(corners)
        waves = numbers[:, :-2].reshape(-1, 2, len(MODES))
        outlines = misjudged(corners - (x, y), self.outline, waves)
        return [
            Built(outline, x + self.placement * shift, y, self.angle_deg * angle, math.sqrt(area))
            for outline, (shift, angle) in zip(outlines, numbers[:, -2:].tolist(), strict=True)
        ]


def put_down_with(
    errors: BuilderErrors, group: Sequence[Outlined], numbers: Floats
) -> list[list[tuple[int, Built]]]:
    """Return a stone and its wedges as they are and where they are put, for each of some runs.

    The stone comes first.  `numbers`, (runs, blocks, :data:`NUMBERS`), have standard deviation 1.
    """
    wedge = errors.times(1 / 3)  # it is small, and cut to its place
    put = [
        [(i, built) for built in (wedge if k else errors).all_built(corners, numbers[:, k])]
        for k, (i, corners) in enumerate(group)
    ]
    return [list(run) for run in zip(*put, strict=True)]


def stratified(rng: np.random.Generator, runs: int, blocks: int) -> Floats:
    """Draw numbers of standard deviation 1 for some runs, (runs, blocks, :data:`NUMBERS`).

    Over the runs each number falls once into each of so many ranges of equal probability, in
    random order (Latin hypercube).  So few runs already miss to all sides, as many free ones do.
    """
    ranges = rng.permuted(np.tile(np.arange(runs), (blocks * NUMBERS, 1)), axis=1)
    shares = (ranges + rng.random(ranges.shape)) / runs
    return np.asarray(ndtri(shares)).T.reshape(runs, blocks, NUMBERS)


def as_planned(corners: Points) -> Built:
    """Return a block where it is planned, as it was seen."""
    area, x, y = area_and_centroid(corners)
    return Built(corners - (x, y), x, y, 0.0, math.sqrt(area))


def misjudged(outline: Points, sigma: float, waves: Floats) -> list[Points]:
    """Return an outline about its centroid as it may really be: smooth errors of what was seen.

    The error is along the way from the centroid, of Fourier modes 2 to 6 over the polar angle with
    equal weights; `sigma` is its standard deviation at any angle.  `waves` (n, 2, modes) are the
    cosines and sines of n errors, of standard deviation 1.
    """
    if not sigma:
        return [outline] * len(waves)
    fine = _refined(outline, LONGEST_EDGE * math.sqrt(area_and_centroid(outline)[0]))
    radius = np.hypot(*fine.T)
    angle = np.arctan2(fine[:, 1], fine[:, 0])[:, None] * MODES
    size = sigma / math.sqrt(len(MODES))
    errors = (np.cos(angle) * waves[:, :1] + np.sin(angle) * waves[:, 1:]).sum(axis=2) * size
    errors = np.maximum(errors / np.maximum(radius, 1e-9), -DEEPEST)
    found = [outline] * len(waves)
    left = np.arange(len(waves))
    for share in (1.0, 0.5, 0.25):
        moved = fine * (1.0 + share * errors[left])[:, :, None]
        # Only an outline that is not seen whole from its centroid may come to cross itself.
        simple = shapely.is_valid(shapely.polygons(moved))
        for k, corners in zip(left[simple].tolist(), moved[simple], strict=True):
            found[k] = corners - area_and_centroid(corners)[1:]
        left = left[~simple]
    return found


def _refined(outline: Points, longest: float) -> Points:
    """Return an outline with corners added so that no edge is longer."""
    way = np.roll(outline, -1, axis=0) - outline
    counts = np.maximum(1, np.ceil(np.hypot(*way.T) / longest)).astype(int)
    edge = np.repeat(np.arange(len(outline)), counts)
    step = np.arange(len(edge)) - (np.cumsum(counts) - counts)[edge]
    return np.asarray(outline[edge] + way[edge] * (step / counts[edge])[:, None])
