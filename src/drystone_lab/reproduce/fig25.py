"""Fig. 25: orientations in steps of 10 degrees beside that of largest shape factor (§5.3)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from scipy.stats import binomtest

from drystone_lab.pictures.groups import group_panels
from drystone_lab.pictures.wall_grid import plot_walls
from drystone_lab.reproduce.base import TWO_SIDED, PaperWall
from drystone_lab.reproduce.findings import LEVEL, Finding, findings_table, sentences
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.noise_sets import PUBLISHED, Sets, generated_set, noise_sets
from drystone_lab.reproduce.summary import COLUMNS, METRICS, metric_cells, rounded, summary
from drystone_lab.runs.outcome import Outcome
from drystone_lab.runs.spec import RunSpec
from drystone_lab.table import Cell, Table

ORIENTATIONS = ("sf", "10deg")
"""Setting of each: that of largest shape factor, and 36."""

NOISES = (40, 50, 70, 80)
WALLS = 3

QUICK_SETS: Sets = {70: generated_set(70, 10, 0.1)}
"""A few generated stones: 36 orientations of each are still a thousand candidates."""

PAPER = (
    "§5.3: 'By considering more orientation options, such as orientations ranging between "
    "[-pi, pi] with 10-degree intervals, the performance of the algorithm can significantly "
    "increase in terms of the filling ratio and the lateral resistance.' Fig. 25 shows typical "
    "walls; no numbers are given.",
)


@dataclass(frozen=True, eq=False)
class Twins:
    """Walls of one set, those of each seed with either orientations.

    Parameters
    ----------
    wall : PaperWall
        The stones; its number is their noise, %.
    specs : dict of str to tuple of RunSpec
        By orientations, equal seeds at equal places.
    outcomes : dict of str to tuple of Outcome
        Of these runs.
    """

    wall: PaperWall
    specs: Mapping[str, tuple[RunSpec, ...]]
    outcomes: Mapping[str, tuple[Outcome, ...]]

    def gains(self, name: str) -> list[float]:
        """Return by how much a figure is larger with more orientations, for each seed."""
        few, many = (self.outcomes[each] for each in ORIENTATIONS)
        pairs = [(a.figures[name], b.figures[name]) for a, b in zip(few, many, strict=True)]
        return [b - a for a, b in pairs if a is not None and b is not None]


def make(context: Context, sets: Sets | None = None, walls: int | None = None) -> Output:
    """Build walls of some noise levels with few and with many orientations.

    Parameters
    ----------
    context : Context
        Does and keeps the runs.
    sets : mapping of int to PaperWall, optional
        By noise, %.
    walls : int, optional
        Of each set.
    """
    if sets is None:
        sets = QUICK_SETS if context.quick else noise_sets(NOISES)
    count = walls or (1 if context.quick else WALLS)
    twins = built(context, sets, range(context.seed, context.seed + count))
    found = findings(twins)
    return Output(
        paper=PAPER,
        ours=(_setting(twins), *sentences(found)),
        tables=(
            ("sets", _sets(twins)),
            ("claims", findings_table("The paper's claims about orientations", found)),
            ("walls", _walls(twins)),
        ),
        times=(("seconds", _seconds(twins)),),
        pictures=(_examples(context, twins), _strips(twins)),
        runs=tuple(spec for each in twins for group in each.specs.values() for spec in group),
    )


def built(context: Context, sets: Sets, seeds: Sequence[int]) -> tuple[Twins, ...]:
    """Build the walls of every set and seed with either orientations, from two sides."""
    specs = {
        (noise, name): tuple(wall.run(seed, TWO_SIDED, ("orientations", name)) for seed in seeds)
        for noise, wall in sets.items()
        for name in ORIENTATIONS
    }
    every = context.run([spec for group in specs.values() for spec in group])
    by_key = {outcome.key: outcome for outcome in every}
    return tuple(
        Twins(
            wall,
            {name: specs[noise, name] for name in ORIENTATIONS},
            {name: tuple(by_key[s.key] for s in specs[noise, name]) for name in ORIENTATIONS},
        )
        for noise, wall in sets.items()
    )


def findings(twins: Sequence[Twins]) -> tuple[Finding, ...]:
    """Compare the figures of equal seeds."""
    return (
        _gain(twins, "F_SF", "Filling increases significantly with 10-degree steps."),
        _gain(twins, "F_LR", "Lateral resistance increases significantly with 10-degree steps."),
    )


def _setting(twins: Sequence[Twins]) -> str:
    names = ", ".join(each.wall.name for each in twins)
    count = len(twins[0].specs[ORIENTATIONS[0]])
    return (
        f"Sets: {names}; {count} of the seeds each, from two sides. Which sets the paper draws is "
        "not in its text. With few orientations a stone has that of its largest shape factor; the "
        "paper's 'minimized' is read as a slip, as Eq. 12d has argmax. Pairs of one set share its "
        "stones, so that the test below is lenient with a gain."
    )


def _gain(twins: Sequence[Twins], name: str, claim: str) -> Finding:
    gains = [gain for each in twins for gain in each.gains(name)]
    if not gains:
        return Finding(claim, "no wall of either has it.", None)
    higher, lower = sum(gain > 0 for gain in gains), sum(gain < 0 for gain in gains)
    # Most pairs share their stones with others, so the test is lenient with a gain.
    changed = higher + lower
    p = float(binomtest(higher, changed, 0.5, "greater").pvalue) if changed else 1.0
    words = (
        f"{name} is higher in {higher} and lower in {lower} of {len(gains)} pairs of one seed, by "
        f"{median(gains):+.3f} in the median (sign test, one-sided: p {p:.2g})."
    )
    # Four pairs cannot pass a test at this level even if all of them agree.
    enough = 0.5 ** len(gains) < LEVEL
    return Finding(claim, words, median(gains) > 0 and p < LEVEL if enough else None)


def _sets(twins: Sequence[Twins]) -> Table:
    rows = tuple(
        (each.wall.name, name, *summary(each.outcomes[name]))
        for each in twins
        for name in ORIENTATIONS
    )
    return Table(
        "Medians and ranges with few and with many orientations, from two sides",
        ("set", "orientations", *COLUMNS),
        rows,
    )


def _walls(twins: Sequence[Twins]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (each.wall.name, name, spec.seed, outcome.figures["placed"], *metric_cells(outcome))
        for each in twins
        for name in ORIENTATIONS
        for spec, outcome in zip(each.specs[name], each.outcomes[name], strict=True)
    ]
    columns = ("set", "orientations", "seed", "placed", *METRICS)
    return Table("Walls with few and with many orientations", columns, tuple(rows))


def _seconds(twins: Sequence[Twins]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for each in twins:
        few, many = (
            median(outcome.times["wall"] for outcome in each.outcomes[name])
            for name in ORIENTATIONS
        )
        rows.append((each.wall.name, round(few, 2), round(many, 2), round(many / few, 1)))
    return Table(
        "Seconds a wall, median",
        ("set", *(f"{name}, s" for name in ORIENTATIONS), "times as long"),
        tuple(rows),
    )


def _examples(context: Context, twins: Sequence[Twins]) -> Picture:
    walls = []
    for each in twins:
        for name in ORIENTATIONS:
            spec, outcome = each.specs[name][0], each.outcomes[name][0]
            filling, resistance = (rounded(outcome.figures[n]) for n in ("F_SF", "F_LR"))
            title = f"{each.wall.name}, orientations {name}, seed {spec.seed}\n"
            title += f"F_SF {filling}, F_LR {'-' if resistance is None else resistance}"
            walls.append((title, outcome.wall(spec, context.data), outcome.clusters))
    return Picture(
        "fig25", plot_walls(walls, 2),
        "Left: each stone in its orientation of largest shape factor. Right: in steps of 10 "
        "degrees, the same seed.",
    )  # fmt: skip


def _strips(twins: Sequence[Twins]) -> Picture:
    panels = {
        figure: {
            f"{each.wall.number} %{' gen.' if each.wall.stand_in else ''}\n{name}": [
                o.figures[figure] for o in each.outcomes[name]
            ]
            for each in twins
            for name in ORIENTATIONS
        }
        for figure in ("F_SF", "F_LR")
    }
    return Picture(
        "fig25-figures", group_panels(panels),
        "Filling and lateral resistance by noise and orientations: a point a wall, a line the "
        "median; gen.: generated stones.",
    )  # fmt: skip


ITEM = Item(
    "orientations in steps of 10 degrees",
    "§5.3",
    make,
    needs=tuple(
        wall.source.name for wall in noise_sets([n for n in NOISES if n in PUBLISHED]).values()
    ),
)
