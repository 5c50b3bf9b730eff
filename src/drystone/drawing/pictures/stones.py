"""Stones as they lie in the source image or a photograph, label images, and ways along joints."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from drystone.drawing.canvas import add, draw, draw_legend, fit_axes
from drystone.drawing.drawing import Dots, Drawable, Drawing, Lines, Surface, Words
from drystone.drawing.outlines import label_regions, rectangle
from drystone.drawing.palette import GREY, PALE, PLAIN_COLOUR, WEDGE_COLOUR, cluster_colour
from drystone.model.stone import Stone, StoneSet
from drystone.model.wall import Labels

GAP = 0.25  # space between stones laid out in rows, in mean widths of a stone


def plot_stones(
    stone_set: StoneSet, clusters: Mapping[int, int] | None = None, ax: Axes | None = None
) -> Axes:
    """Draw stones as they lie in the source image, coloured by cluster (Fig. 5).

    Stones that come from a folder of masks have a frame each; they are laid out in rows.  There is
    at least one.  `clusters` are those of stones by id, from 1; None draws all in one colour.  The
    axes are in source px, y up from the image's bottom edge.
    """
    source = stone_set.source
    if source.files:
        corners = _rows(stone_set)
    else:
        corners = {stone.id: (stone.left_px, stone.bottom_px) for stone in stone_set}
    right = max(corners[s.id][0] + s.mask.shape[1] for s in stone_set)
    top = max(corners[s.id][1] + s.mask.shape[0] for s in stone_set)
    if not source.files:
        right, top = max(right, source.width_px), max(top, source.height_px)
    items: list[Drawable] = []
    for stone in stone_set:
        x, y = corners[stone.id]
        centroid = (x + stone.local_centroid[0], y + stone.local_centroid[1])
        fill = PLAIN_COLOUR if clusters is None else cluster_colour(clusters[stone.id])
        area = Surface(f"stone-{stone.id}", (stone.outline + centroid,), fill)
        items += [area, Words(f"number-{stone.id}", str(stone.id), centroid, area.room, fill)]
    used = sorted({clusters[stone.id] for stone in stone_set}) if clusters else []
    legend = {f"cluster {one}": Surface("", (), cluster_colour(one)) for one in used}
    pad = 0.01 * right
    box = (-pad, -pad, right + pad, top + pad)
    return draw(Drawing(tuple(items), box, "px", legend=legend), ax)


def _rows(stones: StoneSet) -> dict[int, tuple[float, float]]:
    """Return where the lower left corners go when stones are laid out in rows, first row on top."""
    gap = GAP * float(np.mean([stone.mask.shape[1] for stone in stones]))
    area = sum((s.mask.shape[1] + gap) * (s.mask.shape[0] + gap) for s in stones)
    longest = max(2.0 * area**0.5, *(s.mask.shape[1] + 2 * gap for s in stones), 0.0)
    rows: list[list[tuple[Stone, float]]] = [[]]
    x = gap
    for stone in stones:
        if rows[-1] and x + stone.mask.shape[1] + gap > longest:
            rows.append([])
            x = gap
        rows[-1].append((stone, x))
        x += stone.mask.shape[1] + gap
    corners: dict[int, tuple[float, float]] = {}
    y = gap
    for row in reversed(rows):
        corners |= {stone.id: (x, y) for stone, x in row}
        y += max(stone.mask.shape[0] for stone, _ in row) + gap
    return corners


def plot_labels(labels: Labels, ax: Axes | None = None, *, title: str = "") -> Axes:
    """Draw a label image, (h, w), coloured and numbered by id; 0 is background, row 0 at the top.

    The axes are in px, y up from the image's bottom edge.
    """
    height, width = labels.shape
    pad = 0.01 * width
    items: list[Drawable] = []
    for rank, region in enumerate(label_regions(labels), 1):
        fill = cluster_colour(rank)
        area = Surface(f"block-{region.id}", region.loops, fill)
        number = Words(f"number-{region.id}", str(region.id), region.centroid, area.room, fill)
        items += [area, number]
    box = (-pad, -pad, width + pad, height + pad)
    return draw(Drawing(tuple(items), box, "px", title), ax)


def plot_joint_paths(
    labels: Labels, paths: Sequence[NDArray[np.integer]], ax: Axes | None = None
) -> Axes:
    """Draw the paths of the alignment factors F_AV and F_AH over the stones (Fig. 17).

    A path is the pixels (row, col) that it goes through, (n, 2); they may be just outside of the
    image.  The axes are in px, y up from the image's bottom edge.
    """
    height, width = labels.shape
    blocks = (
        Surface(f"block-{region.id}", region.loops, PALE, line=GREY, width_pt=0.4)
        for region in label_regions(labels)
    )
    middles = (np.asarray(path)[:, ::-1] + 0.5 for path in paths)
    ways = (
        Lines(f"path-{number}", [np.asarray(line * (1, -1) + (0, height))], WEDGE_COLOUR, 1.6)
        for number, line in enumerate(middles, 1)
    )
    return draw(Drawing((*blocks, *ways), (-2, -3, width + 2, height + 2), "px"), ax)


SURE_COLOUR, DOUBT_COLOUR = "#ffe14d", "#ff3fb4"
"""Light yellow and pink: apart in hue and lightness for colour-blind readers, and from stone."""

DASHES = (4.0, 2.0)
_LENGTHS_M = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)


def plot_photo(
    picture: NDArray[np.uint8],
    labels: NDArray[np.uint16],
    doubtful: tuple[Sequence[int], Iterable[tuple[float, float]]] = ((), ()),
    px_per_m: float | None = None,
) -> Axes:
    """Draw outlines and numbers of stones over a photograph in the frame of their labels.

    `doubtful` are numbers of stones that are drawn dashed in another colour, and places (column,
    row) that get a circle: necks.  `px_per_m` is for the scale bar.
    """
    height, width = labels.shape
    ax = fit_axes(None, (0, 0, width, height))
    ax.set_axis_off()
    ax.imshow(picture, extent=(0, width, 0, height), interpolation="antialiased", zorder=0)
    stones, places = doubtful[0], np.array(list(doubtful[1]), float).reshape(-1, 2)
    halo = [withStroke(linewidth=2.0, foreground="#000000")]
    items: list[Drawable] = []
    for region in label_regions(labels.astype(np.uint32)):
        doubt = region.id in stones
        # A dark line below keeps the outline visible on stones of its own colour.
        items += [
            Surface(f"below-{region.id}", region.loops, line="#000000", width_pt=2.2, z=2.0),
            Surface(f"stone-{region.id}", region.loops, line=DOUBT_COLOUR if doubt else SURE_COLOUR,
                 width_pt=1.2, dashes=DASHES if doubt else (), z=3.0),
        ]  # fmt: skip
        ax.text(*region.centroid, str(region.id), size=8, color="#ffffff", ha="center",
                va="center_baseline", weight="bold", zorder=5, path_effects=halo)  # fmt: skip
    necks = Dots("necks", places * (1, -1) + (0, height), DOUBT_COLOUR, 11.0, open=True, z=6.0)
    add(ax, [*items, necks])
    if px_per_m is not None:
        _scale_bar(ax, width, height, px_per_m)
    legend: dict[str, Surface | Lines | Dots] = {"stone": Surface("", (), SURE_COLOUR, "#000000")}
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
        Surface(f"bar-{half}", (rectangle(x + half * long / 2, y, long / 2, thick),), colour,
             "#000000", z=6.0)
        for half, colour in halves
    ])  # fmt: skip
    said = f"{length:g} m" if length >= 1 else f"{100 * length:g} cm"
    ax.text(
        x + long / 2, y + 1.6 * thick, said, size=8, color="#ffffff", ha="center", va="bottom",
        zorder=6, path_effects=[withStroke(linewidth=2.0, foreground="#000000")],
    )  # fmt: skip
