"""Walls to choose from, side by side, and their figures of merit."""

from collections.abc import Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.drawing.canvas import draw_block, fit_axes
from drystone.drawing.palette import CLUSTER_COLOURS, GREY, PLAIN_COLOUR, WEDGE_COLOUR
from drystone.drawing.pictures.wall import wall_loops
from drystone.model.wall import Wall

COLUMNS = 3
PANEL_IN = 3.2
"""Width of the picture of a wall."""

AXES = (("F_SF", "F_LR"), ("F_AV", "F_AH"))
"""What is drawn against what."""

Figures = Mapping[str, float | None]


def plot_choice(walls: Sequence[Wall], figures: Sequence[Figures]) -> Figure:
    """Draw walls with their figures of merit, numbered from 1, and these against each other.

    Parameters
    ----------
    walls : sequence of Wall
        At least one, all of one size.
    figures : sequence of mapping of str to float or None
        F_SF, F_AV, F_AH and F_LR of each.

    Returns
    -------
    figure : Figure
        Its axes are those of the walls, then F_LR over F_SF and F_AH over F_AV.
    """
    rows = -(-len(walls) // COLUMNS)
    site = walls[0].site
    wall_in = max(0.6, PANEL_IN * site.height_px / site.width_px) + 0.45
    figure = Figure(figsize=(COLUMNS * PANEL_IN, rows * wall_in + PANEL_IN), layout="constrained")
    parts = figure.subfigures(2, 1, squeeze=False, height_ratios=(rows * wall_in, PANEL_IN))
    above, below = parts[:, 0]
    panels = above.subplots(rows, COLUMNS, squeeze=False).ravel().tolist()
    for number, (ax, wall, values) in enumerate(zip(panels, walls, figures, strict=False), 1):
        _draw_wall(ax, wall)
        ax.set_title(f"{number:02}  {_words(values)}", fontsize=7, loc="left", pad=3)
    for ax in panels[len(walls) :]:
        ax.remove()
    for ax, (across, up) in zip(below.subplots(1, len(AXES)), AXES, strict=True):
        _draw_figures(ax, figures, across, up)
    return figure


def _draw_wall(ax: Axes, wall: Wall) -> None:
    unit = wall.site.units_per_px
    width, height = wall.site.width_px * unit, wall.site.height_px * unit
    fit_axes(ax, (-0.01 * width, -0.01 * height, 1.01 * width, 1.04 * height))
    ax.set_axis_off()
    ax.plot([0, width, width, 0, 0], [0, 0, height, height, 0], color=GREY, linewidth=0.6)
    wedges = {wedge.id for wedge in wall.wedges}
    for block, loops in wall_loops(wall).items():
        fill = WEDGE_COLOUR if block in wedges else PLAIN_COLOUR
        draw_block(ax, loops, f"block-{block}", fill=fill, linewidth=0.4)


def _draw_figures(ax: Axes, figures: Sequence[Figures], across: str, up: str) -> None:
    for number, values in enumerate(figures, 1):
        x, y = values[across], values[up]
        if x is None or y is None:
            continue
        ax.plot([x], [y], "o", color=CLUSTER_COLOURS[0], markersize=4)
        ax.annotate(f"{number:02}", (x, y), xytext=(3, 3), textcoords="offset points", fontsize=7)
    ax.set_xlabel(across, fontsize=8)
    ax.set_ylabel(up, fontsize=8)
    ax.tick_params(labelsize=7)


def _words(values: Figures) -> str:
    digits = {"F_SF": 3, "F_AV": 1, "F_AH": 2, "F_LR": 2}
    return "  ".join(
        f"{name} {'-' if values[name] is None else format(values[name], f'.{count}f')}"
        for name, count in digits.items()
    )
