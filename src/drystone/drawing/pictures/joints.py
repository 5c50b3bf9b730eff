"""The shortest paths along joints (Fig. 17)."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from drystone.drawing.canvas import draw_block, fit_axes
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import GREY, WEDGE_COLOUR
from drystone.model.wall import Labels


def plot_joint_paths(
    labels: Labels, paths: Sequence[NDArray[np.integer]], ax: Axes | None = None
) -> Axes:
    """Draw the paths of the alignment factors F_AV and F_AH over the stones (Fig. 17).

    Parameters
    ----------
    labels : (h, w) integer array
        The wall; row 0 at the top.
    paths : sequence of (n, 2) integer arrays
        Pixels (row, col) of each path; rows and columns just outside of the image are allowed.
    ax : Axes, optional
        Where to draw; None makes a figure.

    Returns
    -------
    ax : Axes
        In px, y up from the image's bottom edge.
    """
    height, width = labels.shape
    ax = fit_axes(ax, (-2, -3, width + 2, height + 2))
    for region in label_regions(labels):
        draw_block(
            ax, region.loops, f"block-{region.id}", fill="#e4e0d8", edgecolor=GREY, linewidth=0.4
        )
    for number, path in enumerate(paths, 1):
        rows, cols = np.asarray(path).T
        ax.plot(
            cols + 0.5,
            height - rows - 0.5,
            color=WEDGE_COLOUR,
            linewidth=1.6,
            alpha=0.75,
            solid_joinstyle="round",
            solid_capstyle="round",
            gid=f"path-{number}",
        )
    ax.set_xlabel("px", fontsize=7, labelpad=1)
    return ax
