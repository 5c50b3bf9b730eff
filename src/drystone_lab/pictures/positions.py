"""Where a stone could go on a landscape, and what each position is worth (Fig. 8)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.patches import Patch, Rectangle
from numpy.typing import NDArray

from drystone.drawing.canvas import draw_block, draw_ground, fit_axes
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import GREY, OUTLINE_COLOUR
from drystone.kernels.lowering import Positions
from drystone.kernels.raster import Mask
from drystone.model.pose import PosedStone
from drystone.model.wall import Labels

BUILT = "#dedad2"
OPACITY = 0.85
VALUES = "cividis"
"""Colour map of values: even in lightness, the same for colour-blind readers."""


@dataclass(frozen=True, eq=False)
class Layer:
    """A set of positions of a mask.

    Parameters
    ----------
    positions : (h - h' + 1, w - w' + 1) bool array
        By row and column of the mask's top-left corner.
    colour : str
        Of the set.
    label : str
        Its meaning.
    """

    positions: Mask
    colour: str
    label: str


def plot_position_layers(
    labels: Labels, posed: PosedStone, layers: Sequence[Layer], ax: Axes | None = None
) -> Axes:
    """Draw sets of positions of a stone as areas; a position is where its centroid is.

    Parameters
    ----------
    labels : (h, w) integer array
        The landscape, row 0 at the top.
    posed : PosedStone
        The stone.
    layers : sequence of Layer
        Later ones cover earlier ones.
    ax : Axes, optional
        Where to draw; None makes a figure.

    Returns
    -------
    ax : Axes
        In working px, y up from the ground.
    """
    ax = _landscape(labels, ax)
    height = labels.shape[0]
    x, y = posed.anchor
    for layer in layers:
        rows, cols = layer.positions.shape
        image = np.zeros((rows, cols, 4))
        image[layer.positions] = to_rgba(layer.colour, OPACITY)
        top = height - posed.height_px + y + 0.5
        ax.imshow(image, extent=(x - 0.5, x + cols - 0.5, top - rows, top), zorder=3,
                  interpolation="nearest", gid=f"layer-{layer.label}")  # fmt: skip
    _show_all(ax, labels)
    handles = [Patch(facecolor=to_rgba(one.colour, OPACITY), label=one.label) for one in layers]
    ax.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(layers),
              fontsize=7, frameon=False, borderaxespad=0.1, handlelength=1.0)  # fmt: skip
    return ax


def plot_position_values(
    labels: Labels,
    posed: PosedStone,
    positions: Positions,
    values: NDArray[np.floating],
    chosen: tuple[int, int],
    ax: Axes | None = None,
) -> Axes:
    """Draw what positions of a stone are worth, and the stone where it was put.

    Parameters
    ----------
    labels, posed
        As for :func:`plot_position_layers`.
    positions : (n, 2) int array
        Row and column of the mask's top-left corner.
    values : (n,) float array
        Of each.
    chosen : (int, int)
        Row and column of the one that was taken.
    ax : Axes, optional
        Where to draw; None makes a figure.
    """
    ax = _landscape(labels, ax)
    height = labels.shape[0]
    stone = np.zeros(labels.shape, np.uint32)
    row, col = chosen
    stone[row : row + posed.height_px, col : col + posed.width_px] = posed.mask
    (region,) = label_regions(stone)
    draw_block(ax, region.loops, "chosen", fill="#ffffff", linewidth=1.4, zorder=2)
    x = positions[:, 1] + posed.anchor[0]
    y = height - positions[:, 0] - posed.height_px + posed.anchor[1]
    drawn = ax.scatter(x, y, c=values, cmap=VALUES, s=4, marker="s", linewidths=0, zorder=3,
                       gid="values")  # fmt: skip
    at = (col + posed.anchor[0], height - row - posed.height_px + posed.anchor[1])
    ax.plot(*at, "x", color="#d55e00", markersize=7, markeredgewidth=2, zorder=4, gid="best")
    bar = ax.figure.colorbar(drawn, ax=ax, fraction=0.02, pad=0.01)
    bar.set_label("LFR + H(GDS) - $x_c$/w", size=7)
    bar.ax.tick_params(labelsize=6, length=2)
    _show_all(ax, labels)
    return ax


def _landscape(labels: Labels, ax: Axes | None) -> Axes:
    height, width = labels.shape
    depth = _depth(labels)
    ax = fit_axes(ax, (-2.0, -depth, width + 2.0, height + 2.0))
    draw_ground(ax, -2.0, width + 2.0, depth)
    ax.add_patch(Rectangle((0, 0), width, height, fill=False, edgecolor=GREY, linewidth=0.6,
                           linestyle=(0, (5, 4)), gid="frame"))  # fmt: skip
    for region in label_regions(labels):
        draw_block(ax, region.loops, f"block-{region.id}", fill=BUILT, edgecolor=OUTLINE_COLOUR,
                   linewidth=0.3)  # fmt: skip
    ax.set_xlabel("working px", fontsize=7, labelpad=1)
    return ax


def _depth(labels: Labels) -> float:
    height, width = labels.shape
    return float(0.04 * max(height, 0.2 * width))


def _show_all(ax: Axes, labels: Labels) -> None:
    """Show the whole site: an image or dots would take the limits of the axes for their own."""
    height, width = labels.shape
    ax.set_xlim(-2.0, width + 2.0)
    ax.set_ylim(-_depth(labels), height + 2.0)
    ax.set_aspect("equal")
