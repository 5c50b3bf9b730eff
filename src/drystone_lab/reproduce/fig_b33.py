"""Fig. B.33: 91 irregular stones, built from one end and from both (B.2)."""

import math
from collections.abc import Mapping

from drystone_lab.pictures.wall_grid import plot_walls
from drystone_lab.reproduce.base import TWO_SIDED, PaperWall
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.summary import METRICS, metric_cells
from drystone_lab.runs.outcome import Outcome
from drystone_lab.runs.source import from_file, generated
from drystone_lab.runs.spec import RunSpec
from drystone_lab.table import Cell, Table

SIDES = ("one side", "two sides")

PAPER_PLACED = (90, 91)
"""Of 91, in the left and in the right wall."""

GENERATED = PaperWall(
    0, "91 generated stones",
    generated(
        "rubble", 2024, count=91, width_px=480.0, height_px=200.0, area_ratio=0.75, courses=8,
        spread=0.6, roughness=0.3, pentagons=0.5, rounding=0.2, tilt_deg=45.0,
    ),
    480, 200, 1.0, stand_in=True,
)  # fmt: skip
"""As irregular as rubble of ours can be, of sizes that differ by a factor; about as many pixels a
stone as the paper's PR has, and as much wall for them as its best walls fill."""

QUICK = PaperWall(
    0, "24 generated stones",
    generated(
        "rubble", 2024, count=24, width_px=240.0, height_px=100.0, area_ratio=0.75, courses=4,
        spread=0.6, roughness=0.3, pentagons=0.5, rounding=0.2, tilt_deg=45.0,
    ),
    240, 100, 1.0, stand_in=True,
)  # fmt: skip

MOST_PX = 96_000
"""Pixels of the wall of a user's stones at the working resolution, at most."""

PAPER = (
    "Fig. B.33 (B.2): 'Walls constructed from a stone set of 91 irregular stones, of which "
    f"{PAPER_PLACED[0]} stones could be placed in the construction of the left wall and "
    f"{PAPER_PLACED[1]} stones could be placed in the construction of the right wall', coloured by "
    "cluster. The stones are not public, and what the two walls differ in is not said.",
)


def make(context: Context, wall: PaperWall | None = None) -> Output:
    """Build a wall from one end and from both.

    Parameters
    ----------
    context : Context
        `image` for a user's own stones, which are to fill a wall of the size of their image.
    wall : PaperWall, optional
        Stones and size.
    """
    wall = wall or _wall(context)
    specs = {
        "one side": wall.run(context.seed),
        "two sides": wall.run(context.seed, TWO_SIDED),
    }
    outcomes = dict(zip(SIDES, context.run(list(specs.values())), strict=True))
    return Output(
        paper=PAPER,
        ours=_found(wall, outcomes),
        tables=(("walls", _table(wall, outcomes)),),
        pictures=(_picture(context, wall, specs, outcomes),),
        runs=tuple(specs.values()),
    )


def wall_of_image(context: Context) -> PaperWall:
    """Return the wall of a user's stones: as large as their image, at :data:`MOST_PX` at most."""
    if context.image is None:
        raise ValueError("there is no image")
    source = from_file(context.image)
    size = source.stones(context.data).source
    pixels = size.width_px * size.height_px
    # Two digits, rounded down, so that the scale reads well and stays below the limit.
    scale = min(1.0, math.floor(100 * math.sqrt(MOST_PX / pixels)) / 100)
    return PaperWall(0, context.image.name, source, 0.0, 0.0, max(0.01, scale))


def _wall(context: Context) -> PaperWall:
    if context.image is not None:
        return wall_of_image(context)
    return QUICK if context.quick else GENERATED


def _found(wall: PaperWall, outcomes: Mapping[str, Outcome]) -> tuple[str, ...]:
    each = "; ".join(
        f"from {side} {outcome.figures['placed']} of {outcome.figures['stones']}, F_SF "
        f"{outcome.figures['F_SF']:.3f}"
        for side, outcome in outcomes.items()
    )
    whose = (
        "our own irregular rubble, as the paper's stones are not public"
        if wall.stand_in
        else "a user's"
    )
    return (
        f"{wall.name}, {whose}: {each}. How many of them fit depends on the wall that they are "
        "given, which the paper does not tell, so the counts can be compared in kind only.",
    )


def _table(wall: PaperWall, outcomes: Mapping[str, Outcome]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (wall.name, side, outcome.figures["placed"], outcome.figures["stones"],
         len({*outcome.clusters.values()}), *metric_cells(outcome), outcome.figures["wedges"])
        for side, outcome in outcomes.items()
    ]  # fmt: skip
    rows += [("the paper's", f"wall {n}", placed, 91, None, None, None, None, None, None)
             for n, placed in enumerate(PAPER_PLACED, 1)]  # fmt: skip
    columns = ("stones", "built from", "placed", "of", "clusters", *METRICS, "wedges")
    return Table("Walls of many irregular stones", columns, tuple(rows))


def _picture(
    context: Context,
    wall: PaperWall,
    specs: Mapping[str, RunSpec],
    outcomes: Mapping[str, Outcome],
) -> Picture:
    walls = [
        (
            f"{wall.name}, from {side}: {outcome.figures['placed']} of "
            f"{outcome.figures['stones']} placed",
            outcome.wall(specs[side], context.data),
            outcome.clusters,
        )
        for side, outcome in outcomes.items()
    ]
    return Picture(
        "figB33", plot_walls(walls, 2),
        f"Walls of {wall.name}, built from one end and from both; stones of one cluster have "
        "one colour, numbers are the order of placement, wedges are dark red.",
    )  # fmt: skip


ITEM = Item("91 irregular stones", "B.2", make)
