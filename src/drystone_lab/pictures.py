"""Charts of studies, of times and of forces that were measured; walls side by side on a sheet."""

from collections.abc import Callable, Mapping, Sequence
from statistics import median
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter
from scipy.stats import rankdata

from drystone.drawing.canvas import add, draw_block, fit_axes, name_axes
from drystone.drawing.drawing import GROUND, MARGIN
from drystone.drawing.drawing import ground as ground_below
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import CLUSTER_COLOURS, GREY, OUTLINE_COLOUR, WEDGE_COLOUR
from drystone.drawing.pictures.stones import plot_stones
from drystone.drawing.pictures.wall import plot_wall
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels, Wall
from drystone.planner.profile import Part, StepTime
from drystone_lab.timed_walls import fitted

LOOKS = (
    (CLUSTER_COLOURS[0], "o"), (WEDGE_COLOUR, "s"), (CLUSTER_COLOURS[12], "^"),
    (CLUSTER_COLOURS[3], "D"), (CLUSTER_COLOURS[10], "v"), (CLUSTER_COLOURS[15], "P"),
    (CLUSTER_COLOURS[1], "X"), (CLUSTER_COLOURS[14], "<"),
)  # fmt: skip
"""Colour and marker of a group, so that neither alone must be told apart; then round again."""

SPREAD = 0.28
"""Half the width of a strip; groups are 1 apart."""

GroupValues = Sequence[float | None]
"""A figure of several walls; None where a wall has none, which is left out."""


