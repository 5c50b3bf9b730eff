"""The outlines of a wall as a file draws them: blocks that stand on their lowest point."""

import math
from collections.abc import Collection, Mapping

import numpy as np
import shapely

from drystone.errors import LabelImageError, Notice
from drystone.io.outlines_in.fill import filled_area
from drystone.io.outlines_in.model import Area, OutlineFile
from drystone.io.outlines_in.silhouettes import outer_edge
from drystone.io.pictures import check_size
from drystone.kernels.polygons import Points
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels

MOST_PX = 200_000_000
"""Of a picture of a wall."""


def wall_outlines(file: OutlineFile, stones: StoneSet) -> dict[int, Points] | None:
    """Return the outlines of the stones that were read, (n, 2) by id, counter-clockwise and closed.

    They are in px, y up from the lowest point; of a file in px x is that of its image.  Ground that
    the file draws is level, and what is wholly under it is not there.  Holes are filled, and of a
    stone in several pieces the largest counts, as when its pixels are read.  None when some stone
    is known by pixels only.
    """
    known = {stone.id or 0: stone for stone in file.stones}
    ids = [stone.id for stone in stones]
    if any(i not in known or known[i].masks or not known[i].areas for i in ids):
        return None
    scale = 1.0 if file.unit_m is None else file.unit_m * (stones.source.px_per_m or 1.0)
    sign = 1.0 if file.y_up else -1.0
    try:
        edges = {i: outer_edge(known[i].rings) for i in ids}
    except ValueError:  # crossings without end
        return None
    found = {i: edge * (scale, sign * scale) for i, edge in edges.items() if edge is not None}
    if len(found) < len(ids):
        return None
    if file.ground is not None:
        found = _on_ground(found, file.ground * (1.0, -1.0))
    corners = np.concatenate(list(found.values()))
    # Of an image the left edge is that of the wall, but for what reaches beyond it.
    left = corners[:, 0].min()
    left = left if file.unit_m or file.y_up else min(0.0, np.floor(left))
    origin = np.array([left, corners[:, 1].min()])
    return {i: _closed(outline - origin) for i, outline in found.items()}


def outlines_painted(outlines: Mapping[int, Points]) -> Labels:
    """Return the label image whose lower left corner is the origin of outlines in px.

    Where they overlap the smaller stone is seen.  E110 where it would fill the memory.
    """
    corners = np.concatenate(list(outlines.values()))
    width, height = (max(1, math.ceil(side - 1e-9)) for side in corners.max(axis=0).tolist())
    check_size(width, height, MOST_PX, "Is a corner far away from the wall? Correct it.")
    labels = np.zeros((height, width), np.uint32)
    size = {i: shapely.Polygon(outline).area for i, outline in outlines.items()}
    for i in sorted(outlines, key=lambda one: (-size[one], one)):
        ring = outlines[i][:-1] * (1.0, -1.0) + (0.0, float(height))
        placed = filled_area(Area((ring,), "nonzero"))
        if placed is None:
            continue
        top, left, bottom, right = placed.sides
        labels[top:bottom, left:right][placed.mask] = i
    return labels


def not_cut(notices: Collection[Notice]) -> tuple[Notice, ...]:
    """Leave out that outlines were cut at the edges of their image: blocks are not."""
    return tuple(one for one in notices if "outside the image, cut off" not in one.message)


def _on_ground(rings: Mapping[int, Points], ground: Points) -> dict[int, Points]:
    """Turn rings until the ground is level; what is buried under it is cut off, or left out."""
    along = ground[1] - ground[0]
    cos, sin = along / np.hypot(*along) * np.sign(along[0])
    above = {}
    for i, ring in rings.items():
        corners = (ring - ground[0]) @ [[cos, -sin], [sin, cos]] + ground[0]
        turned = shapely.make_valid(shapely.Polygon(corners))
        left, _, right, top = turned.bounds
        seen = turned & shapely.box(left, ground[0, 1], right, max(top, ground[0, 1]))
        parts = [part for part in shapely.get_parts(seen) if part.area > 0.0]
        if parts:
            above[i] = np.array(max(parts, key=shapely.area).exterior.coords)[:-1]
    if not above:
        what = "no stone is above the ground that was drawn."
        raise LabelImageError("E104", what, cure="Draw the ground under the wall.")
    return above


def _closed(ring: Points) -> Points:
    """Return a ring as a closed line, counter-clockwise, without corners twice in a row."""
    shape = shapely.remove_repeated_points(shapely.Polygon(ring), 1e-9)
    return np.asarray(shapely.get_coordinates(shapely.orient_polygons(shape).exterior))
