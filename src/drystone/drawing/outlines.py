"""Polygons to draw: along the pixel edges of label images, or the stones' own outlines."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.outline import pixel_rings
from drystone.kernels.polygons import area_and_centroid, turn
from drystone.kernels.raster import Mask
from drystone.model.wall import Labels, Wall

Loop = NDArray[np.float64]
"""(n, 2) corners (x, y), y up, first corner not repeated: counter-clockwise around stone,
clockwise around holes."""

Bounds = tuple[float, float, float, float]  # x0, y0, x1, y1
UNSEEN = 1e-3
"""Share of a wall's size that nobody sees: stones settle .01 source px above the ground."""


@dataclass(frozen=True, eq=False)
class Region:
    """What a label covers along pixel edges, px, or a polygon, as given; in the wall frame."""

    id: int
    loops: tuple[Loop, ...]
    centroid: tuple[float, float]


def label_regions(labels: Labels) -> tuple[Region, ...]:
    """Return the regions of a label image in the order of their ids."""
    ids, ranks = np.unique(labels, return_inverse=True)
    # Ranks instead of ids: find_objects makes a list as long as the largest id.
    ranks = ranks.reshape(labels.shape) + (0 if ids.size and ids[0] == 0 else 1)
    present, regions = [int(label) for label in ids if label], []
    for rank, window in enumerate(ndimage.find_objects(ranks), 1):
        mask = ranks[window] == rank
        left, bottom = window[1].start, len(labels) - window[0].stop
        rows, cols = np.nonzero(mask)
        x, y = left + float(cols.mean()) + 0.5, bottom + len(mask) - float(rows.mean()) - 0.5
        loops = tuple(loop + np.array([left, bottom], float) for loop in pixel_loops(mask))
        regions.append(Region(present[rank - 1], loops, (x, y)))
    return tuple(regions)


def wall_regions(wall: Labels | Mapping[int, Loop]) -> tuple[Region, ...]:
    """Return the regions of a wall, ordered by id, in the frame of its block model.

    A label image stands on its lowest stone pixel, as in
    :func:`drystone.contacts.blocks.model_from_labels`.  Polygons go either way round, closed or
    not.
    """
    if not isinstance(wall, Mapping):
        filled = np.flatnonzero((wall > 0).any(axis=1))
        return label_regions(wall[: int(filled[-1]) + 1]) if filled.size else ()
    regions = []
    for block in sorted(wall):
        loop = np.asarray(wall[block], float)
        if (loop[0] == loop[-1]).all():
            loop = loop[:-1]
        area, x, y = area_and_centroid(loop)
        regions.append(Region(block, (loop if area > 0 else loop[::-1],), (x, y)))
    return tuple(regions)


def rectangle(x: float, y: float, width: float, height: float) -> Loop:
    """Return the corners of a rectangle from its lower left one."""
    return np.array([(x, y), (x + width, y), (x + width, y + height), (x, y + height)])


def regions_box(*walls: Iterable[Iterable[Loop]]) -> Bounds:
    """Return x0, y0, x1, y1 of the loops of regions; a unit square when there are none."""
    loops = [loop for wall in walls for loops in wall for loop in loops]
    points = np.concatenate(loops) if loops else np.array([[0.0, 0.0], [1.0, 1.0]])
    (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return x0, y0, x1, y1


def stands_on_ground(regions: Iterable[Region]) -> bool:
    """Whether the lowest corner of a wall is at y = 0, where the ground is."""
    _, y0, x1, y1 = box = regions_box(region.loops for region in regions)
    return abs(y0) <= UNSEEN * max(x1 - box[0], y1 - y0)


def pixel_loops(mask: Mask) -> tuple[Loop, ...]:
    """Return the boundary of a mask along pixel edges, without collinear corners.

    The origin is its lower left corner.  Pixels that touch only at a corner get loops of their own.
    """
    loops = []
    for ring in pixel_rings(mask) if mask.any() else ():
        points = ring[:-1]
        steps = np.roll(points, -1, axis=0) - points
        loops.append(points[(steps != np.roll(steps, 1, axis=0)).any(axis=1)])
    return tuple(sorted(loops, key=lambda loop: tuple(loop[0])))


def wall_outlines(wall: Wall) -> dict[int, Loop]:
    """Return the outline of each stone and wedge in the wall frame, in the plan's units.

    A stone's is its own outline from the source image, turned and moved; a wedge's follows its
    pixels, unless the wall is one of outlines.
    """
    site = wall.site
    if wall.outlines is not None:
        px_per_m = site.px_per_m or 1.0
        return {block: loop / px_per_m for block, loop in wall.outlines.blocks}
    outlines: dict[int, Loop] = {}
    for group in wall.groups:
        placement = group.placement
        stone = turn(placement.posed.stone.outline, placement.posed.angle_deg) * site.scale
        points = stone + placement.centroid(site.height_px)
        outlines[placement.stone_id] = points * site.units_per_px
        for wedge in group.wedges:
            corner = (wedge.col, site.height_px - wedge.row - wedge.mask.shape[0])
            loop = max(pixel_loops(wedge.mask), key=len) + corner
            outlines[wedge.id] = loop * site.units_per_px
    return outlines
