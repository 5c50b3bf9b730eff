"""Figures of walls over the noise of their stones (Fig. 24)."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.drawing.palette import CLUSTER_COLOURS, GREY, OUTLINE_COLOUR

PANEL_IN = (3.9, 2.8)
COLUMNS = 2

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

Pairs = Sequence[tuple[int, float]]


@dataclass(frozen=True)
class NoisePanel:
    """One figure of many walls.

    Parameters
    ----------
    figure : str
        Which, with its unit; written at the axis.
    full, poor : sequence of (int, float)
        Noise in % and value of the walls filled above and below the threshold.
    reference, baseline : mapping of int to float
        By noise, drawn as lines.
    """

    figure: str
    full: Pairs
    poor: Pairs
    reference: Mapping[int, float]
    baseline: Mapping[int, float]


@dataclass(frozen=True)
class NoiseNames:
    """What the legend calls what is drawn."""

    full: str
    poor: str
    reference: str
    baseline: str


def plot_noise(panel: NoisePanel, names: NoiseNames, ax: Axes | None = None) -> Axes:
    """Draw a figure over the noise.

    Parameters
    ----------
    panel : NoisePanel
        What is drawn.
    names : NoiseNames
        For a legend.
    ax : Axes, optional
        Where to draw; None makes a figure.
    """
    ax = Figure(figsize=PANEL_IN).add_subplot() if ax is None else ax
    for name, pairs, look in ((names.full, panel.full, FULL), (names.poor, panel.poor, POOR)):
        seen: Counter[int] = Counter()
        x = []
        for noise, _ in pairs:
            x.append(noise + SHIFTS[seen[noise] % len(SHIFTS)])
            seen[noise] += 1
        ax.plot(
            x, [value for _, value in pairs], linestyle="", markersize=4, alpha=0.8,
            markeredgecolor=OUTLINE_COLOUR, markeredgewidth=0.3, label=name, gid=name, **look,
        )  # fmt: skip
    lines = (
        (names.reference, panel.reference, REFERENCE),
        (names.baseline, panel.baseline, BASELINE),
    )
    for name, line, look in lines:
        ax.plot(list(line), list(line.values()), label=name, gid=name, zorder=3, **look)
    ax.set_ylabel(panel.figure, fontsize=8)
    ax.set_xlabel("noise, %", fontsize=8)
    ax.tick_params(labelsize=7)
    ax.grid(axis="y", color=GREY, linewidth=0.3, alpha=0.5)
    return ax


def noise_panels(
    panels: Sequence[NoisePanel], names: NoiseNames, ticks: Mapping[int, str]
) -> Figure:
    """Draw several figures of the same walls, with one legend above.

    Parameters
    ----------
    panels : sequence of NoisePanel
        At least one.
    names : NoiseNames
        For the legend.
    ticks : mapping of int to str
        What is written at the axis of noise.
    """
    rows = -(-len(panels) // COLUMNS)
    sheet = Figure(figsize=(COLUMNS * PANEL_IN[0], rows * PANEL_IN[1]), layout="constrained")
    axes = sheet.subplots(rows, COLUMNS, squeeze=False).ravel().tolist()
    for ax, panel in zip(axes, panels, strict=False):
        plot_noise(panel, names, ax)
        ax.set_xticks(list(ticks), list(ticks.values()))
    for ax in axes[len(panels) :]:
        ax.remove()
    handles, labels = axes[0].get_legend_handles_labels()
    sheet.legend(handles, labels, fontsize=7, frameon=False, loc="outside upper center", ncols=4)
    return sheet
