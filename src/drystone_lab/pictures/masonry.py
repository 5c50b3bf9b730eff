"""A wall that is known from its label image alone, such as one that masons built (Fig. 13)."""

from collections.abc import Mapping

from matplotlib.axes import Axes

from drystone.drawing.canvas import draw_block, draw_ground, fit_axes
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import PLAIN_COLOUR, cluster_colour
from drystone.model.wall import Labels
from drystone_lab.pictures.sheet import Panel
from drystone_lab.pictures.wall_grid import wall_aspect


def plot_masonry(
    labels: Labels,
    clusters: Mapping[int, int] | None = None,
    ax: Axes | None = None,
    *,
    units_per_px: float = 1.0,
) -> Axes:
    """Draw the stones of a wall, coloured by cluster, on the ground.

    Parameters
    ----------
    labels : (h, w) integer array
        0 where nothing is; row 0 at the top, the ground below the last row.
    clusters : mapping of int to int, optional
        Cluster of each stone's id, from 1; None, or a stone that it does not name: one colour.
    ax : Axes, optional
        Where to draw; None makes a figure.
    units_per_px : float
        Source px in a px of the image.

    Returns
    -------
    ax : Axes
        In source px, y up from the ground.
    """
    height, width = (units_per_px * size for size in labels.shape)
    margin, depth = 0.015 * width, 0.035 * max(height, 0.2 * width)
    ax = fit_axes(ax, (-margin, -depth, width + margin, height + margin))
    draw_ground(ax, -margin, width + margin, depth)
    for region in label_regions(labels):
        cluster = (clusters or {}).get(region.id)
        fill = PLAIN_COLOUR if cluster is None else cluster_colour(cluster)
        loops = tuple(loop * units_per_px for loop in region.loops)
        draw_block(ax, loops, f"stone-{region.id}", fill=fill, zorder=1)
    ax.set_xlabel("px", fontsize=7, labelpad=1)
    return ax


def masonry_panel(
    title: str, labels: Labels, clusters: Mapping[int, int] | None, units_per_px: float
) -> Panel:
    """Return such a wall as a panel of a sheet; see :func:`plot_masonry`."""

    def draw(ax: Axes) -> Axes:
        return plot_masonry(labels, clusters, ax, units_per_px=units_per_px)

    return Panel(title, wall_aspect(labels.shape[0] / labels.shape[1]), draw)
