"""A search that begins with a wall that was planned before."""

from collections.abc import Mapping
from dataclasses import replace

from drystone.model.site import Site
from drystone.model.wall import Group, Wall, outlined
from drystone.model.wedge_shape import WedgeShape
from drystone.planner.planner import Planner
from drystone.planner.replay import differences, refuse
from drystone.planner.workshop import Workshop
from drystone.search.yard import Yard
from drystone.settle.rest import settled_at
from drystone.settle.wedge import squeezed_out

EDGE_PX = 1e-6
"""What rounding may add to `settle.beyond_px`, source px."""


def begin_with(
    planner: Planner, wall: Wall, course_heights_px: Mapping[int, float]
) -> tuple[int, ...]:
    """Let a planner begin with a wall, as far as its stones may be used and stand.

    Without its wedges that are none by these settings.  The planner has built nothing yet.  On
    outlines the wall may be of another size or resolution.  For stones that began a course, the
    height is that which Eq. 8 compared with.  Returns the ids of the stones that were taken out:
    banned or not there, out of their turn in a given order, standing out of the wall by more than
    `settle.beyond_px` allows now, or not standing with these settings, as when what carried them
    is left out.  UsageError (E144): those that may be used are of something else.
    """
    yard = Yard.of(planner)
    workshop, settings = yard.workshop, yard.settings
    fitting = set(workshop.fitting)
    usable = tuple(group for group in wall.groups if group.placement.stone_id in fitting)
    site = workshop.site if wall.outlines is None else wall.site
    refuse(differences(replace(wall, groups=usable), workshop.stones, site, settings), "begin")
    groups, last = [], -1
    for group in usable:
        stone_id = group.placement.stone_id
        in_turn = settings.order == "free" or stone_id > last
        if in_turn and _within(group, workshop.site, settings.settle.beyond_px):
            groups.append(_as_here(wall, group, workshop))
            last = stone_id
    finer = workshop.site.scale / wall.site.scale
    heights = {stone_id: px * finer for stone_id, px in course_heights_px.items()}
    planner.build, _, solves = yard.replayed(planner.build, groups, heights, strict=False)
    planner.solves += solves
    used = {action.stone_id for action in planner.build.actions}
    return tuple(p.stone_id for p in wall.placements if p.stone_id not in used)


def _within(group: Group, site: Site, beyond_px: float) -> bool:
    """Say whether outlines stand out over the ends and the top by no more than they may."""
    if group.placement.settled is None:
        return True
    least = -beyond_px - EDGE_PX
    width, height = site.extent_px
    return all(
        min(x.min(), width - x.max(), height - y.max()) >= least
        for x, y in (corners.T for _, corners in outlined(group.placement, group.wedges))
    )


def _as_here(wall: Wall, group: Group, workshop: Workshop) -> Group:
    """Return a step on outlines as this search has it.

    With its own outline of the stone, that of a plan may be coarser, and without the wedges that
    no mason would cut or with nothing beside them.
    """
    placement, settled = group.placement, group.placement.settled
    if settled is None:
        return group
    limits, around, width = workshop.limits, wall.exact.polygons, workshop.site.extent_px[0]
    kept = (
        wedge
        for wedge in group.wedges
        if wedge.corners is not None
        and limits.allows(WedgeShape.of(wedge.corners))
        and not squeezed_out(wedge.corners, settled.corners, around, width, limits)
    )
    outline, angle_deg = workshop.outlines.outline(placement.posed.stone), placement.posed.angle_deg
    again = settled_at(outline, angle_deg, settled.x_px, settled.y_px)
    return Group(replace(placement, settled=again), tuple(kept))
