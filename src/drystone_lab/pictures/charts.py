"""Figures of many walls: by group, over the noise of their stones, by version."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.drawing.palette import CLUSTER_COLOURS, GREY, OUTLINE_COLOUR, WEDGE_COLOUR

LOOKS = (
    (CLUSTER_COLOURS[0], "o"), (WEDGE_COLOUR, "s"), (CLUSTER_COLOURS[12], "^"),
    (CLUSTER_COLOURS[3], "D"), (CLUSTER_COLOURS[10], "v"), (CLUSTER_COLOURS[15], "P"),
    (CLUSTER_COLOURS[1], "X"), (CLUSTER_COLOURS[14], "<"),
)  # fmt: skip
"""Colour and marker of a group, so that neither alone must be told apart; then round again."""

PANEL_IN = (3.6, 2.7)
TWO_IN = (5.2, 3.8)
COLUMNS = 4
"""Panels in a row at most."""

SPREAD = 0.28
"""Half the width of a strip; groups are 1 apart."""

GroupValues = Sequence[float | None]
"""A figure of several walls; None where a wall has none, which is left out."""

Pairs = Sequence[tuple[float | None, float | None]]


def name_axes(ax: Axes, across: str, up: str) -> None:
    """Write what is drawn at both axes of a chart."""
    ax.set_xlabel(across, fontsize=8)
    ax.set_ylabel(up, fontsize=8)
    ax.tick_params(labelsize=7)


def figure_of(ax: Axes) -> Figure:
    """Return the figure whose axes these are."""
    figure = ax.get_figure(root=True)
    assert figure is not None  # noqa: S101 - it was made for the axes
    return figure


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


def plot_groups(
    groups: Mapping[str, GroupValues],
    ax: Axes | None = None,
    *,
    figure: str = "",
    claims: Mapping[str, float] | None = None,
) -> Axes:
    """Draw the values of each group as a strip of points, and its median as a line.

    >>> ax = plot_groups({"rotation": [0.7, 0.8], "wedge": [0.6, None]}, figure="F_SF")
    >>> [text.get_text() for text in ax.get_xticklabels()]
    ['rotation', 'wedge']
    """
    ax = Figure(figsize=PANEL_IN).add_subplot() if ax is None else ax
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
    for number, (name, value) in enumerate((claims or {}).items()):
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
    ax.set_ylabel(figure, fontsize=8)
    ax.tick_params(axis="y", labelsize=7)
    ax.grid(axis="y", color=GREY, linewidth=0.3, alpha=0.5)
    if claims:
        ax.legend(fontsize=7, frameon=False, loc="lower right", bbox_to_anchor=(1.0, 1.0),
                  borderaxespad=0.2)  # fmt: skip
    return ax


def group_panels(
    figures: Mapping[str, Mapping[str, GroupValues]],
    *,
    title: str = "",
    claims: Mapping[str, Mapping[str, float]] | None = None,
) -> Figure:
    """Draw several figures of the same groups, a panel each."""
    sheet, panels = panel_sheet(len(figures), COLUMNS, PANEL_IN, title)
    for ax, (name, groups) in zip(panels, figures.items(), strict=True):
        plot_groups(groups, ax, figure=name, claims=(claims or {}).get(name))
    return sheet


def plot_two_figures(
    groups: Mapping[str, Pairs], ax: Axes | None = None, *, across: str, up: str
) -> Axes:
    """Draw one figure over another, a point a wall; large ones are medians of groups."""
    ax = Figure(figsize=TWO_IN).add_subplot() if ax is None else ax
    for place, (name, pairs) in enumerate(groups.items()):
        colour, marker = LOOKS[place % len(LOOKS)]
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
    columns = (0.0, 0.5, -0.5, 1.0, -1.0) if len(values) > 1 else (0.0,)
    shifts = [0.0] * len(values)
    for rank, place in enumerate(sorted(range(len(values)), key=values.__getitem__)):
        shifts[place] = SPREAD * columns[rank % len(columns)]
    return shifts


FULL: dict[str, Any] = {"marker": "o", "color": CLUSTER_COLOURS[0]}
POOR: dict[str, Any] = {"marker": "^", "color": CLUSTER_COLOURS[1]}
"""Walls above and below the threshold of filling: blue points and yellow triangles."""

REFERENCE: dict[str, Any] = {
    "linestyle": (0, (5, 3)), "linewidth": 1.3, "marker": "s", "markersize": 3.5,
    "color": CLUSTER_COLOURS[12],
}  # fmt: skip
BASELINE: dict[str, Any] = {
    "linestyle": "dotted", "linewidth": 1.2, "marker": "x", "markersize": 4, "color": OUTLINE_COLOUR
}  # fmt: skip

SHIFTS = (0.0, 1.4, -1.4, 2.8, -2.8)
"""Walls of one level in turn, so that they do not hide each other; % of noise."""

NoisePairs = Sequence[tuple[int, float]]


@dataclass(frozen=True)
class NoisePanel:
    """One figure of many walls."""

    figure: str  # Which, with its unit; written at the axis
    # full, poor: Noise in % and value of the walls filled above and below the threshold
    full: NoisePairs
    poor: NoisePairs
    reference: Mapping[int, float]
    baseline: Mapping[int, float]


NoiseNames = tuple[str, str, str, str]
"""What the legend calls full and poor walls, the reference and the baseline."""


def noise_panels(
    panels: Sequence[NoisePanel], names: NoiseNames, ticks: Mapping[int, str]
) -> Figure:
    """Draw several figures of the same walls over the noise, with one legend above."""
    sheet, axes = panel_sheet(len(panels), 2, (3.9, 2.8))
    for ax, panel in zip(axes, panels, strict=True):
        _plot_noise(ax, panel, names)
        ax.set_xticks(list(ticks), list(ticks.values()))
    handles, labels = axes[0].get_legend_handles_labels()
    sheet.legend(handles, labels, fontsize=7, frameon=False, loc="outside upper center", ncols=4)
    return sheet


def _plot_noise(ax: Axes, panel: NoisePanel, names: NoiseNames) -> None:
    full, poor, reference, baseline = names
    for name, pairs, look in ((full, panel.full, FULL), (poor, panel.poor, POOR)):
        seen: Counter[int] = Counter()
        x = []
        for noise, _ in pairs:
            x.append(noise + SHIFTS[seen[noise] % len(SHIFTS)])
            seen[noise] += 1
        ax.plot(
            x, [value for _, value in pairs], linestyle="", markersize=4, alpha=0.8,
            markeredgecolor=OUTLINE_COLOUR, markeredgewidth=0.3, label=name, gid=name, **look,
        )  # fmt: skip
    for name, line, look in (
        (reference, panel.reference, REFERENCE),
        (baseline, panel.baseline, BASELINE),
    ):
        ax.plot(list(line), list(line.values()), label=name, gid=name, zorder=3, **look)
    name_axes(ax, "noise, %", panel.figure)
    ax.grid(axis="y", color=GREY, linewidth=0.3, alpha=0.5)


VersionLines = Mapping[str, Sequence[float | None]]
"""By method: a value a version, None where there is none."""


def plot_history(ax: Axes, versions: Sequence[str], lines: VersionLines, figure: str) -> None:
    """Draw a figure over versions, a line a method; dashed where colours come round again."""
    for number, (method, values) in enumerate(lines.items()):
        turn, place = divmod(number, len(LOOKS))
        colour, marker = LOOKS[place]
        points = [(x, value) for x, value in enumerate(values) if value is not None]
        ax.plot(
            [x for x, _ in points], [value for _, value in points], color=colour, marker=marker,
            markersize=4.5, linewidth=1, linestyle="--" if turn else "-", label=method,
        )  # fmt: skip
    ax.set_xticks(range(len(versions)), versions)
    ax.set_xlim(-0.4, len(versions) - 0.6)
    name_axes(ax, "version", figure)


def history_panels(
    versions: Sequence[str], figures: Mapping[str, VersionLines], title: str
) -> Figure:
    """Draw several figures over versions, with one legend."""
    sheet, panels = panel_sheet(len(figures), 3, (3.4, 2.4), title)
    for ax, (name, lines) in zip(panels, figures.items(), strict=True):
        plot_history(ax, versions, lines, name)
    handles, labels = panels[0].get_legend_handles_labels()
    sheet.legend(
        handles, labels, fontsize=7, edgecolor="none", loc="outside lower center",
        ncols=min(len(labels), 8),
    )  # fmt: skip
    return sheet
