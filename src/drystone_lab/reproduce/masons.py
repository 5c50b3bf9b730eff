"""The masons' walls: Fig. 13, gaps closed (§5.1); Table 2, Figs. 17 and 18, beside ours (§5.2)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import floor
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy import ndimage

from drystone.clusters import cluster_stones
from drystone.contacts.blocks import model_from_labels
from drystone.contacts.gaps import model_with_closed_gaps, settle_gaps
from drystone.drawing.canvas import draw
from drystone.drawing.drawing import GROUND, MARGIN, Drawing, Surface, ground
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import PLAIN_COLOUR, cluster_colour
from drystone.drawing.pictures.stones import plot_joint_paths
from drystone.metrics import paths as joint_paths
from drystone.metrics.frame import frame_wall, reduce_labels
from drystone.metrics.measure import WallMetrics, measure_labels
from drystone.metrics.paths import PAD_LEFT, PAD_TOP, SHORTEST, JointPath, joint_mask, mean_excess
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels
from drystone.poses import PoseBook
from drystone.statics.limit import lateral_resistance
from drystone_lab import cells
from drystone_lab import pictures as sheets
from drystone_lab.cells import METRICS, rounded
from drystone_lab.reproduce.item import Context, ItemFigure, PaperItem, Trials
from drystone_lab.reproduce.items import ITEMS
from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.table import Cell, Rows
from drystone_lab.walls import MASONS, PR, Target

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
    stones = {int(each): np.argwhere(labels == each) for each in np.unique(labels) if each}
    nearest = sorted((_distance(pixels.mean(axis=0), labels), i) for i, pixels in stones.items())
    for _, block in nearest:
        moved[tuple(stones[block].T)] = 0
        moved[tuple(_nearest(stones[block], moved).T)] = block
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
    middle = pixels.mean(axis=0)
    while True:
        here = _distance(middle, others)
        ways = sorted((_distance(middle + move, others), order) for order, move in enumerate(MOVES))
        for distance, order in ways:
            step = np.array(MOVES[order])
            moved = pixels + step
            inside = (moved >= 0).all() and (moved < others.shape).all()
            if distance < here and inside and not others[tuple(moved.T)].any():
                pixels, middle = moved, middle + step
                break
        else:
            return pixels


def _distance(place: NDArray[np.floating], labels: Labels) -> float:
    """Return how far a row and column is from the bottom left corner."""
    return float(np.hypot(labels.shape[0] - 0.5 - place[0], place[1] + 0.5))


REFERENCES, CONSTRUCTED = (
    {number: tuple(figures) for number, figures in enumerate(walls, 1)}
    for walls in ITEMS["table2"]["printed"].values()
)
"""Figures of Table 2 by number of the wall."""

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

    @property
    def both(self) -> tuple[tuple[str, Labels], tuple[str, Labels]]:
        """The wall as it was traced, and with its gaps treated as in the paper."""
        return ("as traced", self.labels), (PAPERS_WAY, self.papers_way)

    def panel(self, title: str, labels: Labels) -> sheets.Panel:
        """Return a picture of it as a panel of a sheet, stones coloured by cluster, source px."""
        unit = 1 / self.wall.scale
        height, width = (unit * size for size in labels.shape)
        margin, depth = MARGIN * width, GROUND * max(height, 0.2 * width)
        box = (-margin, -depth, width + margin, height + margin)
        stones = []
        for region in label_regions(labels):
            cluster = self.clusters.get(region.id)
            fill = PLAIN_COLOUR if cluster is None else cluster_colour(cluster)
            loops = tuple(loop * unit for loop in region.loops)
            stones.append(Surface(f"stone-{region.id}", loops, fill))
        drawing = Drawing((*ground(box), *stones), box, "px")
        aspect = sheets.wall_aspect(height / width)
        return sheets.Panel(title, aspect, lambda ax: draw(drawing, ax))


def masons_wall(wall: Target, data: Path | None) -> TracedWall:
    """Read a published wall and bring it to the working scale."""
    if data is None:
        raise FileNotFoundError(wall.source.name)
    labels = reduce_labels(wall.source.labels(data), wall.scale)
    return TracedWall(wall, labels, cluster_stones(wall.source.stones(data), PoseBook(wall.scale)))


def treatments(wall: TracedWall) -> Iterator[tuple[str, float | None, str]]:
    """Yield F_LR of a wall as it was traced and with its gaps treated in all ways.

    The name of the way, F_LR, and the status, which says what a wall without it does.
    """
    labels = wall.labels
    models = {
        "as traced": model_from_labels(labels).model,
        **{
            f"gaps up to {reach} px closed": model_with_closed_gaps(labels, reach).model
            for reach in (1, 2, 3, 4, 6, 8)
        },
        "stones lowered": model_from_labels(settle_gaps(labels)[0]).model,
        "lowered and pushed left": model_from_labels(settle_gaps(labels, "left")[0]).model,
        "lowered and pushed right": model_from_labels(settle_gaps(labels, "right")[0]).model,
        PAPERS_WAY: model_from_labels(wall.papers_way).model,
    }
    for name, model in models.items():
        both = lateral_resistance(model)
        told = next((end for end in (both.left, both.right) if end.alpha is None), both.left)
        yield name, rounded(both.value), str(told.status)


def masons_walls(context: Context, walls: Sequence[Target] = MASONS) -> list[TracedWall]:
    """Read walls."""
    return [masons_wall(wall, context.data) for wall in walls]


def measured(labels: Labels) -> WallMetrics:
    """Return the metrics of a wall by our definition (DESIGN 5), F_LR of its pixels among them."""
    resistance = lateral_resistance(model_from_labels(labels).model)
    return measure_labels(labels, lateral_resistance=resistance.value)


def _metrics(walls: Sequence[TracedWall]) -> Rows:
    for each in walls:
        for name, labels in each.both:
            ours = measured(labels)
            size = f"{ours.width:.0f} x {ours.height:.0f}"
            yield each.wall.name, name, size, ours.stones, *cells.metric_cells(vars(ours))
        yield each.wall.name, "paper, Table 2", None, None, *REFERENCES[each.wall.number]


def _gaps_picture(walls: Sequence[TracedWall]) -> ItemFigure:
    panels = [
        each.panel(f"{each.wall.name}, {name}", labels)
        for each in walls
        for name, labels in (
            ("as traced", each.labels),
            ("drawn together, dilated", each.papers_way),
        )
    ]
    return ItemFigure("fig13", sheets.sheet_of(panels, 2))


FIG13 = PaperItem(
    study=masons_walls,
    tables={
        "fig13": _metrics,
        "fig13_resistance": lambda walls: [
            (wall.wall.name, *treated) for wall in walls for treated in treatments(wall)
        ],
    },
    pictures=lambda walls: [_gaps_picture(walls)],
)

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

    def merit(place: int) -> tuple[float, float, float, float, int]:
        figures = outcomes[place].figures
        filled = float(figures["F_SF"] or 0.0)
        resistance = -1.0 if figures["F_LR"] is None else round(figures["F_LR"], EXACT)
        return tenths(filled), tenths(resistance), filled, resistance, -place

    return max(range(len(outcomes)), key=merit)


def tenths(value: float) -> int:
    """Round to one decimal, halves up; in tenths.

    >>> tenths(0.45), tenths(0.4499999999), tenths(0.44)
    (5, 5, 4)
    """
    return floor(10 * round(value, EXACT) + 0.5)


class FiveWall(NamedTuple):
    """One of the five walls: its trials, and what masons built from its stones, if any did.

    The first trial is that of the fixed seed.
    """

    trials: Trials
    masons: TracedWall | None

    @property
    def stones(self) -> StoneSet:
        """All that there are."""
        return self.trials.wall.source.stones(self.trials.data)

    @property
    def best(self) -> int:
        """Place of the best trial by the paper's rule."""
        return best_trial(self.trials.outcomes)


