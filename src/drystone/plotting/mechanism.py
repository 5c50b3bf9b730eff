"""The failure mechanism of a wall (Fig. 15)."""

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize, to_hex
from numpy.typing import NDArray

from drystone.model.wall import Labels
from drystone.plotting.canvas import draw_block, draw_ground, fit_axes
from drystone.plotting.outlines import Loop, Region, label_regions
from drystone.plotting.palette import GREY, OUTLINE_COLOUR
from drystone.statics.model import Direction
from drystone.statics.result import Mechanism

LARGEST_SHARE = 0.12
"""Largest displacement in the picture over the height of the wall."""

COLOURS = ListedColormap(colormaps["YlOrRd"](np.linspace(0.02, 0.82, 256)))
"""From pale (still) to red: lightness falls steadily, so it reads in grey too, and its dark end is
light enough for outlines to show."""


def plot_mechanism(
    labels: Labels,
    mechanism: Mechanism,
    direction: Direction,
    alpha: float | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw how a wall fails: every block moved by its velocity, coloured by displacement (Fig. 15).

    A point at r from a block's centroid moves by ``v + w x r`` (small turns, linearised), scaled
    so that the largest displacement in the picture is 12 % of the wall's height.  Thin grey lines
    show the wall before.  Blocks without a velocity stay where they are.

    Parameters
    ----------
    labels : (h, w) integer array
        The wall whose blocks the mechanism names; row 0 at the top.
    mechanism : Mechanism
        Velocities of the blocks.
    direction : {"left", "right"}
        Where the live load points.
    alpha : float, optional
        Load multiplier (adequacy factor), written beside the arrow.
    ax : Axes, optional
        Where to draw; None makes a figure.

    Returns
    -------
    ax : Axes
        In px of the label image, y up from its bottom edge.

    Raises
    ------
    ValueError
        When the mechanism names a block that the label image does not have.
    """
    regions = label_regions(labels)
    velocities = _velocities(regions, mechanism)
    moved = displaced(regions, velocities, LARGEST_SHARE * _height(regions))
    speed = np.hypot(velocities[:, 0], velocities[:, 1])
    share = speed / speed.max() if speed.any() else speed
    x0, x1, top = _extent(moved, labels.shape[1])
    depth = 0.035 * max(top, 0.2 * (x1 - x0))
    arrow_y = top + 2 * depth
    ax = fit_axes(ax, (x0, -depth, x1, arrow_y + 1.5 * depth))
    ax.set_axis_off()
    draw_ground(ax, x0, x1, depth)
    # The blocks that move most are drawn last: dilatancy opens joints, rounding may close some.
    for index in np.argsort(share, kind="stable"):
        fill = to_hex(COLOURS(float(share[index])))
        draw_block(ax, moved[index], f"moved-{regions[index].id}", fill=fill, zorder=1)
    for region in regions:
        gid = f"before-{region.id}"
        draw_block(ax, region.loops, gid, edgecolor=GREY, linewidth=0.5, zorder=2)
    _draw_load(ax, (x0 + x1) / 2, arrow_y, direction, alpha)
    _draw_scale(ax)
    return ax


def _velocities(regions: tuple[Region, ...], mechanism: Mechanism) -> NDArray[np.float64]:
    """Return the velocities in the order of the regions; blocks not named stand still."""
    known = dict(zip(mechanism.block_ids, mechanism.velocity, strict=True))
    missing = sorted(set(known) - {region.id for region in regions})
    if missing:
        raise ValueError(f"the mechanism moves blocks that the label image lacks: {missing}")
    still = np.zeros(3)
    rows = [known.get(region.id, still) for region in regions]
    return np.array(rows, float).reshape(-1, 3)


def displaced(
    regions: tuple[Region, ...], velocities: NDArray[np.float64], largest: float
) -> tuple[tuple[Loop, ...], ...]:
    """Move every region by its velocity, linearised, so that no point moves more than `largest`.

    Parameters
    ----------
    regions : tuple of Region
        The blocks at rest.
    velocities : (n, 3) float array
        Horizontal, vertical and turning (counter-clockwise) velocity at the centroid, a row each.
    largest : float
        Displacement of the point that moves most, px.
    """
    fields = [
        [_point_velocity(loop - region.centroid, velocity) for loop in region.loops]
        for region, velocity in zip(regions, velocities, strict=True)
    ]
    fastest = max((float(np.hypot(*f.T).max()) for block in fields for f in block), default=0.0)
    factor = largest / fastest if fastest > 0 else 0.0
    return tuple(
        tuple(loop + factor * field for loop, field in zip(region.loops, block, strict=True))
        for region, block in zip(regions, fields, strict=True)
    )


def _point_velocity(arms: Loop, velocity: NDArray[np.float64]) -> Loop:
    along_x, along_y, turning = velocity
    return np.column_stack([along_x - turning * arms[:, 1], along_y + turning * arms[:, 0]])


def _height(regions: tuple[Region, ...]) -> float:
    heights = [loop[:, 1] for region in regions for loop in region.loops]
    return float(np.ptp(np.concatenate(heights))) if heights else 0.0


def _extent(moved: tuple[tuple[Loop, ...], ...], width: float) -> tuple[float, float, float]:
    """Return both ends of the ground, wider where blocks move out of the image, and the top."""
    points = np.concatenate(
        [np.array([[0.0, 0.0], [width, 1.0]]), *(loop for block in moved for loop in block)]
    )
    pad = 0.02 * width
    return (
        float(points[:, 0].min()) - pad,
        float(points[:, 0].max()) + pad,
        float(points[:, 1].max()),
    )


def _draw_load(ax: Axes, x: float, y: float, direction: Direction, alpha: float | None) -> None:
    left, right = ax.get_xlim()
    half = 0.06 * (right - left) * (1 if direction == "right" else -1)
    ax.annotate(
        "",
        xy=(x + half, y),
        xytext=(x - half, y),
        gid="live-load",
        arrowprops={
            "arrowstyle": "-|>,head_width=.35,head_length=.7",
            "linewidth": 2.2,
            "color": OUTLINE_COLOUR,
            "shrinkA": 0,
            "shrinkB": 0,
        },
    )
    value = "" if alpha is None else rf", $\alpha$ = {alpha:.3f}"
    text = rf"live load, $\alpha$ times the weight, to the {direction}{value}"
    ax.text(x + abs(half) * 1.15, y, text, size=8, ha="left", va="center", color=OUTLINE_COLOUR)


def _draw_scale(ax: Axes) -> None:
    scale = ScalarMappable(Normalize(0, 1), COLOURS)
    bar = ax.figure.colorbar(scale, ax=ax, fraction=0.03, pad=0.01, aspect=18, shrink=0.8)
    bar.set_label("displacement / largest displacement", size=7)
    bar.ax.tick_params(labelsize=7, length=2, width=0.5)
    bar.outline.set_linewidth(0.5)
