"""Walls side by side, small multiples as in Fig. 16 and Figs. B.30-B.32."""

from collections.abc import Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.drawing.pictures.wall import plot_wall
from drystone.model.wall import Wall
from drystone_lab.pictures.sheet import Panel, sheet_of

TitledWall = tuple[str, Wall, Mapping[int, int] | None]
"""What is written above a wall, the wall, and the cluster of each of its stones by id."""

MARGIN, GROUND = 0.015, 0.035
"""What pictures of walls leave beside and above them, over their width, and the depth of the ground
over their height or a fifth of their width."""


def plot_walls(walls: Sequence[TitledWall], columns: int) -> Figure:
    """Draw walls in rows, stones coloured by cluster and numbered in order, wedges dark red.

    Parameters
    ----------
    walls : sequence of (str, Wall, mapping or None)
        At least one: title (of lines, or ""), wall, and clusters by stone or None for stones in
        one colour.
    columns : int
        Walls in a row.

    Returns
    -------
    Figure
        An axes a wall, in their order, each in its own scale; px or m as in
        :func:`drystone.drawing.plot_wall`.

    Raises
    ------
    ValueError
        There is no wall, or no column.
    """
    return sheet_of([wall_panel(*wall) for wall in walls], columns)


def wall_panel(title: str, wall: Wall, clusters: Mapping[int, int] | None) -> Panel:
    """Return a wall as a panel of a sheet; see :func:`plot_walls`."""

    def draw(ax: Axes) -> Axes:
        return plot_wall(wall, clusters, ax)

    return Panel(title, wall_aspect(wall.site.height_px / wall.site.width_px), draw)


def wall_aspect(aspect: float) -> float:
    """Return height over width of a wall's picture, the ground included, from those of the wall.

    Examples
    --------
    >>> round(wall_aspect(0.5), 4)
    0.517
    """
    return (aspect + MARGIN + GROUND * max(aspect, 0.2)) / (1 + 2 * MARGIN)
