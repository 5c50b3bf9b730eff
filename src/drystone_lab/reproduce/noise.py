"""Figs. 22 to 24: polygons of eight noise levels; Fig. 25: orientations in steps (§5.3)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import cycle
from statistics import median

from matplotlib.figure import Figure
from scipy.stats import binomtest

from drystone_lab.pictures.charts import (
    TWO_IN,
    NoiseNames,
    NoisePanel,
    group_panels,
    noise_panels,
    plot_two_figures,
)
from drystone_lab.pictures.walls import plot_walls
from drystone_lab.reproduce.cells import (
    LEVEL,
    METRICS,
    ClaimCheck,
    Trend,
    figures_of,
    metric_cells,
    rounded,
    trend,
)
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.reproduce.noise_sets import (
    GAP_RANGE,
    ReferenceWall,
    reference_of,
)
from drystone_lab.reproduce.study import Study, StudyWalls, Trials, walls_table, ways_table
from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.table import Table
from drystone_lab.walls import NOISES, NOISY, TWO_SIDED, coarser, generated_noise

RULES = {"paper": TWO_SIDED, "random": (*TWO_SIDED, ("selection_rule", "random"))}
"""The paper's method, from both ends; or any candidate, all with one chance."""

FILLED = 0.6
"""Filling above which walls are told apart (Fig. 24)."""

OFFSETS_PT = ((9, 9), (9, -14), (-18, 9), (-18, -14))  # Of names: neighbours lie together

MIXED = 60
"""Noise in % below which the paper's walls are always filled above :data:`FILLED`."""


@dataclass(frozen=True, eq=False)
class NoiseLevel:
    """The walls of one set of stones by either rule, and the published wall where there is one."""

    built: StudyWalls
    reference: ReferenceWall | None

    @property
    def noise(self) -> int:
        """Of the stones, %."""
        return self.ours.wall.number

    @property
    def generated(self) -> bool:
        """Whether the stones are our own."""
        return self.ours.wall.stand_in

    @property
    def ours(self) -> Trials:
        """Walls of the paper's method."""
        return self.built.all[0]

    def rule(self, rule: str) -> Trials:
        """Return the walls of a rule."""
        (trials,) = self.built.of(rule)
        return trials

    def least(self, name: str, rule: str = "paper") -> float:
        """Return the median of a figure, 0 when no wall has it: one that falls has none."""
        return self.rule(rule).median(name) or 0.0


@dataclass(frozen=True, eq=False)
class NoiseLevels:
    """The walls of all noise levels."""

    built: StudyWalls
    all: tuple[NoiseLevel, ...]

    @property
    def low(self) -> list[NoiseLevel]:
        """Levels below :data:`MIXED`."""
        return [level for level in self.all if level.noise < MIXED]


def noise_levels(context: Context, study: Study) -> NoiseLevels:
    """Build walls of every noise level, and measure the published ones."""
    found = study(context)
    groups = found.by_wall
    levels = (NoiseLevel(group, reference_of(group.all[0].wall, context.data)) for group in groups)
    return NoiseLevels(found, tuple(levels))


def is_full(outcome: RunOutcome) -> bool:
    """Tell whether a wall is filled above :data:`FILLED`."""
    filling = outcome.figures["F_SF"]
    return filling is not None and filling > FILLED


def trends(levels: NoiseLevels, name: str, rule: str = "paper") -> dict[str, Trend | None]:
    """Correlate a figure with the noise: over walls; over sets, which alone are independent."""
    walls = [(level.noise, value) for level in levels.all
             for value in figures_of(level.rule(rule).outcomes, name)]  # fmt: skip
    sets = [(level.noise, level.rule(rule).median(name)) for level in levels.all]
    return {
        "walls": trend(walls),
        "sets": trend(sets),
    }


def reference_trend(levels: NoiseLevels, name: str) -> Trend | None:
    """Correlate a figure of the published walls with the noise."""
    known = [level for level in levels.all if level.reference is not None]
    return trend([(one.noise, one.reference.metric(name)) for one in known if one.reference])


def residuals(levels: NoiseLevels) -> dict[int, float]:
    """Return by how much the median filling of each level is above that of its neighbours."""
    medians = [level.least("F_SF") for level in levels.all]
    found = {}
    for place, level in enumerate(levels.all):
        beside = medians[max(0, place - 1) : place] + medians[place + 1 : place + 2]
        if beside:
            found[level.noise] = medians[place] - median(beside)
    return found


