"""Walls of several noise levels: runs, and their tables (§5.3)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Literal

from drystone_lab.reproduce.base import TWO_SIDED, PaperWall
from drystone_lab.reproduce.findings import Trend, trend
from drystone_lab.reproduce.item import Context
from drystone_lab.reproduce.noise_sets import GAP_RANGE, Reference, Sets, reference_of
from drystone_lab.reproduce.summary import (
    COLUMNS,
    METRICS,
    figures_of,
    median_of,
    metric_cells,
    rounded,
    summary,
)
from drystone_lab.runs.outcome import Outcome
from drystone_lab.runs.source import Scalar
from drystone_lab.runs.spec import RunSpec
from drystone_lab.table import Cell, Table

Rule = Literal["paper", "random"]

RULES: Mapping[Rule, tuple[tuple[str, Scalar], ...]] = {
    "paper": (TWO_SIDED,),
    "random": (TWO_SIDED, ("selection_rule", "random")),
}
"""Changes of the paper's method: none but both ends; or any candidate, all with one chance."""

FILLED = 0.6
"""Filling above which walls are told apart (Fig. 24)."""

STAND_IN = "generated"


@dataclass(frozen=True, eq=False)
class Level:
    """The walls of one set of stones.

    Parameters
    ----------
    wall : PaperWall
        The stones; its number is their noise, %.
    specs : dict of str to tuple of RunSpec
        By rule, the same seeds for each.
    outcomes : dict of str to tuple of Outcome
        Of these runs.
    reference : Reference or None
        The published wall.
    """

    wall: PaperWall
    specs: Mapping[Rule, tuple[RunSpec, ...]]
    outcomes: Mapping[Rule, tuple[Outcome, ...]]
    reference: Reference | None

    @property
    def noise(self) -> int:
        """Of the stones, %."""
        return self.wall.number

    @property
    def stones(self) -> str:
        """Whether the stones are published or generated."""
        return STAND_IN if self.wall.stand_in else "published"

    @property
    def ours(self) -> tuple[Outcome, ...]:
        """Walls of the paper's method."""
        return self.outcomes["paper"]

    @property
    def example(self) -> tuple[RunSpec, Outcome]:
        """The wall of ours that is drawn: the lower one in the middle by filling."""
        order = sorted(range(len(self.ours)), key=lambda i: (self.ours[i].figures["F_SF"], i))
        middle = order[(len(order) - 1) // 2]
        return self.specs["paper"][middle], self.ours[middle]

    def median(self, name: str, rule: Rule = "paper") -> float | None:
        """Return the median of a figure; None when no wall has it."""
        return median_of(self.outcomes[rule], name)


def built_levels(context: Context, sets: Sets, seeds: Sequence[int]) -> tuple[Level, ...]:
    """Build walls of every set by either rule.

    Parameters
    ----------
    context : Context
        Does and keeps the runs.
    sets : mapping of int to PaperWall
        By noise, %.
    seeds : sequence of int
        A wall each.
    """
    specs = {
        (noise, rule): tuple(wall.run(seed, *changes) for seed in seeds)
        for noise, wall in sets.items()
        for rule, changes in RULES.items()
    }
    every = context.run([spec for group in specs.values() for spec in group])
    by_key = {outcome.key: outcome for outcome in every}
    return tuple(
        Level(
            wall,
            {rule: specs[noise, rule] for rule in RULES},
            {rule: tuple(by_key[spec.key] for spec in specs[noise, rule]) for rule in RULES},
            reference_of(wall, context.data),
        )
        for noise, wall in sets.items()
    )


def walls_table(levels: Sequence[Level]) -> Table:
    """Return a row a wall."""
    rows: list[tuple[Cell, ...]] = [
        (
            level.noise, level.stones, rule, spec.seed, outcome.figures["placed"],
            outcome.figures["stones"], *metric_cells(outcome), is_full(outcome),
        )
        for level in levels
        for rule in RULES
        for spec, outcome in zip(level.specs[rule], level.outcomes[rule], strict=True)
    ]  # fmt: skip
    return Table(
        "Walls of polygons of several noise levels, from two sides",
        ("noise, %", "stones", "rule", "seed", "placed", "of", *METRICS, f"F_SF above {FILLED:g}"),
        tuple(rows),
        (
            "Rule paper: Algorithm 2. Rule random: any of the candidates that stand, all with the "
            "same chance.",
            "Generated stones are our own noisy polygons; those of these levels are not public.",
        ),
    )


def levels_table(levels: Sequence[Level]) -> Table:
    """Return medians and ranges by level and rule."""
    rows = tuple(
        (level.noise, level.stones, rule, *summary(level.outcomes[rule]))
        for level in levels
        for rule in RULES
    )
    columns = ("noise, %", "set", "rule", *COLUMNS)
    return Table("Medians and ranges by noise level, from two sides", columns, rows)


def reference_table(levels: Sequence[Level]) -> Table:
    """Return the published walls, measured by the same definitions."""
    rows = tuple(
        (
            level.noise, reference.stones, rounded(reference.F_SF), rounded(reference.F_AV),
            rounded(reference.F_AH), *(rounded(value) for value in reference.F_LR),
        )
        for level in levels
        if (reference := level.reference) is not None
    )  # fmt: skip
    closed = (f"F_LR, gaps closed x{factor:g}" for factor in GAP_RANGE)
    return Table(
        "The published walls of Thangavelu et al. (2018) as label images",
        ("noise, %", "stones", "F_SF", "F_AV", "F_AH", "F_LR, no gap closed", *closed),
        rows,
        (
            "F_SF is of the whole image, which is also the size of our walls, and so the most that "
            "its stones can fill. Gaps: x1 closes those of up to 6.7 px of the source (2 px at the "
            "working scale .3); - does not stand.",
        ),
    )


def trends(levels: Sequence[Level], name: str, rule: Rule = "paper") -> dict[str, Trend | None]:
    """Correlate a figure with the noise: over walls, over the medians of the sets, and published.

    Returns
    -------
    dict of str to Trend or None
        ``"walls"``; ``"sets"``, which alone are independent of each other; ``"published"``: sets
        that are published.
    """
    walls = [(level.noise, value) for level in levels
             for value in figures_of(level.outcomes[rule], name)]  # fmt: skip
    sets = [(level.noise, level.median(name, rule)) for level in levels]
    public = [
        (level.noise, level.median(name, rule)) for level in levels if not level.wall.stand_in
    ]
    return {"walls": trend(walls), "sets": trend(sets), "published": trend(public)}


def reference_trend(levels: Sequence[Level], name: str) -> Trend | None:
    """Correlate a figure of the published walls with the noise."""
    return trend(
        [(level.noise, level.reference.metric(name)) for level in levels if level.reference]
    )


def trends_table(levels: Sequence[Level]) -> Table:
    """Return the correlations of all figures with the noise."""
    rows: list[tuple[Cell, ...]] = []
    for name in METRICS:
        for rule in RULES:
            each = trends(levels, name, rule)
            rows += [(name, f"{rule}: {over}", *_cells(found)) for over, found in each.items()]
        rows.append((name, "published walls", *_cells(reference_trend(levels, name))))
    return Table(
        "Spearman's correlation with the noise",
        ("figure", "over", "rho", "p", "pairs"),
        tuple(rows),
        (
            "Walls of one set share its stones, so their p says little about noise in general; "
            "over sets a pair is the median of a set.",
        ),
    )


def is_full(outcome: Outcome) -> bool:
    """Tell whether a wall is filled above :data:`FILLED`."""
    filling = outcome.figures["F_SF"]
    return filling is not None and filling > FILLED


def residuals(levels: Sequence[Level]) -> dict[int, float]:
    """Return by how much the median filling of each level is above that of its neighbours.

    Neighbours are the levels before and after; the first and last have one.
    """
    medians = [level.median("F_SF") or 0.0 for level in levels]
    found = {}
    for place, level in enumerate(levels):
        beside = medians[max(0, place - 1) : place] + medians[place + 1 : place + 2]
        if beside:
            found[level.noise] = medians[place] - median(beside)
    return found


def _cells(found: Trend | None) -> tuple[Cell, ...]:
    return (None, None, None) if found is None else (rounded(found.rho), found.p, found.count)
