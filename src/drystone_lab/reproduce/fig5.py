"""Fig. 5: the stones PR in clusters of like eccentricity and size (§3.4)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.cluster.hierarchy import ward

from drystone.clusters import ClusterSettings, cluster_stones, stone_features
from drystone.drawing.pictures.stones import plot_stones
from drystone.model.stone import StoneSet
from drystone.poses import PoseBook
from drystone_lab.pictures.features import COUNTS_IN, plot_counts, plot_features
from drystone_lab.reproduce.base import MASONS, PR, PaperWall
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.table import Cell, Table

DISTANCE = ClusterSettings().distance
DISTANCES = (0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4)
"""Thresholds that are compared; the paper's among them."""

PAPER_CLUSTERS = 7
"""Of the 32 stones PR (§3.4)."""

PAPER = (
    "Fig. 5 shows the stones of the wall PR coloured by cluster, and each as a point by its "
    f"features. §3.4: 'a set with 32 stones which is separated into {PAPER_CLUSTERS} clusters' by "
    "Ward's agglomerative clustering with a distance threshold of 0.2, on the eccentricity of the "
    "ellipse with like second moments and the area of the bounding box over the largest in the "
    "set. The members of the clusters are only in the picture.",
)


@dataclass(frozen=True, eq=False)
class Grouped:
    """A set of stones in clusters.

    Parameters
    ----------
    name : str
        Of the set.
    stones : StoneSet
        The stones.
    features : (n, 2) float array
        Of each (:func:`drystone.clusters.stone_features`).
    counts : dict of float to int
        Clusters by threshold.
    merges : (n - 1,) float array
        Distances at which Ward's linkage joins two clusters, ascending.
    clusters : dict of int to int
        At the paper's threshold, by id.
    """

    name: str
    stones: StoneSet
    features: NDArray[np.float64]
    counts: Mapping[float, int]
    merges: NDArray[np.float64]
    clusters: Mapping[int, int]

    @classmethod
    def of(cls, name: str, stones: StoneSet) -> "Grouped":
        """Group a set of at least two stones by every threshold."""
        book = PoseBook()
        features = stone_features(stones, book)
        by_distance = {
            distance: cluster_stones(stones, book, ClusterSettings(distance=distance))
            for distance in (DISTANCE, *DISTANCES)
        }
        counts = {distance: len({*by_distance[distance].values()}) for distance in DISTANCES}
        merges = np.sort(ward(features)[:, 2])
        return cls(name, stones, features, counts, merges, by_distance[DISTANCE])

    def between(self, count: int) -> tuple[float, float]:
        """Return from which threshold on, and below which, there are so many clusters.

        Parameters
        ----------
        count : int
            From 2 to one less than there are stones.
        """
        return float(self.merges[-count]), float(self.merges[1 - count])


def make(context: Context, wall: PaperWall = PR, others: Sequence[PaperWall] = MASONS) -> Output:
    """Group the stones of a wall, and count the clusters of some sets over the threshold.

    Parameters
    ----------
    context : Context
        Gives the published data.
    wall : PaperWall
        Whose stones are drawn.
    others : sequence of PaperWall
        Whose clusters are counted; those whose stones are absent are left out.
    """
    drawn = Grouped.of(wall.name, wall.source.stones(context.data))
    counted = {wall.name: drawn}
    for other in others:
        if other.name not in counted and other.source.is_there(context.data):
            counted[other.name] = Grouped.of(other.name, other.source.stones(context.data))
    return Output(
        paper=PAPER,
        ours=_found(drawn, list(counted.values())),
        tables=(
            ("clusters", _clusters(drawn)),
            ("stones", _stones(drawn)),
            ("thresholds", _thresholds(list(counted.values()))),
        ),
        pictures=(_picture(drawn), _counts_picture(list(counted.values()))),
    )