def noise_findings(levels: NoiseLevels) -> tuple[ClaimCheck, ...]:
    """Compare the levels with what §5.3 says of them."""
    low = [outcome for level in levels.low for outcome in level.ours.outcomes]
    full = sum(map(is_full, low))
    against = {
        name: sum(one.least(name) > one.least(name, "random") for one in levels.low)
        for name in ("F_SF", "F_LR")
    }
    told = ", ".join(f"{name} in {count}" for name, count in against.items())
    reference = reference_trend(levels, "F_AV")
    # Few walls are published: a correlation that is not clear is not yet against the claim.
    clear = reference is not None and (reference.clear or reference.rho <= 0)
    return (
        _trending(levels, "F_SF", -1, "Filling falls as the noise rises (Fig. 24a)."),
        ClaimCheck(
            f"Below {MIXED} % noise F_SF is always above {FILLED:g}.",
            f"{full} of {len(low)} walls below {MIXED} % are above {FILLED:g}.",
            full == len(low) if low else None,
        ),
        *_between(levels),
        ClaimCheck(
            f"Below {MIXED} % noise the walls are better filled than by the random strategy.",
            f"against a random choice among the same candidates the median is higher by {told} of "
            f"{len(levels.low)} sets. The random strategy of that study is another one.",
            against["F_SF"] == len(levels.low) if levels.low else None,
        ),
        _trending(levels, "F_LR", 0, "Lateral resistance has no clear trend."),
        _trending(levels, "F_AV", 1, "Interlocking F_AV rises with the noise."),
        ClaimCheck(
            "F_AV of the reference walls rises with the noise.",
            "too few published walls." if reference is None else f"{reference.words()}.",
            reference.rho > 0 if reference is not None and clear else None,
        ),
        _trending(levels, "F_AH", 0, "Horizontality has no obvious trend."),
        _against_reference(levels, "F_SF", "The wall is filled as much as the reference."),
        _against_reference(
            levels, "F_AV", "Head joints are better staggered than the reference's."
        ),
    )


def _trending(levels: NoiseLevels, name: str, sign: int, claim: str) -> ClaimCheck:
    """Compare a trend over the medians of the sets with a claimed one; 0 for none."""
    each = trends(levels, name)
    words = [f"over {over}: {found.words()}" for over, found in each.items() if found is not None]
    said, sets = "; ".join(words) + "." if words else "too few levels.", each["sets"]
    if sets is None:
        return ClaimCheck(claim, said, None)
    if sign:
        return ClaimCheck(claim, said, sets.rho * sign > 0 and sets.clear)
    # Eight medians may miss a trend that the walls do show.
    others = any(found.clear for found in each.values() if found is not None)
    return ClaimCheck(claim, said, False if sets.clear else None if others else True)


def _between(levels: NoiseLevels) -> Iterator[ClaimCheck]:
    if len(levels.all) < 2:
        return
    worst = {
        name: min(levels.all, key=lambda one, name=name: one.least(name))  # type: ignore[misc]
        for name in ("F_SF", "F_LR")
    }
    words = "; ".join(
        f"the lowest median {name} is that of {level.noise} % noise, {level.least(name):.3f}"
        for name, level in worst.items()
    )
    there = levels.all[-1].noise == NOISES[-1]
    hardest = all(level.noise == NOISES[-1] for level in worst.values())
    claim = f"The set of {NOISES[-1]} % is the most difficult: walls unfilled and weak."
    yield ClaimCheck(claim, f"{words}.", hardest if there else None)
    # The first and the last have a neighbour on one side only: a mere trend sets them apart.
    inner = [level.noise for level in levels.all[1:-1]]
    if inner:
        above = residuals(levels)
        best = max(inner, key=lambda noise: above[noise])
        yield ClaimCheck(
            "One noisy level is filled surprisingly well.",
            f"the median F_SF of {best} % less that of the levels beside it is {above[best]:+.3f}, "
            "the most of all that have one on either side.",
            None,
        )


def _against_reference(levels: NoiseLevels, name: str, claim: str) -> ClaimCheck:
    known = [(level, level.reference) for level in levels.all if level.reference is not None]
    # Sizes of walls are rounded to px, so that walls of all stones differ in later digits.
    better = sum(
        round(level.least(name), 3) >= round(wall.metric(name) or 0.0, 3) for level, wall in known
    )
    each = "; ".join(
        f"{level.noise} %: {level.least(name):.3g} against {wall.metric(name) or 0.0:.3g}"
        for level, wall in known
    )
    words = f"the median is at least the published wall's in {better} of {len(known)} sets"
    return ClaimCheck(claim, f"{words} ({each}).", better == len(known) if known else None)


