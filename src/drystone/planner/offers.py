"""What a policy sees of the candidates of a step, and asks an engine (Table 1)."""

from collections.abc import Iterable

import numpy as np

from drystone.kernels.polygons import Points, turn
from drystone.kernels.raster import wrap_deg
from drystone.model.plan import Point
from drystone.model.site import Site
from drystone.model.wall import Group, Wall, outlined
from drystone.physics.building import stays
from drystone.planner.build import Candidate
from drystone.selection.policy import Offer
from drystone.statics.model import GROUND, Interface

UPWARD = 0.1
"""A contact bears a stone when its unit normal, into the stone, goes up by more than this: an
upright face does not."""


def offer(candidate: Candidate, site: Site, wedge_ids: frozenset[int] = frozenset()) -> Offer:
    """Return what a policy sees of a candidate after which the wall stands.

    `wedge_ids` are those of the wedges that the wall has already.
    """
    wedge_ids |= {wedge.id for wedge in candidate.stabilised.wedges}
    placement = candidate.stabilised.placement
    settled, posed = placement.settled, placement.posed
    # What is settled, its model too, is in source px.
    scale = 1.0 if settled is None else site.scale
    if settled is None:
        (rows, cols), height = placement.window, site.height_px
        box = cols.start, height - rows.stop, cols.stop, height - rows.start
    else:
        box = *settled.corners.min(axis=0), *settled.corners.max(axis=0)
    left, bottom, right, top = (scale * float(end) for end in box)
    block = next(b for b in reversed(candidate.model.blocks) if b.id == candidate.stone_id)
    new = candidate.model.added or candidate.model
    pairs = [{i.block, i.other} for i in new.interfaces]
    touched = set().union(*(pair for pair in pairs if candidate.stone_id in pair))
    return Offer(
        stone_id=candidate.stone_id,
        angle_deg=candidate.proposal.trial_angle_deg,
        turned_deg=abs(wrap_deg(posed.angle_deg - candidate.proposal.trial_angle_deg)),
        side=candidate.side,
        indices=candidate.indices,
        area_px=scale**2 * block.area,
        left_px=left,
        bottom_px=bottom,
        right_px=right,
        top_px=top,
        centroid_px=placement.centroid(site.height_px),
        support_px=support_px(new.interfaces, candidate.stone_id, scale),
        touches=tuple(sorted(touched - {candidate.stone_id, GROUND} - wedge_ids)),
        wedges=len(candidate.stabilised.wedges),
        wall_width_px=site.width_px,
        wall_height_px=site.height_px,
    )


def support_px(
    interfaces: Iterable[Interface], stone_id: int, scale: float
) -> tuple[Point, Point] | None:
    """Return the ends of the line on which a stone is borne, if anything bears it.

    The leftmost and the rightmost of the bearing points (x, y) of all its supports, wedges among
    them; of points above each other the lower one; working px.  `scale` is the working px in a
    unit of the interfaces.
    """
    points: list[Point] = []
    for interface in interfaces:
        into = (interface.block == stone_id) - (interface.other == stone_id)
        if into * interface.normal[1] > UPWARD:
            points += [(scale * x, scale * y) for x, y in interface.points.tolist()]
    if not points:
        return None
    return min(points), min(points, key=lambda point: (-point[0], point[1]))


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
