"""A photograph with the stones that were found in it, for a person to check."""

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from drystone.drawing.canvas import add, draw_legend, fit_axes
from drystone.drawing.drawing import Area, Dots, Item, Lines
from drystone.drawing.outlines import label_regions, rectangle

SURE_COLOUR, DOUBT_COLOUR = "#ffe14d", "#ff3fb4"
"""Light yellow and pink: apart in hue and lightness for colour-blind readers, and from stone."""

DASHES = (4.0, 2.0)
_LENGTHS_M = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)


def plot_photo(
    picture: NDArray[np.uint8],
    labels: NDArray[np.uint16],
    doubtful: tuple[Sequence[int], Iterable[tuple[float, float]]] = ((), ()),
    px_per_m: float | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw outlines and numbers of stones over a photograph in the frame of their labels.

    `doubtful` are numbers of stones that are drawn dashed in another colour, and places (column,
    row) that get a circle: necks.  `px_per_m` is for the scale bar.
    """
    height, width = labels.shape
    ax = fit_axes(ax, (0, 0, width, height))
    ax.set_axis_off()
    ax.imshow(picture, extent=(0, width, 0, height), interpolation="antialiased", zorder=0)
    stones, places = doubtful[0], np.array(list(doubtful[1]), float).reshape(-1, 2)
    halo = [withStroke(linewidth=2.0, foreground="#000000")]
    items: list[Item] = []
    for region in label_regions(labels.astype(np.uint32)):
        doubt = region.id in stones
        # A dark line below keeps the outline visible on stones of its own colour.
        items += [
            Area(f"below-{region.id}", region.loops, line="#000000", width_pt=2.2, z=2.0),
            Area(f"stone-{region.id}", region.loops, line=DOUBT_COLOUR if doubt else SURE_COLOUR,
                 width_pt=1.2, dashes=DASHES if doubt else (), z=3.0),
        ]  # fmt: skip
        ax.text(*region.centroid, str(region.id), size=8, color="#ffffff", ha="center",
                va="center_baseline", weight="bold", zorder=5, path_effects=halo)  # fmt: skip
    necks = Dots("necks", places * (1, -1) + (0, height), DOUBT_COLOUR, 11.0, open=True, z=6.0)
    add(ax, [*items, necks])
    if px_per_m is not None:
        _scale_bar(ax, width, height, px_per_m)
    legend: dict[str, Area | Lines | Dots] = {"stone": Area("", (), SURE_COLOUR, "#000000")}
    if stones:
        legend["to be checked"] = Lines("", [], DOUBT_COLOUR, 1.4, DASHES)
    if len(places):
        legend["neck: one stone or two?"] = necks
    draw_legend(ax, legend, size=8.0)
    return ax


def _scale_bar(ax: Axes, width: int, height: int, px_per_m: float) -> None:
    """Draw a bar of a round length, about a fifth of the picture."""
    fitting = [one for one in _LENGTHS_M if one * px_per_m < 0.25 * width]
    length = max(fitting, default=_LENGTHS_M[0])
    long, thick = length * px_per_m, 0.012 * height
    x, y = width - long - 0.02 * width, 0.02 * height
    halves = ((0, "#000000"), (1, "#ffffff"))
    add(ax, [
        Area(f"bar-{half}", (rectangle(x + half * long / 2, y, long / 2, thick),), colour,
             "#000000", z=6.0)
        for half, colour in halves
    ])  # fmt: skip
    said = f"{length:g} m" if length >= 1 else f"{100 * length:g} cm"
    ax.text(
        x + long / 2, y + 1.6 * thick, said, size=8, color="#ffffff", ha="center", va="bottom",
        zorder=6, path_effects=[withStroke(linewidth=2.0, foreground="#000000")],
    )  # fmt: skip