def _reference_table(levels: NoiseLevels) -> Table:
    closed = (f"F_LR, gaps closed x{factor:g}" for factor in GAP_RANGE)
    rows = []
    for level in levels.all:
        if (wall := level.reference) is not None:
            figures = map(rounded, (wall.F_SF, wall.F_AV, wall.F_AH, *wall.F_LR))
            rows.append((level.noise, wall.stones, *figures))
    return Table(
        "The published walls of Thangavelu et al. (2018) as label images",
        ("noise, %", "stones", "F_SF", "F_AV", "F_AH", "F_LR, no gap closed", *closed),
        tuple(rows),
        (
            "F_SF is of the whole image, which is also the size of our walls, and so the most that "
            "its stones can fill. Gaps: x1 closes those of up to 6.7 px of the source (2 px at the "
            "working scale 0.3); - does not stand.",
        ),
    )


_levels_table = ways_table(
    "Medians and ranges by noise level, from two sides",
    ("noise, %", "set", "rule"),
    lambda one: (one.wall.number, one.wall.said, one.way),
)
_walls_table = walls_table(
    "Walls of polygons of several noise levels, from two sides",
    ("noise, %", "stones", "rule", "seed", "placed", "of", *METRICS, f"F_SF above {FILLED:g}"),
    lambda one, spec, outcome: (
        one.wall.number, one.wall.said, one.way, spec.seed, outcome.figures["placed"],
        outcome.figures["stones"], *metric_cells(outcome), is_full(outcome),
    ),
    (
        "Rule paper: Algorithm 2. Rule random: any of the candidates that stand, all with the same "
        "chance.",
    ),
)  # fmt: skip


def _noise_pictures(levels: NoiseLevels) -> Iterator[ItemPicture]:
    walls = []
    for level in levels.all:
        place = level.ours.middle
        figures, seed = level.ours.outcomes[place].figures, level.ours.specs[place].seed
        resistance = "-" if figures["F_LR"] is None else f"{figures['F_LR']:.2f}"
        title = f"{level.ours.wall.name}\nF_SF {figures['F_SF'] or 0.0:.2f}, F_LR {resistance}"
        walls.append(level.built.drawn(level.ours, f"{title}, seed {seed}", place))
    yield ItemPicture(
        "fig22", plot_walls(walls, 2),
        "A wall of each noise level, the one in the middle by filling. Numbers are the order of "
        "placement, colours the clusters, wedges are dark red.",
    )  # fmt: skip
    yield _scatter(levels)
    names = NoiseNames(f"F_SF > {FILLED:g}", f"F_SF <= {FILLED:g}", "published walls",
                       "random choice, median")  # fmt: skip
    ticks = {level.noise: f"{level.noise}{'*' if level.generated else ''}" for level in levels.all}
    axes = {"F_SF": "F_SF", "F_LR": "F_LR", "F_AV": "F_AV, %", "F_AH": "F_AH, %"}
    panels = [_panel(levels, name, words) for name, words in axes.items()]
    yield ItemPicture(
        "fig24", noise_panels(panels, names, ticks),
        "The four figures over the noise; * generated stones. Dashed: the walls that Thangavelu et "
        "al. (2018) built of the same stones, measured in the same way; their F_LR with gaps of up "
        "to 6.7 px of the source closed.",
    )  # fmt: skip


def _scatter(levels: NoiseLevels) -> ItemPicture:
    groups = {
        f"{level.noise} %{' gen.' if level.generated else ''}": list(
            zip(level.ours.values("F_LR"), level.ours.values("F_SF"), strict=True)
        )
        for level in levels.all
    }
    figure = Figure(figsize=TWO_IN)
    ax = plot_two_figures(groups, figure.add_subplot(), across="F_LR", up="F_SF")
    ax.margins(0.09)
    for level, offset in zip(levels.all, cycle(OFFSETS_PT), strict=False):
        drawn = level.ours.outcomes[level.ours.middle].figures
        resistance, filling = drawn["F_LR"], drawn["F_SF"]
        if resistance is not None and filling is not None:
            ax.annotate(
                f"{level.noise}", (resistance, filling), offset, textcoords="offset points",
                fontsize=6.5, arrowprops={"arrowstyle": "-|>", "linewidth": 0.7, "shrinkB": 1.5},
                gid=f"example-{level.noise}",
            )  # fmt: skip
    return ItemPicture(
        "fig23", figure,
        "Filling over lateral resistance of all walls. Large marks: medians of a set; arrows: the "
        "walls drawn in fig22; gen.: generated stones.",
    )  # fmt: skip


