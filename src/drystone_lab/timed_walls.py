"""Walls planned and timed: the time of every step by part, and how it grows (§6)."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import log
from pathlib import Path
from statistics import fmean, median

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.planner.profile import Part, Profile, StepTime
from drystone.planner.settings import PlannerSettings
from drystone.selection.sampling import Sampling
from drystone_lab.pictures.growth import Claim, PowerLaw, Series, plot_growth, step_time_panels
from drystone_lab.runs.spec import generated
from drystone_lab.table import Cell, Table
from drystone_lab.walls import Target

PARTS: tuple[Part, ...] = ("placement", "stabilisation", "contacts", "limit analysis", "indices")
"""Of a step; the last three are the paper's selection."""

COLUMNS = (*PARTS, "rest", "all")
"""Mean ms a step."""

LEAST_STONES = 32
"""For which :func:`rubble` makes the given number of courses."""


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


PUBLISHED = "PR"
"""Name of the stones of the paper."""

PAPER_WALL_S = {140 * 40: 0.18 * 60}
"""By pixels.  §6.3: 32 stones in .18 minutes at 140 x 40 px."""

PAPER_STEP_S = {560 * 160: 25.0}
"""By pixels.  §6.3: at the highest resolution no step takes longer."""

FIRST_STONES = 4
"""Growth with the stones placed is fitted from so many on."""

BIN = 8
"""Stones in a row of the table."""

SAMPLINGS: Mapping[Sampling, str] = {"variant": "variant sampling", "full": "full batch sampling"}


def papers(name: str) -> tuple[dict[int, float], dict[int, float]]:
    """Return what the paper says of walls and of longest steps of these stones, by pixels."""
    return (PAPER_WALL_S, PAPER_STEP_S) if name == PUBLISHED else ({}, {})


def pixels_table(name: str, by_scale: Mapping[float, TimedWall]) -> Table:
    """Return the times of walls of several resolutions, and their exponents.

    The stones :data:`PUBLISHED` have the paper's times beside.
    """
    walls, longest_steps = papers(name)
    rows: list[tuple[Cell, ...]] = [
        (
            size_of(planned.site),
            len(planned.steps),
            fmean(step.candidates for step in planned.steps),
            *parts_ms(planned.steps),
            planned.seconds,
            walls.get(planned.pixels),
            planned.longest,
            longest_steps.get(planned.pixels),
        )
        for planned in by_scale.values()
    ]
    pixels = [float(planned.pixels) for planned in by_scale.values()]
    measured = zip(*(numbers_of(row[3:10]) + numbers_of(row[10:11]) + numbers_of(row[12:13])
                     for row in rows), strict=True)  # fmt: skip
    exponents = [exponent(list(zip(pixels, column, strict=True))) for column in measured]
    *steps, wall, longest = exponents
    rows.append(("exponent over pixels", None, None, *steps, wall, None, longest, None))
    return Table(
        f"Time against pixels (Fig. 29): {name}, variant sampling, from the left",
        ("wall, px", "placed", "candidates a step", *COLUMNS, "wall, s", "paper: wall, s",
         "longest step, s", "paper: longest step below, s"),
        three_digits(rows),
        (
            "Parts: mean ms of the processor a step; a wall: from the stones to the last step.",
            "The paper's numbers are those of its text (§6.3; several processes, i7-10700, 2.9"
            " GHz); it calls its growth quadratic in the scale, which is an exponent of 1 here.",
        ),
    )  # fmt: skip


def steps_table(name: str, by_sampling: Mapping[Sampling, TimedWall]) -> Table:
    """Return the times of steps by stones placed, and how those of a candidate grow."""
    rows: list[tuple[Cell, ...]] = []
    for sampling, planned in by_sampling.items():
        for first in range(0, len(planned.steps), BIN):
            steps = planned.steps[first : first + BIN]
            candidates = fmean(step.candidates for step in steps)
            parts = parts_ms(steps)
            stones = f"{first} to {first + len(steps) - 1}"
            rows.append((sampling, stones, candidates, *parts, parts[-1] / candidates))
        rows.append((sampling, "exponent a candidate", None, *_step_exponents(planned.steps), None))
    site = next(iter(by_sampling.values())).site
    return Table(
        f"Time against stones placed (Fig. 28): {name}, {size_of(site)} px, from the left",
        ("sampling", "stones placed", "candidates a step", *COLUMNS, "ms a candidate"),
        three_digits(rows),
        (
            "Mean ms a step; contacts, limit analysis and indices are what the paper calls"
            " selection.",
            f"Exponents: of the ms a candidate of each step, from {FIRST_STONES} stones on.",
        ),
    )


def _step_exponents(steps: Sequence[StepTime]) -> list[float | None]:
    late = [step for step in steps if step.stones >= FIRST_STONES]
    each = [[ms / step.candidates for ms in parts_ms([step])] for step in late]
    stones = [float(step.stones) for step in late]
    return [exponent(list(zip(stones, column, strict=True))) for column in zip(*each, strict=True)]


def steps_figure(by_sampling: Mapping[Sampling, TimedWall]) -> Figure:
    """Draw the time of every step by part, a panel a sampling (Fig. 28)."""
    panels = {SAMPLINGS[sampling]: planned.steps for sampling, planned in by_sampling.items()}
    return step_time_panels(panels)


def plot_pixels(name: str, by_scale: Mapping[float, TimedWall], ax: Axes | None = None) -> Axes:
    """Draw the times of walls and of their longest steps against pixels (Fig. 29)."""
    walls = tuple((float(p.pixels), p.seconds) for p in by_scale.values())
    steps = tuple((float(p.pixels), p.longest) for p in by_scale.values())
    said, said_of_steps = papers(name)
    claims = [Claim("paper: whole wall", float(px), s) for px, s in said.items()]
    claims += [
        Claim("paper: longest step, below", float(px), s, at_most=True)
        for px, s in said_of_steps.items()
    ]
    return plot_growth(
        (Series("whole wall", walls, fitted(walls)), Series("longest step", steps, fitted(steps))),
        claims,
        ax,
        size="pixels of the wall",
    )
