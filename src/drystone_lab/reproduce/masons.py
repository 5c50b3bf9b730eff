"""Fig. 13: the masons' walls, and with their gaps closed (§5.1)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.clusters import cluster_stones
from drystone.contacts.blocks import model_from_labels
from drystone.contacts.gaps import model_with_closed_gaps, settle_gaps
from drystone.metrics.measure import WallMetrics, measure_labels
from drystone.metrics.reduce import reduce_labels
from drystone.model.wall import Labels
from drystone.poses import PoseBook
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone_lab.pictures.walls import masonry_panel, sheet_of
from drystone_lab.reproduce.cells import METRICS, rounded
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.table import Cell, Table
from drystone_lab.walls import MASONS, Target

MOVES = ((1, -1), (1, 0), (0, -1), (1, 1), (-1, -1), (-1, 0), (0, 1), (-1, 1))
"""Steps of a stone, px down and to the right; the first of equally good ones is taken."""


def drawn_together(labels: Labels) -> Labels:
    """Move stones towards the wall's bottom left corner, nearest first, by whole pixels.

    The paper: "we reposition the stones such that the distance between their centers and the
    bottom left corner is minimized. The manipulation is performed sequentially, prioritizing
    stones with smaller distance to the bottom left corner."  A stone takes the step that brings
    its centre nearest to the corner, and does not overlap another stone or leave the image, as
    long as there is one; every stone is moved once.

    >>> drawn_together(np.array([[0, 1, 0, 2], [0, 0, 0, 2]])).tolist()
    [[0, 2, 0, 0], [1, 2, 0, 0]]
    """
    moved = labels.copy()
    ids = [int(each) for each in np.unique(labels) if each]
    for block in sorted(ids, key=lambda each: (_distance(*_centre(labels, each), labels), each)):
        pixels = np.argwhere(moved == block)
        moved[tuple(pixels.T)] = 0
        moved[tuple(_nearest(pixels, moved).T)] = block
    return moved


def dilated(labels: Labels) -> Labels:
    """Let every stone grow by one pixel on all sides, diagonals included, into what is empty.

    A pixel that several stones reach goes to the smallest id.

    >>> dilated(np.array([[1, 0, 0, 0, 2]])).tolist()
    [[1, 1, 0, 2, 2]]
    """
    # Of 0 as the largest value the least of a neighbourhood is a stone, where there is one.
    high = int(labels.max(initial=0)) + 1
    values = np.where(labels == 0, high, labels)
    least = ndimage.minimum_filter(values, size=3, mode="nearest")
    return np.where(labels == 0, np.where(least == high, 0, least), labels).astype(labels.dtype)


def _nearest(pixels: NDArray[np.intp], others: Labels) -> NDArray[np.intp]:
    """Return where the pixels of a stone end."""
    row, col = pixels.mean(axis=0)
    while True:
        here = _distance(row, col, others)
        ways = sorted(
            (_distance(row + down, col + aside, others), order)
            for order, (down, aside) in enumerate(MOVES)
        )
        for distance, order in ways:
            step = np.array(MOVES[order])
            if distance < here and _is_free(pixels + step, others):
                pixels = pixels + step
                row, col = row + step[0], col + step[1]
                break
        else:
            return pixels


def _centre(labels: Labels, block: int) -> tuple[float, float]:
    row, col = np.argwhere(labels == block).mean(axis=0)
    return float(row), float(col)


def _distance(row: float, col: float, labels: Labels) -> float:
    """Return how far a place is from the bottom left corner."""
    return float(np.hypot(labels.shape[0] - 0.5 - row, col + 0.5))


def _is_free(pixels: NDArray[np.intp], others: Labels) -> bool:
    if (pixels < 0).any() or (pixels >= others.shape).any():
        return False
    return not others[tuple(pixels.T)].any()


REACHES_PX = (1, 2, 3, 4, 6, 8)
"""Widest gap that is closed, working px."""

Printed = tuple[float, float, float, float]
"""A half row of Table 2: F_SF (a share), F_AV and F_AH (percent), F_LR."""

REFERENCES: Mapping[int, Printed] = {
    1: (0.837, 39.780, 0.000, 0.64), 2: (0.883, 40.810, 0.830, 0.48),
    3: (0.957, 22.410, 3.440, 0.26), 4: (0.800, 6.765, 1.707, 0.60),
    5: (0.753, 15.783, 6.767, 0.05),
}  # fmt: skip
"""Reference walls of Table 2 by number: masons' (1 to 3), of a model-free algorithm (4, 5)."""

PAPERS_WAY = "drawn together and dilated (the paper's way)"