def _references(wall: FiveWall) -> Rows:
    number, name = wall.trials.wall.number, wall.trials.wall.name
    papers = REFERENCES.get(number, NONE)
    if wall.masons is None:
        yield number, "the paper's", "reference", None, None, *NONE, *papers
        return
    metrics = [(what, measured(labels)) for what, labels in wall.masons.both]
    count = metrics[0][1].stones
    for what, ours in metrics:
        figures = cells.metric_cells(vars(ours))
        yield number, name, f"masons, {what}", count, count, *figures, *papers


def _ours(wall: FiveWall) -> Rows:
    trials, count = wall.trials, len(wall.stones)
    number, name, stand_in = trials.wall.number, trials.wall.name, trials.wall.stand_in
    seeds, papers = len(trials.outcomes), CONSTRUCTED.get(number, NONE)

    def one(what: str, place: int) -> tuple[Cell, ...]:
        outcome = trials.outcomes[place]
        named = f"{what}, seed {trials.specs[place].seed}"
        metrics = cells.metric_cells(outcome.figures)
        return (number, name, named, *cells.placed_of(outcome), *metrics)

    yield *one("fixed seed", 0), *NONE
    middle = (rounded(trials.median(metric)) for metric in METRICS)
    yield number, name, f"median of {seeds}", trials.median("placed"), count, *middle, *NONE
    yield *one(f"best of {seeds}", wall.best), *(NONE if stand_in else papers)
    if stand_in:
        yield number, "the paper's", "best of 20", None, None, *NONE, *papers
    filled = [value or 0.0 for value in trials.values("F_SF")]
    yield *one(f"fullest of {seeds}", filled.index(max(filled))), *NONE  # the earlier one of equals
    most = rounded(float(wall.stones.total_area_px) / (trials.wall.width * trials.wall.height))
    yield number, name, "all stones", count, count, most, None, None, None, *NONE


