"""What a model says against what was measured."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from drystone.drawing.palette import CLUSTER_COLOURS, GREY, OUTLINE_COLOUR, WEDGE_COLOUR
from drystone_lab.pictures.charts import name_axes

COLOURS = (CLUSTER_COLOURS[0], WEDGE_COLOUR, CLUSTER_COLOURS[11])
"""By model; the first three."""

MARKERS = ("o", "s", "^", "D")
"""By series; the first four."""

SIZE_IN = (6.0, 6.0)


class Prediction(NamedTuple):
    """One measured value and what a model says of it."""

    series: str  # Kind of test; chooses the marker
    model: str  # Assumptions; choose the colour
    measured: float
    low: float  # low, predicted, high: Band and middle, in the same unit
    predicted: float
    high: float


def plot_predictions(predictions: Sequence[Prediction], band: str) -> Axes:
    """Draw predicted over measured forces, bands as bars; at most three models, four series."""
    ax = Figure(figsize=SIZE_IN).add_subplot()
    models = list(dict.fromkeys(p.model for p in predictions))
    series = list(dict.fromkeys(p.series for p in predictions))
    colours = dict(zip(models, COLOURS, strict=False))
    markers = dict(zip(series, MARKERS, strict=False))
    for p in predictions:
        ax.errorbar(
            p.measured, p.predicted, yerr=[[p.predicted - p.low], [p.high - p.predicted]],
            color=colours[p.model], marker=markers[p.series], markersize=4.5,
            markerfacecolor="white", linewidth=0.9, capsize=2,
        )  # fmt: skip
    end = 1.05 * float(np.max([[p.measured, p.high] for p in predictions]))
    ax.plot([0, end], [0, end], color=OUTLINE_COLOUR, linewidth=0.8, gid="equal", zorder=0)
    for share in (0.8, 1.2):
        ax.plot([0, end], [0, share * end], color=GREY, linewidth=0.6, linestyle="--", zorder=0)
    ax.set_xlim(0, end)
    ax.set_ylim(0, end)
    name_axes(ax, "measured, kN", "predicted, kN")
    # Colours, markers and lines are explained in the corner where too little is predicted.
    handles = [Line2D([], [], color=c, linewidth=2, label=name) for name, c in colours.items()]
    handles += [
        Line2D([], [], color=OUTLINE_COLOUR, marker=m, linestyle="", markersize=4.5, label=name)
        for name, m in markers.items()
    ]
    handles += [
        Line2D([], [], color=OUTLINE_COLOUR, marker="|", linestyle="", markersize=9, label=band),
        Line2D([], [], color=OUTLINE_COLOUR, linewidth=0.8, label="equal"),
        Line2D([], [], color=GREY, linewidth=0.6, linestyle="--", label="20 % off"),
    ]
    ax.legend(handles=handles, loc="lower right", fontsize=7, framealpha=1.0, edgecolor="none")
    return ax