@dataclass(frozen=True, eq=False)
class TracedWall:
    """A wall of masons as it was traced, at the working scale, and the cluster of each stone."""

    wall: Target
    labels: Labels
    clusters: dict[int, int]

    @cached_property
    def papers_way(self) -> Labels:
        """The wall with its stones drawn together and dilated by one pixel."""
        return dilated(drawn_together(self.labels))


@dataclass(frozen=True)
class Treatment:
    """F_LR for one way to treat the gaps; without one the status says what the wall does."""

    name: str
    F_LR: float | None
    status: str


def masons_wall(wall: Target, data: Path | None) -> TracedWall:
    """Read a published wall and bring it to the working scale."""
    if data is None:
        raise FileNotFoundError(wall.source.name)
    stones = wall.source.stones(data)
    labels = reduce_labels(wall.source.labels(data), wall.scale)
    return TracedWall(wall, labels, cluster_stones(stones, PoseBook(wall.scale)))


def treatments(wall: TracedWall) -> tuple[Treatment, ...]:
    """Return F_LR of a wall as it was traced and with its gaps treated in all ways."""
    labels = wall.labels
    models = {
        "as traced": model_from_labels(labels).model,
        **{
            f"gaps up to {reach} px closed": model_with_closed_gaps(labels, reach).model
            for reach in REACHES_PX
        },
        "stones lowered": model_from_labels(settle_gaps(labels)[0]).model,
        "lowered and pushed left": model_from_labels(settle_gaps(labels, "left")[0]).model,
        "lowered and pushed right": model_from_labels(settle_gaps(labels, "right")[0]).model,
        PAPERS_WAY: model_from_labels(wall.papers_way).model,
    }
    return tuple(_treated(name, model) for name, model in models.items())


def measured(labels: Labels) -> WallMetrics:
    """Return the metrics of a wall by our definition (DESIGN 5), F_LR of its pixels among them."""
    resistance = lateral_resistance(model_from_labels(labels).model)
    return measure_labels(labels, lateral_resistance=resistance.value)


def _treated(name: str, model: RigidBlockModel) -> Treatment:
    both = lateral_resistance(model)
    told = next((end for end in (both.left, both.right) if end.alpha is None), both.left)
    return Treatment(name, both.value, str(told.status))


TreatedWalls = Sequence[tuple[TracedWall, tuple[Treatment, ...]]]


def treated_walls(context: Context, walls: Sequence[Target] = MASONS) -> TreatedWalls:
    """Read walls, and treat their gaps in all ways."""
    found = [masons_wall(wall, context.data) for wall in walls]
    return [(wall, treatments(wall)) for wall in found]


def _metrics(walls: TreatedWalls) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for each, _ in walls:
        for name, labels in (("as traced", each.labels), (PAPERS_WAY, each.papers_way)):
            ours = measured(labels)
            size = f"{ours.width:.0f} x {ours.height:.0f}"
            found = [rounded(getattr(ours, metric)) for metric in METRICS]
            rows.append((each.wall.name, name, size, ours.stones, *found))
        rows.append((each.wall.name, "paper, Table 2", None, None, *REFERENCES[each.wall.number]))
    return Table(
        "The masons' walls by our definition of the metrics",
        ("wall", "gaps", "px", "stones", *METRICS),
        tuple(rows),
        (
            "F_SF is over the bounding box of the stones; dilation enlarges the stones, so F_SF "
            "after it is not that of the wall. Table 2 refers to the walls of Fig. 18, which are "
            "the treated ones, so that its other figures may be of these too; §5.1 says so of the "
            "load multiplier alone.",
        ),
    )


def _resistance(walls: TreatedWalls) -> Table:
    return Table(
        "F_LR of the masons' walls by the treatment of their gaps",
        ("wall", "gaps", "F_LR", "status"),
        tuple(
            (wall.wall.name, way.name, rounded(way.F_LR), way.status)
            for wall, ways in walls
            for way in ways
        ),
        (
            "Widths of gaps in working px. `drystone analyse --close-gaps PX` and `--close-gaps "
            "settle` do the same, but for the paper's way.",
        ),
    )


def _picture(walls: TreatedWalls) -> ItemPicture:
    panels = [
        masonry_panel(f"{each.wall.name}, {name}", labels, each.clusters, 1 / each.wall.scale)
        for each, _ in walls
        for name, labels in (
            ("as traced", each.labels),
            ("drawn together, dilated", each.papers_way),
        )
    ]
    return ItemPicture(
        "fig13",
        sheet_of(panels, 2),
        "Left as traced, right with the stones drawn to the bottom left corner and dilated by one "
        "working px; stones of a colour are of one cluster of their set.",
    )


FIG13 = PaperItem(
    **paper("fig13"),
    study=treated_walls,
    tables={"fig13": _metrics, "fig13_resistance": _resistance},
    pictures=lambda walls: (_picture(walls),),
    needs=tuple(wall.source.name for wall in MASONS),
)
