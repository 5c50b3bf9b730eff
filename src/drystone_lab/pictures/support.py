"""A stone on its support: AB, the centre of mass and where it goes; turned, or wedged (Fig. 9)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, Rectangle
from matplotlib.patheffects import withStroke

from drystone.drawing.canvas import draw_block, fit_axes
from drystone.drawing.outlines import Loop, label_regions
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, WEDGE_COLOUR
from drystone.model.placement import Wedge
from drystone.model.wall import Labels
from drystone.stabilise.support import Pose, Support

BUILT, STONE, GHOST = "#e4e0d8", "#9ecae1", "#0072b2"
LINE, MASS = "#d55e00", "#000000"

PointXY = tuple[float, float]
Window = tuple[float, float, float, float]
"""x0, y0, x1, y1, working px, y up from the ground."""


@dataclass(frozen=True, eq=False)
class SupportedStone:
    """A stone where it is."""

    pose: Pose  # The stone and the row and column of its mask
    support: Support  # Its support, over wedges as well
    falls: int  # Side to which it falls: -1 left, +1 right, 0 stable
    wedges: tuple[Wedge, ...]  # Under it
    height_px: int

    @property
    def mass(self) -> PointXY:
        """Centre of mass C."""
        posed, row, col = self.pose
        return col + posed.anchor[0], self.height_px - row - posed.height_px + posed.anchor[1]

    @property
    def ends(self) -> tuple[PointXY, PointXY]:
        """A, the end of the support that is nearer to the centre of mass, and B."""
        left = float(self.support.left_x), float(self.height_px - self.support.left_row)
        right = float(self.support.right_x), float(self.height_px - self.support.right_row)
        x = self.mass[0]
        return (left, right) if abs(x - left[0]) < abs(x - right[0]) else (right, left)

    @property
    def cross(self) -> float:
        """AB x AC: positive turns counter-clockwise (§3.7)."""
        (x_a, y_a), (x_b, y_b) = self.ends
        x_c, y_c = self.mass
        return (x_b - x_a) * (y_c - y_a) - (y_b - y_a) * (x_c - x_a)

    @property
    def loops(self) -> tuple[Loop, ...]:
        """Boundary of the stone."""
        posed, row, col = self.pose
        (region,) = label_regions(posed.mask.astype(np.uint32))
        low = self.height_px - row - posed.height_px
        return tuple(loop + np.array([col, low]) for loop in region.loops)


def plot_standing(
    labels: Labels,
    standing: SupportedStone,
    window: Window,
    ax: Axes | None = None,
    *,
    before: SupportedStone | None = None,
    title: str = "",
) -> Axes:
    """Draw a stone on its support with the points of Fig. 9.

    `labels` is the landscape without the stone; `before` is where it was at first, dashed.
    """
    ax = fit_axes(ax, window)
    for region in label_regions(labels):
        draw_block(ax, region.loops, f"block-{region.id}", fill=BUILT, edgecolor=GREY,
                   linewidth=0.5)  # fmt: skip
    if window[1] <= 0:
        ax.plot([window[0], window[2]], [0, 0], color=OUTLINE_COLOUR, linewidth=1.4, gid="ground")
    if standing.wedges:
        _draw_supported(ax, before or standing)
    draw_block(ax, standing.loops, "stone", fill=STONE, zorder=2)
    if before is not None and not standing.wedges:
        draw_block(ax, before.loops, "before", edgecolor=GHOST, linestyle=(0, (3, 2)), zorder=3)
    _draw_wedges(ax, standing.wedges, standing.height_px)
    _draw_points(ax, standing)
    if standing.falls:
        _draw_turn(ax, standing)
    ax.set_xlabel("working px", fontsize=7, labelpad=1)
    if title:
        ax.set_title(title, fontsize=7, loc="left", pad=3)
    return ax


def window_around(standings: Sequence[SupportedStone], margin_px: float = 6.0) -> Window:
    """Return a window that shows some stones and what is around them."""
    points = np.concatenate([loop for one in standings for loop in one.loops])
    low, high = points.min(axis=0) - 2 * margin_px, points.max(axis=0) + margin_px
    return float(low[0]), float(max(low[1], -2.0)), float(high[0] + margin_px), float(high[1])


def _draw_points(ax: Axes, standing: SupportedStone) -> None:
    """Draw A, B and the line between them, C and its projection C'."""
    a, b = standing.ends
    x_c, y_c = standing.mass
    share = 0.0 if a[0] == b[0] else (x_c - a[0]) / (b[0] - a[0])
    y_on = a[1] + share * (b[1] - a[1]) if 0 <= share <= 1 else a[1]
    ax.plot([a[0], b[0]], [a[1], b[1]], "-o", color=LINE, linewidth=1.8, markersize=4, gid="AB",
            zorder=5)  # fmt: skip
    ax.plot([x_c, x_c], [y_c, y_on], color=MASS, linewidth=0.9, linestyle=(0, (2, 2)),
            gid="projection", zorder=5)  # fmt: skip
    ax.plot([x_c], [y_c], "+", color=MASS, markersize=9, markeredgewidth=1.5, gid="C", zorder=6)
    ax.plot([x_c], [y_on], "x", color=MASS, markersize=5, gid="C'", zorder=6)
    side = 1 if a[0] >= b[0] else -1
    _write(ax, "A", a, (5.0 * side, -7.0))
    _write(ax, "B", b, (-5.0 * side, -7.0))
    _write(ax, "C", (x_c, y_c), (7.0 * side, 4.0))
    _write(ax, "C'", (x_c, y_on), (7.0 * side, 5.0))


