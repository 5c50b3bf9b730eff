"""Figs. 22 to 24: polygons of eight noise levels; Fig. 25: orientations in steps (§5.3)."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import cycle
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from scipy.stats import binomtest

from drystone.contacts.gaps import model_with_closed_gaps
from drystone.drawing.canvas import name_axes
from drystone.drawing.palette import CLUSTER_COLOURS, GREY, OUTLINE_COLOUR
from drystone.metrics.frame import reduce_labels
from drystone.metrics.measure import WallMetrics, measure_labels
from drystone.model.wall import Labels
from drystone.statics.limit import lateral_resistance
from drystone_lab import pictures
from drystone_lab.cells import LEVEL, METRICS, differences, figures_of, rounded, trend
from drystone_lab.reproduce.item import Claimed, ItemFigure, PaperItem, StudyWalls, Trials
from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.table import Rows
from drystone_lab.walls import NOISES, Target, generated_noise

GAP_SOURCE_PX = 20 / 3
"""Widest gap of a published wall that counts as a contact: 2 px at the working scale."""


class ReferenceWall(NamedTuple):
    """A published wall of Thangavelu et al. (2018), measured as an image that it fills."""

    metrics: WallMetrics
    # F_LR with no gap closed, then with those of half of :data:`GAP_SOURCE_PX`, of that, which is
    # the one of the metrics, and of one and a half; None where it does not stand
    resistances: tuple[float | None, ...]


def reference_of(wall: Target, data: Path | None) -> ReferenceWall | None:
    """Measure the published wall of some stones; None of generated ones, which were never built."""
    if wall.stand_in or data is None:
        return None
    return measured(wall.source.labels(data), wall.scale)


def measured(labels: Labels, scale: float) -> ReferenceWall:
    """Measure a label image as a wall that fills all of it, reduced by a scale."""
    reduced = reduce_labels(labels, scale)
    height, width = reduced.shape
    reaches = (factor * GAP_SOURCE_PX * scale for factor in (0.0, 0.5, 1.0, 1.5))
    resistances = tuple(
        lateral_resistance(model_with_closed_gaps(reduced, reach).model).value for reach in reaches
    )
    # As in plans: stones have their area at the resolution of the source.
    share = (labels > 0).mean()
    metrics = measure_labels(
        reduced, wall_px=(width, height), stone_area_px=float(share * width * height),
        lateral_resistance=resistances[2],
    )  # fmt: skip
    return ReferenceWall(metrics, resistances)


FILLED = 0.6
"""Filling above which walls are told apart (Fig. 24)."""


class NoiseLevel(NamedTuple):
    """The walls of one set of stones by either rule, and the published wall where there is one."""

    ours: Trials  # By the paper's method
    random: Trials
    reference: ReferenceWall | None

    @property
    def noise(self) -> int:
        """Of the stones, %."""
        return self.ours.wall.number


def published_of(levels: Sequence[NoiseLevel]) -> list[tuple[NoiseLevel, ReferenceWall]]:
    """Return the levels whose published walls are there, and these."""
    return [(level, level.reference) for level in levels if level.reference is not None]


def is_full(outcome: RunOutcome) -> bool:
    """Tell whether a wall is filled above :data:`FILLED`."""
    filling = outcome.figures["F_SF"]
    return filling is not None and filling > FILLED


def noise_findings(levels: Sequence[NoiseLevel]) -> Iterator[Claimed]:
    """Compare the levels with what §5.3 says of them."""
    low = [level for level in levels if level.noise < 60]
    walls = [outcome for level in low for outcome in level.ours.outcomes]
    full = sum(map(is_full, walls))
    against = {
        name: sum(one.ours.least(name) > one.random.least(name) for one in low)
        for name in ("F_SF", "F_LR")
    }
    told = ", ".join(f"{name} in {count}" for name, count in against.items())
    reference = trend([(level.noise, wall.metrics.F_AV) for level, wall in published_of(levels)])
    # Few walls are published: a correlation that is not clear is not yet against the claim.
    clear = reference is not None and (reference.clear or reference.rho <= 0)
    yield _trending("falls", levels, "F_SF", -1)
    agrees = full == len(walls) if walls else None
    yield Claimed("always", agrees, full=full, count=len(walls))
    yield from _between(levels)
    agrees = against["F_SF"] == len(low) if low else None
    yield Claimed("random", agrees, told=told, count=len(low))
    yield _trending("resistance", levels, "F_LR", 0)
    yield _trending("interlocking", levels, "F_AV", 1)
    words = "too few published walls" if reference is None else reference.words()
    agrees = reference.rho > 0 if reference is not None and clear else None
    yield Claimed("reference", agrees, words=words)
    yield _trending("horizontality", levels, "F_AH", 0)
    yield _against_reference("as_full", levels, "F_SF")
    yield _against_reference("staggered", levels, "F_AV")


def _trending(key: str, levels: Sequence[NoiseLevel], name: str, sign: int) -> Claimed:
    """Compare a trend over the medians of the sets with a claimed one; 0 for none."""
    # Over walls; over sets, which alone are independent.
    walls = [
        (level.noise, value) for level in levels for value in figures_of(level.ours.outcomes, name)
    ]
    middles = [(level.noise, level.ours.median(name)) for level in levels]
    each = {"walls": trend(walls), "sets": trend(middles)}
    told = [f"over {over}: {found.words()}" for over, found in each.items() if found is not None]
    words, sets = "; ".join(told) + "." if told else "too few levels.", each["sets"]
    if sets is None:
        return Claimed(key, None, words=words)
    if sign:
        return Claimed(key, sets.rho * sign > 0 and sets.clear, words=words)
    # Eight medians may miss a trend that the walls do show.
    others = any(found.clear for found in each.values() if found is not None)
    return Claimed(key, False if sets.clear else None if others else True, words=words)


def _between(levels: Sequence[NoiseLevel]) -> Iterator[Claimed]:
    if len(levels) < 2:
        return
    worst = {
        name: min(levels, key=lambda level, name=name: level.ours.least(name))  # type: ignore[misc]
        for name in ("F_SF", "F_LR")
    }
    words = "; ".join(
        f"the lowest median {name} is that of {level.noise} % noise, {level.ours.least(name):.3f}"
        for name, level in worst.items()
    )
    there = levels[-1].noise == NOISES[-1]
    hardest = all(level.noise == NOISES[-1] for level in worst.values())
    yield Claimed("hardest", hardest if there else None, words=words)
    # The first and the last have a neighbour on one side only: a mere trend sets them apart.
    filled = [level.ours.least("F_SF") for level in levels]
    above = {
        level.noise: filled[place] - median((filled[place - 1], filled[place + 1]))
        for place, level in enumerate(levels[1:-1], 1)
    }
    if above:
        best = max(above, key=lambda noise: above[noise])
        yield Claimed("surprising", None, best=best, above=above[best])


def _against_reference(key: str, levels: Sequence[NoiseLevel], name: str) -> Claimed:
    pairs = [
        (level.noise, level.ours.least(name), getattr(wall.metrics, name) or 0.0)
        for level, wall in published_of(levels)
    ]
    # Sizes of walls are rounded to px, so that walls of all stones differ in later digits.
    better = sum(round(ours, 3) >= round(theirs, 3) for _, ours, theirs in pairs)
    each = "; ".join(f"{noise} %: {ours:.3g} against {theirs:.3g}" for noise, ours, theirs in pairs)
    holds = better == len(pairs) if pairs else None
    return Claimed(key, holds, better=better, count=len(pairs), each=each)


def _references(levels: Sequence[NoiseLevel]) -> Rows:
    for level, wall in published_of(levels):
        of = wall.metrics
        yield level.noise, of.stones, *map(rounded, (of.F_SF, of.F_AV, of.F_AH, *wall.resistances))


def _noise_pictures(levels: Sequence[NoiseLevel]) -> Iterator[ItemFigure]:
    walls = []
    for level in levels:
        place = level.ours.middle
        figures, seed = level.ours.outcomes[place].figures, level.ours.specs[place].seed
        resistance = "-" if figures["F_LR"] is None else f"{figures['F_LR']:.2f}"
        title = f"{level.ours.wall.name}\nF_SF {figures['F_SF'] or 0.0:.2f}, F_LR {resistance}"
        walls.append(level.ours.drawn(f"{title}, seed {seed}", place))
    yield ItemFigure("fig22", pictures.sheet_of(walls, 2))
    yield _scatter(levels)
    yield _over_noise(levels)


def _scatter(levels: Sequence[NoiseLevel]) -> ItemFigure:
    every = [level.ours for level in levels]
    groups = {one.wall.noise: (one.values("F_LR"), one.values("F_SF")) for one in every}
    ax = pictures.plot_two_figures(groups, across="F_LR", up="F_SF")
    ax.margins(0.09)
    offsets_pt = cycle(((9, 9), (9, -14), (-18, 9), (-18, -14)))  # neighbours lie together
    for level, offset in zip(levels, offsets_pt, strict=False):
        drawn = level.ours.outcomes[level.ours.middle].figures
        resistance, filling = drawn["F_LR"], drawn["F_SF"]
        if resistance is not None and filling is not None:
            ax.annotate(
                f"{level.noise}", (resistance, filling), offset, textcoords="offset points",
                fontsize=6.5, arrowprops={"arrowstyle": "-|>", "linewidth": 0.7, "shrinkB": 1.5},
                gid=f"example-{level.noise}",
            )  # fmt: skip
    return ItemFigure("fig23", ax.figure)


_POINTS: dict[str, Any] = {
    "linestyle": "", "markersize": 4, "alpha": 0.8, "markeredgecolor": OUTLINE_COLOUR,
    "markeredgewidth": 0.3,
}  # fmt: skip
SERIES: Mapping[str, tuple[Callable[[NoiseLevel, str], list[float | None]], dict[str, Any]]] = {
    f"F_SF > {FILLED:g}": (
        lambda level, name: [one.figures[name] for one in level.ours.outcomes if is_full(one)],
        {**_POINTS, "marker": "o", "color": CLUSTER_COLOURS[0]},
    ),
    f"F_SF <= {FILLED:g}": (
        lambda level, name: [one.figures[name] for one in level.ours.outcomes if not is_full(one)],
        {**_POINTS, "marker": "^", "color": CLUSTER_COLOURS[1]},
    ),
    "published walls": (
        lambda level, name: [getattr(one.metrics, name) for _, one in published_of([level])],
        {"linestyle": (0, (5, 3)), "linewidth": 1.3, "marker": "s", "markersize": 3.5,
         "color": CLUSTER_COLOURS[12], "zorder": 3},
    ),
    "random choice, median": (
        lambda level, name: [level.random.median(name)],
        {"linestyle": "dotted", "linewidth": 1.2, "marker": "x", "markersize": 4,
         "color": OUTLINE_COLOUR, "zorder": 3},
    ),
}  # fmt: skip
"""What is shown of a level, and how: walls above and below the threshold of filling, as blue points
and yellow triangles; lines of references and of a baseline."""

SHIFTS = (0.0, 1.4, -1.4, 2.8, -2.8)
"""Walls of one level in turn, so that they do not hide each other; % of noise."""


def _over_noise(levels: Sequence[NoiseLevel]) -> ItemFigure:
    """Draw the four figures over the noise, with one legend above."""
    sheet, axes = pictures.panel_sheet(len(METRICS), 2, (3.9, 2.8))
    for ax, name in zip(axes, ("F_SF", "F_LR", "F_AV", "F_AH"), strict=True):
        for words, (values_of, look) in SERIES.items():
            x, y = [], []
            for level in levels:
                found = [value for value in values_of(level, name) if value is not None]
                x += [level.noise + shift for _, shift in zip(found, cycle(SHIFTS), strict=False)]
                y += found
            ax.plot(x, y, label=words, gid=words, **look)
        name_axes(ax, "noise, %", name if name in {"F_SF", "F_LR"} else f"{name}, %")
        ax.grid(axis="y", color=GREY, linewidth=0.3, alpha=0.5)
        ticks = [f"{one.noise}{'*' * one.ours.wall.stand_in}" for one in levels]
        ax.set_xticks([level.noise for level in levels], ticks)
    named = axes[0].get_legend_handles_labels()
    sheet.legend(*named, fontsize=7, frameon=False, loc="outside upper center", ncols=4)
    return ItemFigure("fig24", sheet)


NOISE = PaperItem(
    then=lambda found: [
        NoiseLevel(ours, random, reference_of(ours.wall, ours.data))
        for ours, random in found.by_wall
    ],
    claims=noise_findings,
    tables={"reference": _references},
    pictures=_noise_pictures,
)


def turned_findings(found: StudyWalls) -> Iterator[Claimed]:
    """Compare the figures of equal seeds."""
    for key, figure in (("filling", "F_SF"), ("resistance", "F_LR")):
        few, many = (found.values(way, figure) for way in ("quarter", "10deg"))
        yield gain_of(key, differences(many, few))


def gain_of(key: str, gains: Sequence[float]) -> Claimed:
    """Say by how much a figure is larger with more orientations, by pairs of a set and seed."""
    if not gains:
        return Claimed(key, None, words="no wall of either has it.")
    higher, lower = sum(gain > 0 for gain in gains), sum(gain < 0 for gain in gains)
    # Most pairs share their stones with others, so the test is lenient with a gain.
    changed = higher + lower
    p = float(binomtest(higher, changed, 0.5, "greater").pvalue) if changed else 1.0
    words = (
        f"it is higher in {higher} and lower in {lower} of {len(gains)} pairs of one seed, by "
        f"{median(gains):+.3f} in the median (sign test, one-sided: p {p:.2g})."
    )
    # Four pairs cannot pass a test at this level even if all of them agree.
    enough = 0.5 ** len(gains) < LEVEL
    return Claimed(key, median(gains) > 0 and p < LEVEL if enough else None, words=words)


TURNED = PaperItem(claims=turned_findings)

FEW = generated_noise(70, 10, 0.1)
"""Stones of the quick version: 36 orientations of each are still a thousand candidates."""
