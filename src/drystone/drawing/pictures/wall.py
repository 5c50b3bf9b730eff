"""The wall as planned: clusters, order of placement, wedges, how it falls; walls to choose from."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.drawing.canvas import add, draw, fit_axes, name_axes, save
from drystone.drawing.drawing import Surface, drawing_of_wall, step_by_id
from drystone.drawing.palette import CLUSTER_COLOURS
from drystone.drawing.pictures.mechanism import plot_mechanism
from drystone.model.wall import Wall
from drystone.statics.model import Direction
from drystone.statics.result import LateralResistance, LimitStatus

COLUMNS = 3
PANEL_IN = 3.2  # width of the picture of a wall to choose
AXES = (("F_SF", "F_LR"), ("F_AV", "F_AH"))  # what is drawn against what
DIGITS = {"F_SF": 3, "F_AV": 1, "F_AH": 2, "F_LR": 2}

PICTURE = "picture.png"
MECHANISMS: dict[Direction, str] = {"left": "mechanism_left.png", "right": "mechanism_right.png"}

WallFigures = Mapping[str, float | None]


def plot_wall(
    wall: Wall,
    clusters: Mapping[int, int] | None = None,
    ax: Axes | None = None,
    *,
    title: str = "",
) -> Axes:
    """Draw a wall: stones coloured by cluster and numbered in order of placement, wedges red.

    The number of a stone is its step in the plan, where each wedge is a step too.  `clusters` are
    those of stones by id, from 1; None draws all in one colour.  The axes are in the plan's units:
    source px, or metres when the site has a scale.
    """
    return draw(drawing_of_wall(wall, clusters, title), ax)


def plot_choice(walls: Sequence[Wall], figures: Sequence[WallFigures]) -> Figure:
    """Draw walls with their figures of merit, numbered from 1, and these against each other.

    The walls are of one size; F_LR is drawn over F_SF and F_AH over F_AV.
    """
    rows = -(-len(walls) // COLUMNS)
    site = walls[0].site
    wall_in = max(0.6, PANEL_IN * site.height_px / site.width_px) + 0.45
    figure = Figure(figsize=(COLUMNS * PANEL_IN, rows * wall_in + PANEL_IN), layout="constrained")
    parts = figure.subfigures(2, 1, squeeze=False, height_ratios=(rows * wall_in, PANEL_IN))
    above, below = parts[:, 0]
    panels = above.subplots(rows, COLUMNS, squeeze=False).ravel().tolist()
    for number, (ax, wall, values) in enumerate(zip(panels, walls, figures, strict=False), 1):
        drawing = drawing_of_wall(wall)
        x0, _, x1, y1 = drawing.box
        fit_axes(ax, (x0, -0.01 * y1, x1, y1)).set_axis_off()
        areas = [item for item in drawing.items if isinstance(item, Surface) and not item.hatch]
        add(ax, areas)
        words = "  ".join(
            f"{name} {'-' if values[name] is None else format(values[name], f'.{count}f')}"
            for name, count in DIGITS.items()
        )
        ax.set_title(f"{number:02}  {words}", fontsize=7, loc="left", pad=3)
    for ax in panels[len(walls) :]:
        ax.remove()
    for ax, (across, up) in zip(below.subplots(1, len(AXES)), AXES, strict=True):
        for number, values in enumerate(figures, 1):
            x, y = values[across], values[up]
            if x is not None and y is not None:
                ax.plot([x], [y], "o", color=CLUSTER_COLOURS[0], markersize=4)
                ax.annotate(f"{number:02}", (x, y), xytext=(3, 3), textcoords="offset points",
                            fontsize=7)  # fmt: skip
        name_axes(ax, across, up)
    return figure


def write_pictures(
    folder: str | Path,
    wall: Wall,
    clusters: Mapping[int, int] | None = None,
    *,
    resistance: LateralResistance | None = None,
) -> None:
    """Write picture.png, and mechanism_left.png and mechanism_right.png where they exist (§2).

    A picture of a mechanism that an earlier run left in the folder is removed when this wall has
    none: it would belong to another wall.
    """
    folder = Path(folder)
    save(plot_wall(wall, clusters).figure, folder / PICTURE)
    for direction, name in MECHANISMS.items():
        path = folder / name
        result = None if resistance is None else getattr(resistance, direction)
        if result is None or result.mechanism is None:
            path.unlink(missing_ok=True)
            continue
        side = None if result.status is LimitStatus.UNSTABLE else result.direction
        shown = wall.labels if wall.outlines is None else dict(wall.outlines.blocks)
        ax = plot_mechanism(shown, result.mechanism, side, result.alpha, numbers=step_by_id(wall))
        save(ax.figure, path)
