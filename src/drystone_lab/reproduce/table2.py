"""Table 2 and Fig. 18: walls 1 to 5 from a fixed seed, the best of 20, and the masons' (§5.2)."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from math import floor

from matplotlib.axes import Axes

from drystone.clusters import cluster_stones
from drystone.drawing.pictures.stones import plot_stones
from drystone.metrics.measure import WallMetrics
from drystone.model.stone import StoneSet
from drystone.poses import PoseBook
from drystone_lab.pictures.walls import (
    EMPTY,
    Panel,
    masonry_panel,
    sheet_of,
    wall_aspect,
    wall_panel,
)
from drystone_lab.reproduce import cells
from drystone_lab.reproduce.cells import METRICS, rounded
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.reproduce.masons import (
    PAPERS_WAY,
    REFERENCES,
    Printed,
    TracedWall,
    masons_wall,
    measured,
)
from drystone_lab.reproduce.study import Study, StudyWalls, Trials
from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.table import Cell, Table
from drystone_lab.walls import FIVE, MASONS

CONSTRUCTED: Mapping[int, Printed] = {
    1: (0.974, 39.084, 1.573, 0.83), 2: (0.883, 36.598, 1.348, 0.83),
    3: (0.839, 21.347, 4.163, 0.52), 4: (0.839, 22.674, 2.207, 0.66),
    5: (0.725, 55.851, 3.033, 0.59),
}  # fmt: skip
"""Walls that the paper's algorithm built, the best of 20 trials."""

NONE: tuple[Cell, ...] = (None,) * len(METRICS)

EXACT = 6
"""Decimals of a load multiplier that every solver agrees on; halves are rounded up after that."""


def best_trial(outcomes: Sequence[RunOutcome]) -> int:
    """Return the place of the wall with the highest filling and multiplier, to one decimal.

    The paper chooses "the wall with the highest filling ratio and kinematics multiplier (rounded
    to one decimal place)".  Taken here in the order in which they are named, both to one decimal,
    or the second would never count; between walls that are equal then the full figures decide, in
    the same order, and then the earlier trial.  Multipliers are over mu, as those that the paper
    prints seem to be (Fig. 14: .79, above any mu that it names): F_LR.
    """
    return max(range(len(outcomes)), key=lambda place: (*_merit(outcomes[place]), -place))


def _merit(outcome: RunOutcome) -> tuple[float, float, float, float]:
    resistance, filled = outcome.figures["F_LR"], float(outcome.figures["F_SF"] or 0.0)
    if resistance is None:
        return tenths(filled), -1.0, filled, 0.0
    return tenths(filled), tenths(resistance), filled, round(resistance, EXACT)


def tenths(value: float) -> int:
    """Round to one decimal, halves up; in tenths.

    >>> tenths(0.45), tenths(0.4499999999), tenths(0.44)
    (5, 5, 4)
    """
    return floor(10 * round(value, EXACT) + 0.5)


@dataclass(frozen=True, eq=False)
class FiveWall:
    """One of the five walls: its trials, its stones, and what masons built from them, if any did.

    The first trial is that of the fixed seed.
    """

    trials: Trials
    stones: StoneSet
    masons: TracedWall | None

    @property
    def name(self) -> tuple[int, str]:
        """Number in Table 2, and name of the stones."""
        return self.trials.wall.number, self.trials.wall.name

    @property
    def stand_in(self) -> bool:
        """Whether the stones are not the paper's."""
        return self.trials.wall.stand_in

    @property
    def best(self) -> int:
        """Place of the best trial by the paper's rule."""
        return best_trial(self.trials.outcomes)

    @property
    def fullest(self) -> int:
        """Place of the trial with the highest F_SF, the earlier one of equals."""
        filled = [value or 0.0 for value in self.trials.values("F_SF")]
        return filled.index(max(filled))

    @cached_property
    def traced(self) -> WallMetrics | None:
        """Metrics of the masons' wall as it was traced."""
        return None if self.masons is None else measured(self.masons.labels)


Five = tuple[StudyWalls, Sequence[FiveWall]]


def five_walls(context: Context, study: Study) -> Five:
    """Build the walls, and read the masons'."""
    found = study(context)
    return found, [
        FiveWall(
            each,
            each.wall.source.stones(context.data),
            None if each.wall.stand_in else masons_wall(each.wall, context.data),
        )
        for each in found
    ]


