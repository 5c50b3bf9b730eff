"""Times of a planner at work: step by step, and over the size of the task (Fig. 28, Fig. 29)."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from drystone.drawing.palette import CLUSTER_COLOURS, GREY, OUTLINE_COLOUR, WEDGE_COLOUR
from drystone.planner.profile import Part, StepTime
from drystone_lab.pictures.charts import name_axes
from drystone_lab.timed_walls import fitted

PART_COLOURS: Mapping[Part, str] = {
    "placement": CLUSTER_COLOURS[0],
    "stabilisation": CLUSTER_COLOURS[5],
    "contacts": CLUSTER_COLOURS[7],
    "limit analysis": CLUSTER_COLOURS[1],
    "indices": CLUSTER_COLOURS[10],
}
"""Blue, green and shades of orange, as in Fig. 28, where the last three are one: selection."""

REST = "rest"
PANEL_IN = (4.2, 3.2)
LINES = ((CLUSTER_COLOURS[0], "o"), (WEDGE_COLOUR, "s"), (CLUSTER_COLOURS[12], "^"))
"""Colour and marker by series; the first three."""

Points = Sequence[tuple[float, float]]
"""Sizes and seconds."""


def plot_step_times(ax: Axes, steps: Sequence[StepTime]) -> None:
    """Draw the time of every step as a bar, its parts on top of each other (Fig. 28)."""
    number = np.arange(1, len(steps) + 1)
    foot = np.zeros(len(steps))
    for part, colour in PART_COLOURS.items():
        height = 1e3 * np.array([step.parts.get(part, 0.0) for step in steps])
        ax.bar(number, height, 0.8, foot, color=colour, label=part)
        foot += height
    rest = np.maximum(0.0, 1e3 * np.array([step.seconds for step in steps]) - foot)
    ax.bar(number, rest, 0.8, foot, color=GREY, label=REST)
    ax.set_xlim(0.4, len(steps) + 0.6)
    name_axes(ax, "step", "ms")


def step_time_panels(runs: Mapping[str, Sequence[StepTime]]) -> Figure:
    """Draw the steps of several walls side by side, with one legend."""
    figure = Figure(figsize=(PANEL_IN[0] * len(runs), PANEL_IN[1]))
    panels = figure.subplots(1, len(runs), squeeze=False)[0]
    for ax, (title, steps) in zip(panels, runs.items(), strict=True):
        plot_step_times(ax, steps)
        ax.set_title(title, fontsize=8)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.tight_layout()
    # Above, where it hides no bar.
    figure.legend(
        handles, labels, fontsize=7, edgecolor="none", loc="lower center",
        bbox_to_anchor=(0.5, 1.0), ncols=len(labels),
    )  # fmt: skip
    return figure


def plot_growth(
    ax: Axes, series: Mapping[str, Points], claims: Sequence[tuple[str, str, float, float]]
) -> None:
    """Draw times over sizes, both logarithmic, with the power laws fitted to them (Fig. 29).

    A claim is what somebody else measured: a label, a marker, size and seconds.
    """
    for (label, points), (colour, marker) in zip(series.items(), LINES, strict=False):
        x, y = zip(*points, strict=True)
        ax.plot(x, y, color=colour, marker=marker, linestyle="", markersize=5, label=label)
        if (law := fitted(points)) is not None:
            ends = [min(x), max(x)]
            words = f"exponent {law.exponent:.2f}"
            ax.plot(ends, [law(end) for end in ends], color=colour, linewidth=1, label=words)
    for label, marker, size, seconds in claims:
        ax.plot([size], [seconds], color=OUTLINE_COLOUR, marker=marker, linestyle="",
                markersize=6, label=label)  # fmt: skip
    ax.set_xscale("log")
    ax.set_yscale("log")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())
    name_axes(ax, "pixels of the wall", "s")
    # Above, where it hides no point.
    ax.legend(fontsize=7, edgecolor="none", loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
