"""Fig. 16: how candidates are sampled, uniform, two-fold, full batch, beside variant (§5.1)."""

from collections import Counter
from collections.abc import Sequence
from statistics import median

from drystone_lab.pictures.groups import group_panels
from drystone_lab.pictures.wall_grid import plot_walls
from drystone_lab.reproduce import summary
from drystone_lab.reproduce.base import PR, PaperWall
from drystone_lab.reproduce.drawn import titled_wall
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.trials import Trials, all_specs, run_trials, seeds_of
from drystone_lab.runs.changes import Changes
from drystone_lab.table import Cell, Table

SAMPLINGS = ("variant", "uniform", "twofold", "full")
PARTS = ("placement", "stabilisation", "contacts", "limit analysis", "indices")
FULL_SEEDS, QUICK_SEEDS = 20, 3


def sampled(sampling: str) -> Changes:
    """Return the settings of a kind of sampling."""
    return (("sampling", sampling),)


def make(context: Context) -> Output:
    """Build walls by every kind of sampling."""
    return compare(context, PR, seeds_of(context, FULL_SEEDS, QUICK_SEEDS))


def compare(context: Context, wall: PaperWall, seeds: Sequence[int]) -> Output:
    """Build a wall from several seeds by every kind of sampling.

    Parameters
    ----------
    context : Context
        Does the runs.
    wall : PaperWall
        Stones and size.
    seeds : sequence of int
        The first one's walls are drawn.
    """
    ways = {name: sampled(name) for name in SAMPLINGS}
    trials = run_trials(context, (wall,), ways, seeds)
    return Output(
        paper=(
            "§5.1, Fig. 16: uniform sampling (of 7 stones) gives a more irregular layout than "
            "variant sampling, above all at the ends and in the fourth course. Two-fold sampling "
            "fills the right end better and has straighter courses, and costs twice as much. Full "
            "batch has straighter courses too, but for the last. No metrics are given, and 'For "
            "all sampling methods, the algorithm is able to complete the construction process by "
            "stacking stones to fill the target wall volume'.",
        ),
        ours=(_cost(trials), _quality(trials), _complete(trials)),
        tables=(("fig16", _table(trials)),),
        times=(("fig16_times", _times(trials)),),
        pictures=(
            Picture(
                "fig16",
                plot_walls([titled_wall(context, each, each.way) for each in trials], 2),
                f"Walls of seed {seeds[0]}; numbers are steps of the plan, stones of a colour are "
                "of one cluster, wedges dark red.",
            ),
            _strips(trials),
        ),
        runs=all_specs(trials),
    )


def _cost(trials: Sequence[Trials]) -> str:
    counts = {each.way: summary.median_of(each.outcomes, "candidates") or 0.0 for each in trials}
    base = counts["variant"]
    words = ", ".join(
        f"{way} {count:.0f} ({count / base:.2f} times variant)" if way != "variant" else
        f"{way} {count:.0f}" for way, count in counts.items()
    )  # fmt: skip
    return (
        f"Candidates evaluated for a wall, median of {len(trials[0].outcomes)} seeds: {words}. The "
        "paper's 'twice as computationally expensive' counts sub-iterations; the second one tries "
        f"the stones of a single cluster only. {_same(trials)}"
    )


def _same(trials: Sequence[Trials]) -> str:
    full = next(each for each in trials if each.way == "full")
    plans = [outcome.plan["steps"] for outcome in full.outcomes]
    kinds = sum(plan not in plans[:place] for place, plan in enumerate(plans))
    if kinds == 1:
        return "Full batch has nothing to choose at random: its walls are the same for every seed."
    return f"Full batch has nothing to choose at random, but {kinds} of its walls differ."


def _quality(trials: Sequence[Trials]) -> str:
    parts = []
    for name, words in (("F_AH", "straightest courses"), ("F_SF", "fullest walls")):
        medians = {each.way: summary.median_of(each.outcomes, name) for each in trials}
        found = {way: value for way, value in medians.items() if value is not None}
        pick = min if name == "F_AH" else max
        best = pick(found, key=lambda way: found[way])
        rest = ", ".join(f"{way} {value:.3g}" for way, value in found.items())
        parts.append(f"the {words} by the median of {name} are those of {best} ({rest})")
    return f"In medians, {' and '.join(parts)}."


def _complete(trials: Sequence[Trials]) -> str:
    counts, ends = [], Counter[str]()
    for each in trials:
        whole = sum(o.figures["placed"] == o.figures["stones"] for o in each.outcomes)
        counts.append(f"{each.way} {whole} of {len(each.outcomes)}")
        ends.update(outcome.plan["stopped"] for outcome in each.outcomes)
    stopped = ", ".join(f"'{reason}' {count} times" for reason, count in ends.most_common())
    return (
        f"Walls with all stones placed: {', '.join(counts)}. Construction ended with {stopped}. "
        "Which filling the paper calls complete is not said; Algorithm 1 ends above .99."
    )


def _table(trials: Sequence[Trials]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (
            each.way, *summary.summary(each.outcomes),
            summary.rounded(median(summary.figures_of(each.outcomes, "candidates"))),
        )
        for each in trials
    ]  # fmt: skip
    return Table(
        f"{trials[0].wall.name} by the sampling of candidates, one-sided",
        ("sampling", *summary.COLUMNS, "candidates median"),
        tuple(rows),
    )


def _times(trials: Sequence[Trials]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for each in trials:
        walls = median(outcome.times["wall"] for outcome in each.outcomes)
        parts = [median(outcome.times[part] for outcome in each.outcomes) for part in PARTS]
        rows.append((each.way, *(float(f"{value:.3g}") for value in (walls, *parts))))
    return Table(
        "Seconds a wall by the sampling of candidates, medians",
        ("sampling", "wall, s", *(f"{part}, s" for part in PARTS)),
        tuple(rows),
    )


def _strips(trials: Sequence[Trials]) -> Picture:
    names = (*summary.METRICS, "placed", "candidates")
    figures = {name: {each.way: each.values(name) for each in trials} for name in names}
    return Picture("fig16_seeds", group_panels(figures), "A point a wall; lines are medians.")


ITEM = Item(
    "Sampling: uniform, two-fold, full batch beside variant", "§5.1, Fig. 16", make,
    needs=(PR.source.name,),
)  # fmt: skip
