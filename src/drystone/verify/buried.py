"""Stones that cannot be lowered to their places from straight above (DESIGN 4.4)."""

import numpy as np
import shapely

from drystone.kernels.polygons import Points
from drystone.model.landscape import Landscape
from drystone.model.outlines import Outlines
from drystone.model.overlap import common_parts, shape_of
from drystone.placement.feasible import can_be_lowered
from drystone.verify.canvas import PENETRATION_PX
from drystone.verify.replay import Stage

SLIVER_CELLS = 1.0
"""What stands in the way is moved aside, or slid under, when it is not wider; working px.

Pixels cannot tell less either."""


def is_buried(stage: Stage) -> bool:
    """Say whether a stone cannot be lowered to its place from straight above."""
    placement, before = stage.group.placement, stage.before
    if before.outlines is not None and placement.settled is not None:
        sliver = SLIVER_CELLS / before.site.scale
        return lies_under(placement.settled.corners, before.outlines, sliver)
    landscape = Landscape.of(before)
    return not can_be_lowered(landscape, placement.posed, placement.row, placement.col)


def lies_under(corners: Points, outlines: Outlines, sliver: float) -> bool:
    """Say whether an earlier outline reaches into the way of a stone that comes from above.

    What one of them takes of the way counts where it is wider than `sliver`; all are source px.
    """
    boxes = outlines.polygons.boxes
    (left, bottom), right = corners.min(axis=0), corners[:, 0].max()
    beside = (boxes[:, 0] < right - sliver) & (boxes[:, 2] > left + sliver)
    met = np.flatnonzero(beside & (boxes[:, 3] > bottom))
    if not met.size:
        return False
    way = swept_upwards(corners, float(boxes[met, 3].max()))
    earlier = [shape_of(outlines.polygons.polygon(i)) for i in met.tolist()]
    parts = [part for shape in earlier for part in common_parts(way, shape)]
    # What is no thicker than a stone may lie deep in its bed does not stand in its way.
    bounds = shapely.bounds(shapely.buffer(parts, -PENETRATION_PX / 2.0))
    widths = bounds[:, 2] - bounds[:, 0] + PENETRATION_PX  # NaN of what vanishes
    return bool((widths > sliver).any())


def swept_upwards(corners: Points, top: float) -> shapely.Geometry:
    """Return the area, up to `top`, that a counter-clockwise polygon passes when it is lifted."""
    ends = np.roll(corners, -1, axis=0)
    ceiling = max(top, float(corners[:, 1].max()))
    # Above every point of the polygon is what is above the edges at its underside.
    columns = [
        shapely.Polygon([start, end, (end[0], ceiling), (start[0], ceiling)])
        for start, end in zip(corners.tolist(), ends.tolist(), strict=True)
        if start[0] < end[0]
    ]
    return shapely.union_all(columns)
