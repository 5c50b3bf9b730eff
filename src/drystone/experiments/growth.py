"""Suite "growth": how the time of a step grows with pixels and with stones (§6)."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import log
from pathlib import Path
from statistics import fmean

import numpy as np

from drystone.experiments.table import BenchSettings, Cell, Table
from drystone.generate import RubbleSettings, rubble_stones
from drystone.io.read_stones import read_stones
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.planner.planner import Planner
from drystone.planner.profile import Part, StepTime
from drystone.planner.settings import method_settings
from drystone.plotting.files import save
from drystone.plotting.growth import Claim, PowerLaw, Series, plot_growth, step_time_panels
from drystone.selection.sampling import Sampling

PARTS: tuple[Part, ...] = ("placement", "stabilisation", "contacts", "limit analysis", "indices")
"""Of a step; the last three are the paper's selection."""

SOURCE_PX = (560, 160)
"""Wall of the paper at the resolution of the image PR."""

WORKING = 0.5
"""Scale at which that wall has the paper's 280 x 80 px."""

SCALES = (0.25, 0.5, 1.0, 1.5, 2.0)
"""Of the paper's size."""

COUNTS = (32, 128, 512)
"""Stones for walls of as many times the area."""

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

STEPS_PICTURE = "step_times.png"
PIXELS_PICTURE = "resolution.png"
DPI = 150


@dataclass(frozen=True)
class Sizes:
    """How much is planned.

    Parameters
    ----------
    stones : int or None
        Generated ones; None for the published set.
    scales : tuple of float
        Of the paper's size.
    counts : tuple of int
        Stones of larger walls.
    repeats : int
        Of each wall, but for the larger ones; the quickest counts.
    """

    stones: int | None
    scales: tuple[float, ...] = SCALES
    counts: tuple[int, ...] = COUNTS
    repeats: int = 12


@dataclass(frozen=True)
class Task:
    """Stones and the wall that they are for.

    Parameters
    ----------
    name : str
        Of the stones.
    stones : StoneSet
        The stones.
    wall_px : (float, float)
        Width and height of the wall, px of the source image.
    """

    name: str
    stones: StoneSet
    wall_px: tuple[float, float]


@dataclass(frozen=True)
class Planned:
    """Times of one wall.

    Parameters
    ----------
    site : Site
        Where.
    preparation : float
        Seconds before the first step.
    steps : tuple of StepTime
        Each the quickest of its repetitions.
    """

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


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Plan walls of several resolutions and sizes, and draw Fig. 28 and Fig. 29 of them.

    Parameters
    ----------
    settings : BenchSettings
        `data` for the published stones, generated ones without it; `quick` for eight stones.
    """
    sizes = Sizes(None)
    if settings.quick:
        sizes = Sizes(8, (0.5, 1.0), (8, 16), repeats=1)
    task = _task(settings, sizes.stones)
    seed, often = settings.seed, sizes.repeats
    by_scale = {s: _planned(task, s * WORKING, "variant", seed, often) for s in sizes.scales}
    samplings: tuple[Sampling, ...] = ("variant", "full")
    by_sampling = {s: _planned(task, WORKING, s, seed, often) for s in samplings}
    by_count = {n: _planned(_rubble(n, seed), 1.0, "variant", seed, 1)
                for n in sizes.counts}  # fmt: skip
    if settings.output is not None:
        _draw(settings.output, task.name, by_scale, by_sampling)
    return (
        _pixels_table(task.name, by_scale),
        _steps_table(task.name, by_sampling),
        _walls_table(by_count),
    )


def _task(settings: BenchSettings, stones: int | None) -> Task:
    if stones is None and settings.data is not None and (settings.data / "almeida").is_dir():
        published = read_stones(settings.data / "almeida" / "PR.png")
        return Task(PUBLISHED, published, SOURCE_PX)
    return _rubble(stones or COUNTS[0], settings.seed, SOURCE_PX)


def _rubble(count: int, seed: int, full_px: tuple[int, int] = (280, 80)) -> Task:
    """Generate stones for a wall that has the given size when there are 32 of them."""
    factor = (count / COUNTS[0]) ** 0.5
    width, height = round(factor * full_px[0]), round(factor * full_px[1])
    size = RubbleSettings(
        count=count, width_px=width, height_px=height, courses=max(1, round(4 * factor))
    )
    stones = rubble_stones(size, np.random.default_rng(seed))
    return Task(f"{count} generated stones", stones, (width, height))


def _planned(task: Task, scale: float, sampling: Sampling, seed: int, repeats: int) -> Planned:
    """Plan a wall by the paper's method, several times."""
    site = Site.from_source(*task.wall_px, scale)
    settings = method_settings("paper").updated({"sampling": sampling})
    profiles = []
    for _ in range(repeats):
        planner = Planner(task.stones, site, seed=seed, settings=settings)
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


def _exponent(points: Sequence[tuple[float, float]]) -> float | None:
    law = fitted(points)
    return None if law is None else law.exponent


def _parts_ms(steps: Sequence[StepTime]) -> tuple[float, ...]:
    """Return the mean ms a step: parts, the rest, and all."""
    parts = [fmean(step.parts.get(part, 0.0) for step in steps) for part in PARTS]
    seconds = fmean(step.seconds for step in steps)
    return tuple(1e3 * s for s in (*parts, seconds - sum(parts), seconds))


COLUMNS = (*PARTS, "rest", "all")
"""Mean ms a step."""


def _papers(name: str) -> tuple[dict[int, float], dict[int, float]]:
    """Return what the paper says of walls and of longest steps of these stones, by pixels."""
    return (PAPER_WALL_S, PAPER_STEP_S) if name == PUBLISHED else ({}, {})


