"""Figs. B.30 to B.32: walls of R, PR and IR by all methods of construction (B.1)."""

from collections.abc import Sequence

from drystone.model.site import working_px
from drystone_lab.pictures.wall_grid import plot_walls
from drystone_lab.reproduce.base import MASONS, PR, TWO_SIDED, PaperWall, R, coarser
from drystone_lab.reproduce.drawn import titled_wall
from drystone_lab.reproduce.fig16 import SAMPLINGS, sampled
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.summary import METRICS, metric_cells
from drystone_lab.reproduce.trials import Trials, all_specs, run_trials
from drystone_lab.runs.changes import Changes
from drystone_lab.table import Table

SIDES: dict[str, Changes] = {"one-sided": (), "two-sided": (TWO_SIDED,)}
WAYS: dict[str, Changes] = {
    f"{sampling}, {side}": (*sampled(sampling), *changes)
    for sampling in SAMPLINGS
    for side, changes in SIDES.items()
}
NUMBERS = {"R": "B.30", "PR": "B.31", "IR": "B.32"}
QUICK = (coarser(R, 0.1), coarser(PR, 0.25))
"""The many stones of IR take longest."""


def make(context: Context) -> Output:
    """Build walls by all methods."""
    return build(context, QUICK if context.quick else MASONS)


def build(context: Context, walls: Sequence[PaperWall]) -> Output:
    """Build a wall of each set by all methods, from the seed of the context.

    Parameters
    ----------
    context : Context
        Does the runs.
    walls : sequence of PaperWall
        The sets.
    """
    trials = run_trials(context, walls, WAYS, (context.seed,))
    return Output(
        paper=(
            "B.1, Figs. B.30 to B.32: walls of the regular, partially regular and irregular "
            "stones by various methods of construction, on images of 289 x 79, 280 x 80 and "
            "433 x 115 px. No numbers, and no names of the methods, are in the text.",
        ),
        ours=(
            *(_said([each for each in trials if each.wall == wall]) for wall in walls),
            "One seed a method; how much walls of one method differ from seed to seed is seen in "
            "table2, fig16 and fig21.",
            *(("This quick version has coarser walls, and none of IR.",) if context.quick else ()),
        ),
        tables=(("figB30_32", _table(trials)),),
        pictures=tuple(_picture(context, trials, wall) for wall in walls),
        runs=all_specs(trials),
    )


def _said(group: Sequence[Trials]) -> str:
    filled = {each.way: float(each.outcomes[0].figures["F_SF"] or 0) for each in group}
    full = max(filled, key=lambda way: filled[way])
    whole = sum(o.figures["placed"] == o.figures["stones"] for t in group for o in t.outcomes)
    wall = group[0].wall
    size = " x ".join(f"{working_px(side, wall.scale)}" for side in (wall.width, wall.height))
    return (
        f"{wall.name} on {size} px: F_SF from {min(filled.values()):.3f} to "
        f"{filled[full]:.3f}, the fullest by {full}; {whole} of {len(group)} walls have all stones."
    )


def _table(trials: Sequence[Trials]) -> Table:
    rows = []
    for each in trials:
        figures = each.outcomes[0].figures
        rows.append(
            (
                each.wall.name, each.way, figures["placed"], figures["stones"],
                *metric_cells(each.outcomes[0]), figures["wedges"], figures["candidates"],
            )
        )  # fmt: skip
    return Table(
        "Walls of one seed by all methods of construction",
        ("wall", "method", "placed", "stones", *METRICS, "wedges", "candidates"),
        tuple(rows),
    )


def _picture(context: Context, trials: Sequence[Trials], wall: PaperWall) -> Picture:
    drawn = [titled_wall(context, each, each.way) for each in trials if each.wall == wall]
    number = NUMBERS.get(wall.name, "B.1")
    return Picture(
        f"fig{number.replace('.', '')}",
        plot_walls(drawn, len(SIDES)),
        f"Fig. {number}, stones {wall.name}: left from one end, right from both. Numbers are steps "
        "of the plan, stones of a colour are of one cluster, wedges dark red.",
    )


ITEM = Item(
    "Walls of the stones of Fig. 18 by other methods", "B.1, Figs. B.30 to B.32", make,
    needs=tuple(wall.source.name for wall in MASONS),
)  # fmt: skip
