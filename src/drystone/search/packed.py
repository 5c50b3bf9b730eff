"""Walls in few bytes: what is sent to other processes, and kept, to be built again.

All of it is plain: numbers, words and tuples of them.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from drystone.kernels.raster import Mask
from drystone.model.placement import Placement, Side, Wedge
from drystone.model.pose import PosedStone
from drystone.model.wall import Group
from drystone.planner.build import Solves
from drystone.planner.workshop import Workshop
from drystone.search.goal import Courses, FoundWall, WallFigures
from drystone.search.yard import Yard
from drystone.settle.rest import settled_at

UNSEEN: Mask = np.ones((1, 1), bool)
"""Stands for the pixels of what is settled, which are found when it is placed."""

MOST = 12
"""So many walls are kept."""

STEPS = {"F_SF": 0.005, "F_AV": 1.0, "F_AH": -0.1, "carried": 0.02}
"""Differences of figures that count; below 0 where less is better."""


@dataclass(frozen=True)
class PackedGroup:
    """One step of construction; lengths in source px."""

    stone_id: int
    angle_deg: float
    place: tuple[float, float]  # of the stone's centroid
    side: Side
    rotation_moves: int
    wedges: tuple[tuple[tuple[float, float], ...], ...]  # corners of those under the stone
    course_height_px: float | None


@dataclass(frozen=True, eq=False)
class PackedWall:
    """A :class:`~drystone.search.goal.FoundWall` as the steps of its construction."""

    groups: tuple[PackedGroup, ...]
    figures: WallFigures | None
    merit: float
    solves: Solves
    courses: Courses | None

    @classmethod
    def of(cls, found: FoundWall) -> "PackedWall":
        """Pack a wall."""
        heights = found.build.course_heights_px()
        groups = tuple(_packed_group(group, heights) for group in found.build.wall.groups)
        return cls(groups, found.figures, found.merit, found.solves, found.courses)


def _packed_group(group: Group, heights: dict[int, float]) -> PackedGroup:
    placement, settled = group.placement, group.placement.exact
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


def found_again(one: PackedWall, yard: Yard) -> FoundWall:
    """Build a wall again; ValueError when it does not stand, as another wall may."""
    groups = [_group(group, yard.workshop) for group in one.groups]
    heights = {g.stone_id: g.course_height_px for g in one.groups if g.course_height_px is not None}
    build, left_out, _ = yard.replayed(yard.planner().build, groups, heights)
    if left_out:
        raise ValueError(f"stones {left_out} do not stand where they stood")
    return FoundWall(build, one.figures, one.merit, one.solves, one.courses)


def _group(one: PackedGroup, workshop: Workshop) -> Group:
    stone = workshop.stones.by_id(one.stone_id)
    posed = PosedStone(stone, one.angle_deg, workshop.site.scale, UNSEEN.copy(), (0.0, 0.0))
    settled = settled_at(workshop.outlines.outline(stone), one.angle_deg, *one.place)
    placement = Placement(posed, 0, 0, one.side, one.rotation_moves, settled)
    wedges = (Wedge(0, one.stone_id, UNSEEN.copy(), 0, 0, np.array(cut)) for cut in one.wedges)
    return Group(placement, tuple(wedges))


def archived(kept: Iterable[PackedWall], more: Iterable[PackedWall]) -> tuple[PackedWall, ...]:
    """Add walls to those of which none is beaten by another; the best first, at most :data:`MOST`.

    A wall is beaten by one of at least its merit that is at least as good in every figure, rounded
    to :data:`STEPS`; one that lacks pinned stones is, by any of more merit that lacks fewer.  Of
    equal ones the first is kept.
    """
    scored = [(wall, score_of(wall.figures)) for wall in (*kept, *more) if wall.figures is not None]
    # None is beaten by one after it.
    scored.sort(key=lambda one: (one[0].merit, one[1]), reverse=True)
    found: list[tuple[PackedWall, tuple[int, ...]]] = []
    for wall, score in scored:
        # One that lacks fewer is better whatever its figures are.
        if not any(
            other[0] > score[0] or all(a >= b for a, b in zip(other, score, strict=True))
            for _, other in found
        ):
            found.append((wall, score))
    return tuple(wall for wall, _ in found[:MOST])


def score_of(figures: WallFigures) -> tuple[int, ...]:
    """Return the pinned stones that are there, and the figures in steps; higher is better."""
    steps = (round(getattr(figures, name) / step) for name, step in STEPS.items())
    return (-figures.missing, *steps)
