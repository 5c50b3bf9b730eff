"""wall-numbered.png: the wall with the numbers of the steps."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.canvas import draw_block, draw_ground, fit_axes, write_number
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.files import save
from drystone.drawing.lettering import drawable, fitted
from drystone.drawing.palette import GREY, PLAIN_COLOUR, WEDGE_COLOUR
from drystone.kernels.polygons import Points

NAME = "wall-numbered.png"
DPI = 200
TITLE_PT = 9.0

WEDGE_OFFSETS_PT = ((10.0, 9.0), (-10.0, 9.0), (10.0, -9.0), (-10.0, -9.0))
"""Where the number of a wedge may be, from its middle."""


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written."""
    return (NAME,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:
    """Write the picture."""
    path = folder / NAME
    save(plot_numbered(assembly, title=settings.title).figure, path, DPI)
    return (path,)


def plot_numbered(assembly: Assembly, ax: Axes | None = None, *, title: str = "") -> Axes:
    """Draw a wall in one colour, with the step of every stone and wedge.

    Parameters
    ----------
    assembly : Assembly
        The wall.
    ax : Axes, optional
        Where to draw; None makes a figure.
    title : str
        Written above; what is wider than the wall is cut.

    Returns
    -------
    ax : Axes
        In the unit of the assembly.
    """
    width, height = assembly.size
    margin, depth = 0.015 * width, 0.035 * max(height, 0.2 * width)
    ax = fit_axes(ax, (-margin, -depth, width + margin, height + margin))
    draw_ground(ax, -margin, width + margin, depth)
    ax.add_patch(
        Rectangle((0, 0), width, height, fill=False, edgecolor=GREY, linewidth=0.9,
                  linestyle=(0, (5, 4)), gid="frame", zorder=3)
    )  # fmt: skip
    draw_parts(ax, assembly)
    ax.set_xlabel(assembly.unit, fontsize=7, labelpad=1)
    if title:
        room = ax.get_window_extent().width * 72.0 / ax.figure.dpi
        said = fitted(drawable(title), TITLE_PT, room)
        ax.set_title(said, fontsize=TITLE_PT, loc="left", pad=4, parse_math=False)
    return ax


def draw_parts(
    ax: Axes,
    assembly: Assembly,
    per_unit: float = 1.0,
    origin: tuple[float, float] = (0.0, 0.0),
) -> None:
    """Draw numbered stones and wedges.

    Parameters
    ----------
    ax : Axes
        Of equal scales.
    assembly : Assembly
        The wall.
    per_unit : float
        Units of the axes in one of the assembly.
    origin : (float, float)
        The wall's lower left corner in the axes.
    """
    for part in assembly.parts:
        loop = part.corners * per_unit + origin
        wedge = part.kind == "wedge"
        fill = WEDGE_COLOUR if wedge else PLAIN_COLOUR
        draw_block(ax, [loop], part.name, fill=fill, zorder=2 if wedge else 1)
        if not wedge:
            x, y = part.centroid
            place = origin[0] + x * per_unit, origin[1] + y * per_unit
            write_number(ax, part.step, place, [loop], fill)
    # Where numbers of stones are, in points of the page: a wedge's number stays away from them.
    ax.apply_aspect()
    stones = [np.array(part.centroid) * per_unit + origin for part in assembly.stones]
    taken, ground = _in_points(ax, stones), _in_points(ax, [np.array(origin)])[0, 1] + 4.0
    for part in assembly.wedges:
        loop = part.corners * per_unit + origin
        away = _in_points(ax, [loop.mean(axis=0)])[0] + np.array(WEDGE_OFFSETS_PT)
        free = [
            float(np.hypot(*(taken - place).T).min(initial=1e9)) if place[1] > ground else 0.0
            for place in away
        ]
        _number_wedge(ax, part, loop, WEDGE_OFFSETS_PT[int(np.argmax(free))])


def _in_points(ax: Axes, places: list[Points]) -> Points:
    pixels = ax.transData.transform(np.array(places).reshape(-1, 2))
    return np.asarray(pixels * 72.0 / ax.figure.dpi)


def _number_wedge(ax: Axes, part: Part, loop: Points, offset: tuple[float, float]) -> None:
    """Write the number of a wedge beside it, in its colour: it is too small to hold one."""
    x, y = loop.mean(axis=0).tolist()
    ax.annotate(
        str(part.step), (x, y), offset, textcoords="offset points", size=6.5, weight="bold",
        color=WEDGE_COLOUR, ha="center", va="center", zorder=6, gid=f"number-{part.name}",
        path_effects=[withStroke(linewidth=1.4, foreground="white")],
        arrowprops={"arrowstyle": "-", "linewidth": 0.6, "color": WEDGE_COLOUR, "shrinkA": 3,
                    "shrinkB": 0},
    )  # fmt: skip
