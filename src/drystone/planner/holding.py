"""Whether an engine lets a stone stay where it is put: what some policies ask (Table 1)."""

import numpy as np

from drystone.kernels.polygons import Points
from drystone.kernels.raster import turn
from drystone.model.wall import Group, Wall, outlined
from drystone.physics.building import stays


def holds(wall: Wall, group: Group, mu: float) -> bool:
    """Say whether a stone stays where it is put when what is built does not move.

    Stones that are pixels are put into the engine by their outlines.
    """
    height = wall.site.height_px
    new = _blocks(group, height)
    built = [block for one in wall.groups for block in _blocks(one, height)]
    corners = np.vstack([points for _, points in new])
    low, high = corners.min(axis=0), corners.max(axis=0)
    low, high = low - (high - low), high + (high - low)  # as much again around it
    near = [
        block for block in built
        if (block[1].max(axis=0) >= low).all() and (block[1].min(axis=0) <= high).all()
    ]  # fmt: skip
    return stays(near, new, mu)


def _blocks(group: Group, height_px: int) -> list[tuple[int, Points]]:
    placement = group.placement
    if placement.settled is not None:
        return outlined(placement, group.wedges)
    posed = placement.posed
    outline = posed.scale * turn(posed.stone.outline, posed.angle_deg)
    blocks = [(placement.stone_id, outline + np.array(placement.centroid(height_px)))]
    for wedge in group.wedges:
        (rows, cols) = wedge.window
        low, high = height_px - rows.stop, height_px - rows.start
        box = [[cols.start, low], [cols.stop, low], [cols.stop, high], [cols.start, high]]
        blocks.append((wedge.id, np.array(box, float)))
    return blocks
