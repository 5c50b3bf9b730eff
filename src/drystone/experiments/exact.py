"""Suite "exact": walls planned on outlines beside walls planned on pixels (DESIGN 4.9)."""

from collections.abc import Iterable, Sequence
from itertools import chain, groupby
from statistics import median

from drystone.contacts.settled import PlacedPolygons, model_of_outlines
from drystone.experiments.exact_walls import BuiltWall, built_walls
from drystone.experiments.planned_walls import missing_data
from drystone.experiments.table import BenchSettings, Cell, Table
from drystone.model.overlap import deepest_overlap, shape_of
from drystone.statics.limit import lateral_resistance
from drystone.verify.check import check_plan

COLUMNS = (
    "wall", "placed", "all placed", "F_SF", "F_AV", "F_AH", "F_LR", "outlines .05 px", ".1 px",
    ".2 px", "1 px", "unstable", "deepest px", "wedges", "s", "problems",
)  # fmt: skip

TOLERANCES_PX = (0.05, 0.1, 0.2, 1.0)
"""Contact tolerances, source px, at which outlines are judged."""


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Plan all walls on both geometries, and judge both by their outlines."""
    walls = built_walls(settings)
    rows = [
        _row(list(group))
        for _, group in groupby(walls, lambda wall: (wall.target.name, wall.geometry))
    ]
    return (
        Table(
            "One pass of best on outlines and on pixels, medians over the seeds",
            COLUMNS,
            tuple(rows),
            (
                "F_LR is what the plan says on its own geometry; then F_LR of the same poses by "
                "the outlines, with gaps up to so many source px as contacts. A wall that "
                "is unstable counts as 0 in the medians; how many are so at .1 px stands beside "
                "them. What overlaps by less than the tolerance counts as touching.",
                "Problems are what `drystone check` finds, on the geometry of the plan.",
                *missing_data(settings),
            ),
        ),
    )


def _row(walls: Sequence[BuiltWall]) -> tuple[Cell, ...]:
    first = walls[0]
    placed = [len(wall.result.plan.stone_steps) for wall in walls]
    metrics = [wall.result.metrics for wall in walls]
    by_outline = [outline_resistances(wall) for wall in walls]
    problems = [len(check_plan(wall.result.plan, wall.stones).problems) for wall in walls]
    return (
        f"{first.target.name}, {first.geometry}",
        f"{min(placed)}-{max(placed)} of {len(first.stones)}",
        f"{sum(n == len(first.stones) for n in placed)} of {len(walls)}",
        median(m.F_SF for m in metrics),
        _median(m.F_AV for m in metrics),
        _median(m.F_AH for m in metrics),
        _median(m.F_LR for m in metrics),
        *(median(found[k] or 0.0 for found in by_outline) for k in range(len(TOLERANCES_PX))),
        sum(found[1] is None for found in by_outline),
        max(deepest(wall) for wall in walls),
        median(len(wall.result.plan.wedge_steps) for wall in walls),
        median(wall.result.seconds for wall in walls),
        sum(problems),
    )


def outline_resistances(wall: BuiltWall) -> tuple[float | None, ...]:
    """Return F_LR by the outlines at each tolerance; None where the wall does not stand."""
    blocks = PlacedPolygons.of(chain.from_iterable(wall.groups))
    mu = float(wall.result.plan.settings["mu"])
    return tuple(
        lateral_resistance(model_of_outlines(blocks, mu, tolerance)).value
        for tolerance in TOLERANCES_PX
    )


def deepest(wall: BuiltWall) -> float:
    """Return how deep two outlines lie in each other at most, source px."""
    blocks = chain.from_iterable(wall.groups)
    return deepest_overlap([(block, shape_of(corners)) for block, corners in blocks])[0]


def _median(values: Iterable[float | None]) -> float | None:
    found = [value for value in values if value is not None]
    return median(found) if found else None
