"""Figs. 26 and 27: walls of Fourier stones, round or elliptic, of one or of many sizes (§5.3)."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median

from matplotlib.figure import Figure
from scipy.stats import mannwhitneyu

from drystone.generate.fourier import FourierSettings, fourier_descriptors
from drystone_lab.pictures.charts import TWO_IN, plot_two_figures
from drystone_lab.pictures.walls import plot_walls
from drystone_lab.reproduce.cells import (
    COLUMNS,
    LEVEL,
    METRICS,
    ClaimCheck,
    figures_of,
    metric_cells,
    summary,
)
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.reproduce.study import StudyWalls, trials_of
from drystone_lab.runs.spec import generated
from drystone_lab.table import Cell, Table
from drystone_lab.walls import TWO_SIDED, Target

WALL_PX = 210
"""Width and height; the paper's pixels, as its radii are."""

AREA_RATIOS = (2.0, 1.1)
"""Of all stones over the wall: enough to choose from to the end; and hardly more than it holds, to
see what that changes."""

WALLS, QUICK_WALLS = 20, 2
"""Of each kind."""


@dataclass(frozen=True)
class StoneKind:
    """A kind of Fourier stones: elongation, and the range of the mean radius."""

    D2: float
    smallest_px: float
    largest_px: float

    @property
    def shape(self) -> str:
        """For people."""
        return "elliptic" if self.D2 else "round"

    @property
    def name(self) -> str:
        """Shape and sizes."""
        sizes = f"{self.smallest_px:g}"
        if self.varied:
            sizes += f" to {self.largest_px:g}"
        return f"{self.shape}, radius {sizes} px"

    @property
    def varied(self) -> bool:
        """True for stones of several sizes."""
        return self.largest_px > self.smallest_px

    @property
    def mean_area_px(self) -> float:
        """Expected area of a stone.

        >>> round(StoneKind(0.0, 30.0, 30.0).mean_area_px / (math.pi * 30**2), 4)
        1.0023
        """
        low, high = self.smallest_px, self.largest_px
        # E r^2 of a uniform radius; and a contour r (1 + sum D_n cos) encloses pi r^2 (1 + sum/2).
        squared = (low**2 + low * high + high**2) / 3
        waves = float((fourier_descriptors(FourierSettings(D2=self.D2)) ** 2).sum())
        return math.pi * squared * (1 + waves / 2)

    def wall(self, seed: int, wall_px: int, area_ratio: float) -> Target:
        """Return a wall of stones of its own."""
        count = math.ceil(area_ratio * wall_px**2 / self.mean_area_px)
        stones = generated(
            "fourier", seed, count=count, D2=self.D2, smallest_radius_px=self.smallest_px,
            largest_radius_px=self.largest_px,
        )  # fmt: skip
        return Target(self.name, stones, wall_px, wall_px, 1.0)


KINDS = tuple(StoneKind(D2, *radii) for D2 in (0.0, 0.2) for radii in ((30.0, 30.0), (10.0, 50.0)))
"""The paper's, each fixed size before the varied one of its shape."""


@dataclass(frozen=True, eq=False)
class RoundedWalls:
    """Walls of every kind by the ratio of areas; those of the first ratio are drawn."""

    kinds: tuple[StoneKind, ...]
    by_ratio: Mapping[float, StudyWalls]

    @property
    def first(self) -> StudyWalls:
        """Walls of the first ratio, a kind after the other."""
        return next(iter(self.by_ratio.values()))


def rounded_walls(
    context: Context, kinds: Sequence[StoneKind] = KINDS, wall_px: int = WALL_PX, walls: int = 0
) -> RoundedWalls:
    """Build walls of every kind of stones, each of stones of its own, from both ends."""
    ratios = AREA_RATIOS[:1] if context.quick else AREA_RATIOS
    count = walls or (QUICK_WALLS if context.quick else WALLS)
    seeds = range(context.seed, context.seed + count)
    asked = [
        (kind.wall(0, wall_px, ratio), kind.name,
         tuple(kind.wall(seed, wall_px, ratio).run(seed, *TWO_SIDED) for seed in seeds))
        for ratio in ratios
        for kind in kinds
    ]  # fmt: skip
    found, each = trials_of(context, asked), len(kinds)
    return RoundedWalls(
        tuple(kinds),
        {
            ratio: StudyWalls(context, found[each * k : each * (k + 1)])
            for k, ratio in enumerate(ratios)
        },
    )