def _write(ax: Axes, text: str, at: PointXY, offset: PointXY) -> None:
    ax.annotate(text, at, offset, textcoords="offset points", size=7.5, ha="center", va="center",
                zorder=7, path_effects=[withStroke(linewidth=1.8, foreground="white")])  # fmt: skip


def _draw_turn(ax: Axes, standing: SupportedStone) -> None:
    """Draw to which side the stone turns, above it."""
    points = np.concatenate(standing.loops)
    (left, _), (right, top) = points.min(axis=0), points.max(axis=0)
    middle, reach = (left + right) / 2, 0.25 * (right - left)
    side = standing.falls
    ax.add_patch(
        FancyArrowPatch(
            (middle - side * reach, top + 1.5), (middle + side * reach, top + 1.5),
            connectionstyle=f"arc3,rad={-0.35 * side}", arrowstyle="-|>", mutation_scale=9,
            linewidth=1.3, color=LINE, gid="turn", zorder=6,
        )
    )  # fmt: skip


def _draw_supported(ax: Axes, before: SupportedStone) -> None:
    """Draw the supported side, which wedging leaves alone (grey in Fig. 9c)."""
    points = np.concatenate(before.loops)
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    x_a = before.ends[0][0]
    ends = (left, x_a) if before.falls > 0 else (x_a, right)
    ax.add_patch(Rectangle((ends[0], bottom), ends[1] - ends[0], top - bottom, facecolor=GREY,
                           alpha=0.45, gid="supported", zorder=3))  # fmt: skip


def _draw_wedges(ax: Axes, wedges: Sequence[Wedge], height_px: int) -> None:
    for wedge in wedges:
        (region,) = label_regions(wedge.mask.astype(np.uint32))
        tall, wide = wedge.mask.shape
        low = height_px - wedge.row - tall
        loops = [loop + np.array([wedge.col, low]) for loop in region.loops]
        draw_block(ax, loops, f"wedge-{wedge.id}", fill=WEDGE_COLOUR, zorder=4)
        _write(ax, f"h {tall}, w {wide}", (wedge.col + wide / 2, float(low)), (0.0, -8.0))
