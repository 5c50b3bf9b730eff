"""The rows of Table 2, the paper's figures beside ours."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from drystone.metrics.measure import WallMetrics
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels
from drystone_lab.reproduce import summary
from drystone_lab.reproduce.best_trial import best_trial
from drystone_lab.reproduce.masons_wall import PAPERS_WAY, MasonsWall, measured
from drystone_lab.reproduce.published_table import CONSTRUCTED, REFERENCES, Printed
from drystone_lab.reproduce.trials import Trials
from drystone_lab.table import Cell, Table

COLUMNS = (
    "wall", "stones", "what", "placed", "of", *summary.METRICS,
    *(f"paper {name}" for name in summary.METRICS),
)  # fmt: skip

Row = tuple[Cell, ...]


@dataclass(frozen=True, eq=False)
class FiveWall:
    """One of the five walls.

    Parameters
    ----------
    trials : Trials
        Its walls; the first is that of the fixed seed.
    stones : StoneSet
        What they are built from.
    masons : MasonsWall or None
        What masons built from the same stones; None where nobody did.
    """

    trials: Trials
    stones: StoneSet
    masons: MasonsWall | None

    @property
    def number(self) -> int:
        """Of the wall in Table 2."""
        return self.trials.wall.number

    @property
    def name(self) -> str:
        """Of the stones."""
        return self.trials.wall.name

    @property
    def best(self) -> int:
        """Place of the best trial by the paper's rule."""
        return best_trial(self.trials.outcomes)

    @property
    def fullest(self) -> int:
        """Place of the trial with the highest F_SF, the earlier one of equals."""
        filled = [outcome.figures["F_SF"] or 0.0 for outcome in self.trials.outcomes]
        return filled.index(max(filled))

    @property
    def most_filling(self) -> float:
        """F_SF of a wall with all stones, which no wall of these stones can exceed."""
        wall = self.trials.wall
        return float(sum(stone.area_px for stone in self.stones)) / (wall.width * wall.height)

    @cached_property
    def masons_metrics(self) -> WallMetrics | None:
        """Metrics of the masons' wall as it was traced."""
        return None if self.masons is None else measured(self.masons.labels)


def comparison(walls: Sequence[FiveWall]) -> Table:
    """Return Table 2: rows of each wall, our figures and the paper's beside each other."""
    rows = [row for wall in walls for row in (*_reference_rows(wall), *_our_rows(wall))]
    return Table(
        "Table 2: reference walls and constructed ones by one definition, and what the paper "
        "prints",
        COLUMNS,
        tuple(rows),
        (
            "F_SF a share, F_AV and F_AH in percent. Our walls: the area of their stones over the "
            "target; masons' walls: over the bounding box of their stones.",
            "Best: the highest filling, then the highest multiplier over mu, both to one decimal "
            "(§5.2); the paper does not say how both count, so the fullest is shown too.",
            "All stones: the area of all stones over the target, the largest F_SF there can be.",
            "Walls 4 and 5 of the paper are of stones that are not public; ours are of generated "
            "ones, so their rows are no comparison.",
        ),
    )


def _reference_rows(wall: FiveWall) -> list[Row]:
    papers = _printed(REFERENCES.get(wall.number))
    if wall.masons is None or wall.masons_metrics is None:
        nothing = (None,) * len(summary.METRICS)
        return [(wall.number, "the paper's", "reference", None, None, *nothing, *papers)]
    count = wall.masons_metrics.stones
    traced = (
        wall.number, wall.name, "masons, as traced", count, count,
        *_measured(wall.masons_metrics), *papers,
    )  # fmt: skip
    closed = _whole(wall.masons.papers_way)
    dilated = (
        wall.number, wall.name, f"masons, {PAPERS_WAY}", count, count, *closed, *papers,
    )  # fmt: skip
    return [traced, dilated]


def _our_rows(wall: FiveWall) -> list[Row]:
    outcomes = wall.trials.outcomes
    seeds = len(outcomes)
    papers = _printed(CONSTRUCTED.get(wall.number))
    none = (None,) * len(papers)
    start = (wall.number, wall.name)
    fixed = _one(wall, "fixed seed", 0)
    best = _one(wall, f"best of {seeds}", wall.best)
    fullest = _one(wall, f"fullest of {seeds}", wall.fullest)
    middle = [summary.rounded(summary.median_of(outcomes, name)) for name in summary.METRICS]
    placed = summary.median_of(outcomes, "placed")
    count = len(wall.stones)
    most = summary.rounded(wall.most_filling)
    return [
        (*fixed, *none),
        (*start, f"median of {seeds}", placed, count, *middle, *none),
        (*best, *(none if wall.trials.wall.stand_in else papers)),
        *([(wall.number, "the paper's", "best of 20", None, None, None, None, None, None, *papers)]
          if wall.trials.wall.stand_in else []),
        (*fullest, *none),
        (*start, "all stones", count, count, most, None, None, None, *none),
    ]  # fmt: skip


def _one(wall: FiveWall, what: str, place: int) -> Row:
    outcome, seed = wall.trials.outcomes[place], wall.trials.specs[place].seed
    placed, stones = outcome.figures["placed"], outcome.figures["stones"]
    start = (wall.number, wall.name, f"{what}, seed {seed}")
    return (*start, placed, stones, *summary.metric_cells(outcome))


def spread(walls: Sequence[FiveWall]) -> Table:
    """Return medians and ranges of the walls of all seeds."""
    rows = tuple((wall.number, wall.name, *summary.summary(wall.trials.outcomes)) for wall in walls)
    return Table("Walls of all seeds", ("wall", "set", *summary.COLUMNS), rows)


def _whole(labels: Labels) -> tuple[Cell, ...]:
    return _measured(measured(labels))


def _measured(found: WallMetrics) -> tuple[Cell, ...]:
    return tuple(summary.rounded(getattr(found, name)) for name in summary.METRICS)


def _printed(figures: Printed | None) -> tuple[Cell, ...]:
    return tuple(None if figures is None else getattr(figures, name) for name in summary.METRICS)
