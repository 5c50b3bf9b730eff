"""Figs. 22-24: polygons of eight noise levels, ten walls each (§5.3)."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from drystone_lab.pictures.groups import TWO_IN, plot_two_figures
from drystone_lab.pictures.noise import NoiseNames, NoisePanel, noise_panels
from drystone_lab.pictures.wall_grid import plot_walls
from drystone_lab.reproduce.findings import findings_table, sentences
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.noise_claims import findings
from drystone_lab.reproduce.noise_sets import PUBLISHED, Sets, noise_set, noise_sets
from drystone_lab.reproduce.noise_walls import (
    FILLED,
    Level,
    built_levels,
    is_full,
    levels_table,
    reference_table,
    trends_table,
    walls_table,
)
from drystone_lab.reproduce.summary import figures_of

WALLS, QUICK_WALLS = 10, 2
"""Of each level."""

QUICK_SCALE = 0.15

PAPER = (
    "§5.3: stones of Thangavelu et al. (2018), polygons 'with eight degrees of Gaussian noise "
    "applied to their vertices', ten walls of each set, built from two sides. Fig. 22 shows one of "
    "each, Fig. 23 F_SF over F_LR of all 80, Fig. 24 the four figures over the noise, with the "
    "walls of that study for reference. The numbers are only in the pictures.",
    "The text says: the set of 80 % is the most difficult, its walls 'both unfilled and weak'; "
    "filling rises as the noise falls, with one level done surprisingly well (which one is lost in "
    "our copy of the text); below 60 % noise F_SF is always above .6, 'outperforming the random "
    "strategy'; F_LR has no clear trend; F_AV rises with the noise in its own and in the "
    "reference walls, and its own is better; F_AH has no obvious trend; the wall is filled as much "
    "as in the reference.",
)

SETTING = (
    f"The stones of {', '.join(map(str, PUBLISHED))} % are the published ones and the wall has the "
    "size of their image, as these stones are those of a finished wall. The other levels are not "
    "public: their stones are our own noisy polygons, marked as generated everywhere, and their "
    "wall is as large as the published walls are for their stones."
)

AXES = {"F_SF": "F_SF", "F_LR": "F_LR", "F_AV": "F_AV, %", "F_AH": "F_AH, %"}
"""In the order of Fig. 24."""


def make(context: Context, sets: Sets | None = None, walls: int | None = None) -> Output:
    """Build walls of every noise level, ours and of random choice, and compare them.

    Parameters
    ----------
    context : Context
        Does and keeps the runs.
    sets : mapping of int to PaperWall, optional
        By noise, %; all of them by default.
    walls : int, optional
        Of each set and rule.
    """
    if sets is None:
        sets = noise_sets(scale=QUICK_SCALE) if context.quick else noise_sets()
    count = walls or (QUICK_WALLS if context.quick else WALLS)
    levels = built_levels(context, sets, range(context.seed, context.seed + count))
    found = findings(levels)
    return Output(
        paper=PAPER,
        ours=(SETTING, *sentences(found)),
        tables=(
            ("levels", levels_table(levels)),
            ("claims", findings_table("The paper's claims about noise", found)),
            ("trends", trends_table(levels)),
            ("reference", reference_table(levels)),
            ("walls", walls_table(levels)),
        ),
        pictures=(_examples(context, levels), _scatter(levels), _over_noise(levels)),
        runs=tuple(spec for level in levels for group in level.specs.values() for spec in group),
    )


def _examples(context: Context, levels: Sequence[Level]) -> Picture:
    walls = []
    for level in levels:
        spec, outcome = level.example
        filling, resistance = outcome.figures["F_SF"], outcome.figures["F_LR"]
        title = f"{level.wall.name}\nF_SF {filling or 0.0:.2f}"
        title += f", F_LR {'-' if resistance is None else f'{resistance:.2f}'}, seed {spec.seed}"
        walls.append((title, outcome.wall(spec, context.data), outcome.clusters))
    return Picture(
        "fig22", plot_walls(walls, 2),
        "A wall of each noise level, the one in the middle by filling. Generated: stones of our "
        "own, where those of the paper are not public. Numbers are the order of placement, colours "
        "the clusters, wedges are dark red.",
    )  # fmt: skip


def _scatter(levels: Sequence[Level]) -> Picture:
    groups = {
        f"{level.noise} %{' gen.' if level.wall.stand_in else ''}": [
            (outcome.figures["F_LR"], outcome.figures["F_SF"]) for outcome in level.ours
        ]
        for level in levels
    }
    figure = Figure(figsize=TWO_IN)
    ax = plot_two_figures(groups, figure.add_subplot(), across="F_LR", up="F_SF")
    ax.margins(0.09)
    for level in levels:
        _, outcome = level.example
        resistance, filling = outcome.figures["F_LR"], outcome.figures["F_SF"]
        if resistance is not None and filling is not None:
            ax.annotate(
                f"{level.noise}", (resistance, filling), (9, 9), textcoords="offset points",
                fontsize=6.5, arrowprops={"arrowstyle": "-|>", "linewidth": 0.7, "shrinkB": 1.5},
                gid=f"example-{level.noise}",
            )  # fmt: skip
    return Picture(
        "fig23", figure,
        "Filling over lateral resistance of all walls. Large marks: medians of a set; arrows: the "
        "walls drawn in fig22; gen.: generated stones.",
    )  # fmt: skip


def _over_noise(levels: Sequence[Level]) -> Picture:
    names = NoiseNames(f"F_SF > {FILLED:g}", f"F_SF <= {FILLED:g}", "published walls",
                       "random choice, median")  # fmt: skip
    ticks = {level.noise: f"{level.noise}{'*' if level.wall.stand_in else ''}" for level in levels}
    panels = [_panel(levels, name, words) for name, words in AXES.items()]
    return Picture(
        "fig24", noise_panels(panels, names, ticks),
        "The four figures over the noise; * generated stones. Dashed: the walls that Thangavelu et "
        "al. (2018) built of the same stones, measured in the same way; their F_LR with gaps of up "
        "to 6.7 px of the source closed.",
    )  # fmt: skip


def _panel(levels: Sequence[Level], name: str, words: str) -> NoisePanel:
    def pairs(full: bool) -> tuple[tuple[int, float], ...]:
        return tuple(
            (level.noise, value)
            for level in levels
            for value in figures_of([o for o in level.ours if is_full(o) is full], name)
        )

    reference = {
        level.noise: value
        for level in levels
        if level.reference is not None and (value := level.reference.metric(name)) is not None
    }
    random = {level.noise: level.median(name, "random") for level in levels}
    baseline = {noise: value for noise, value in random.items() if value is not None}
    return NoisePanel(words, pairs(True), pairs(False), reference, baseline)


ITEM = Item(
    "polygons of eight noise levels",
    "§5.3",
    make,
    needs=tuple(noise_set(noise).source.name for noise in PUBLISHED),
)