def panel_sheet(
    count: int, columns: int, panel_in: tuple[float, float], title: str = ""
) -> tuple[Figure, list[Axes]]:
    """Return a sheet with room for so many charts, a few in a row, and their axes."""
    rows = -(-count // columns)
    columns = -(-count // rows)
    size = (columns * panel_in[0], rows * panel_in[1] + 0.3)
    sheet = Figure(figsize=size, layout="constrained")
    panels = sheet.subplots(rows, columns, squeeze=False).ravel().tolist()
    for ax in panels[count:]:
        ax.remove()
    if title:
        sheet.suptitle(title, fontsize=9)
    return sheet, panels[:count]


def group_panels(
    figures: Mapping[str, Mapping[str, GroupValues]],
    *,
    title: str = "",
    claims: Mapping[str, Mapping[str, float]] | None = None,
) -> Figure:
    """Draw several figures of the same groups, a panel each: points in strips, medians as lines.

    >>> sheet = group_panels({"F_SF": {"rotation": [0.7, 0.8], "wedge": [0.6, None]}})
    >>> [text.get_text() for text in sheet.axes[0].get_xticklabels()]
    ['rotation', 'wedge']
    """
    sheet, panels = panel_sheet(len(figures), 4, (3.6, 2.7), title)
    for ax, (name, groups) in zip(panels, figures.items(), strict=True):
        _draw_groups(ax, groups, (claims or {}).get(name, {}))
        ax.set_ylabel(name, fontsize=8)
    return sheet


def _draw_groups(ax: Axes, groups: Mapping[str, GroupValues], claims: Mapping[str, float]) -> None:
    for place, (name, values) in enumerate(groups.items()):
        colour, marker = LOOKS[place % len(LOOKS)]
        found = [value for value in values if value is not None]
        x = [place + shift for shift in _shifts(found)]
        ax.plot(
            x, found, marker, color=colour, markersize=3.5, alpha=0.75,
            markeredgecolor=OUTLINE_COLOUR, markeredgewidth=0.3, gid=f"group-{name}",
        )  # fmt: skip
        if found:
            middle = median(found)
            ends = [place - 1.3 * SPREAD, place + 1.3 * SPREAD]
            ax.plot(ends, [middle, middle], color=OUTLINE_COLOUR, linewidth=1.6,
                    gid=f"median-{name}")  # fmt: skip
    places = {name: place for place, name in enumerate(groups)}
    for number, (name, value) in enumerate(claims.items()):
        ax.plot([places[name]], [value], "x", color=OUTLINE_COLOUR, markersize=7,
                label="the paper" if number == 0 else "_again", gid=f"claim-{name}")  # fmt: skip
    ax.set_xlim(-0.6, len(groups) - 0.4)
    longest = max((len(name) for name in groups), default=0)
    # Names of more letters than a strip is wide are turned, or they would run into each other.
    turned = longest * len(groups) > 42
    ax.set_xticks(
        range(len(groups)), list(groups), fontsize=7, rotation=30 if turned else 0,
        ha="right" if turned else "center",
    )  # fmt: skip
    ax.tick_params(axis="y", labelsize=7)
    ax.grid(axis="y", color=GREY, linewidth=0.3, alpha=0.5)
    if claims:
        ax.legend(fontsize=7, frameon=False, loc="lower right", bbox_to_anchor=(1.0, 1.0),
                  borderaxespad=0.2)  # fmt: skip


def plot_two_figures(
    groups: Mapping[str, tuple[GroupValues, GroupValues]], *, across: str, up: str
) -> Axes:
    """Draw one figure over another, a point a wall; large ones are medians of groups.

    A group is the figures to the right of its walls, and those upwards in the same order.
    """
    ax = Figure(figsize=(5.2, 3.8)).add_subplot()
    for place, (name, figures) in enumerate(groups.items()):
        colour, marker = LOOKS[place % len(LOOKS)]
        pairs = zip(*figures, strict=True)
        found = [(x, y) for x, y in pairs if x is not None and y is not None]
        x, y = [pair[0] for pair in found], [pair[1] for pair in found]
        ax.plot(
            x, y, marker, color=colour, markersize=4, alpha=0.7, markeredgecolor=OUTLINE_COLOUR,
            markeredgewidth=0.3, label=name, gid=f"group-{name}",
        )  # fmt: skip
        if found:
            ax.plot(
                [median(x)], [median(y)], marker, color=colour, markersize=9,
                markeredgecolor=OUTLINE_COLOUR, markeredgewidth=1.3, zorder=4,
                gid=f"median-{name}",
            )  # fmt: skip
    name_axes(ax, across, up)
    ax.grid(color=GREY, linewidth=0.3, alpha=0.5)
    # Above, where it hides no point.
    ax.legend(fontsize=7, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    return ax


def _shifts(values: Sequence[float]) -> list[float]:
    """Return where the points of a strip go beside its middle, neighbours in value apart.

    In the order of the values five columns take turns, so that the same values are always drawn at
    the same places.
    """
    ranks = rankdata(values, "ordinal").astype(int)
    return [SPREAD * (-1.0, 0.0, 0.5, -0.5, 1.0)[rank % 5] for rank in ranks]


PART_COLOURS: Mapping[Part, str] = {
    "placement": CLUSTER_COLOURS[0],
    "stabilisation": CLUSTER_COLOURS[5],
    "contacts": CLUSTER_COLOURS[7],
    "limit analysis": CLUSTER_COLOURS[1],
    "indices": CLUSTER_COLOURS[10],
}
"""Blue, green and shades of orange, as in Fig. 28, where the last three are one: selection."""

REST = "rest"


def step_time_panels(runs: Mapping[str, Sequence[StepTime]]) -> Figure:
    """Draw the time of every step as a bar, its parts on top of each other (Fig. 28).

    Walls are side by side, with one legend.
    """
    figure = Figure(figsize=(4.2 * len(runs), 3.2))
    panels = figure.subplots(1, len(runs), squeeze=False)[0]
    for ax, (title, steps) in zip(panels, runs.items(), strict=True):
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
    ax: Axes,
    series: Mapping[str, Sequence[tuple[float, float]]],
    claims: Sequence[tuple[str, str, float, float]],
) -> None:
    """Draw times over sizes, both logarithmic, with the power laws fitted to them (Fig. 29).

    A claim is what somebody else measured: a label, a marker, size and seconds.
    """
    for (label, points), (colour, marker) in zip(series.items(), LOOKS, strict=False):
        x, y = zip(*points, strict=True)
        ax.plot(x, y, color=colour, marker=marker, linestyle="", markersize=5, label=label)
        if (law := fitted(points)) is not None:
            ends = [min(x), max(x)]
            words = f"exponent {law.exponent:.2f}"
            times = [law.factor * end**law.exponent for end in ends]
            ax.plot(ends, times, color=colour, linewidth=1, label=words)
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


class Prediction(NamedTuple):
    """One measured value and what a model says of it."""

    series: str  # Kind of test; chooses the marker
    model: str  # Assumptions; choose the colour
    measured: float
    low: float  # low, predicted, high: Band and middle, in the same unit
    predicted: float
    high: float


def plot_predictions(predictions: Sequence[Prediction], band: str) -> Axes:
    """Draw predicted over measured forces, bands as bars."""
    ax = Figure(figsize=(6.0, 6.0)).add_subplot()
    models = dict.fromkeys(p.model for p in predictions)
    series = dict.fromkeys(p.series for p in predictions)
    colours = {name: colour for name, (colour, _) in zip(models, LOOKS, strict=False)}
    markers = {name: marker for name, (_, marker) in zip(series, LOOKS, strict=False)}
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


LEFT_IN, BELOW_IN = 0.4, 0.38
"""Beside a panel and below it, for its ticks."""

LINE_IN, ABOVE_IN = 0.16, 0.12
"""Above it: a line of its title, and some room."""


class Panel(NamedTuple):
    """A picture on a sheet."""

    title: str  # Written above, in lines, or ""
    aspect: float  # Height over width of what is drawn
    draw: Callable[[Axes], object] | None  # Draws it on axes; without it the place stays empty


EMPTY = Panel("", 0.0, None)
"""A place without a picture."""


def sheet_of(panels: Sequence[Panel], columns: int) -> Figure:
    """Draw panels in rows, all of one width.

    >>> figure = sheet_of([Panel("a", 0.5, lambda ax: ax.plot([1, 2])), EMPTY], 2)
    >>> [ax.get_title(loc="left") for ax in figure.axes]
    ['a']
    """
    columns = min(columns, len(panels))
    # The sheet is as wide as that where it leaves room for the panels.
    across = max(3.2, 11.0 / columns - LEFT_IN)
    rows = [panels[first : first + columns] for first in range(0, len(panels), columns)]
    above = [ABOVE_IN + LINE_IN * max(len(p.title.splitlines()) for p in row) for row in rows]
    tall = [across * max(panel.aspect for panel in row) for row in rows]
    width = columns * (across + LEFT_IN)
    height = sum(above) + sum(tall) + BELOW_IN * len(rows)
    figure = Figure(figsize=(width, height))
    bottom = height
    for row, up, high in zip(rows, above, tall, strict=True):
        bottom -= up + high
        for column, panel in enumerate(row):
            if panel.draw is None:
                continue
            left = LEFT_IN + column * (across + LEFT_IN)
            ax = figure.add_axes((left / width, bottom / height, across / width, high / height))
            # Pictures lower than their row hang from its title.
            ax.set_anchor("NW")
            panel.draw(ax)
            legend = ax.get_legend()
            if legend is not None:
                legend.remove()
            ax.tick_params(labelsize=6)
            ax.set_title(panel.title, fontsize=8, loc="left", pad=3)
        bottom -= BELOW_IN
    return figure


def wall_panel(title: str, wall: Wall, clusters: Mapping[int, int] | None) -> Panel:
    """Return a wall as a panel, stones coloured by cluster and numbered, wedges dark red."""
    aspect = wall_aspect(wall.site.height_px / wall.site.width_px)
    return Panel(title, aspect, lambda ax: plot_wall(wall, clusters, ax))


def stones_panel(title: str, stones: StoneSet, clusters: Mapping[int, int]) -> Panel:
    """Return the stones of a set as a panel, where they lie in its image, coloured by cluster."""
    aspect = wall_aspect(stones.source.height_px / stones.source.width_px)
    return Panel(title, aspect, lambda ax: plot_stones(stones, clusters, ax))


def wall_aspect(aspect: float) -> float:
    """Return height over width of a wall's picture, the ground included, from those of the wall.

    >>> round(wall_aspect(0.5), 4)
    0.517
    """
    return (aspect + MARGIN + GROUND * max(aspect, 0.2)) / (1 + 2 * MARGIN)


def plot_landscape(
    ax: Axes,
    labels: Labels,
    fill: str,
    *,
    fills: Mapping[int, str] = MappingProxyType({}),
    ground: float = 0.04,
    framed: bool = True,
    edgecolor: str = GREY,
    linewidth: float = 0.4,
) -> None:
    """Draw stones on the ground, y up, in working px, and the frame of their site, dashed.

    `fills` are the colours of single stones by id; `ground` is its depth over the height of the
    picture, or over a fifth of its width.
    """
    height, width = labels.shape
    depth = ground * max(height, 0.2 * width)
    fit_axes(ax, (-2.0, -depth, width + 2.0, height + 2.0))
    add(ax, ground_below((-2.0, -depth, width + 2.0, 0.0)))
    if framed:
        ax.add_patch(Rectangle((0, 0), width, height, fill=False, edgecolor=GREY, linewidth=0.6,
                               linestyle=(0, (5, 4)), gid="frame"))  # fmt: skip
    for region in label_regions(labels):
        draw_block(ax, region.loops, f"block-{region.id}", fill=fills.get(region.id, fill),
                   edgecolor=edgecolor, linewidth=linewidth)  # fmt: skip
    ax.set_xlabel("working px", fontsize=7, labelpad=1)