def rounded_findings(kinds: Sequence[StoneKind], built: StudyWalls) -> tuple[ClaimCheck, ...]:
    """Compare fixed with varied sizes, for each shape that has both."""
    claims = {
        "F_SF": "Walls of stones of a fixed size are poorly filled",
        "F_AV": "Variety of sizes enhances interlocking",
    }
    found = []
    for name, claim in claims.items():
        values = {
            (kind.shape, kind.varied): figures_of(trials.outcomes, name)
            for kind, trials in zip(kinds, built, strict=True)
        }
        for shape in dict.fromkeys(kind.shape for kind in kinds):
            if (shape, False) in values and (shape, True) in values:
                pair = values[shape, False], values[shape, True]
                found.append(_compared(f"{claim} ({shape}).", name, *pair))
    return tuple(found)


def _compared(claim: str, name: str, fixed: Sequence[float], varied: Sequence[float]) -> ClaimCheck:
    if not fixed or not varied:
        return ClaimCheck(claim, "no walls that have it.", None)
    words = (
        f"median {name} {median(fixed):.3g} for a fixed size and {median(varied):.3g} for varied "
        f"ones, {len(fixed)} and {len(varied)} walls"
    )
    if min(len(fixed), len(varied)) < 4:
        return ClaimCheck(claim, f"{words}: too few for a test.", None)
    p = float(mannwhitneyu(varied, fixed, alternative="greater", method="asymptotic").pvalue)
    return ClaimCheck(claim, f"{words} (rank-sum test, one-sided: p {p:.2g}).", p < LEVEL)


def _kinds_table(found: RoundedWalls) -> Table:
    rows = tuple(
        (ratio, one.way, *summary(one.outcomes))
        for ratio, built in found.by_ratio.items()
        for one in built
    )
    return Table(
        "Walls of Fourier stones: medians and ranges, from two sides",
        ("area of stones / wall", "kind", *COLUMNS),
        rows,
    )


def _walls_table(found: RoundedWalls) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (ratio, one.way, spec.seed, outcome.figures["placed"], outcome.figures["stones"],
         *metric_cells(outcome))
        for ratio, built in found.by_ratio.items()
        for one in built
        for spec, outcome in zip(one.specs, one.outcomes, strict=True)
    ]  # fmt: skip
    columns = ("area of stones / wall", "kind", "seed", "placed", "of", *METRICS)
    return Table("Walls of Fourier stones", columns, tuple(rows))


def _pictures(found: RoundedWalls) -> Iterator[ItemPicture]:
    walls = []
    for one in found.first:
        filling, interlocking, *_ = metric_cells(one.outcomes[one.middle])
        title = f"{one.way}\nF_SF {filling}, F_AV {interlocking} %"
        title += f", seed {one.specs[one.middle].seed}"
        walls.append(found.first.drawn(one, title, one.middle))
    yield ItemPicture(
        "fig26", plot_walls(walls, 2),
        "A wall of each kind, the one in the middle by filling. Numbers are the order of "
        "placement, colours the clusters, wedges are dark red.",
    )  # fmt: skip
    groups = {
        one.way: list(zip(one.values("F_SF"), one.values("F_AV"), strict=True))
        for one in found.first
    }
    figure = Figure(figsize=TWO_IN)
    ax = plot_two_figures(groups, figure.add_subplot(), across="F_SF", up="F_AV, %")
    ax.legend(fontsize=7, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    yield ItemPicture(
        "fig27", figure,
        "Interlocking over filling of all walls by kind of stones; large marks are medians.",
    )  # fmt: skip


def _claims(found: RoundedWalls) -> Iterator[ClaimCheck]:
    for ratio, built in found.by_ratio.items():
        for one in rounded_findings(found.kinds, built):
            yield replace(one, found=f"with {ratio:g} times the area of the wall, {one.found}")


ROUNDED = PaperItem(
    **paper("fig26-27"),
    study=rounded_walls,
    claims=_claims,
    tables={"kinds": _kinds_table, "walls": _walls_table},
    pictures=lambda found: tuple(_pictures(found)),
)