def _found(drawn: Grouped, counted: Sequence[Grouped]) -> tuple[str, ...]:
    number = len({*drawn.clusters.values()})
    low, high = drawn.between(PAPER_CLUSTERS)
    agrees = "the paper's number" if number == PAPER_CLUSTERS else f"not {PAPER_CLUSTERS}"
    sets = "; ".join(
        f"{one.name}: {len({*one.clusters.values()})} of {len(one.stones)} stones"
        for one in counted
    )
    ends = (DISTANCES[0], DISTANCES[-1])
    return (
        f"The {len(drawn.stones)} stones {drawn.name} fall into {number} clusters at a distance "
        f"of {DISTANCE:g}, {agrees}. There are {PAPER_CLUSTERS} for every threshold from {low:.3f} "
        f"to {high:.3f}, {drawn.counts[ends[0]]} at {ends[0]:g} and {drawn.counts[ends[1]]} at "
        f"{ends[1]:g}.",
        f"Clusters at {DISTANCE:g} by set: {sets}. Size is relative to the largest of a set, so "
        "the number depends on how far its sizes spread, and one very large stone makes fewer "
        "clusters of the others.",
    )


def _clusters(drawn: Grouped) -> Table:
    ids = np.array([stone.id for stone in drawn.stones])
    place = np.array([drawn.clusters[i] for i in ids.tolist()])
    rows: list[tuple[Cell, ...]] = []
    for cluster in sorted({*drawn.clusters.values()}):
        among = place == cluster
        eccentricity, size = drawn.features[among].mean(axis=0).tolist()
        names = " ".join(map(str, ids[among].tolist()))
        rows.append((cluster, int(among.sum()), round(eccentricity, 4), round(size, 4), names))
    return Table(
        f"Clusters of the stones {drawn.name} at a distance of {DISTANCE:g}",
        ("cluster", "stones", "mean eccentricity", "mean size", "ids"),
        tuple(rows),
        ("Size: area of the bounding box over the largest in the set; clusters by falling size.",),
    )


def _stones(drawn: Grouped) -> Table:
    return Table(
        f"Features of the stones {drawn.name}",
        ("stone", "cluster", "eccentricity", "size"),
        tuple(
            (stone.id, drawn.clusters[stone.id], round(eccentricity, 4), round(size, 4))
            for stone, (eccentricity, size) in zip(
                drawn.stones, drawn.features.tolist(), strict=True
            )
        ),
    )


def _thresholds(counted: Sequence[Grouped]) -> Table:
    return Table(
        "Clusters over the distance threshold",
        ("stones", "count", *(f"{distance:g}" for distance in DISTANCES)),
        tuple(
            (one.name, len(one.stones), *(one.counts[distance] for distance in DISTANCES))
            for one in counted
        ),
        (f"The paper: {PAPER_CLUSTERS} of PR at 0.2 (§3.4).",),
    )


def _picture(drawn: Grouped) -> Picture:
    figure = Figure(figsize=(7.2, 6.4), layout="constrained")
    parts = figure.subfigures(2, 1, squeeze=False, height_ratios=(1.5, 1.0))
    above, below = parts[:, 0]
    ids = [stone.id for stone in drawn.stones]
    plot_features(drawn.features, ids, drawn.clusters, above.add_subplot())
    plot_stones(drawn.stones, drawn.clusters, below.add_subplot())
    number = len({*drawn.clusters.values()})
    return Picture(
        "fig5", figure,
        f"The {len(ids)} stones {drawn.name} in {number} clusters: by eccentricity and size, and "
        "as they lie in the source image. Numbers are ids.",
    )  # fmt: skip


def _counts_picture(counted: Sequence[Grouped]) -> Picture:
    counts = {one.name: sorted(one.counts.items()) for one in counted}
    claim = (0.2, PAPER_CLUSTERS, "PR in the paper")
    figure = Figure(figsize=COUNTS_IN, layout="constrained")
    plot_counts(counts, figure.add_subplot(), claim=claim)
    return Picture(
        "fig5-thresholds", figure,
        "How many clusters there are over the distance threshold.",
    )  # fmt: skip


ITEM = Item("clusters of the stones PR", "§3.4", make, needs=(PR.source.name,))
