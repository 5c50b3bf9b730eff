"""Fig. 21: walls built from both ends (§5.2)."""

from collections.abc import Sequence

from drystone_lab.pictures.groups import group_panels
from drystone_lab.pictures.wall_grid import plot_walls
from drystone_lab.reproduce import summary, wins
from drystone_lab.reproduce.base import MASONS, TWO_SIDED, PaperWall
from drystone_lab.reproduce.drawn import titled_wall
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.trials import (
    BASE,
    Trials,
    all_specs,
    run_trials,
    seeds_of,
)
from drystone_lab.runs.changes import Changes
from drystone_lab.table import Table

ONE, TWO = "one-sided", "two-sided"
WAYS: dict[str, Changes] = {ONE: BASE, TWO: (TWO_SIDED,)}
FIGURES = (*summary.METRICS, "E_FLUSH")
FULL_SEEDS, QUICK_SEEDS = 20, 4


def make(context: Context) -> Output:
    """Build walls from one end and from both."""
    return compare(context, MASONS, seeds_of(context, FULL_SEEDS, QUICK_SEEDS))


def compare(context: Context, walls: Sequence[PaperWall], seeds: Sequence[int]) -> Output:
    """Build walls of some sets from some seeds, from one end and from both.

    Parameters
    ----------
    context : Context
        Does the runs.
    walls : sequence of PaperWall
        The sets.
    seeds : sequence of int
        The walls of the first are drawn.
    """
    trials = run_trials(context, walls, WAYS, seeds)
    return Output(
        paper=(
            "§5.2, Fig. 21: built from both ends (Eq. 29), stones are aligned with both ends of "
            "the walls R, PR and IR, and the weak region with voids moves from the right end to "
            "the middle, where both halves meet. No metrics are given.",
        ),
        ours=(
            *(_said([each for each in trials if each.wall == wall]) for wall in walls),
            "Where the voids are was not measured: the picture shows it for one seed.",
        ),
        tables=(
            (
                "fig21",
                Table(
                    "Walls built from one end and from both",
                    ("wall", "built", *summary.COLUMNS, "E_FLUSH median"),
                    tuple(_row(each) for each in trials),
                    (
                        "E_FLUSH: mean gap of the ends to the wall's end lines over the mean "
                        "width of a stone; our measure of the paper's alignment with both ends.",
                    ),
                ),
            ),
            ("fig21_pairs", _pairs(trials)),
        ),
        pictures=(
            Picture(
                "fig21",
                plot_walls([titled_wall(context, t, f"{t.wall.name}, {t.way}") for t in trials], 2),
                f"Walls of seed {seeds[0]}, left from one end, right from both; numbers are steps "
                "of the plan, stones of a colour are of one cluster, wedges dark red.",
            ),
            _strips(trials),
        ),
        runs=all_specs(trials),
    )


def _row(trials: Trials) -> tuple[str | int | float | bool | None, ...]:
    flush = summary.rounded(summary.median_of(trials.outcomes, "E_FLUSH"))
    return trials.wall.name, trials.way, *summary.summary(trials.outcomes), flush


def _said(pair: Sequence[Trials]) -> str:
    one, two = pair
    parts = []
    for name in FIGURES:
        won = wins.wins(two.values(name), one.values(name), name)
        first, second = (summary.median_of(each.outcomes, name) for each in pair)
        if first is not None and second is not None:
            parts.append(f"{name} {second:.3g} after {first:.3g} (better in {won.better} of "
                         f"{won.pairs})")  # fmt: skip
    return f"{one.wall.name}, median of two-sided after one-sided: {', '.join(parts)}."


def _pairs(trials: Sequence[Trials]) -> Table:
    rows = wins.wins_rows(trials, TWO, (ONE,))
    return Table(
        "Two-sided against one-sided, pairs of one set and seed",
        ("other", *wins.COLUMNS),
        rows,
    )


def _strips(trials: Sequence[Trials]) -> Picture:
    figures = {
        name: {f"{each.wall.name} {each.way[:3]}": each.values(name) for each in trials}
        for name in FIGURES
    }
    return Picture(
        "fig21_seeds",
        group_panels(figures),
        "A point a wall, one-sided and two-sided; lines are medians.",
    )


ITEM = Item(
    "Walls built from both ends", "§5.2, Fig. 21", make,
    needs=tuple(wall.source.name for wall in MASONS),
)  # fmt: skip