def _comparison(found: Five) -> Table:
    """Return Table 2: rows of each wall, our figures and the paper's beside each other."""
    return Table(
        "Table 2: reference walls and constructed ones by one definition, and what the paper "
        "prints",
        ("wall", "stones", "what", "placed", "of", *METRICS, *(f"paper {m}" for m in METRICS)),
        tuple(row for wall in found[1] for row in (*_references(wall), *_ours(wall))),
        (
            "F_SF a share, F_AV and F_AH in percent. Our walls: the area of their stones over the "
            "target; masons' walls: over the bounding box of their stones.",
            "Best: the highest filling, then the highest multiplier over mu, both to one decimal "
            "(§5.2); the paper does not say how both count, so the fullest is shown too.",
            "All stones: the area of all stones over the target, the largest F_SF there can be.",
            "Walls 4 and 5: the stones of Liu et al. (2018) are not public; ours are generated, so "
            "their rows cannot be compared.",
        ),
    )


def _references(wall: FiveWall) -> Iterator[tuple[Cell, ...]]:
    number, papers = wall.name[0], REFERENCES.get(wall.name[0], NONE)
    if wall.masons is None or wall.traced is None:
        yield (number, "the paper's", "reference", None, None, *NONE, *papers)
        return
    count = wall.traced.stones
    dilated = measured(wall.masons.papers_way)
    for what, metrics in (("as traced", wall.traced), (PAPERS_WAY, dilated)):
        figures = (rounded(getattr(metrics, name)) for name in METRICS)
        yield (*wall.name, f"masons, {what}", count, count, *figures, *papers)


def _ours(wall: FiveWall) -> Iterator[tuple[Cell, ...]]:
    trials, count = wall.trials, len(wall.stones)
    seeds, papers = len(trials.outcomes), CONSTRUCTED.get(wall.name[0], NONE)

    def one(what: str, place: int) -> tuple[Cell, ...]:
        outcome = trials.outcomes[place]
        placed, stones = outcome.figures["placed"], outcome.figures["stones"]
        named = f"{what}, seed {trials.specs[place].seed}"
        return (*wall.name, named, placed, stones, *cells.metric_cells(outcome))

    yield (*one("fixed seed", 0), *NONE)
    middle = (rounded(trials.median(name)) for name in METRICS)
    yield (*wall.name, f"median of {seeds}", trials.median("placed"), count, *middle, *NONE)
    yield (*one(f"best of {seeds}", wall.best), *(NONE if wall.stand_in else papers))
    if wall.stand_in:
        yield (wall.name[0], "the paper's", "best of 20", None, None, *NONE, *papers)
    yield (*one(f"fullest of {seeds}", wall.fullest), *NONE)
    area = wall.stones.total_area_px
    most = rounded(float(area) / (trials.wall.width * trials.wall.height))
    yield (*wall.name, "all stones", count, count, most, None, None, None, *NONE)


def _spread(found: Five) -> Table:
    rows = tuple((*wall.name, *cells.summary(wall.trials.outcomes)) for wall in found[1])
    return Table("Walls of all seeds", ("wall", "set", *cells.COLUMNS), rows)


def _fig18(found: Five) -> ItemPicture:
    panels = [panel for wall in found[1] for panel in _panels(found[0], wall)]
    return ItemPicture(
        "fig18",
        sheet_of(panels, 4),
        "From the left: the stones by cluster; the wall of the fixed seed; the best of all seeds "
        "by the paper's rule; the masons' wall, its stones drawn together and dilated by one "
        "working px. Numbers on stones of walls are steps of the plan, on stones alone their ids; "
        "wedges are dark red.",
    )


def _panels(built: StudyWalls, wall: FiveWall) -> list[Panel]:
    trials, stones = wall.trials, wall.stones
    seeds = [spec.seed for spec in trials.specs]
    clusters = cluster_stones(stones, PoseBook(trials.wall.scale))

    def draw(ax: Axes) -> Axes:
        return plot_stones(stones, clusters, ax)

    title = f"Wall {trials.wall.number}, {trials.wall.name}\n"
    title += f"{len(stones)} stones in {len(set(clusters.values()))} clusters"
    best = f"best of {len(seeds)}, seed {seeds[wall.best]}"
    masons = EMPTY
    if wall.masons is not None:
        unit = 1 / trials.wall.scale
        labels = wall.masons.papers_way
        masons = masonry_panel("masons, gaps closed", labels, wall.masons.clusters, unit)
    return [
        Panel(title, wall_aspect(stones.source.height_px / stones.source.width_px), draw),
        wall_panel(*built.titled(trials, f"fixed seed {seeds[0]}")),
        wall_panel(*built.titled(trials, best, wall.best)),
        masons,
    ]


TABLE2 = PaperItem(
    **paper("table2"),
    study=partial(five_walls, study=Study(walls=FIVE, quick_seeds=2)),
    tables={"table2": _comparison, "table2_seeds": _spread},
    pictures=lambda found: (_fig18(found),),
    needs=tuple(wall.source.name for wall in MASONS),
)
