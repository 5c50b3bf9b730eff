"""How the time of a step grows with walls of more stones; Figs. 28 and 29 are the lab's."""

from statistics import fmean

from drystone.planner.settings import method_settings
from drystone_lab.table import Table
from drystone_lab.timed_walls import (
    COLUMNS,
    LEAST_STONES,
    TimedWall,
    exponents,
    parts_ms,
    planned,
    rubble,
    three_digits,
)

LARGER_PX = (280, 80)
"""Wall of the paper at the resolution of the image PR, for 32 stones."""

COUNTS = (32, 128, 512)
"""Stones for walls of as many times the area."""


def larger_walls(seed: int, counts: tuple[int, ...] = COUNTS) -> Table:
    """Plan walls of ever more generated stones of one size, by the clock."""
    return growth_table({count: _timed(count, seed) for count in counts})


def _timed(count: int, seed: int) -> TimedWall:
    factor = (count / LEAST_STONES) ** 0.5
    width, height = (round(factor * side) for side in LARGER_PX)
    wall = rubble(count, seed, (width, height))
    return planned(wall, None, method_settings("paper"), seed=seed, repeats=1)


def growth_table(by_count: dict[int, TimedWall]) -> Table:
    """Return the times of walls by their stones, and how they grow."""
    measured = [
        (
            fmean(step.candidates for step in wall.steps),
            *parts_ms(wall.steps),
            1e3 * wall.preparation / count,
            wall.seconds,
        )
        for count, wall in by_count.items()
    ]
    rows = [
        three_digits((str(count), wall.size, len(wall.steps), *row))
        for (count, wall), row in zip(by_count.items(), measured, strict=True)
    ]
    growth = exponents([float(count) for count in by_count], measured)
    rows.append(three_digits(("exponent", "", None, *growth)))
    return Table(
        "Larger walls of stones of one size: generated rubble, variant sampling, from the left",
        ("stones", "wall, px", "placed", "candidates a step", *COLUMNS,
         "preparation, ms a stone", "wall, s"),
        tuple(rows),
        ("Exponents over the number of stones; the wall has as many more pixels.",),
    )  # fmt: skip
