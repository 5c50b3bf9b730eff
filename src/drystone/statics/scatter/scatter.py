"""Scatter of the load multiplier: walls shaken at random, and each one analysed (Monte Carlo).

**Friction.**  Uniform in a range; one value for the wall, or one for each interface.  Interfaces
with a coefficient of their own (frictionless head joints) keep it.

**Outline.**  An outline is known to `outline_noise` (standard deviation).  So every stone may end
a bit earlier or later at each end of an interface, and the direction of an interface is known to
the noise over its length: it turns about its middle, contact points and normal together.  No
piece of an outline shorter than `RESOLVED` times the noise shows a direction, so short interfaces
and contacts at a point turn as one of that length.  Interfaces turn independently: a bed on
several stones becomes rough, and a rough bed may lock, so a shaken wall can carry more than the
wall itself.

**Placement.**  Stones are laid `placement_noise` off in each direction, by chance: the centroid
moves, and so do the stone's ends of its interfaces.  Across the interface the joint stays between
the two stones: it moves by the mean of both, and not at all when one of them cannot move.

An interface reaches as far as both stones do: at each end the stone that ends first decides.  A
model does not know which of two stones that is, so both ends are moved and the nearer one
counts, which is exact where the stones are flush and on the safe side elsewhere (by .56 standard
deviations on average).  The ground has no ends.  When nothing is left of an interface its ends
meet in a point: stones that touch go on touching, and no stone gains a neighbour.  The area is
not shaken: errors of an outline average out in it.
"""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial
from math import isfinite
from typing import NamedTuple

import numpy as np

from drystone.errors import InputError
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.program import Floats
from drystone.statics.model import GROUND, Interface, RigidBlockModel
from drystone.statics.result import LateralResistance, LimitStatus

RESOLVED = 3.0
"""Shortest length, in standard deviations of the outline, over which its direction is known."""


@dataclass(frozen=True, kw_only=True)
class ScatterSettings:
    """What is not known exactly; lengths are those of the model (E302, E318 for nonsense)."""

    samples: int = 500  # walls to analyse
    mu: tuple[float, float] | None = None  # least and greatest friction; None for that of the model
    mu_per_interface: bool = False  # every interface has a friction of its own
    outline_noise: float = 0.0  # standard deviation of outlines, >= 0
    placement_noise: float = 0.0
    """Standard deviation of the place of a stone in each direction, >= 0."""

    def __post_init__(self) -> None:
        if self.mu is not None and not 0 <= self.mu[0] <= self.mu[1] < np.inf:
            what = f"friction between {self.mu[0]} and {self.mu[1]} makes no sense."
            cure = "Give two numbers >= 0, the least first; dry stone has about 0.4 to 0.8."
            raise InputError("E302", what, where="mu", cure=cure)
        if self.samples < 1:
            raise _nonsense("samples", self.samples, "1 or more")
        for name in ("outline_noise", "placement_noise"):
            noise = getattr(self, name)
            if not (isfinite(noise) and noise >= 0):
                raise _nonsense(name, noise, "a standard deviation >= 0, in lengths of the model")


def shaken(
    model: RigidBlockModel, settings: ScatterSettings, rng: np.random.Generator
) -> RigidBlockModel:
    """Return the wall as it might be.

    The same numbers are drawn whatever the settings, so twice the noise moves things twice as far.
    """
    low, high = settings.mu or (model.mu, model.mu)
    drawn = rng.uniform(low, high, 1 + len(model.interfaces)).tolist()
    rubbed = replace(model, mu=drawn[0])
    if settings.mu_per_interface:
        pairs = list(zip(model.interfaces, drawn[1:], strict=True))
        own = [mu for face, mu in pairs if face.mu is None]
        faces = tuple(replace(face, mu=mu) if face.mu is None else face for face, mu in pairs)
        rubbed = replace(model, interfaces=faces, mu=float(np.mean(own)) if own else drawn[0])
    steps = settings.placement_noise * rng.standard_normal((len(model.blocks), 2))
    errors = settings.outline_noise * rng.standard_normal((len(model.interfaces), 2, 2))
    turns = rng.standard_normal(len(model.interfaces))
    steps[np.array([block.fixed for block in model.blocks], bool)] = 0.0
    centroids = np.array([block.centroid for block in model.blocks]).reshape(-1, 2) + steps
    blocks = tuple(
        replace(block, centroid=(x, y))
        for block, (x, y) in zip(model.blocks, centroids.tolist(), strict=True)
    )
    interfaces = _shaken_interfaces(rubbed, settings, steps, errors, turns)
    return RigidBlockModel(blocks, interfaces, rubbed.mu)


