"""Rounded stones from Fourier descriptors (§5.3, Eq. 30; Mollon and Zhao 2012)."""

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import count
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from drystone.generate.layout import accepted, check_room, check_setting, stones_of, whole_mask
from drystone.kernels.polygons import Points
from drystone.model.settings import typed
from drystone.model.stone import StoneSet

LARGEST_DESCRIPTOR = 2.0
"""With a larger D_n no radius is positive everywhere: r (1 - cos(n theta + phase)) would have the
mean r0 (1 - D_n / 2)."""

LARGEST_TABLE = 50_000_000
"""Points times harmonics: with more, most machines run out of memory."""


@typed
@dataclass(frozen=True, kw_only=True)
class FourierSettings:
    """How rounded stones look; the paper's four sets are D2 = 0 or 0.2 with either radius.

    Parameters
    ----------
    count : int
        Number of stones.
    smallest_radius_px, largest_radius_px : float
        Range of the mean radius, uniform in between, at least 1 px.  The paper has 30 for both,
        and 10 to 50.
    D2 : float
        Elongation: 0 gives round stones, 0.2 ellipses.
    D3, D8 : float
        Irregularity and roughness, positive.
    alpha, beta : float
        Exponents by which descriptors 4 ... 7 and those above 8 decay; no descriptor is above 2.
    points : int
        Points on a contour, at least 8.
    harmonics : int
        The last harmonic; below half of `points`, as more points could not show it.  Points times
        harmonics are 50 million at most.
    """

    count: int = 100
    smallest_radius_px: float = 30.0
    largest_radius_px: float = 30.0
    D2: float = 0.0
    D3: float = 0.05
    D8: float = 0.015
    alpha: float = -2.0
    beta: float = -2.0
    points: int = 128
    harmonics: int = 63

    def __post_init__(self) -> None:
        smallest, largest = self.smallest_radius_px, self.largest_radius_px
        ranges = (
            (self.count >= 1, "count must be at least 1"),
            (1 <= smallest <= largest, "the radius must be 1 px or more, smallest first"),
            (self.D2 >= 0, "D2 must not be negative"),
            (self.D3 > 0 and self.D8 > 0, "D3 and D8 must be positive"),
            (self.points >= 8, "a contour needs at least 8 points"),
            (3 <= self.harmonics < self.points / 2, "harmonics must be 3 ... points / 2 - 1"),
            (
                self.points * self.harmonics <= LARGEST_TABLE,
                f"points times harmonics must be at most {LARGEST_TABLE // 1_000_000} million",
            ),
        )
        for ok, what in ranges:
            check_setting(ok, what, "fourier")
        # By their logarithms, as the descriptors themselves may be too large for a number.
        largest_log2 = max(float(_log2_descriptors(self).max()), math.log2(max(self.D2, 1.0)))
        check_setting(
            largest_log2 <= math.log2(LARGEST_DESCRIPTOR),
            "D2, and what D3, D8, alpha and beta make of the other descriptors, must be at most 2",
            "fourier",
        )
        # The radius is positive everywhere, which bounds how long a stone can be.
        size_px = 2 * largest * (1 + min(self.D2, 1)), 2 * largest
        check_room(self.count, size_px, ("largest_radius_px", "count"), "fourier")

    @cached_property
    def waves(self) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        """Angles (points,) of the points; cosine and sine (points, N + 1) of harmonics there."""
        theta = np.arange(self.points) * (2 * math.pi / self.points)
        angle = np.outer(theta, np.arange(self.harmonics + 1))
        return theta, np.cos(angle), np.sin(angle)


def fourier_descriptors(settings: FourierSettings) -> NDArray[np.float64]:
    """Return D_0 ... D_N: amplitudes of the harmonics over the mean radius (Eq. 30d).

    D_n = 2^(alpha log2(n/3) + log2 D3) for n = 3 ... 7 and 2^(beta log2(n/8) + log2 D8) from 8.
    D_0 and D_1 are 0: the first is the radius itself, the second only shifts the stone.
    """
    return np.concatenate([[0.0, 0.0, settings.D2], 2.0 ** _log2_descriptors(settings)])


def _log2_descriptors(settings: FourierSettings) -> NDArray[np.float64]:
    """Return the binary logarithms of D_3 ... D_N; infinite where those are not finite."""
    n = np.arange(3, settings.harmonics + 1)
    with np.errstate(over="ignore", invalid="ignore"):
        low = settings.alpha * np.log2(n / 3) + math.log2(settings.D3)
        high = settings.beta * np.log2(n / 8) + math.log2(settings.D8)
    return np.where(n < 8, low, high)


def fourier_contour(radius_px: float, settings: FourierSettings, rng: Generator) -> Points | None:
    """Draw one contour (Eq. 30a-c): descriptors as given, phases at random in [-pi, pi).

    (points, 2) about its pole, counter-clockwise, the first point on the x axis; None when the
    radius is not positive everywhere, so that the contour would cross itself.
    """
    amplitude = radius_px * fourier_descriptors(settings)
    phase = rng.uniform(-math.pi, math.pi, amplitude.size)
    theta, cos, sin = settings.waves
    wave = cos @ (amplitude * np.cos(phase)) + sin @ (amplitude * np.sin(phase))
    radius = radius_px + wave
    if radius.min() <= 0:
        return None
    return np.column_stack([radius * np.cos(theta), radius * np.sin(theta)])


@typed
def fourier_stones(settings: FourierSettings, rng: Generator) -> StoneSet:
    """Generate rounded stones (§5.3).

    Parameters
    ----------
    settings : FourierSettings
        How they look.
    rng : Generator
        Equal states give equal stones.

    Raises
    ------
    UsageError
        E130 when the descriptors leave no stone in one piece.

    Examples
    --------
    >>> stones = fourier_stones(FourierSettings(count=5), np.random.default_rng(1))
    >>> [stone.id for stone in stones]
    [1, 2, 3, 4, 5]
    """
    # The radius stays when phases are rejected, or the sizes would no longer be uniform.
    smallest, largest = settings.smallest_radius_px, settings.largest_radius_px
    masks = []
    for radius in rng.uniform(smallest, largest, settings.count).tolist():
        drawn = (whole_mask(fourier_contour(radius, settings, rng)) for _ in count())
        masks.append(accepted(drawn, "fourier"))
    return stones_of(masks)
