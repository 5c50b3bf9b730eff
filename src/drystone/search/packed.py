"""Walls in few bytes: what is sent to other processes, and kept, to be built again.

All of it is plain: numbers, words and tuples of them.
"""

from dataclasses import dataclass

import numpy as np

from drystone.kernels.raster import Mask
from drystone.model.placement import Placement, Settled, Side, Wedge
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.model.wall import Group
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.planner import Planner
from drystone.planner.replay import replayed
from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.search.found import Courses, Found
from drystone.search.goal import Figures
from drystone.settle.rest import placed_outline

UNSEEN: Mask = np.ones((1, 1), bool)
"""Stands for the pixels of what is settled, which are found when it is placed."""


PackedWedge = tuple[tuple[float, float], ...]
"""Corners of a wedge, source px."""


@dataclass(frozen=True)
class PackedGroup:
    """One step of construction."""

    stone_id: int  # Of the stone
    angle_deg: float  # Its pose
    place: tuple[float, float]  # Where its centroid lies, source px
    side: Side  # From which end it was placed
    rotation_moves: int  # See `drystone.model.placement.Placement`
    wedges: tuple[PackedWedge, ...]  # Under it
    course_height_px: float | None  # See `drystone.planner.build.Candidate`


@dataclass(frozen=True, eq=False)
class Packed:
    """A finished wall and what it is worth, in few bytes."""

    groups: tuple[PackedGroup, ...]  # The steps of its construction
    figures: Figures | None  # See `drystone.search.found.Found`
    merit: float  # Likewise
    solves: Solves  # Likewise
    courses: Courses | None  # Likewise

    @classmethod
    def of(cls, found: Found) -> "Packed":
        """Pack a wall."""
        heights = found.build.course_heights_px()
        groups = tuple(_packed_group(group, heights) for group in found.build.wall.groups)
        return cls(groups, found.figures, found.merit, found.solves, found.courses)


def _packed_group(group: Group, heights: dict[int, float]) -> PackedGroup:
    placement, settled = group.placement, group.placement.settled
    assert settled is not None  # noqa: S101 - searches are of walls on outlines
    return PackedGroup(
        placement.stone_id,
        placement.posed.angle_deg,
        (settled.x_px, settled.y_px),
        placement.side,
        placement.rotation_moves,
        tuple(
            tuple((x, y) for x, y in wedge.corners.tolist())
            for wedge in group.wedges
            if wedge.corners is not None
        ),
        heights.get(placement.stone_id),
    )


def found_again(
    one: Packed, workshop: Workshop, settings: PlannerSettings, until: Deadline = NEVER
) -> Found:
    """Build a wall again."""
    start = Planner(workshop.stones, workshop.site, settings=settings, workshop=workshop).build
    groups = one.groups
    heights = {g.stone_id: g.course_height_px for g in groups if g.course_height_px is not None}
    again = [_group(group, workshop) for group in groups]
    build, left_out, _ = replayed(start, again, heights, workshop, settings, until=until)
    if left_out:
        raise ValueError(f"stones {left_out} do not stand where they stood")
    return Found(build, one.figures, one.merit, one.solves, one.courses)


def _group(one: PackedGroup, workshop: Workshop) -> Group:
    stone = workshop.stones.by_id(one.stone_id)
    posed = PosedStone(stone, one.angle_deg, workshop.site.scale, UNSEEN.copy(), (0.0, 0.0))
    settled = settled_again(stone, one.angle_deg, one.place, workshop)
    placement = Placement(posed, 0, 0, one.side, one.rotation_moves, settled)
    wedges = (
        Wedge(0, one.stone_id, UNSEEN.copy(), 0, 0, np.array(corners)) for corners in one.wedges
    )
    return Group(placement, tuple(wedges))


def settled_again(
    stone: Stone, angle_deg: float, place: tuple[float, float], workshop: Workshop
) -> Settled:
    """Return where a stone lies whose centroid is at a place, source px."""
    outline = workshop.outlines.outline(stone)
    return Settled(*place, placed_outline(outline, angle_deg, *place))