def _panel(levels: NoiseLevels, name: str, words: str) -> NoisePanel:
    def pairs(full: bool) -> tuple[tuple[int, float], ...]:
        return tuple(
            (level.noise, value)
            for level in levels.all
            for value in figures_of([o for o in level.ours.outcomes if is_full(o) is full], name)
        )

    reference = {
        level.noise: value
        for level in levels.all
        if level.reference is not None and (value := level.reference.metric(name)) is not None
    }
    random = {level.noise: level.rule("random").median(name) for level in levels.all}
    baseline = {noise: value for noise, value in random.items() if value is not None}
    return NoisePanel(words, pairs(True), pairs(False), reference, baseline)


NOISE = PaperItem(
    **paper("fig22-24"),
    study=partial(
        noise_levels,
        study=Study(
            walls=NOISY,
            ways=RULES,
            seeds=10,
            quick_seeds=1,
            quick_walls=tuple(coarser(wall, 0.1) for wall in NOISY),
        ),
    ),
    claims=noise_findings,
    tables={
        "levels": lambda levels: _levels_table(levels.built),
        "reference": _reference_table,
        "walls": lambda levels: _walls_table(levels.built),
    },
    pictures=lambda levels: tuple(_noise_pictures(levels)),
)

ORIENTATIONS = ("quarter", "10deg")
"""Setting of each: the four of largest shape factor, and 36."""


def _gains(found: StudyWalls, name: str) -> list[float]:
    """Return by how much a figure is larger with more orientations, for each set and seed."""
    few, many = (
        [value for one in found.of(way) for value in one.values(name)] for way in ORIENTATIONS
    )
    return [b - a for a, b in zip(few, many, strict=True) if a is not None and b is not None]


def turned_findings(found: StudyWalls) -> tuple[ClaimCheck, ...]:
    """Compare the figures of equal seeds."""
    return (
        _gain(_gains(found, "F_SF"), "Filling increases significantly with 10-degree steps."),
        _gain(
            _gains(found, "F_LR"),
            "Lateral resistance increases significantly with 10-degree steps.",
        ),
    )


def _gain(gains: Sequence[float], claim: str) -> ClaimCheck:
    if not gains:
        return ClaimCheck(claim, "no wall of either has it.", None)
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
    return ClaimCheck(claim, words, median(gains) > 0 and p < LEVEL if enough else None)


def _turned_pictures(found: StudyWalls) -> Iterator[ItemPicture]:
    walls = [
        found.titled(one, f"{one.wall.name}, orientations {one.way}, seed {found.seeds[0]}")
        for one in found
    ]
    yield ItemPicture(
        "fig25", plot_walls(walls, 2),
        "Left: each stone in its four orientations of largest shape factor. Right: in steps of 10 "
        "degrees, the same seed.",
    )  # fmt: skip
    panels = {
        figure: {
            f"{one.wall.number} %{' gen.' * one.wall.stand_in}, {one.way}": one.values(figure)
            for one in found
        }
        for figure in ("F_SF", "F_LR")
    }
    yield ItemPicture(
        "fig25-figures", group_panels(panels),
        "Filling and lateral resistance by noise and orientations: a point a wall, a line the "
        "median; gen.: generated stones.",
    )  # fmt: skip


TURNED = PaperItem(**paper("fig25"),
    study=Study(
        walls=NOISY,
        ways={name: (*TWO_SIDED, ("orientations", name)) for name in ORIENTATIONS},
        seeds=3,
        quick_seeds=1,
        # A few generated stones: 36 orientations of each are still a thousand candidates.
        quick_walls=(generated_noise(70, 10, 0.1),),
    ),
    claims=turned_findings,
    tables={
        "sets": ways_table(
            "Medians and ranges with few and with many orientations, from two sides",
            ("set", "orientations"),
            lambda one: (one.wall.name, one.way),
        ),
        "walls": walls_table(
            "Walls with few and with many orientations",
            ("set", "orientations", "seed", "placed", *METRICS),
            lambda one, spec, outcome: (
                one.wall.name, one.way, spec.seed, outcome.figures["placed"],
                *metric_cells(outcome),
            ),
        ),
    },
    pictures=lambda found: tuple(_turned_pictures(found)),
)  # fmt: skip
