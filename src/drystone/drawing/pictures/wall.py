"""The wall as planned: clusters, order of placement, wedges."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from drystone.drawing.canvas import (
    draw_block,
    draw_ground,
    draw_legend,
    fit_axes,
    write_number,
)
from drystone.drawing.outlines import Loop, label_regions, wall_outlines
from drystone.drawing.palette import GREY, PLAIN_COLOUR, WEDGE_COLOUR, cluster_colour
from drystone.model.wall import Group, Wall


def plot_wall(
    wall: Wall,
    clusters: Mapping[int, int] | None = None,
    ax: Axes | None = None,
    *,
    outlines: Mapping[int, Loop] | None = None,
    title: str = "",
) -> Axes:
    """Draw a wall: stones coloured by cluster and numbered in order of placement, wedges red.

    The number of a stone is its step in the plan, where each wedge is a step too.

    Parameters
    ----------
    wall : Wall
        Also an empty one.
    clusters : mapping of int to int, optional
        Cluster of each stone's id, from 1; None draws all stones in one colour.
    ax : Axes, optional
        Where to draw; None makes a figure.
    outlines : mapping of int to (n, 2) float array, optional
        Polygons to draw instead of the pixels, by id, wall frame, plan's units; for example
        from :func:`drystone.drawing.wall_outlines`, which are drawn of a wall of outlines.
    title : str
        Written above.

    Returns
    -------
    ax : Axes
        In the plan's units: source px, or metres when the site has a scale.
    """
    site = wall.site
    width, height = site.width_px * site.units_per_px, site.height_px * site.units_per_px
    margin, depth = 0.015 * width, 0.035 * max(height, 0.2 * width)
    ax = fit_axes(ax, (-margin, -depth, width + margin, height + margin))
    draw_ground(ax, -margin, width + margin, depth)
    frame = Rectangle(
        (0, 0),
        width,
        height,
        fill=False,
        edgecolor=GREY,
        linewidth=0.9,
        linestyle=(0, (5, 4)),
        gid="frame",
        zorder=3,
    )
    ax.add_patch(frame)
    loops = wall_loops(wall, outlines)
    step = 1
    for group in wall.groups:
        _draw_group(ax, wall, group, loops, clusters, step)
        step += 1 + len(group.wedges)
    ax.set_xlabel("m" if site.px_per_m else "px", fontsize=7, labelpad=1)
    if title:
        ax.set_title(title, fontsize=9, loc="left", pad=4)
    legend = _legend(wall, clusters)
    if legend:
        draw_legend(ax, legend)
    return ax


def wall_loops(
    wall: Wall, outlines: Mapping[int, Loop] | None = None
) -> dict[int, tuple[Loop, ...]]:
    """Return the boundary of every stone and wedge in the plan's units."""
    if outlines is None and wall.outlines is not None:
        outlines = wall_outlines(wall)
    if outlines is not None:
        return {label: (np.asarray(points, float),) for label, points in outlines.items()}
    units = wall.site.units_per_px
    return {
        region.id: tuple(loop * units for loop in region.loops)
        for region in label_regions(wall.labels)
    }


def _draw_group(
    ax: Axes,
    wall: Wall,
    group: Group,
    loops: Mapping[int, tuple[Loop, ...]],
    clusters: Mapping[int, int] | None,
    step: int,
) -> None:
    placement, units = group.placement, wall.site.units_per_px
    stone_id = placement.stone_id
    x, y = placement.centroid(wall.site.height_px)
    fill = PLAIN_COLOUR if clusters is None else cluster_colour(clusters[stone_id])
    draw_block(ax, loops[stone_id], f"stone-{stone_id}", fill=fill, zorder=1)
    write_number(ax, step, (x * units, y * units), loops[stone_id], fill)
    for wedge in group.wedges:
        draw_block(ax, loops[wedge.id], f"wedge-{wedge.id}", fill=WEDGE_COLOUR, zorder=2)


def _legend(wall: Wall, clusters: Mapping[int, int] | None) -> dict[str, str]:
    used = sorted({clusters[p.stone_id] for p in wall.placements}) if clusters else []
    entries = {f"cluster {number}": cluster_colour(number) for number in used}
    if wall.wedges:
        entries["wedge"] = WEDGE_COLOUR
    return entries
