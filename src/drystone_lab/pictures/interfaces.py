"""From pixels to rigid blocks: boundary edges with their normals, and the blocks (Fig. 12)."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from numpy.typing import NDArray

from drystone.drawing.canvas import draw_block, draw_ground, draw_legend, fit_axes
from drystone.drawing.drawing import Lines
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import GREY, PALE
from drystone.drawing.pictures.contacts import JOINT, NORMAL, plot_contacts
from drystone.model.wall import Labels
from drystone.statics.model import RigidBlockModel

CENTRE = "#0072b2"
NORMAL_PX = 2.5
"""Length of the normal of a pixel edge."""


def plot_boundary_edges(
    labels: Labels,
    starts: NDArray[np.floating],
    ends: NDArray[np.floating],
    ax: Axes | None = None,
) -> Axes:
    """Draw the pixel edges on which blocks touch, each with its normal.

    Parameters
    ----------
    labels : (h, w) integer array
        Row 0 at the top; the wall stands on the last row.
    starts, ends : (n, 2) float arrays
        Ends (x, y) of each edge, px, y up from the ground; the normal is to the left of the way
        from start to end.
    ax : Axes, optional
        Where to draw; None makes a figure.
    """
    height, width = labels.shape
    depth = 0.06 * max(height, 0.2 * width)
    ax = fit_axes(ax, (-2.0, -depth, width + 2.0, height + 2.0))
    ax.set_axis_off()
    draw_ground(ax, -2.0, width + 2.0, depth)
    for region in label_regions(labels):
        draw_block(ax, region.loops, f"block-{region.id}", fill=PALE, edgecolor=GREY, linewidth=0.4)
    way = ends - starts
    normals = np.column_stack([-way[:, 1], way[:, 0]])
    middles = (starts + ends) / 2.0
    edges = np.stack([starts, ends], axis=1)
    arrows = np.stack([middles, middles + NORMAL_PX * normals], axis=1)
    for lines, colour, thick, gid in (
        (edges, JOINT, 1.6, "edges"),
        (arrows, NORMAL, 0.6, "normals"),
    ):
        drawn = LineCollection(list(lines), colors=colour, linewidths=thick, gid=gid, zorder=4)
        ax.add_collection(drawn, autolim=False)
    legend = {
        "pixel edge between blocks": Lines("", [], JOINT, 1.6),
        "its normal": Lines("", [], NORMAL, 0.8),
    }
    draw_legend(ax, legend)
    return ax


def plot_blocks(labels: Labels, model: RigidBlockModel, ax: Axes | None = None) -> Axes:
    """Draw rigid blocks: interfaces, their ends and normals, and the centres of mass.

    Parameters
    ----------
    labels : (h, w) integer array
        Row 0 at the top.
    model : RigidBlockModel
        Of this image.
    ax : Axes, optional
        Where to draw; None makes a figure.
    """
    ax = plot_contacts(labels, model, ax)
    for block in model.blocks:
        ax.plot(*block.centroid, "^", color=CENTRE, markersize=7, gid=f"centre-{block.id}",
                zorder=5)  # fmt: skip
    return ax
