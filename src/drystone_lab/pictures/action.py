"""One stone on the landscape, with what its indices measure (Fig. 6, Fig. 7)."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke

from drystone.drawing.canvas import draw_block, draw_ground, fit_axes
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import GREY, OUTLINE_COLOUR
from drystone.kernels.raster import Mask
from drystone.model.landscape import Box, view_box
from drystone.model.pose import PosedStone
from drystone.model.wall import Labels

Mark = Literal["box", "rays", "begun", "neighbour", "joints", "slope"]
"""What the indices SF, LFR, GDS, NHR, IWR and IS measure, in this order."""

BUILT = "#e4e0d8"
STONE, NEIGHBOUR, BELOW, RAYS, BEGUN = "#d55e00", "#009e73", "#56b4e9", "#f0e442", "#0072b2"
"""Okabe and Ito's colours, apart for colour-blind readers; roles as in Fig. 7."""

PointXY = tuple[float, float]


@dataclass(frozen=True)
class NeighbourBox:
    """A placed stone that an index looks at."""

    id: int
    box: Box


@dataclass(frozen=True, eq=False)
class ActionView:
    """A stone at a place, and what its indices measure; working px, building side on the left."""

    labels: Labels  # The landscape before the stone, row 0 at the top
    posed: PosedStone  # The stone
    row: int  # row, col: Top-left corner of its mask
    col: int
    swept: Mask
    built_height: int  # Height of the box B of the landscape
    neighbour: NeighbourBox | None  # Left neighbour in its course
    below: tuple[NeighbourBox | None, NeighbourBox | None]  # below1 and below2
    # Columns of the mask in which the highest points of its halves are
    peaks: tuple[int, int] | None

    @property
    def box(self) -> Box:
        """Bounding box of the stone, y up from the ground."""
        return view_box(self.posed, self.row, self.col, int(self.labels.shape[0]))

    @property
    def stone_pixels(self) -> Mask:
        """The stone in an image as large as the landscape."""
        image = np.zeros(self.labels.shape, bool)
        height, width = self.posed.mask.shape
        image[self.row : self.row + height, self.col : self.col + width] = self.posed.mask
        return image


def plot_action(
    action: ActionView, marks: Collection[Mark], ax: Axes | None = None, *, title: str = ""
) -> Axes:
    """Draw a stone on the landscape with what some of its indices measure."""
    height, width = action.labels.shape
    depth = 0.04 * max(height, 0.2 * width)
    ax = fit_axes(ax, (-2.0, -depth, width + 2.0, height + 2.0))
    draw_ground(ax, -2.0, width + 2.0, depth)
    frame = Rectangle((0, 0), width, height, fill=False, edgecolor=GREY, linewidth=0.6,
                      linestyle=(0, (5, 4)), gid="frame")  # fmt: skip
    ax.add_patch(frame)
    fills = _fills(action, marks)
    for region in label_regions(action.labels):
        fill = fills.get(region.id, BUILT)
        draw_block(ax, region.loops, f"block-{region.id}", fill=fill, edgecolor=GREY, linewidth=0.4)
    if "rays" in marks:
        _draw_rays(ax, action)
    (region,) = label_regions(action.stone_pixels.astype(np.uint32))
    draw_block(ax, region.loops, "stone", fill=STONE, zorder=3)
    for mark, draw in (("box", _draw_box), ("begun", _draw_begun), ("neighbour", _draw_tops),
                       ("joints", _draw_joints), ("slope", _draw_slope)):  # fmt: skip
        if mark in marks:
            draw(ax, action)
    if {"neighbour", "joints"} <= {*marks}:
        _name_stones(ax, action)
    if title:
        ax.set_title(title, fontsize=7, loc="left", pad=2)
    return ax


def _fills(action: ActionView, marks: Collection[Mark]) -> dict[int, str]:
    fills: dict[int, str] = {}
    if "joints" in marks:
        fills |= {beside.id: BELOW for beside in action.below if beside is not None}
    if "neighbour" in marks and action.neighbour is not None:
        fills[action.neighbour.id] = NEIGHBOUR
    return fills


