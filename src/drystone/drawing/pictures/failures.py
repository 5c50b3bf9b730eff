"""What fails when a plan is checked: where blocks were planned, and where they ended."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from drystone.drawing.canvas import (
    MARGIN_IN,
    WIDTH_IN,
    Box,
    draw_block,
    draw_ground,
    fit_axes,
    write_number,
)
from drystone.drawing.outlines import Loop, Region, polygon_regions, regions_box
from drystone.drawing.palette import GREY, OUTLINE_COLOUR
from drystone.drawing.scene import PALE, points_down

CONCERNED = "#f0a030"
PLANNED = "#0050a0"
PLANNED_PALE = "#90b0d8"
COMMON = "#c00020"

NOTICEABLE = 4e-3
"""Blocks that have moved by this share of the wall's height are shown where they were planned."""

LEGEND_IN, TITLE_IN = 0.3, 0.3
HEIGHT_IN = 5.0
"""Largest height of one view."""


@dataclass(frozen=True, eq=False)
class FailureView:
    """A wall and what fails in it; lengths in source px, wall frame.

    Parameters
    ----------
    title : str
        What it shows, in a line.
    planned : mapping of int to (n, 2) float array
        Every block where it was planned.
    concerned : sequence of int
        Ids of the blocks that fail.
    ended : mapping of int to (n, 2) float array
        Where blocks ended; the others are where they were planned.
    common : sequence of (n, 2) float arrays
        Areas that two blocks claim.
    size : (float, float) or None
        Width and height of the wall that was to be built.
    """

    title: str
    planned: Mapping[int, Loop]
    concerned: Sequence[int] = ()
    ended: Mapping[int, Loop] = field(default_factory=dict)
    common: Sequence[Loop] = ()
    size: tuple[float, float] | None = None

    @property
    def box(self) -> Box:
        """What is to be seen."""
        frame = [np.array([(0.0, 0.0), self.size])] if self.size else []
        loops = [[loop] for loop in (*self.planned.values(), *self.ended.values(), *frame)]
        x0, y0, x1, y1 = regions_box(loops)
        pad = 0.03 * max(y1 - y0, 0.2 * (x1 - x0))
        return x0 - pad, min(y0, 0.0) - 2 * pad, x1 + pad, y1 + pad


def plot_failures(views: Sequence[FailureView]) -> Figure:
    """Draw one or more views under each other.

    Parameters
    ----------
    views : sequence of FailureView
        At least one.

    Returns
    -------
    Figure
        To be written with :func:`drystone.drawing.save`.
    """
    boxes = [view.box for view in views]
    heights = [min(WIDTH_IN * (y1 - y0) / (x1 - x0), HEIGHT_IN) for x0, y0, x1, y1 in boxes]
    gap = TITLE_IN + LEGEND_IN
    width, height = WIDTH_IN + 2 * MARGIN_IN, sum(heights) + gap * len(views)
    figure = Figure(figsize=(width, height))
    bottom = height
    for view, tall in zip(views, heights, strict=True):
        bottom -= gap + tall
        left = (MARGIN_IN / width, (bottom + LEGEND_IN) / height)
        plot_failure(view, figure.add_axes((*left, WIDTH_IN / width, tall / height)))
    return figure


def plot_failure(view: FailureView, ax: Axes | None = None) -> Axes:
    """Draw a wall and what fails in it.

    Blocks are drawn where they ended; those that fail are coloured and numbered, dashed lines
    show where they, and others that have moved, were planned.

    Parameters
    ----------
    view : FailureView
        What to draw.
    ax : Axes, optional
        Where to draw; None makes a figure.

    Returns
    -------
    ax : Axes
        Wall frame, source px.
    """
    box = view.box
    ax = fit_axes(ax, box)
    ax.set_axis_off()
    draw_ground(ax, box[0], box[2], -box[1])
    if view.size:
        ax.add_patch(
            Rectangle((0, 0), *view.size, fill=False, edgecolor=GREY, linestyle=":", gid="site")
        )
    ended = polygon_regions({**view.planned, **view.ended})
    concerned = set(view.concerned)
    # Blocks that fail are drawn last, over those that they lie in.
    for region in sorted(ended, key=lambda region: region.id in concerned):
        _draw_ended(ax, region, fails=region.id in concerned)
    dashed = _draw_planned(ax, view)
    for number, loop in enumerate(view.common):
        draw_block(
            ax, [loop], f"common-{number}", fill=COMMON, edgecolor=COMMON, linewidth=0.8, zorder=4
        )
    ax.set_title(view.title, size=9, loc="left")
    _draw_meaning(ax, view, dashed=dashed)
    return ax


def _draw_ended(ax: Axes, region: Region, *, fails: bool) -> None:
    fill = CONCERNED if fails else PALE
    draw_block(
        ax,
        region.loops,
        f"block-{region.id}",
        fill=fill,
        edgecolor=OUTLINE_COLOUR if fails else GREY,
        linewidth=0.8 if fails else 0.5,
        zorder=2 if fails else 1,
    )
    write_number(ax, region.id, region.centroid, region.loops, fill)
    ax.texts[-1].set_gid(f"number-{region.id}")
    if not fails:
        # Whatever lies over it hides its number too.
        ax.texts[-1].set(color=GREY, zorder=1.5)


def _draw_planned(ax: Axes, view: FailureView) -> bool:
    """Draw where blocks that moved were planned; say whether there are any."""
    _, y0, _, y1 = regions_box([loop] for loop in view.planned.values())
    drawn = False
    for block, loop in view.planned.items():
        way = np.hypot(*(view.ended[block] - loop).T).max() if block in view.ended else 0.0
        if way > NOTICEABLE * (y1 - y0):
            fails = block in view.concerned
            draw_block(
                ax,
                [loop],
                f"planned-{block}",
                edgecolor=PLANNED if fails else PLANNED_PALE,
                linewidth=1.0 if fails else 0.5,
                linestyle=(0, (4, 2)),
                zorder=3,
            )
            drawn = True
    return drawn


def _draw_meaning(ax: Axes, view: FailureView, *, dashed: bool) -> None:
    """Write what colours and lines mean in a row under the axes."""
    handles: list[Line2D | Patch] = []
    if view.concerned:
        handles.append(Patch(facecolor=CONCERNED, edgecolor=OUTLINE_COLOUR, label="fails"))
    if dashed:
        line = Line2D([], [], color=PLANNED, linewidth=1.0, linestyle=(0, (4, 2)))
        line.set_label("where it was planned")
        handles.append(line)
    if view.common:
        handles.append(Patch(facecolor=COMMON, edgecolor=COMMON, label="claimed by two"))
    if view.size:
        dotted = Line2D([], [], color=GREY, linestyle=":", label="wall that was to be built")
        handles.append(dotted)
    ax.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0.0, 0.0),
        bbox_transform=ax.transAxes + points_down(ax, 4.0),
        ncols=4,
        fontsize=7,
        frameon=False,
        borderaxespad=0.0,
    )
