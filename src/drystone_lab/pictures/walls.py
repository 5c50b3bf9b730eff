"""Walls side by side on a sheet, each with a title."""

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from drystone.drawing.canvas import add, draw_block, fit_axes
from drystone.drawing.drawing import ground as ground_below
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import GREY, PLAIN_COLOUR, cluster_colour
from drystone.drawing.pictures.stones import plot_stones
from drystone.drawing.pictures.wall import plot_wall
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels, Wall

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


TitledWall = tuple[str, Wall, Mapping[int, int] | None]
"""What is written above a wall, the wall, and the cluster of each of its stones by id."""

MARGIN, GROUND = 0.015, 0.035
"""What pictures of walls leave beside and above them, over their width, and the depth of the ground
over their height or a fifth of their width."""


def plot_walls(walls: Sequence[TitledWall], columns: int) -> Figure:
    """Draw walls in rows, stones coloured by cluster and numbered in order, wedges dark red."""
    return sheet_of([wall_panel(*wall) for wall in walls], columns)


def wall_panel(title: str, wall: Wall, clusters: Mapping[int, int] | None) -> Panel:
    """Return a wall as a panel of a sheet; see :func:`plot_walls`."""
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


def masonry_panel(
    title: str, labels: Labels, clusters: Mapping[int, int], units_per_px: float
) -> Panel:
    """Return the stones of a wall on the ground as a panel, coloured by cluster.

    In source px, y up from the ground, which is below the last row of `labels` (row 0 at the top).
    """
    height, width = (units_per_px * size for size in labels.shape)
    margin, depth = MARGIN * width, GROUND * max(height, 0.2 * width)

    def draw(ax: Axes) -> None:
        ax = fit_axes(ax, (-margin, -depth, width + margin, height + margin))
        add(ax, ground_below((-margin, -depth, width + margin, 0.0)))
        for region in label_regions(labels):
            cluster = clusters.get(region.id)
            fill = PLAIN_COLOUR if cluster is None else cluster_colour(cluster)
            loops = tuple(loop * units_per_px for loop in region.loops)
            draw_block(ax, loops, f"stone-{region.id}", fill=fill, zorder=1)
        ax.set_xlabel("px", fontsize=7, labelpad=1)

    return Panel(title, wall_aspect(labels.shape[0] / labels.shape[1]), draw)
