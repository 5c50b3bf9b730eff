"""The threshold of GDS in Eq. 12: beta 0, .5, .7, .9, and GDS without threshold (§3.6)."""

from collections.abc import Sequence

from drystone_lab.pictures.groups import group_panels
from drystone_lab.reproduce import summary, wins
from drystone_lab.reproduce.base import MASONS, PaperWall
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.trials import (
    Trials,
    all_specs,
    run_trials,
    seeds_of,
)
from drystone_lab.runs.changes import Changes
from drystone_lab.table import Table

BETAS = (0.0, 0.5, 0.7, 0.9)
PAPERS = "0.7"
"""Name of the threshold that the paper found best."""

NO_THRESHOLD = -1.0
"""GDS is never below 0, so H(GDS, -1) is GDS itself."""

FULL_SEEDS, QUICK_SEEDS, ALONE_SEEDS = 20, 3, 3


def _way(beta: float) -> Changes:
    return (("placement.beta", beta),)


def make(context: Context) -> Output:
    """Build walls with every threshold."""
    return compare(context, MASONS, seeds_of(context, FULL_SEEDS, QUICK_SEEDS))


def compare(context: Context, walls: Sequence[PaperWall], seeds: Sequence[int]) -> Output:
    """Build walls of some sets from some seeds with every threshold.

    Parameters
    ----------
    context : Context
        Does the runs.
    walls : sequence of PaperWall
        The sets.
    seeds : sequence of int
        The same for all; the first :data:`ALONE_SEEDS` for GDS without threshold.
    """
    trials = run_trials(context, walls, {f"{beta:g}": _way(beta) for beta in BETAS}, seeds)
    alone = run_trials(context, walls, {"alone": _way(NO_THRESHOLD)}, seeds[:ALONE_SEEDS])
    others = [f"{beta:g}" for beta in BETAS if f"{beta:g}" != PAPERS]
    rows = tuple(wins.wins_rows(trials, PAPERS, others))
    return Output(
        paper=(
            "§3.6: in the majority of the cases evaluated, beta = 0.7 in H(GDS, beta) of Eq. 12 "
            "resulted in better outcomes than GDS alone or beta = 0, 0.5 or 0.9. Neither the cases "
            "nor the numbers are given.",
        ),
        ours=(_same_walls(trials, alone), _verdict(trials, others)),
        tables=(
            (
                "beta",
                Table(
                    "Walls by the threshold of GDS",
                    ("wall", "beta", *summary.COLUMNS),
                    tuple((t.wall.name, t.way, *summary.summary(t.outcomes)) for t in trials),
                    (f"One-sided, variant sampling; {len(seeds)} seeds from {seeds[0]}.",),
                ),
            ),
            (
                "beta_pairs",
                Table(
                    f"Walls with beta = {PAPERS} against those with others, pairs of one seed",
                    ("other beta", *wins.COLUMNS),
                    rows,
                    (f"All sets together: {', '.join(wall.name for wall in walls)}.",),
                ),
            ),
        ),
        pictures=(_picture(trials),),
        runs=all_specs((*trials, *alone)),
    )


def _same_walls(trials: Sequence[Trials], alone: Sequence[Trials]) -> str:
    zero = wins.by_way(trials, "0")
    same = sum(_equal_walls(one, two) for one, two in zip(alone, zero, strict=True))
    runs = sum(len(each.outcomes) for each in alone)
    return (
        "GDS alone and beta = 0 are one function: H(x, 0) is x for x > 0, and 0 for x = 0, which "
        f"is x again. So the planner built the same wall, step by step, in {same} of {runs} "
        "runs with and without the threshold 0. The paper names both; perhaps its "
        "GDS alone is an objective without LFR and without the distance from the end."
    )


def _verdict(trials: Sequence[Trials], others: Sequence[str]) -> str:
    ours = wins.by_way(trials, PAPERS)
    parts = []
    for other in others:
        against = wins.by_way(trials, other)
        each = {name: wins.wins_of(ours, against, name) for name in summary.METRICS}
        pairs = sum(len(one.outcomes) for one in ours)
        same = sum(_equal_walls(one, two) for one, two in zip(ours, against, strict=True))
        counts = ", ".join(f"{w.better} to {w.worse} by {name}" for name, w in each.items())
        majority = [name for name, w in each.items() if w.is_majority]
        said = f"a majority by {' and '.join(majority)}" if majority else "no majority"
        parts.append(f"Against beta = {other}, {same} of {pairs} pairs of one seed are the same "
                     f"wall; better to worse walls are {counts}: {said} of all pairs.")  # fmt: skip
    return " ".join((*parts, f"The threshold is {PAPERS} in each first wall of a pair."))


def _equal_walls(one: Trials, other: Trials) -> int:
    pairs = zip(one.outcomes, other.outcomes, strict=False)
    return sum(first.plan["steps"] == second.plan["steps"] for first, second in pairs)


def _picture(trials: Sequence[Trials]) -> Picture:
    walls = list(dict.fromkeys(each.wall.name for each in trials))
    figures = {
        f"{name}, {figure}": {
            each.way: each.values(figure) for each in trials if each.wall.name == name
        }
        for name in walls
        for figure in summary.METRICS
    }
    return Picture(
        "beta",
        group_panels(figures, title="Walls by the threshold beta of GDS; lines are medians"),
        "A point a wall, a row a set of stones. F_AH is better when lower, the others when higher; "
        "F_AV and F_AH in percent.",
    )


ITEM = Item(
    "The threshold of GDS in Eq. 12", "§3.6", make,
    needs=tuple(wall.source.name for wall in MASONS),
)  # fmt: skip
