"""What stones are grouped by, and into how many groups (§3.4, Fig. 5)."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from drystone.drawing.palette import OUTLINE_COLOUR, WEDGE_COLOUR, cluster_colour

SQUARE_IN = (4.6, 4.0)
COUNTS_IN = (5.6, 3.6)
MARKERS = ("o", "s", "D", "^", "v", "P", "X", "p")
"""By cluster, then round again: colour alone need not tell them apart."""

MARKER_PT = 6.0
LABEL_PT = 8.0
"""Size of a point, and how far from it its id is written."""

COUNT_LOOKS = (("#0072b2", "o"), (WEDGE_COLOUR, "s"), ("#008655", "^"))
"""Colour and marker of a set."""


def plot_features(
    features: NDArray[np.floating],
    stone_ids: Sequence[int],
    clusters: Mapping[int, int],
    ax: Axes | None = None,
) -> Axes:
    """Draw stones by eccentricity and size, coloured by cluster and numbered by id.

    Parameters
    ----------
    features : (n, 2) float array
        From :func:`drystone.clusters.stone_features`.
    stone_ids : sequence of int
        Their ids.
    clusters : mapping of int to int
        Cluster of each id, from 1.
    ax : Axes, optional
        Where to draw; None makes a figure.
    """
    ax = Figure(figsize=SQUARE_IN, layout="constrained").add_subplot() if ax is None else ax
    for stone_id, (across, up) in zip(stone_ids, features.tolist(), strict=True):
        cluster = clusters[stone_id]
        fill = cluster_colour(cluster)
        ax.plot(
            [across], [up], MARKERS[(cluster - 1) % len(MARKERS)], color=fill,
            markersize=MARKER_PT, markeredgecolor=OUTLINE_COLOUR, markeredgewidth=0.5,
            gid=f"stone-{stone_id}",
        )  # fmt: skip
    ax.set_xlabel("eccentricity", fontsize=8)
    ax.set_ylabel("area of the bounding box / largest", fontsize=8)
    ax.tick_params(labelsize=7)
    ax.margins(0.08)
    _write_ids(ax, features, stone_ids)
    return ax


def _write_ids(ax: Axes, features: NDArray[np.floating], stone_ids: Sequence[int]) -> None:
    """Write an id beside each point, where it is farthest from the other points and ids."""
    points = ax.transData.transform(features)
    turns = np.arange(8) * np.pi / 4
    ways = LABEL_PT * np.column_stack([1.2 * np.cos(turns), np.sin(turns)])
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


def plot_counts(
    counts: Mapping[str, Sequence[tuple[float, int]]],
    ax: Axes | None = None,
    *,
    claim: tuple[float, int, str] | None = None,
) -> Axes:
    """Draw how many clusters there are over the distance threshold.

    Parameters
    ----------
    counts : mapping of str to sequence of (float, int)
        By name of the stones: threshold and clusters, thresholds ascending.
    ax : Axes, optional
        Where to draw; None makes a figure.
    claim : (float, int, str), optional
        Threshold, clusters, and who found them.
    """
    ax = Figure(figsize=COUNTS_IN, layout="constrained").add_subplot() if ax is None else ax
    for rank, (name, points) in enumerate(counts.items()):
        colour, marker = COUNT_LOOKS[rank % len(COUNT_LOOKS)]
        ax.plot(*zip(*points, strict=True), marker, color=colour, linestyle="-", markersize=4,
                linewidth=1.2, label=name, gid=f"counts-{name}")  # fmt: skip
    if claim is not None:
        distance, number, who = claim
        ax.plot([distance], [number], "x", color=OUTLINE_COLOUR, markersize=9,
                markeredgewidth=1.6, label=who, gid="claim", zorder=5)  # fmt: skip
    ax.set_xlabel("distance threshold of Ward's linkage", fontsize=8)
    ax.set_ylabel("clusters", fontsize=8)
    ax.tick_params(labelsize=7)
    ax.set_ylim(bottom=0)
    ax.grid(visible=True, axis="y", linewidth=0.3)
    ax.legend(fontsize=7, frameon=False)
    return ax
