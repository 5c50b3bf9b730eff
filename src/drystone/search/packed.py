"""Walls in few bytes: what is sent to other processes, where they are built again."""

from dataclasses import dataclass

import numpy as np

from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask
from drystone.model.placement import Placement, Settled, Side, Wedge
from drystone.model.pose import PosedStone
from drystone.model.wall import Group
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.planner import Planner
from drystone.planner.replay import replayed
from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.search.found import Courses, Found
from drystone.search.goal import Figures

UNSEEN: Mask = np.ones((1, 1), bool)
"""Stands for the pixels of a settled stone, which are found when it is placed."""


@dataclass(frozen=True, eq=False)
class PackedGroup:
    """One step of construction.

    Parameters
    ----------
    stone_id : int
        Of the stone.
    angle_deg : float
        Its pose.
    place : tuple of int or Settled
        Row and column of its mask; where it lies when it is settled.
    side : {"left", "right"}
        From which end it was placed.
    rotation_moves : int
        See :class:`drystone.model.placement.Placement`.
    wedges : tuple of ((h, w) bool array, int, int, (n, 2) float array or None)
        Mask, row, column and corners of each wedge.
    course_height_px : float or None
        See :class:`drystone.planner.build.Candidate`.
    """

    stone_id: int
    angle_deg: float
    place: tuple[int, int] | Settled
    side: Side
    rotation_moves: int
    wedges: tuple[tuple[Mask, int, int, Points | None], ...]
    course_height_px: float | None


@dataclass(frozen=True, eq=False)
class Packed:
    """A finished wall and what it is worth, in few bytes.

    Parameters
    ----------
    groups : tuple of PackedGroup
        The steps of its construction.
    figures : Figures or None
        See :class:`drystone.search.found.Found`.
    merit : float
        Likewise.
    solves : Solves
        Likewise.
    courses : Courses or None
        Likewise.
    """

    groups: tuple[PackedGroup, ...]
    figures: Figures | None
    merit: float
    solves: Solves
    courses: Courses | None

    @classmethod
    def of(cls, found: Found) -> "Packed":
        """Pack a wall."""
        heights = found.build.course_heights_px()
        groups = tuple(_packed_group(group, heights) for group in found.build.wall.groups)
        return cls(groups, found.figures, found.merit, found.solves, found.courses)


def _packed_group(group: Group, heights: dict[int, float]) -> PackedGroup:
    placement = group.placement
    return PackedGroup(
        placement.stone_id,
        placement.posed.angle_deg,
        placement.settled or (placement.row, placement.col),
        placement.side,
        placement.rotation_moves,
        tuple((wedge.mask, wedge.row, wedge.col, wedge.corners) for wedge in group.wedges),
        heights.get(placement.stone_id),
    )


def found_again(
    one: Packed, workshop: Workshop, settings: PlannerSettings, until: Deadline = NEVER
) -> Found:
    """Build a wall again.

    Raises
    ------
    ValueError
        When it does not stand, as another wall than the one that was packed may.
    TimeIsUp
        The time limit struck.
    """
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
    wedges = tuple(
        Wedge(0, one.stone_id, mask, row, col, corners) for mask, row, col, corners in one.wedges
    )
    if isinstance(one.place, Settled):
        posed = PosedStone(stone, one.angle_deg, workshop.site.scale, UNSEEN.copy(), (0.0, 0.0))
        placement = Placement(posed, 0, 0, one.side, one.rotation_moves, one.place)
    else:
        posed = workshop.book.pose(stone, one.angle_deg)
        placement = Placement(posed, *one.place, one.side, one.rotation_moves)
    return Group(placement, wedges)