def _name_stones(ax: Axes, action: ActionView) -> None:
    """Write which stone is which, where several are coloured."""
    below1, below2 = action.below
    told = {"left neighbour": action.neighbour, "below1": below1, "below2": below2}
    boxes = {name: beside.box for name, beside in told.items() if beside is not None}
    for name, (left, right, bottom, top) in {**boxes, "stone": action.box}.items():
        ax.text(
            (left + right) / 2,
            (bottom + top) / 2,
            name,
            size=7,
            ha="center",
            va="center",
            zorder=6,
            gid="name",
            path_effects=[withStroke(linewidth=1.5, foreground="white")],
        )


def _draw_rays(ax: Axes, action: ActionView) -> None:
    """Colour what the rays sweep: pale where it is empty, stronger over what is filled."""
    height, width = action.labels.shape
    image = np.zeros((height, width, 4))
    image[action.swept] = to_rgba(RAYS, 0.9)
    image[action.swept & (action.labels > 0)] = to_rgba("#a08500", 0.55)
    ax.imshow(image, extent=(0, width, 0, height), interpolation="nearest", zorder=2, gid="rays")
    # An image would take the limits of the axes for its own.
    ax.set_aspect("equal")


def _draw_box(ax: Axes, action: ActionView) -> None:
    left, right, bottom, top = action.box
    ax.add_patch(
        Rectangle((left, bottom), right - left, top - bottom, fill=False, linewidth=1.0,
                  edgecolor=OUTLINE_COLOUR, linestyle=(0, (2, 1.5)), gid="box", zorder=4)
    )  # fmt: skip


def _draw_begun(ax: Axes, action: ActionView) -> None:
    width = action.labels.shape[1]
    ax.add_patch(
        Rectangle((0, 0), width, action.built_height, fill=False, linewidth=1.6,
                  edgecolor=BEGUN, gid="begun", zorder=4)
    )  # fmt: skip


def _draw_tops(ax: Axes, action: ActionView) -> None:
    """Draw the heights of both tops, and how far they are apart."""
    if action.neighbour is None:
        return
    stone, beside = action.box, action.neighbour.box
    ends = (min(stone.left, beside.left), max(stone.right, beside.right))
    for top in (stone.top, beside.top):
        ax.plot(ends, [top, top], color=OUTLINE_COLOUR, linewidth=0.8, linestyle=(0, (4, 2)),
                gid="top", zorder=4)  # fmt: skip
    middle = (ends[0] + ends[1]) / 2
    ax.plot([middle, middle], [stone.top, beside.top], color=OUTLINE_COLOUR, linewidth=2.0,
            gid="difference", zorder=5, solid_capstyle="butt")  # fmt: skip


def _draw_joints(ax: Axes, action: ActionView) -> None:
    """Draw how far the ends of the stone are from the joints below."""
    below1, below2 = action.below
    stone = action.box
    pairs: list[tuple[PointXY, PointXY]] = []
    if below1 is not None:
        pairs.append(((stone.left, stone.bottom), (below1.box.right, below1.box.top)))
    if below2 is not None:
        pairs.append(((stone.right, stone.bottom), (below2.box.left, below2.box.top)))
    for (x_end, y_end), (x_joint, y_joint) in pairs:
        ax.plot([x_end, x_joint], [y_end, y_end], color=OUTLINE_COLOUR, linewidth=1.8,
                gid="offset", zorder=5, solid_capstyle="butt")  # fmt: skip
        ax.plot([x_joint, x_joint], [y_end, y_joint], color=OUTLINE_COLOUR, linewidth=0.6,
                zorder=5)  # fmt: skip
        ax.plot([x_joint], [y_joint], "o", color=OUTLINE_COLOUR, markersize=3, gid="joint",
                zorder=5)  # fmt: skip


def _draw_slope(ax: Axes, action: ActionView) -> None:
    if action.peaks is None:
        return
    top = action.posed.top
    x = [action.col + column + 0.5 for column in action.peaks]
    y = [action.labels.shape[0] - action.row - int(top[column]) for column in action.peaks]
    ax.plot(x, y, "o-", color=OUTLINE_COLOUR, markersize=3.5, linewidth=1.2, gid="slope", zorder=5)
