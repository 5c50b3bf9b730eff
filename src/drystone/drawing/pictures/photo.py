"""A photograph with the stones that were found in it, for a person to check."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from drystone.drawing.canvas import block_path, fit_axes
from drystone.drawing.outlines import Region, label_regions

SURE_COLOUR, DOUBT_COLOUR = "#ffe14d", "#ff3fb4"
"""Light yellow and pink: apart in hue and lightness for colour-blind readers, and from stone."""

_LENGTHS_M = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)


def plot_photo(
    picture: NDArray[np.uint8],
    labels: NDArray[np.uint16],
    doubtful: tuple[Sequence[int], Iterable[tuple[float, float]]] = ((), ()),
    px_per_m: float | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw outlines and numbers over a photograph.

    Parameters
    ----------
    picture : (h, w, 3) uint8 array
        RGB, in the frame of the labels.
    labels : (h, w) integer array
        Stones; 0 elsewhere.
    doubtful : (stones, places)
        Numbers of stones that are drawn in another colour and dashed; places (column, row) that
        get a circle: necks.
    px_per_m : float or None
        For the scale bar.
    ax : Axes, optional
        Where to draw; a figure of its own otherwise.
    """
    height, width = labels.shape
    ax = fit_axes(ax, (0, 0, width, height))
    ax.set_axis_off()
    ax.imshow(picture, extent=(0, width, 0, height), interpolation="antialiased", zorder=0)
    stones, places = doubtful
    for region in label_regions(labels.astype(np.uint32)):
        _draw_stone(ax, region, region.id in stones)
    places = list(places)
    for column, row in places:
        ax.plot(
            column, height - row, "o", markersize=11, markerfacecolor="none",
            markeredgecolor=DOUBT_COLOUR, markeredgewidth=1.6, zorder=6,
        )  # fmt: skip
    if px_per_m is not None:
        _scale_bar(ax, width, height, px_per_m)
    _legend(ax, bool(stones), bool(places))
    return ax


def _draw_stone(ax: Axes, region: Region, in_doubt: bool) -> None:
    path = block_path(region.loops)
    colour = DOUBT_COLOUR if in_doubt else SURE_COLOUR
    # A dark line below keeps the outline visible on stones of its own colour.
    ax.add_patch(PathPatch(path, facecolor="none", edgecolor="#000000", linewidth=2.2, zorder=2))
    ax.add_patch(
        PathPatch(
            path, facecolor="none", edgecolor=colour, linewidth=1.2, zorder=3,
            linestyle=(0, (4, 2)) if in_doubt else "solid",
        )
    )  # fmt: skip
    ax.text(
        region.centroid[0], region.centroid[1], str(region.id), size=8, color="#ffffff",
        ha="center",
        va="center_baseline", weight="bold", zorder=5,
        path_effects=[withStroke(linewidth=2.0, foreground="#000000")],
    )  # fmt: skip


def _scale_bar(ax: Axes, width: int, height: int, px_per_m: float) -> None:
    """Draw a bar of a round length, about a fifth of the picture."""
    fitting = [one for one in _LENGTHS_M if one * px_per_m < 0.25 * width]
    length = max(fitting, default=_LENGTHS_M[0])
    long, thick = length * px_per_m, 0.012 * height
    x, y = width - long - 0.02 * width, 0.02 * height
    for half, colour in ((0, "#000000"), (1, "#ffffff")):
        ax.add_patch(
            Rectangle(
                (x + half * long / 2, y), long / 2, thick, facecolor=colour, edgecolor="#000000",
                linewidth=0.6, zorder=6,
            )
        )  # fmt: skip
    said = f"{length:g} m" if length >= 1 else f"{100 * length:g} cm"
    ax.text(
        x + long / 2, y + 1.6 * thick, said, size=8, color="#ffffff", ha="center", va="bottom",
        zorder=6, path_effects=[withStroke(linewidth=2.0, foreground="#000000")],
    )  # fmt: skip


def _legend(ax: Axes, doubts: bool, necks: bool) -> None:
    handles = [_line(SURE_COLOUR, "solid", "stone")]
    if doubts:
        handles.append(_line(DOUBT_COLOUR, (0, (4, 2)), "to be checked"))
    if necks:
        handles.append(
            Line2D(
                [], [], marker="o", linestyle="none", markersize=9, markerfacecolor="none",
                markeredgecolor=DOUBT_COLOUR, markeredgewidth=1.6, label="neck: one stone or two?",
            )
        )  # fmt: skip
    ax.legend(
        handles=handles, loc="upper left", bbox_to_anchor=(0.0, -0.005), ncols=3, fontsize=8,
        frameon=False, borderaxespad=0.0,
    )  # fmt: skip


def _line(colour: str, style: Any, text: str) -> Line2D:
    under = [withStroke(linewidth=2.6, foreground="#000000")]
    return Line2D(
        [], [], color=colour, linestyle=style, linewidth=1.4, label=text, path_effects=under
    )