def _shaken_interfaces(
    model: RigidBlockModel, settings: ScatterSettings, steps: Floats, errors: Floats, turns: Floats
) -> tuple[Interface, ...]:
    """Move the ends of all k interfaces with their stones, and turn them.

    `steps` is (n, 2), of the blocks.  `errors` is (k, 2, 2), along the interface, of both stones at
    both ends.  `turns` is (k,), in standard deviations.
    """
    if not (model.interfaces and (settings.outline_noise or settings.placement_noise)):
        return model.interfaces
    ends = np.array([(i.points[0], i.points[-1]) for i in model.interfaces])
    normal = np.array([i.normal for i in model.interfaces])
    length = np.array([i.length for i in model.interfaces])
    is_line = length > 0
    along = np.column_stack((normal[:, 1], -normal[:, 0]))
    along[is_line] = (ends[is_line, 1] - ends[is_line, 0]) / length[is_line, None]
    # Of both stones of each: the first is the one that the normal points into.
    place = {block.id: row for row, block in enumerate(model.blocks)} | {GROUND: -1}
    pairs = np.array([(place[i.block], place[i.other]) for i in model.interfaces])
    step, endless = np.append(steps, [(0.0, 0.0)], axis=0)[pairs], pairs < 0
    fixed = np.array([*(block.fixed for block in model.blocks), True])
    stays = fixed[pairs].any(axis=1)

    reach = np.einsum("kij,kj->ki", step, along)[:, :, None] + errors
    reach[endless] = (-np.inf, np.inf)
    low, high = reach[:, :, 0].max(axis=1), length + reach[:, :, 1].min(axis=1)
    half = np.where(is_line, np.maximum(high - low, 0.0), 0.0) / 2
    across = np.where(stays, 0.0, np.einsum("kij,kj->k", step, normal) / 2)
    middle = ends[:, 0] + along * ((low + high) / 2)[:, None] + normal * across[:, None]

    noise = settings.outline_noise
    angle = turns * noise / np.maximum(length, RESOLVED * noise) if noise else 0.0 * turns
    along, normal = _turned(along, angle), _turned(normal, angle)
    first, last = middle - along * half[:, None], middle + along * half[:, None]
    points = np.stack((first, last), axis=1)
    return tuple(
        replace(interface, points=points[k, : len(interface.points)], normal=(nx, ny))
        for k, (interface, (nx, ny)) in enumerate(
            zip(model.interfaces, normal.tolist(), strict=True)
        )
    )


def _turned(vectors: Floats, angle: Floats) -> Floats:
    cos, sin = np.cos(angle), np.sin(angle)
    x, y = vectors.T
    return np.column_stack((cos * x - sin * y, sin * x + cos * y))


def _nonsense(name: str, given: float, wanted: str) -> InputError:
    what = f"{name} of {given} makes no sense for the scatter."
    return InputError("E318", what, where=name, cure=f"Give {wanted}.")


class Quantiles(NamedTuple):
    """Of a figure, over the walls that stand."""

    low: float  # of 5 %
    median: float
    high: float  # of 95 %


@dataclass(frozen=True, eq=False)
class Scatter:
    """What the shaken walls carry; a wall that does not stand is a result too, without numbers."""

    settings: ScatterSettings
    seed: int
    unshaken: LateralResistance  # of the model as it was given, with its own friction
    status: tuple[LimitStatus, ...]  # (n,): of every sample: "optimal" when both directions are
    mu: Floats
    """(n,): coefficient of friction of every sample; the mean over the interfaces that draw one
    when each has its own; 0 where those of the model all have one, which stays."""
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
        return _quantiles(self.value)


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
    mu = 0.0 if model.mu_idle else wall.mu
    return next(worst), mu, both.left.alpha, both.right.alpha


def _quantiles(values: Floats | None) -> Quantiles | None:
    if values is None or not len(values):
        return None
    return Quantiles(*np.quantile(values, (0.05, 0.5, 0.95)).tolist())
