"""Walls planned and timed: the time of every step by part, and how it grows (§6)."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import log
from pathlib import Path
from statistics import fmean, median
from typing import NamedTuple

import numpy as np

from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.planner.profile import Part, Profile, StepTime
from drystone.planner.settings import PlannerSettings
from drystone.selection.sampling import Sampling
from drystone_lab.runs.spec import generated
from drystone_lab.table import Cell
from drystone_lab.walls import Target

PARTS: tuple[Part, ...] = ("placement", "stabilisation", "contacts", "limit analysis", "indices")
"""Of a step; the last three are the paper's selection."""

COLUMNS = (*PARTS, "rest", "all")
"""Mean ms a step."""

LEAST_STONES = 32
"""For which :func:`rubble` makes four courses."""

SAMPLINGS: Mapping[Sampling, str] = {"variant": "variant sampling", "full": "full batch sampling"}


@dataclass(frozen=True)
class TimedWall:
    """Times of one wall: seconds before the first step, and each step, the median of several."""

    site: Site
    preparation: float
    steps: tuple[StepTime, ...]

    @property
    def seconds(self) -> float:
        """From the stones to the last step."""
        return self.preparation + sum(step.seconds for step in self.steps)

    @property
    def longest(self) -> float:
        """Seconds of the longest step."""
        return max(step.seconds for step in self.steps)

    @property
    def pixels(self) -> int:
        """Size of the image."""
        return self.site.width_px * self.site.height_px

    @property
    def size(self) -> str:
        """Width and height in working px, for people."""
        return f"{self.site.width_px} x {self.site.height_px}"

    @property
    def candidates(self) -> int:
        """Evaluated in all steps."""
        return sum(step.candidates for step in self.steps)


def rubble(count: int, seed: int, wall_px: tuple[int, int]) -> Target:
    """Return generated stones for a wall, with four courses when there are 32 of them."""
    width, height = wall_px
    courses = max(1, round(4 * (count / LEAST_STONES) ** 0.5))
    source = generated(
        "rubble", seed, count=count, width_px=width, height_px=height, courses=courses
    )
    return Target(f"{count} generated stones", source, width, height, 1.0)


def planned(
    wall: Target, data: Path | None, settings: PlannerSettings, *, seed: int, repeats: int
) -> TimedWall:
    """Plan a wall several times, and keep the median repetition of every step."""
    stones = wall.source.stones(data)
    site = Site.from_source(wall.width, wall.height, wall.scale)
    profiles = []
    for _ in range(repeats):
        profile = Profile(time.thread_time)
        planner = Planner(stones, site, seed=seed, settings=settings, profile=profile)
        for _ in planner.steps():
            pass
        profiles.append(planner.profile)
    each = zip(*(profile.steps for profile in profiles), strict=True)
    steps = tuple(sorted(same, key=lambda step: step.seconds)[repeats // 2] for same in each)
    return TimedWall(site, median(p.total("preparation") for p in profiles), steps)


class PowerLaw(NamedTuple):
    """y = factor * x ** exponent."""

    factor: float
    exponent: float


def fitted(points: Sequence[tuple[float, float]]) -> PowerLaw | None:
    """Fit a power law to sizes and times, least squares of the logarithms.

    None with less than two sizes, or where something took no time.

    >>> law = fitted([(1.0, 3.0), (2.0, 12.0), (4.0, 48.0)])
    >>> round(law.factor, 9), round(law.exponent, 9)
    (3.0, 2.0)
    """
    if len({x for x, _ in points}) < 2 or any(y <= 0 for _, y in points):
        return None
    x, y = zip(*((log(a), log(b)) for a, b in points), strict=True)
    exponent, offset = np.polyfit(x, y, 1)
    return PowerLaw(float(np.exp(offset)), float(exponent))


def exponents(sizes: Sequence[float], rows: Sequence[Sequence[float]]) -> list[float | None]:
    """Return the exponent of :func:`fitted` of every column; None where it has none."""
    columns = zip(*rows, strict=True)
    laws = [fitted(list(zip(sizes, column, strict=True))) for column in columns]
    return [None if law is None else law.exponent for law in laws]


def parts_ms(steps: Sequence[StepTime]) -> tuple[float, ...]:
    """Return the mean ms a step: parts, the rest, and all; :data:`COLUMNS`."""
    parts = [fmean(step.parts.get(part, 0.0) for step in steps) for part in PARTS]
    seconds = fmean(step.seconds for step in steps)
    return tuple(1e3 * s for s in (*parts, seconds - sum(parts), seconds))


def three_digits(row: Sequence[Cell]) -> tuple[Cell, ...]:
    """Keep three digits of every number: times do not repeat to more."""
    return tuple(float(f"{cell:.3g}") if isinstance(cell, float) else cell for cell in row)
