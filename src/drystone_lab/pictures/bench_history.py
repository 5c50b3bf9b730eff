"""Figures of a benchmark by version: a panel a figure, a line a method."""

from collections.abc import Mapping, Sequence
from math import ceil

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.drawing.palette import CLUSTER_COLOURS, OUTLINE_COLOUR

LINES = (
    (CLUSTER_COLOURS[0], "o"), ("#8b0000", "s"), (CLUSTER_COLOURS[12], "^"),
    (CLUSTER_COLOURS[3], "D"), (CLUSTER_COLOURS[10], "v"), (CLUSTER_COLOURS[13], "P"),
    (OUTLINE_COLOUR, "X"), (CLUSTER_COLOURS[6], "<"),
)  # fmt: skip
"""Colour and marker by method; they come round again with a dashed line after the last."""

PANEL_IN = (3.4, 2.4)
ACROSS = 3

Lines = Mapping[str, Sequence[float | None]]
"""By method: a value a version, None where there is none."""


def plot_history(
    versions: Sequence[str], lines: Lines, ax: Axes | None = None, *, figure: str = ""
) -> Axes:
    """Draw a figure over versions, a line a method.

    Parameters
    ----------
    versions : sequence of str
        Oldest first.
    lines : mapping of str to sequence of float or None
        By method, a value a version.
    ax : Axes, optional
        Where to draw; None makes a figure.
    figure : str
        What it is, with its unit, written at the axis.
    """
    ax = Figure(figsize=PANEL_IN).add_subplot() if ax is None else ax
    for number, (method, values) in enumerate(lines.items()):
        turn, place = divmod(number, len(LINES))
        colour, marker = LINES[place]
        points = [(x, value) for x, value in enumerate(values) if value is not None]
        ax.plot(
            [x for x, _ in points], [value for _, value in points], color=colour, marker=marker,
            markersize=4.5, linewidth=1, linestyle="--" if turn else "-", label=method,
        )  # fmt: skip
    ax.set_xticks(range(len(versions)), versions)
    ax.set_xlim(-0.4, len(versions) - 0.6)
    ax.set_xlabel("version", fontsize=8)
    ax.set_ylabel(figure, fontsize=8)
    ax.tick_params(labelsize=7)
    return ax


def history_panels(versions: Sequence[str], figures: Mapping[str, Lines], title: str) -> Figure:
    """Draw several figures over versions, with one legend.

    Parameters
    ----------
    versions : sequence of str
        Oldest first.
    figures : mapping of str to lines
        By figure with its unit, at least one; the same methods in each.
    title : str
        Above them.
    """
    across = min(ACROSS, len(figures))
    down = ceil(len(figures) / across)
    whole = Figure(figsize=(PANEL_IN[0] * across, PANEL_IN[1] * down + 0.4))
    panels = whole.subplots(down, across, squeeze=False).ravel().tolist()
    for ax, (name, lines) in zip(panels, figures.items(), strict=False):
        plot_history(versions, lines, ax, figure=name)
    for empty in panels[len(figures) :]:
        whole.delaxes(empty)
    handles, labels = panels[0].get_legend_handles_labels()
    whole.suptitle(title, fontsize=9)
    whole.tight_layout()
    # Below, where it hides no panel.
    whole.legend(
        handles, labels, fontsize=7, edgecolor="none", loc="upper center",
        bbox_to_anchor=(0.5, 0.0), ncols=min(len(labels), 8),
    )  # fmt: skip
    return whole
