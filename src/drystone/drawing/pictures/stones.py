"""Stones as they lie in the source image, label images, and ways along joints."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from drystone.drawing.canvas import draw
from drystone.drawing.drawing import Area, Drawing, Item, Lines, Words
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import GREY, PALE, PLAIN_COLOUR, WEDGE_COLOUR, cluster_colour
from drystone.drawing.wall import cluster_legend
from drystone.model.stone import Stone, StoneSet
from drystone.model.wall import Labels

GAP = 0.25
"""Space between stones laid out in rows, in mean widths of a stone."""


def plot_stones(
    stone_set: StoneSet, clusters: Mapping[int, int] | None = None, ax: Axes | None = None
) -> Axes:
    """Draw stones as they lie in the source image, coloured by cluster (Fig. 5).

    Stones that come from a folder of masks have a frame each; they are laid out in rows.

    Parameters
    ----------
    stone_set : StoneSet
        At least one stone.
    clusters : mapping of int to int, optional
        Cluster of each stone's id, from 1; None draws all stones in one colour.
    ax : Axes, optional
        Where to draw; None makes a figure.

    Returns
    -------
    ax : Axes
        In source px, y up from the image's bottom edge.
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
    items: list[Item] = []
    for stone in stone_set:
        x, y = corners[stone.id]
        centroid = (x + stone.local_centroid[0], y + stone.local_centroid[1])
        fill = PLAIN_COLOUR if clusters is None else cluster_colour(clusters[stone.id])
        area = Area(f"stone-{stone.id}", (stone.outline + centroid,), fill)
        items += [area, Words(f"number-{stone.id}", str(stone.id), centroid, area.room, fill)]
    legend = cluster_legend(clusters[stone.id] for stone in stone_set) if clusters else {}
    pad = 0.01 * right
    box = (-pad, -pad, right + pad, top + pad)
    return draw(Drawing(tuple(items), box, "px", legend=legend), ax)


def _rows(stones: StoneSet) -> dict[int, tuple[float, float]]:
    """Return where the lower left corners go when stones are laid out in rows, first row on top."""
    gap = GAP * float(np.mean([stone.mask.shape[1] for stone in stones]))
    area = sum((s.mask.shape[1] + gap) * (s.mask.shape[0] + gap) for s in stones)
    longest = max(2.0 * area**0.5, *(s.mask.shape[1] + 2 * gap for s in stones), 0.0)
    rows: list[list[Stone]] = [[]]
    x = gap
    for stone in stones:
        if rows[-1] and x + stone.mask.shape[1] + gap > longest:
            rows.append([])
            x = gap
        rows[-1].append(stone)
        x += stone.mask.shape[1] + gap
    corners: dict[int, tuple[float, float]] = {}
    y = gap
    for row in reversed(rows):
        x = gap
        for stone in row:
            corners[stone.id] = (x, y)
            x += stone.mask.shape[1] + gap
        y += max(stone.mask.shape[0] for stone in row) + gap
    return corners


def plot_labels(labels: Labels, ax: Axes | None = None, *, title: str = "") -> Axes:
    """Draw a label image, coloured and numbered by id.

    Parameters
    ----------
    labels : (h, w) integer array
        0 is background; row 0 at the top.
    ax : Axes, optional
        Where to draw; None makes a figure.
    title : str
        Written above.

    Returns
    -------
    ax : Axes
        In px, y up from the image's bottom edge.
    """
    height, width = labels.shape
    pad = 0.01 * width
    items: list[Item] = []
    for rank, region in enumerate(label_regions(labels), 1):
        fill = cluster_colour(rank)
        area = Area(f"block-{region.id}", region.loops, fill)
        number = Words(f"number-{region.id}", str(region.id), region.centroid, area.room, fill)
        items += [area, number]
    box = (-pad, -pad, width + pad, height + pad)
    return draw(Drawing(tuple(items), box, "px", title), ax)


def plot_joint_paths(
    labels: Labels, paths: Sequence[NDArray[np.integer]], ax: Axes | None = None
) -> Axes:
    """Draw the paths of the alignment factors F_AV and F_AH over the stones (Fig. 17)."""
    height, width = labels.shape
    blocks = (
        Area(f"block-{region.id}", region.loops, PALE, line=GREY, width_pt=0.4)
        for region in label_regions(labels)
    )
    ways = (
        Lines(
            f"path-{number}",
            [np.asarray((path[:, ::-1] + 0.5) * (1, -1) + (0, height))],
            WEDGE_COLOUR,
            1.6,
        )
        for number, path in enumerate(map(np.asarray, paths), 1)
    )
    return draw(Drawing((*blocks, *ways), (-2, -3, width + 2, height + 2), "px"), ax)
