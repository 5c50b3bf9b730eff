"""Figs. 26 and 27: walls of Fourier stones, round or elliptic, of one or of many sizes (§5.3)."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from matplotlib.figure import Figure
from scipy.stats import mannwhitneyu

from drystone.generate.fourier import FourierSettings, fourier_descriptors
from drystone_lab.pictures.groups import TWO_IN, plot_two_figures
from drystone_lab.pictures.wall_grid import plot_walls
from drystone_lab.reproduce.base import TWO_SIDED
from drystone_lab.reproduce.findings import (
    LEVEL,
    Finding,
    agreeing,
    findings_table,
    sentences,
)
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.summary import (
    COLUMNS,
    METRICS,
    figures_of,
    metric_cells,
    summary,
)
from drystone_lab.runs.outcome import Outcome
from drystone_lab.runs.source import generated
from drystone_lab.runs.spec import RunSpec
from drystone_lab.table import Cell, Table

WALL_PX = 210
"""Width and height; the paper's pixels, as its radii are."""

AREA_RATIOS = (2.0, 1.1)
"""Of all stones over the wall: enough to choose from to the end; and hardly more than it holds, to
see what that changes."""

WALLS, QUICK_WALLS = 20, 2

PAPER = (
    "§5.3: stones of Fourier descriptors (Eq. 30), round (D2 = 0) or elliptic (D2 = .2), with a "
    "radius of 30 px or uniform between 10 and 50 px; 'we form four sets of stones and construct "
    "20 walls, each measuring 210 pixels in height and width'. Fig. 26 shows one of each, Fig. 27 "
    "F_SF and F_AV of all; the numbers are only in the picture.",
    "The text says: the walls of stones of a fixed size are poorly filled, as stones are placed "
    "near the boundary first (Eq. 12) and round ones then do not stay; stones of varying sizes "
    "are easier to stack, and their variety enhances interlocking.",
)


@dataclass(frozen=True)
class Kind:
    """A kind of Fourier stones.

    Parameters
    ----------
    D2 : float
        Elongation.
    smallest_px, largest_px : float
        Range of the mean radius.
    """

    D2: float
    smallest_px: float
    largest_px: float

    @property
    def name(self) -> str:
        """For people."""
        shape = "elliptic" if self.D2 else "round"
        sizes = f"{self.smallest_px:g}"
        if self.varied:
            sizes += f" to {self.largest_px:g}"
        return f"{shape}, radius {sizes} px"

    @property
    def varied(self) -> bool:
        """True for stones of several sizes."""
        return self.largest_px > self.smallest_px

    @property
    def mean_area_px(self) -> float:
        """Expected area of a stone.

        Examples
        --------
        >>> round(Kind(0.0, 30.0, 30.0).mean_area_px / (math.pi * 30**2), 4)
        1.0023
        """
        low, high = self.smallest_px, self.largest_px
        # E r^2 of a uniform radius; and a contour r (1 + sum D_n cos) encloses pi r^2 (1 + sum/2).
        squared = (low**2 + low * high + high**2) / 3
        waves = float((fourier_descriptors(FourierSettings(D2=self.D2)) ** 2).sum())
        return math.pi * squared * (1 + waves / 2)

    def run(self, seed: int, wall_px: int, area_ratio: float) -> RunSpec:
        """Return a run: a wall of stones of its own, from two sides."""
        count = math.ceil(area_ratio * wall_px**2 / self.mean_area_px)
        stones = generated(
            "fourier", seed, count=count, D2=self.D2, smallest_radius_px=self.smallest_px,
            largest_radius_px=self.largest_px,
        )  # fmt: skip
        return RunSpec(
            source=stones, width=wall_px, height=wall_px, changes=(TWO_SIDED,), seed=seed
        )


KINDS = tuple(Kind(D2, *radii) for D2 in (0.0, 0.2) for radii in ((30.0, 30.0), (10.0, 50.0)))
"""The paper's, each fixed size before the varied one of its shape."""

Walls = Mapping[Kind, tuple[tuple[RunSpec, Outcome], ...]]


def make(
    context: Context,
    kinds: Sequence[Kind] = KINDS,
    walls: int | None = None,
    wall_px: int = WALL_PX,
    ratios: Sequence[float] | None = None,
) -> Output:
    """Build walls of every kind of stones.

    Parameters
    ----------
    context : Context
        Does and keeps the runs.
    kinds : sequence of Kind
        Of stones.
    walls : int, optional
        Of each kind.
    wall_px : int
        Width and height.
    ratios : sequence of float, optional
        Area of the stones over the wall; the first is what is drawn and judged.
    """
    ratios = ratios or (AREA_RATIOS[:1] if context.quick else AREA_RATIOS)
    count = walls or (QUICK_WALLS if context.quick else WALLS)
    seeds = range(context.seed, context.seed + count)
    asked = {
        (ratio, kind): tuple(kind.run(seed, wall_px, ratio) for seed in seeds)
        for ratio in ratios
        for kind in kinds
    }
    outcomes = iter(context.run([spec for group in asked.values() for spec in group]))
    done = {key: tuple((spec, next(outcomes)) for spec in group) for key, group in asked.items()}
    by_ratio = {ratio: {kind: done[ratio, kind] for kind in kinds} for ratio in ratios}
    built = by_ratio[ratios[0]]
    found = findings(built)
    return Output(
        paper=PAPER,
        ours=(_setting(built, ratios[0]), *sentences(found), *_fewer(by_ratio)),
        tables=(
            ("kinds", _kinds(by_ratio)),
            ("claims", findings_table("The paper's claims about rounded stones", found)),
            ("walls", _walls(by_ratio)),
        ),
        pictures=(_examples(context, built), _scatter(built)),
        runs=tuple(spec for group in asked.values() for spec in group),
    )


