"""Fig. 20: filling against the area of wedges by the way to stabilise (§5.2)."""

from collections.abc import Sequence
from statistics import median

from drystone_lab.pictures.groups import plot_two_figures
from drystone_lab.reproduce import summary, wins
from drystone_lab.reproduce.base import IR, LIU_5, PaperWall, coarser
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.trials import Trials, all_specs, at_hand, run_trials, seeds_of
from drystone_lab.table import Table

METHODS = ("both", "rotation", "wedge", "none")
FULL_SEEDS, QUICK_SEEDS = 20, 4
QUICK_SCALE = 0.2


def make(context: Context) -> Output:
    """Build walls by every way to stabilise."""
    walls = at_hand(context, (LIU_5, IR))
    if context.quick:
        walls = tuple(coarser(wall, QUICK_SCALE) for wall in walls)
    return compare(context, walls, seeds_of(context, FULL_SEEDS, QUICK_SEEDS))


def compare(context: Context, walls: Sequence[PaperWall], seeds: Sequence[int]) -> Output:
    """Build walls of some sets from some seeds by every way to stabilise.

    Parameters
    ----------
    context : Context
        Does the runs.
    walls : sequence of PaperWall
        The sets.
    seeds : sequence of int
        The same for all ways.
    """
    ways = {method: (("stabilise.method", method),) for method in METHODS}
    trials = run_trials(context, walls, ways, seeds)
    groups = [[each for each in trials if each.wall == wall] for wall in walls]
    stand_ins = [wall.name for wall in walls if wall.stand_in]
    return Output(
        paper=(
            "§5.2, Fig. 20: walls of the fifth set, a point each, by filling and area of wedges: "
            "'combining rotation and wedging techniques enhances the algorithm's performance in "
            "optimizing the stone filling ratio'. Its numbers are in the picture only.",
        ),
        ours=(
            *(_said(group) for group in groups),
            f"The stones of Liu et al. (2018) are not public: {', '.join(stand_ins)} is a set of "
            "generated polygons of much noise, not theirs.",
        ),
        tables=(
            ("fig20", _table(trials)),
            *((f"fig20_pairs_{number}", _pairs(group)) for number, group in enumerate(groups, 1)),
        ),
        pictures=tuple(_picture(group, number) for number, group in enumerate(groups, 1)),
        runs=all_specs(trials),
    )


def _wedge_share(trials: Trials) -> tuple[float | None, ...]:
    """Return the area of the wedges in percent of the wall."""
    whole = trials.wall.width * trials.wall.height
    return tuple(
        None if area is None else 100 * area / whole for area in trials.values("wedge_area")
    )


def _said(group: Sequence[Trials]) -> str:
    medians = {each.way: summary.median_of(each.outcomes, "F_SF") or 0.0 for each in group}
    best = max(medians, key=lambda way: medians[way])
    listed = ", ".join(f"{way} {value:.3f}" for way, value in medians.items())
    pairs, most = [], True
    for other in METHODS[1:]:
        won = wins.wins_of(wins.by_way(group, "both"), wins.by_way(group, other), "F_SF")
        pairs.append(f"{won.better} of {won.pairs} of {other}")
        most = most and won.is_majority
    claim = "as in the paper" if best == "both" else "unlike in the paper, where it is both"
    if best == "both" and not most:
        claim += " but not in most pairs with each of the others"
    return (
        f"{group[0].wall.name}: the median filling is largest with {best} ({listed}), {claim}; "
        f"with both it is larger than that of the same seed in {', '.join(pairs)}."
    )


def _table(trials: Sequence[Trials]) -> Table:
    rows = []
    for each in trials:
        wedges = summary.median_of(each.outcomes, "wedges")
        middle = median(share for share in _wedge_share(each) if share is not None)
        cells = summary.summary(each.outcomes)
        rows.append((each.wall.name, each.way, *cells, wedges, summary.rounded(middle)))
    return Table(
        "Walls by the way to stabilise",
        ("wall", "stabilise", *summary.COLUMNS, "wedges median", "wedges % of wall median"),
        tuple(rows),
        ("Variant sampling, one-sided. F_SF is without wedges.",),
    )


def _pairs(group: Sequence[Trials]) -> Table:
    return Table(
        f"{group[0].wall.name}: both against other ways to stabilise, pairs of one seed",
        ("other", *wins.COLUMNS),
        wins.wins_rows(group, "both", METHODS[1:]),
    )


def _picture(group: Sequence[Trials], number: int) -> Picture:
    points = {
        each.way: tuple(zip(_wedge_share(each), each.values("F_SF"), strict=True)) for each in group
    }
    wall = group[0].wall
    # The set is named in the picture itself, as one of them stands in for the paper's.
    across = f"{wall.name}: area of wedges, % of the wall"
    ax = plot_two_figures(points, across=across, up="F_SF")
    figure = ax.get_figure(root=True)
    assert figure is not None  # noqa: S101 - it was made for the axes
    caption = f"{wall.name}: a point a wall, medians large."
    return Picture(f"fig20_{number}", figure, caption)


ITEM = Item("Stabilisation: filling against area of wedges", "§5.2, Fig. 20", make)
