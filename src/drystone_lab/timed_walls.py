"""Walls planned by the clock: the time of every step by part, and how it grows (§6)."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import log
from pathlib import Path
from statistics import fmean

import numpy as np

from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.planner.profile import Part, StepTime
from drystone.planner.settings import PlannerSettings
from drystone_lab.pictures.growth import PowerLaw
from drystone_lab.runs.source import generated
from drystone_lab.table import Cell
from drystone_lab.walls import Target

PARTS: tuple[Part, ...] = ("placement", "stabilisation", "contacts", "limit analysis", "indices")
"""Of a step; the last three are the paper's selection."""

COLUMNS = (*PARTS, "rest", "all")
"""Mean ms a step."""

LEAST_STONES = 32
"""For which :func:`rubble` makes the given number of courses."""


@dataclass(frozen=True)
class Planned:
    """Times of one wall: seconds before the first step, and each step, the quickest of several."""

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


def rubble(
    count: int, seed: int, wall_px: tuple[int, int], courses: int = 4, scale: float = 1.0
) -> Target:
    """Return generated stones for a wall, with so many courses when there are 32 of them."""
    width, height = wall_px
    factor = (count / LEAST_STONES) ** 0.5
    source = generated(
        "rubble", seed, count=count, width_px=width, height_px=height,
        courses=max(1, round(courses * factor)),
    )  # fmt: skip
    return Target(f"{count} generated stones", source, width, height, scale)


def planned(
    wall: Target, data: Path | None, settings: PlannerSettings, *, seed: int, repeats: int
) -> Planned:
    """Plan a wall several times, and keep the quickest repetition of every step."""
    stones = wall.source.stones(data)
    site = Site.from_source(wall.width, wall.height, wall.scale)
    profiles = []
    for _ in range(repeats):
        planner = Planner(stones, site, seed=seed, settings=settings)
        for _ in planner.steps():
            pass
        profiles.append(planner.profile)
    each = zip(*(profile.steps for profile in profiles), strict=True)
    steps = tuple(min(same, key=lambda step: step.seconds) for same in each)
    return Planned(site, min(p.total("preparation") for p in profiles), steps)


def fitted(points: Sequence[tuple[float, float]]) -> PowerLaw | None:
    """Fit a power law to sizes and times, least squares of the logarithms.

    None with less than two sizes, or where something took no time.

    Examples
    --------
    >>> law = fitted([(1.0, 3.0), (2.0, 12.0), (4.0, 48.0)])
    >>> round(law.factor, 9), round(law.exponent, 9)
    (3.0, 2.0)
    """
    if len({x for x, _ in points}) < 2 or any(y <= 0 for _, y in points):
        return None
    x, y = zip(*((log(a), log(b)) for a, b in points), strict=True)
    exponent, offset = np.polyfit(x, y, 1)
    return PowerLaw(float(np.exp(offset)), float(exponent))


def exponent(points: Sequence[tuple[float, float]]) -> float | None:
    """Return the exponent of :func:`fitted`; None where it has none."""
    law = fitted(points)
    return None if law is None else law.exponent


def parts_ms(steps: Sequence[StepTime]) -> tuple[float, ...]:
    """Return the mean ms a step: parts, the rest, and all; :data:`COLUMNS`."""
    parts = [fmean(step.parts.get(part, 0.0) for step in steps) for part in PARTS]
    seconds = fmean(step.seconds for step in steps)
    return tuple(1e3 * s for s in (*parts, seconds - sum(parts), seconds))


def size_of(site: Site) -> str:
    """Return width and height of a wall in working px, for people."""
    return f"{site.width_px} x {site.height_px}"


def three_digits(rows: Sequence[tuple[Cell, ...]]) -> tuple[tuple[Cell, ...], ...]:
    """Keep three digits of every number: times do not repeat to more."""
    return tuple(
        tuple(float(f"{cell:.3g}") if isinstance(cell, float) else cell for cell in row)
        for row in rows
    )


def numbers_of(cells: Sequence[Cell]) -> list[float]:
    """Return the cells that are numbers, in their order."""
    return [float(cell) for cell in cells if isinstance(cell, int | float)]