def findings(built: Walls) -> tuple[Finding, ...]:
    """Compare fixed with varied sizes, for each shape that has both."""
    return (
        *_by_shape(built, "F_SF", "Walls of stones of a fixed size are poorly filled"),
        *_by_shape(built, "F_AV", "Variety of sizes enhances interlocking"),
    )


def _by_shape(built: Walls, name: str, claim: str) -> list[Finding]:
    found = []
    for D2 in dict.fromkeys(kind.D2 for kind in built):  # noqa: N806 - the paper's name
        same = {kind.varied: kind for kind in built if kind.D2 == D2}
        if len(same) < 2:
            continue
        fixed, varied = (
            figures_of([outcome for _, outcome in built[same[v]]], name) for v in (False, True)
        )
        shape = "elliptic" if D2 else "round"
        found.append(_compared(f"{claim} ({shape}).", name, fixed, varied))
    return found


def _compared(claim: str, name: str, fixed: Sequence[float], varied: Sequence[float]) -> Finding:
    if min(len(fixed), len(varied)) < 4:
        words = "too few walls for a test" if fixed and varied else "no walls that have it"
        medians = f": {median(fixed):.3g} and {median(varied):.3g}" if fixed and varied else ""
        return Finding(claim, f"{words}, median {name} fixed and varied{medians}.", None)
    p = float(mannwhitneyu(varied, fixed, alternative="greater", method="asymptotic").pvalue)
    return Finding(
        claim,
        f"median {name} {median(fixed):.3g} for a fixed size and {median(varied):.3g} for varied "
        f"ones, {len(fixed)} and {len(varied)} walls (rank-sum test, one-sided: p {p:.2g}).",
        p < LEVEL,
    )


def _setting(built: Walls, ratio: float) -> str:
    counts = "; ".join(
        f"{kind.name}: {group[0][1].figures['stones']}" for kind, group in built.items()
    )
    return (
        f"The paper does not say how many stones a set has; here their area is {ratio:g} times "
        f"that of the wall ({counts}). {_chosen(ratio)}Every wall has stones of its own, so that "
        "what differs is their kind and not the luck of one set; the paper may have used one set "
        "of each, and its 20 walls may be of all kinds together."
    )


def _chosen(ratio: float) -> str:
    """Say how the number of stones was chosen, where it is ours."""
    if ratio != AREA_RATIOS[0]:
        return ""
    return (
        f"We took {ratio:g} for the main version after we had seen the walls of both {ratio:g} and "
        f"{AREA_RATIOS[1]:g} times, so agreement with the paper is in part our choice; the full "
        "version tells both. "
    )


def _fewer(by_ratio: Mapping[float, Walls]) -> tuple[str, ...]:
    """Say what becomes of the claims with fewer stones."""
    paragraphs = []
    first = [one.holds for one in findings(next(iter(by_ratio.values())))]
    for ratio, built in list(by_ratio.items())[1:]:
        found = findings(built)
        each = " ".join(f"{one.claim} {one.found[0].upper()}{one.found[1:]}" for one in found)
        same = [one.holds for one in found] == first
        verdicts = "the verdicts are the same" if same else "the verdicts are not the same"
        paragraphs.append(
            f"With {ratio:g} times the area of the wall {verdicts}. {agreeing(found)} {each}"
        )
    return tuple(paragraphs)


def _kinds(by_ratio: Mapping[float, Walls]) -> Table:
    rows = tuple(
        (ratio, kind.name, *summary([outcome for _, outcome in group]))
        for ratio, built in by_ratio.items()
        for kind, group in built.items()
    )
    return Table(
        "Walls of Fourier stones: medians and ranges, from two sides",
        ("area of stones / wall", "kind", *COLUMNS),
        rows,
    )


def _walls(by_ratio: Mapping[float, Walls]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (ratio, kind.name, spec.seed, outcome.figures["placed"], outcome.figures["stones"],
         *metric_cells(outcome))
        for ratio, built in by_ratio.items()
        for kind, group in built.items()
        for spec, outcome in group
    ]  # fmt: skip
    columns = ("area of stones / wall", "kind", "seed", "placed", "of", *METRICS)
    return Table("Walls of Fourier stones", columns, tuple(rows))


def _examples(context: Context, built: Walls) -> Picture:
    walls = []
    for kind, group in built.items():
        order = sorted(range(len(group)), key=lambda i: (group[i][1].figures["F_SF"], i))
        spec, outcome = group[order[(len(order) - 1) // 2]]
        filling, interlocking, *_ = metric_cells(outcome)
        title = f"{kind.name}\nF_SF {filling}, F_AV {interlocking} %, seed {spec.seed}"
        walls.append((title, outcome.wall(spec, context.data), outcome.clusters))
    return Picture(
        "fig26", plot_walls(walls, 2),
        "A wall of each kind, the one in the middle by filling. Numbers are the order of "
        "placement, colours the clusters, wedges are dark red.",
    )  # fmt: skip


def _scatter(built: Walls) -> Picture:
    groups = {
        kind.name: [(o.figures["F_SF"], o.figures["F_AV"]) for _, o in group]
        for kind, group in built.items()
    }
    figure = Figure(figsize=TWO_IN)
    ax = plot_two_figures(groups, figure.add_subplot(), across="F_SF", up="F_AV, %")
    ax.legend(fontsize=7, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    return Picture(
        "fig27", figure,
        "Interlocking over filling of all walls by kind of stones; large marks are medians.",
    )  # fmt: skip


ITEM = Item("Fourier stones of four kinds", "§5.3", make)
