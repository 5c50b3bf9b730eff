"""What all pictures share: axes that fit the thing, stones, numbers, the ground."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from drystone.drawing.outlines import Loop
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, text_colour

WIDTH_IN = 9.0
"""Width of the drawing area; a picture with margins then fits the text width of a page."""

HEIGHT_IN = 9.0
"""Largest height of the drawing area."""

MARGIN_IN = 0.6
LARGEST_PT, SMALLEST_PT = 10.0, 3.5

Box = tuple[float, float, float, float]
"""x0, y0, x1, y1."""


def fit_axes(ax: Axes | None, box: Box) -> Axes:
    """Return axes of equal scales that show the box; on a figure of its own when ax is None."""
    width, height = box[2] - box[0], box[3] - box[1]
    if ax is None:
        inches = min(WIDTH_IN / width, HEIGHT_IN / height)
        size = (width * inches + 2 * MARGIN_IN, height * inches + 2 * MARGIN_IN)
        figure = Figure(figsize=size)
        left, bottom = MARGIN_IN / size[0], MARGIN_IN / size[1]
        ax = figure.add_axes((left, bottom, 1 - 2 * left, 1 - 2 * bottom))
    ax.set_xlim(box[0], box[2])
    ax.set_ylim(box[1], box[3])
    ax.set_aspect("equal")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(MaxNLocator(nbins="auto", steps=[1, 2, 5, 10]))
    ax.tick_params(labelsize=7, length=2.5, width=0.5)
    for spine in ax.spines.values():
        spine.set_visible(False)
    return ax


def block_path(loops: Iterable[Loop]) -> Path:
    """Join loops into one path; clockwise loops are holes."""
    return Path.make_compound_path(*(Path([*loop, loop[0]], closed=True) for loop in loops))


def draw_block(
    ax: Axes, loops: Iterable[Loop], gid: str, *, fill: str = "none", **style: Any
) -> PathPatch:
    """Add a block to the axes; `gid` names it (in SVG files too)."""
    drawn = {"linewidth": 0.6, "edgecolor": OUTLINE_COLOUR, "joinstyle": "round", **style}
    patch = PathPatch(block_path(loops), facecolor=fill, gid=gid, **drawn)
    ax.add_patch(patch)
    return patch


def write_number(
    ax: Axes, number: int, at: tuple[float, float], loops: Iterable[Loop], fill: str
) -> None:
    """Write a number on a block, as large as the block allows, readable on its colour."""
    points = np.concatenate(list(loops))
    width, height = np.ptp(points, axis=0) * _points_per_unit(ax)
    # A digit is about .62 of its font's size wide; text may take some 60 % of the block's box.
    room = min(height, width / (0.62 * len(str(number))))
    size = min(max(0.6 * float(room), SMALLEST_PT), LARGEST_PT)
    colour = text_colour(fill)
    halo = [withStroke(linewidth=0.12 * size, foreground=fill)]
    ax.text(
        *at,
        str(number),
        size=size,
        color=colour,
        ha="center",
        va="center_baseline",
        path_effects=halo,
        zorder=5,
        clip_on=True,
    )


def _points_per_unit(ax: Axes) -> float:
    """Return how many points of a font a unit of the axes is long."""
    ax.apply_aspect()
    left, right = ax.get_xlim()
    return float(ax.get_window_extent().width / ax.figure.dpi * 72 / (right - left))


def draw_ground(ax: Axes, x0: float, x1: float, depth: float) -> None:
    """Draw the ground: a line at y = 0 and hatching below."""
    earth = Rectangle(
        (x0, -depth),
        x1 - x0,
        depth,
        facecolor="none",
        edgecolor=GREY,
        hatch="/////",
        linewidth=0,
        gid="ground",
        zorder=0,
    )
    ax.add_patch(earth)
    ax.plot([x0, x1], [0, 0], color=OUTLINE_COLOUR, linewidth=1.2, gid="ground-line", zorder=4)


def draw_legend(ax: Axes, entries: dict[str, str]) -> None:
    """Write the meaning of the colours in rows under the axes."""
    handles = [
        Patch(facecolor=colour, edgecolor=OUTLINE_COLOUR, linewidth=0.4, label=text)
        for text, colour in entries.items()
    ]
    around = ax.get_tightbbox() or ax.get_window_extent()
    anchor = ax.transAxes.inverted().transform((around.x0, around.y0 - 4))
    ax.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0.0, anchor[1]),
        ncols=9,
        fontsize=7,
        frameon=False,
        borderaxespad=0.0,
        handlelength=1.0,
        handleheight=1.0,
        columnspacing=1.2,
    )
