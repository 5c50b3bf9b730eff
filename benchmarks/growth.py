"""How the time of a step grows with pixels and with stones (§6)."""

from dataclasses import dataclass, replace
from pathlib import Path
from statistics import fmean

from drystone.drawing.files import save
from drystone.planner.settings import method_settings
from drystone.selection.sampling import Sampling
from drystone_lab.table import BenchSettings, Cell, Table
from drystone_lab.timed_walls import (
    COLUMNS,
    LEAST_STONES,
    SAMPLINGS,
    TimedWall,
    exponent,
    numbers_of,
    parts_ms,
    pixels_table,
    planned,
    plot_pixels,
    rubble,
    size_of,
    steps_figure,
    steps_table,
    three_digits,
)
from drystone_lab.walls import PR, Target

SOURCE_PX = (560, 160)
LARGER_PX = (280, 80)
"""Wall of the paper at the resolution of the image PR."""

SCALES = (0.25, 0.5, 1.0, 1.5, 2.0)
"""Of the paper's size."""

COUNTS = (32, 128, 512)
"""Stones for walls of as many times the area."""

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
        Of each wall, but for the larger ones; the median counts.
    """

    stones: int | None
    scales: tuple[float, ...] = SCALES
    counts: tuple[int, ...] = COUNTS
    repeats: int = 12


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
    wall = _wall(settings, sizes.stones)
    often = sizes.repeats

    def timed(wall: Target, repeats: int, sampling: Sampling = "variant") -> TimedWall:
        paper = method_settings("paper").updated({"sampling": sampling})
        return planned(wall, settings.data, paper, seed=settings.seed, repeats=repeats)

    by_scale = {s: timed(replace(wall, scale=s * wall.scale), often) for s in sizes.scales}
    by_sampling = {s: timed(wall, often, s) for s in SAMPLINGS}
    by_count = {n: timed(_scaled(n, settings.seed, LARGER_PX), 1) for n in sizes.counts}
    if settings.output is not None:
        _draw(settings.output, wall.name, by_scale, by_sampling)
    return (
        pixels_table(wall.name, by_scale),
        steps_table(wall.name, by_sampling),
        _walls_table(by_count),
    )


def _wall(settings: BenchSettings, stones: int | None) -> Target:
    if stones is None and PR.source.is_there(settings.data):
        return PR
    return _scaled(stones or LEAST_STONES, settings.seed, SOURCE_PX, PR.scale)


def _scaled(count: int, seed: int, full_px: tuple[int, int], scale: float = 1.0) -> Target:
    """Return a wall that has as many times the given area as there are 32 stones."""
    factor = (count / LEAST_STONES) ** 0.5
    width, height = (round(factor * side) for side in full_px)
    return rubble(count, seed, (width, height), scale=scale)


def _walls_table(by_count: dict[int, TimedWall]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (
            str(count),
            size_of(wall.site),
            len(wall.steps),
            fmean(step.candidates for step in wall.steps),
            *parts_ms(wall.steps),
            1e3 * wall.preparation / count,
            wall.seconds,
        )
        for count, wall in by_count.items()
    ]
    counts = [float(count) for count in by_count]
    columns = zip(*(numbers_of(row[3:]) for row in rows), strict=True)
    exponents = [exponent(list(zip(counts, column, strict=True))) for column in columns]
    rows.append(("exponent", "", None, *exponents))
    return Table(
        "Larger walls of stones of one size: generated rubble, variant sampling, from the left",
        ("stones", "wall, px", "placed", "candidates a step", *COLUMNS,
         "preparation, ms a stone", "wall, s"),
        three_digits(rows),
        ("Exponents over the number of stones; the wall has as many more pixels.",),
    )  # fmt: skip


def _draw(
    folder: Path,
    name: str,
    by_scale: dict[float, TimedWall],
    by_sampling: dict[Sampling, TimedWall],
) -> None:
    save(steps_figure(by_sampling), folder / STEPS_PICTURE, dpi=DPI)
    save(plot_pixels(name, by_scale).figure, folder / PIXELS_PICTURE, dpi=DPI)
