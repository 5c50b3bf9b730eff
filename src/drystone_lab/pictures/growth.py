"""Times of a planner at work: step by step, and over the size of the task (Fig. 28, Fig. 29)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from drystone.drawing.palette import CLUSTER_COLOURS, GREY, OUTLINE_COLOUR, WEDGE_COLOUR
from drystone.planner.profile import StepTime
from drystone_lab.pictures.charts import name_axes

PART_COLOURS = {
    "placement": CLUSTER_COLOURS[0],
    "stabilisation": CLUSTER_COLOURS[5],
    "contacts": CLUSTER_COLOURS[7],
    "limit analysis": CLUSTER_COLOURS[1],
    "indices": CLUSTER_COLOURS[10],
}
"""Blue, green and shades of orange, as in Fig. 28, where the last three are one: selection."""

REST = "rest"
PANEL_IN = (4.2, 3.2)
GROWTH_IN = (6.4, 4.0)
LINES = ((CLUSTER_COLOURS[0], "o"), (WEDGE_COLOUR, "s"), (CLUSTER_COLOURS[12], "^"))
"""Colour and marker by series; the first three."""


@dataclass(frozen=True)
class PowerLaw:
    """y = factor * x ** exponent."""

    factor: float
    exponent: float

    def __call__(self, x: float) -> float:
        """Return y."""
        return float(self.factor * x**self.exponent)


@dataclass(frozen=True)
class Series:
    """Times over a size."""

    label: str
    points: tuple[tuple[float, float], ...]  # Size and seconds
    law: PowerLaw | None = None  # Fitted to the points; drawn as a line


@dataclass(frozen=True)
class Claim:
    """What somebody else measured."""

    label: str  # Who, and what
    size: float  # size, seconds: The point
    seconds: float
    at_most: bool = False  # Less than that


def plot_step_times(steps: Sequence[StepTime], ax: Axes | None = None, *, title: str = "") -> Axes:
    """Draw the time of every step as a bar, its parts on top of each other (Fig. 28)."""
    ax = Figure(figsize=PANEL_IN).add_subplot() if ax is None else ax
    number = np.arange(1, len(steps) + 1)
    foot = np.zeros(len(steps))
    for part, colour in PART_COLOURS.items():
        height = 1e3 * np.array([step.parts.get(part, 0.0) for step in steps])  # type: ignore[call-overload]
        ax.bar(number, height, 0.8, foot, color=colour, label=part)
        foot += height
    rest = np.maximum(0.0, 1e3 * np.array([step.seconds for step in steps]) - foot)
    ax.bar(number, rest, 0.8, foot, color=GREY, label=REST)
    ax.set_xlim(0.4, len(steps) + 0.6)
    name_axes(ax, "step", "ms")
    ax.set_title(title, fontsize=8)
    return ax


def step_time_panels(runs: Mapping[str, Sequence[StepTime]]) -> Figure:
    """Draw the steps of several walls side by side, with one legend."""
    figure = Figure(figsize=(PANEL_IN[0] * len(runs), PANEL_IN[1]))
    panels = figure.subplots(1, len(runs), squeeze=False)[0]
    for ax, (title, steps) in zip(panels, runs.items(), strict=True):
        plot_step_times(steps, ax, title=title)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.tight_layout()
    # Above, where it hides no bar.
    figure.legend(
        handles, labels, fontsize=7, edgecolor="none", loc="lower center",
        bbox_to_anchor=(0.5, 1.0), ncols=len(labels),
    )  # fmt: skip
    return figure


def plot_growth(
    series: Sequence[Series],
    claims: Sequence[Claim] = (),
    ax: Axes | None = None,
    *,
    size: str = "size",
) -> Axes:
    """Draw times over sizes, both logarithmic, with the power laws fitted to them (Fig. 29)."""
    ax = Figure(figsize=GROWTH_IN).add_subplot() if ax is None else ax
    for each, (colour, marker) in zip(series, LINES, strict=False):
        x = [point[0] for point in each.points]
        y = [point[1] for point in each.points]
        ax.plot(x, y, color=colour, marker=marker, linestyle="", markersize=5, label=each.label)
        if each.law is not None:
            ends = [min(x), max(x)]
            words = f"exponent {each.law.exponent:.2f}"
            ax.plot(ends, [each.law(end) for end in ends], color=colour, linewidth=1, label=words)
    for claim in claims:
        marker = "v" if claim.at_most else "x"
        ax.plot([claim.size], [claim.seconds], color=OUTLINE_COLOUR, marker=marker, linestyle="",
                markersize=6, label=claim.label)  # fmt: skip
    ax.set_xscale("log")
    ax.set_yscale("log")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())
    name_axes(ax, size, "s")
    # Above, where it hides no point.
    ax.legend(fontsize=7, edgecolor="none", loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    return ax
