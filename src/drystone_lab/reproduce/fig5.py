"""Fig. 5: the stones PR in clusters of like eccentricity and size (§3.4)."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.cluster.hierarchy import ward

from drystone.clusters import ClusterSettings, cluster_stones, stone_features
from drystone.drawing.canvas import name_axes
from drystone.drawing.palette import OUTLINE_COLOUR, cluster_colour
from drystone.drawing.pictures.stones import plot_stones
from drystone.model.stone import StoneSet
from drystone.poses import PoseBook
from drystone_lab.cells import rounded
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem
from drystone_lab.table import Rows
from drystone_lab.walls import MASONS, PR, Target

MARKERS = ("o", "s", "D", "^", "v", "P", "X", "p")
"""By cluster, then round again: colour alone need not tell them apart."""


def plot_features(
    ax: Axes, features: NDArray[np.floating], stone_ids: Sequence[int], clusters: Mapping[int, int]
) -> None:
    """Draw stones by eccentricity and size, coloured by cluster and numbered by id.

    `features` is (n, 2), from :func:`drystone.clusters.stone_features`; clusters are by id, from 1.
    """
    for stone_id, (across, up) in zip(stone_ids, features.tolist(), strict=True):
        cluster = clusters[stone_id]
        ax.plot(
            [across], [up], MARKERS[(cluster - 1) % len(MARKERS)], color=cluster_colour(cluster),
            markersize=6.0, markeredgecolor=OUTLINE_COLOUR, markeredgewidth=0.5,
            gid=f"stone-{stone_id}",
        )  # fmt: skip
    name_axes(ax, "eccentricity", "area of the bounding box / largest")
    ax.margins(0.08)
    # An id is written beside its point, where it is farthest from the other points and ids.
    points = ax.transData.transform(features)
    turns = np.arange(8) * np.pi / 4
    ways = 8.0 * np.column_stack([1.2 * np.cos(turns), np.sin(turns)])
    taken = points
    for number, stone_id in enumerate(stone_ids):
        places = points[number] + ways * ax.figure.dpi / 72
        others = np.delete(taken, number, axis=0)
        room = np.hypot(*(places[:, None] - others).T).min(axis=0, initial=np.inf)
        best = int(np.argmax(room))
        taken = np.vstack([taken, places[best]])
        ax.annotate(
            str(stone_id), features[number].tolist(), ways[best].tolist(), size=6,
            textcoords="offset points", ha="center", va="center_baseline",
        )  # fmt: skip


DISTANCE = ClusterSettings().distance
DISTANCES = (0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4)
"""Thresholds that are compared; the paper's among them."""

PAPER_CLUSTERS = 7
"""Of the 32 stones PR (§3.4)."""


@dataclass(frozen=True, eq=False)
class ClusteredStones:
    """A set of stones in clusters: their number by threshold, and those at the paper's by id."""

    name: str
    stones: StoneSet
    features: NDArray[np.float64]
    counts: Mapping[float, int]
    clusters: Mapping[int, int]

    @classmethod
    def of(cls, name: str, stones: StoneSet) -> "ClusteredStones":
        """Group a set of at least two stones by every threshold."""
        book = PoseBook()
        by_distance = {
            distance: cluster_stones(stones, book, ClusterSettings(distance=distance))
            for distance in DISTANCES
        }
        counts = {distance: len({*one.values()}) for distance, one in by_distance.items()}
        return cls(name, stones, stone_features(stones, book), counts, by_distance[DISTANCE])

    @property
    def number(self) -> int:
        """Of the clusters."""
        return self.counts[DISTANCE]

    def between(self, count: int) -> tuple[float, float]:
        """Return from which threshold on, and below which, there are so many clusters."""
        merges = np.sort(ward(self.features)[:, 2])  # distances at which two are joined
        return float(merges[-count]), float(merges[1 - count])


def grouped(
    context: Context, wall: Target = PR, others: Sequence[Target] = MASONS
) -> list[ClusteredStones]:
    """Group the stones of a wall, which are drawn, and of others whose stones are there."""
    sets = {one.name: one.stones(context.data) for one in (wall, *others)}
    return [ClusteredStones.of(name, stones) for name, stones in sets.items() if stones is not None]


def _clusters(sets: Sequence[ClusteredStones]) -> Rows:
    drawn = sets[0]
    place = np.array([drawn.clusters[stone.id] for stone in drawn.stones])
    for cluster in range(1, drawn.number + 1):
        ids = [stone.id for stone in drawn.stones if drawn.clusters[stone.id] == cluster]
        means = drawn.features[place == cluster].mean(axis=0).tolist()
        yield cluster, len(ids), *map(rounded, means), " ".join(map(str, ids))


def _picture(sets: Sequence[ClusteredStones]) -> ItemFigure:
    drawn = sets[0]
    figure = Figure(figsize=(7.2, 6.4), layout="constrained")
    above, below = figure.subfigures(2, 1, squeeze=False, height_ratios=(1.5, 1.0))[:, 0]
    ids = [stone.id for stone in drawn.stones]
    plot_features(above.add_subplot(), drawn.features, ids, drawn.clusters)
    plot_stones(drawn.stones, drawn.clusters, below.add_subplot())
    return ItemFigure("fig5", figure, drawn)


def _claims(sets: Sequence[ClusteredStones]) -> Iterator[Claimed]:
    number, (low, high) = sets[0].number, sets[0].between(PAPER_CLUSTERS)
    yield Claimed("seven", number == PAPER_CLUSTERS, number=number, low=low, high=high)


CLUSTERS = PaperItem(
    study=grouped,
    claims=_claims,
    tables={
        "clusters": _clusters,
        "stones": lambda sets: [
            (stone.id, sets[0].clusters[stone.id], *map(rounded, features))
            for stone, features in zip(sets[0].stones, sets[0].features.tolist(), strict=True)
        ],
        "thresholds": lambda sets: [
            (one.name, len(one.stones), *(one.counts[distance] for distance in DISTANCES))
            for one in sets
        ],
    },
    pictures=lambda sets: [_picture(sets)],
)
