"""Table 2 and Fig. 18: walls 1 to 5 from a fixed seed, the best of 20, and the masons' (§5.2)."""

from collections.abc import Sequence

from drystone_lab.reproduce import table2_words as words
from drystone_lab.reproduce.base import MASONS, WALLS, PaperWall
from drystone_lab.reproduce.item import Context, Item, Output
from drystone_lab.reproduce.masons_wall import masons_wall
from drystone_lab.reproduce.table2_picture import fig18
from drystone_lab.reproduce.table2_rows import FiveWall, comparison, spread
from drystone_lab.reproduce.trials import BASE, all_specs, run_trials, seeds_of

FULL_SEEDS, QUICK_SEEDS = 20, 4


def make(context: Context) -> Output:
    """Build walls 1 to 5."""
    return compare(context, WALLS, seeds_of(context, FULL_SEEDS, QUICK_SEEDS))


def compare(context: Context, walls: Sequence[PaperWall], seeds: Sequence[int]) -> Output:
    """Build walls from several seeds and set them beside the masons' and Table 2.

    Parameters
    ----------
    context : Context
        Does the runs.
    walls : sequence of PaperWall
        With the numbers of Table 2; those that are no stand-ins are published label images.
    seeds : sequence of int
        The first is the fixed one.
    """
    trials = run_trials(context, walls, {"variant": BASE}, seeds)
    found = [
        FiveWall(
            each,
            each.wall.source.stones(context.data),
            None if each.wall.stand_in else masons_wall(each.wall, context.data),
        )
        for each in trials
    ]
    return Output(
        paper=words.PAPER,
        ours=words.ours(found),
        tables=(("table2", comparison(found)), ("table2_seeds", spread(found))),
        pictures=(fig18(context, found),),
        runs=all_specs(trials),
    )


ITEM = Item(
    "Walls 1 to 5: fixed seed, best of 20, masons", "§5.2, Table 2 and Fig. 18", make,
    needs=tuple(wall.source.name for wall in MASONS),
)  # fmt: skip