def _five_panels(wall: FiveWall) -> list[sheets.Panel]:
    trials, stones = wall.trials, wall.stones
    seeds = [spec.seed for spec in trials.specs]
    clusters = cluster_stones(stones, PoseBook(trials.wall.scale))
    title = f"Wall {trials.wall.number}, {trials.wall.name}\n"
    title += f"{len(stones)} stones in {len(set(clusters.values()))} clusters"
    best = f"best of {len(seeds)}, seed {seeds[wall.best]}"
    masons = sheets.EMPTY
    if wall.masons is not None:
        masons = wall.masons.panel("masons, gaps closed", wall.masons.papers_way)
    return [
        sheets.stones_panel(title, stones, clusters),
        trials.titled(f"fixed seed {seeds[0]}"),
        trials.titled(best, wall.best),
        masons,
    ]


TABLE2 = PaperItem(
    then=lambda found: [
        FiveWall(one, None if one.wall.stand_in else masons_wall(one.wall, one.data))
        for one in found
    ],
    tables={
        # Rows of each wall, our figures and the paper's beside each other
        "table2": lambda walls: [
            row for wall in walls for row in (*_references(wall), *_ours(wall))
        ],
    },
    pictures=lambda walls: [
        ItemFigure(
            "fig18", sheets.sheet_of([panel for wall in walls for panel in _five_panels(wall)], 4)
        )
    ],
)

Way = tuple[str, tuple[JointPath, ...], int, int]
"""Name, paths, length of a straight one in px, and how many Fig. 17 draws."""


class Paths(NamedTuple):
    """The shortest paths along the joints of a wall either way, the shortest first."""

    name: str
    labels: Labels
    ways: tuple[Way, Way]


def paths_of(name: str, labels: Labels, wall_width_px: float | None = None) -> Paths:
    """Find the paths of a label image."""
    framed = frame_wall(labels, wall_width_px).labels
    joint = joint_mask(framed)
    rows, cols = joint.shape
    across = "horizontal", joint_paths.horizontal_paths(joint), cols - 1, 3
    upright = "vertical", joint_paths.vertical_paths(joint), rows - 1, 7
    return Paths(name, framed, (across, upright))


def shortest_paths(context: Context, wall: Target = PR) -> tuple[Paths, ...]:
    """Find the shortest paths; of published stones the image is the masons' wall."""
    built = context.wall(wall.run(context.seed))
    found = [paths_of(f"planned {wall.name}", built.labels, built.site.width_px)]
    if context.data is not None and wall.source.kind == "published":
        traced = wall.source.labels(context.data)
        found.append(paths_of(f"the masons' {wall.name}", reduce_labels(traced, wall.scale)))
    return tuple(found)


def _figures(walls: Sequence[Paths]) -> Rows:
    for paths in walls:
        factors = (
            rounded(mean_excess([path.length_px for path in found[:SHORTEST]], straight))
            for _, found, straight, _ in paths.ways
        )
        yield paths.name, *(straight for _, _, straight, _ in paths.ways), *factors


def _paths(walls: Sequence[Paths]) -> Rows:
    for paths in walls:
        for way, found, straight, _ in paths.ways:
            for rank, path in enumerate(found, 1):
                start = path.pixels[0] - (PAD_TOP, PAD_LEFT)
                at = int(start[0] if way == "horizontal" else start[1])
                excess = rounded(mean_excess([path.length_px], straight))
                yield paths.name, way, rank, at, round(path.length_px, 4), excess


def _picture(paths: Paths, number: int) -> ItemFigure:
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    for ax, (way, found, _, count) in zip(figure.subplots(2, 1), paths.ways, strict=True):
        pad = np.array([PAD_TOP, PAD_LEFT])
        plot_joint_paths(paths.labels, [path.pixels - pad for path in found[:count]], ax)
        lengths = ", ".join(f"{path.length_px:.0f}" for path in found[:count])
        ax.set_title(f"{paths.name}: {way} paths of {lengths} px", fontsize=8, loc="left")
    counts = {way: len(found[:count]) for way, found, _, count in paths.ways}
    return ItemFigure("fig17-masons" if number else "fig17", figure, {"name": paths.name, **counts})


PATHS = PaperItem(
    study=shortest_paths,
    tables={"figures": _figures, "paths": _paths},
    pictures=lambda found: [_picture(paths, number) for number, paths in enumerate(found)],
)