def _pixels_table(name: str, by_scale: dict[float, Planned]) -> Table:
    walls, longest_steps = _papers(name)
    rows: list[tuple[Cell, ...]] = [
        (
            _size(planned.site),
            len(planned.steps),
            fmean(step.candidates for step in planned.steps),
            *_parts_ms(planned.steps),
            planned.seconds,
            walls.get(planned.pixels),
            planned.longest,
            longest_steps.get(planned.pixels),
        )
        for planned in by_scale.values()
    ]
    pixels = [float(planned.pixels) for planned in by_scale.values()]
    measured = zip(*(_numbers(row[3:10]) + _numbers(row[10:11]) + _numbers(row[12:13])
                     for row in rows), strict=True)  # fmt: skip
    exponents = [_exponent(list(zip(pixels, column, strict=True))) for column in measured]
    *steps, wall, longest = exponents
    rows.append(("exponent over pixels", None, None, *steps, wall, None, longest, None))
    return Table(
        f"Time against pixels (Fig. 29): {name}, variant sampling, from the left",
        ("wall, px", "placed", "candidates a step", *COLUMNS, "wall, s", "paper: wall, s",
         "longest step, s", "paper: longest step below, s"),
        _written(rows),
        (
            "Parts are mean ms a step; a wall is from the stones to the last step. One thread.",
            "The paper's numbers are those of its text (§6.3; several processes, i7-10700, 2.9"
            " GHz); it calls its growth quadratic in the scale, which is an exponent of 1 here.",
        ),
    )  # fmt: skip


def _size(site: Site) -> str:
    return f"{site.width_px} x {site.height_px}"


def _written(rows: Sequence[tuple[Cell, ...]]) -> tuple[tuple[Cell, ...], ...]:
    """Keep three digits of every number: times do not repeat to more."""
    return tuple(
        tuple(float(f"{cell:.3g}") if isinstance(cell, float) else cell for cell in row)
        for row in rows
    )


def _numbers(cells: Sequence[Cell]) -> list[float]:
    return [float(cell) for cell in cells if isinstance(cell, int | float)]


def _steps_table(name: str, by_sampling: dict[Sampling, Planned]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for sampling, planned in by_sampling.items():
        for first in range(0, len(planned.steps), BIN):
            steps = planned.steps[first : first + BIN]
            candidates = fmean(step.candidates for step in steps)
            parts = _parts_ms(steps)
            stones = f"{first} to {first + len(steps) - 1}"
            rows.append((sampling, stones, candidates, *parts, parts[-1] / candidates))
        rows.append((sampling, "exponent a candidate", None, *_step_exponents(planned.steps), None))
    site = next(iter(by_sampling.values())).site
    return Table(
        f"Time against stones placed (Fig. 28): {name}, {_size(site)} px, from the left",
        ("sampling", "stones placed", "candidates a step", *COLUMNS, "ms a candidate"),
        _written(rows),
        (
            "Mean ms a step; contacts, limit analysis and indices are what the paper calls"
            " selection.",
            f"Exponents: of the ms a candidate of each step, from {FIRST_STONES} stones on.",
        ),
    )


def _step_exponents(steps: Sequence[StepTime]) -> list[float | None]:
    late = [step for step in steps if step.stones >= FIRST_STONES]
    each = [[ms / step.candidates for ms in _parts_ms([step])] for step in late]
    stones = [float(step.stones) for step in late]
    return [_exponent(list(zip(stones, column, strict=True))) for column in zip(*each, strict=True)]


def _walls_table(by_count: dict[int, Planned]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (
            str(count),
            _size(planned.site),
            len(planned.steps),
            fmean(step.candidates for step in planned.steps),
            *_parts_ms(planned.steps),
            1e3 * planned.preparation / count,
            planned.seconds,
        )
        for count, planned in by_count.items()
    ]
    counts = [float(count) for count in by_count]
    columns = zip(*(_numbers(row[3:]) for row in rows), strict=True)
    exponents = [_exponent(list(zip(counts, column, strict=True))) for column in columns]
    rows.append(("exponent", "", None, *exponents))
    return Table(
        "Larger walls of stones of one size: generated rubble, variant sampling, from the left",
        ("stones", "wall, px", "placed", "candidates a step", *COLUMNS,
         "preparation, ms a stone", "wall, s"),
        _written(rows),
        ("Exponents over the number of stones; the wall has as many more pixels.",),
    )  # fmt: skip


def _draw(
    folder: Path,
    name: str,
    by_scale: dict[float, Planned],
    by_sampling: dict[Sampling, Planned],
) -> None:
    titles = {"variant": "variant sampling", "full": "full batch sampling"}
    panels = {titles[sampling]: planned.steps for sampling, planned in by_sampling.items()}
    save(step_time_panels(panels), folder / STEPS_PICTURE, dpi=DPI)
    walls = tuple((float(p.pixels), p.seconds) for p in by_scale.values())
    steps = tuple((float(p.pixels), p.longest) for p in by_scale.values())
    said, said_of_steps = _papers(name)
    claims = [Claim("paper: whole wall", float(px), s) for px, s in said.items()]
    claims += [
        Claim("paper: longest step, below", float(px), s, at_most=True)
        for px, s in said_of_steps.items()
    ]
    ax = plot_growth(
        (
            Series("whole wall", walls, fitted(walls)),
            Series("longest step", steps, fitted(steps)),
        ),
        claims,
        size="pixels of the wall",
    )
    save(ax.figure, folder / PIXELS_PICTURE, dpi=DPI)
