"""How the load multiplier of a picture goes to that of the wall as its resolution grows."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.outlines import model_from_outlines, outlines_of_labels
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitResult, LimitStatus
from drystone_lab.tilted_walls import tilted_wall

COURSES = (3, 4, 5)
"""The walls have these numbers of courses in turn."""


@dataclass(frozen=True)
class RefinementRow:
    """Errors at one resolution.

    Parameters
    ----------
    height_px : int
        Height of the wall.
    cases : int
        Load multipliers compared: walls times offsets times two directions.
    unanswered : int
        Comparisons without a number, of either kind of contacts; left out of the means.
    pixel_error, outline_error : float
        Mean of |alpha - exact alpha| with contacts from pixel edges and from outlines.
    pixel_worst, outline_worst : float
        Largest of them.
    """

    height_px: int
    cases: int
    unanswered: int
    pixel_error: float
    outline_error: float
    pixel_worst: float
    outline_worst: float


@dataclass(frozen=True)
class RefinementStudy:
    """Errors at all resolutions, and p in error ~ height^-p, fitted to their logarithms."""

    rows: tuple[RefinementRow, ...]
    pixel_order: float
    outline_order: float


def refinement_study(
    heights_px: Sequence[int] = (40, 80, 160, 320),
    *,
    walls: int = 9,
    offsets: int = 3,
    mu: float = 0.58,
    seed: int = 0,
) -> RefinementStudy:
    """Compare pictures of walls of tilted joints with their polygons.

    Parameters
    ----------
    heights_px : sequence of int
        Heights of the walls in the pictures, at least two different ones.
    walls : int
        Number of walls from :func:`drystone_lab.tilted_walls.tilted_wall`.
    offsets : int
        Sub-pixel positions at which each wall is rasterised.
    mu : float
        Coefficient of friction.
    seed : int
        Decides the walls.

    Notes
    -----
    A picture of blocks that do not stand counts with alpha = 0.

    Examples
    --------
    >>> study = refinement_study((40, 80), walls=1, offsets=1)
    >>> [row.cases for row in study.rows]
    [2, 2]
    """
    seeds = np.random.default_rng(seed).integers(0, 2**32, walls).tolist()
    drawn = [
        tilted_wall(np.random.default_rng(wall_seed), COURSES[i % len(COURSES)])
        for i, wall_seed in enumerate(seeds)
    ]
    exact = [_alphas(wall.model(mu)) for wall in drawn]
    rows = []
    for height_px in heights_px:
        pixels, outlines = [], []
        for wall, true in zip(drawn, exact, strict=True):
            for number in range(offsets):
                labels = wall.picture(height_px, _offset(number))
                standing = _alphas(model_from_labels(labels, mu).model)
                pixels.append(np.abs(standing - true))
                standing = _alphas(model_from_outlines(outlines_of_labels(labels), mu))
                outlines.append(np.abs(standing - true))
        rows.append(_row(height_px, np.array(pixels), np.array(outlines)))
    return RefinementStudy(
        tuple(rows),
        fitted_order(heights_px, [row.pixel_error for row in rows]),
        fitted_order(heights_px, [row.outline_error for row in rows]),
    )


def fitted_order(heights_px: Sequence[int], errors: Sequence[float]) -> float:
    """Return p of error ~ height^-p by least squares of the logarithms.

    Examples
    --------
    >>> round(fitted_order((10, 20, 40), (0.4, 0.1, 0.025)), 9)
    2.0
    """
    return float(-np.polyfit(np.log(heights_px), np.log(errors), 1)[0])


def _offset(number: int) -> tuple[float, float]:
    """Return the n-th point of an even sequence of sub-pixel positions (Roberts's R2)."""
    return (0.5 + 0.7548776662466927 * number) % 1.0, (0.5 + 0.5698402909980532 * number) % 1.0


def _alphas(model: RigidBlockModel) -> np.ndarray:
    both = lateral_resistance(model)
    return np.array([_alpha(both.left), _alpha(both.right)])


def _alpha(result: LimitResult) -> float:
    if result.status is LimitStatus.UNSTABLE:
        return 0.0
    return np.nan if result.alpha is None else result.alpha


def _row(height_px: int, pixels: np.ndarray, outlines: np.ndarray) -> RefinementRow:
    missing = int(np.isnan(pixels).sum() + np.isnan(outlines).sum())
    return RefinementRow(
        height_px,
        pixels.size,
        missing,
        float(np.nanmean(pixels)),
        float(np.nanmean(outlines)),
        float(np.nanmax(pixels)),
        float(np.nanmax(outlines)),
    )
