"""Scatter of the load multiplier: walls shaken at random, and each one analysed (Monte Carlo)."""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.program import Floats
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance, LimitStatus
from drystone.statics.scatter.shaking import ScatterSettings, shaken


class Quantiles(NamedTuple):
    """Of a figure, over the walls that stand."""

    low: float
    """Of 5 %."""
    median: float
    high: float
    """Of 95 %."""


@dataclass(frozen=True, eq=False)
class Scatter:
    """What the shaken walls carry; a wall that does not stand is a result too, without numbers."""

    settings: ScatterSettings
    seed: int
    unshaken: LateralResistance  # of the model as it was given, with its own friction
    status: tuple[LimitStatus, ...]  # (n,): of every sample: "optimal" when both directions are
    mu: Floats
    """(n,): coefficient of friction of every sample; the mean over the interfaces that draw one
    when each has its own."""
    alpha_left: Floats
    """(number of optimal samples,): load multipliers of the walls that stand, in the order of the
    samples."""
    alpha_right: Floats  # (number of optimal samples,)

    @property
    def counts(self) -> dict[LimitStatus, int]:
        """How many samples ended how."""
        return {status: self.status.count(status) for status in LimitStatus}

    @property
    def falling_share(self) -> float | None:
        """Share of the walls that do not stand, in [0, 1]; None when no analysis told.

        Samples on which the solver gave up tell neither, and do not count; those that carry any
        load stand.
        """
        counts = self.counts
        if not counts[LimitStatus.OPTIMAL] + counts[LimitStatus.UNSTABLE]:
            return None
        return counts[LimitStatus.UNSTABLE] / self.known

    @property
    def known(self) -> int:
        """How many samples an analysis told of: all but those on which the solver gave up."""
        return len(self.status) - self.counts[LimitStatus.FAILED]

    @property
    def standing_mu(self) -> Floats:
        """Friction of the walls that stand, in the order of `alpha_left` and `alpha_right`."""
        return self.mu[[status is LimitStatus.OPTIMAL for status in self.status]]

    @property
    def alpha(self) -> Floats:
        """The lesser of both directions, of the walls that stand.

        This is the figure that compares: in `value` a slippery wall that slides looks as strong
        as a rough one.
        """
        return np.minimum(self.alpha_left, self.alpha_right)

    @property
    def value(self) -> Floats | None:
        """F_LR, the lesser alpha over the mu of its own sample; None when some mu is 0."""
        mu = self.standing_mu
        return self.alpha / mu if mu.all() else None

    @property
    def alpha_quantiles(self) -> Quantiles | None:
        """Of `alpha`; None when no wall stands."""
        return _quantiles(self.alpha)

    @property
    def value_quantiles(self) -> Quantiles | None:
        """Of `value`; None when there is none."""
        value = self.value
        return None if value is None else _quantiles(value)


def scatter(
    model: RigidBlockModel,
    settings: ScatterSettings,
    *,
    seed: int = 0,
    executor: Executor | None = None,
    on_sample: Callable[[int], None] | None = None,
) -> Scatter:
    """Shake a wall many times and find what it carries each time, to both sides.

    Each sample has random numbers of its own, from the seed and its number, so that threads or
    processes of an executor never change the result.  `on_sample` gets the number of samples done.
    """
    analyse = partial(_analysed, model, settings, seed)
    numbers = range(settings.samples)
    # Enough for each worker to be busy, few enough to see progress.
    chunk = max(1, min(8, settings.samples // 32))
    found = executor.map(analyse, numbers, chunksize=chunk) if executor else map(analyse, numbers)
    samples = []
    for done, sample in enumerate(found, start=1):
        samples.append(sample)
        if on_sample is not None:
            on_sample(done)
    alphas = np.array([s[2:] for s in samples if s[0] is LimitStatus.OPTIMAL], float)
    left, right = alphas.reshape(-1, 2).T
    mu = np.array([sample[1] for sample in samples])
    unshaken, status = lateral_resistance(model), tuple(sample[0] for sample in samples)
    return Scatter(settings, seed, unshaken, status, mu, left, right)


def _analysed(
    model: RigidBlockModel, settings: ScatterSettings, seed: int, number: int
) -> tuple[LimitStatus, float, float | None, float | None]:
    """Return how a sample ends, its friction, and its load multipliers to both sides."""
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(number,)))
    wall = shaken(model, settings, rng)
    both = lateral_resistance(wall)
    ends = both.left.status, both.right.status
    worst = (status for status in reversed(LimitStatus) if status in ends)
    return next(worst), wall.mu, both.left.alpha, both.right.alpha


def _quantiles(values: Floats) -> Quantiles | None:
    if not len(values):
        return None
    return Quantiles(*np.quantile(values, (0.05, 0.5, 0.95)).tolist())
