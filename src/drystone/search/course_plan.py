"""A wall planned course by course, before its stones are laid."""

from dataclasses import dataclass

from drystone.model.placement import Side


@dataclass(frozen=True)
class PlannedStone:
    """Where a stone shall lie, as far as height profiles tell."""

    stone_id: int  # Its id
    angle_deg: float  # Counter-clockwise from the source image
    side: Side  # From which end of the wall its course is laid up to it
    x_px: float  # Its centroid in the wall frame, source px
    y_px: float
    left_px: float  # Its box there
    right_px: float
    top_px: float


@dataclass(frozen=True)
class CoursePlan:
    """A wall planned course by course."""

    # The lowest first; each in the order of laying: from both ends to the course's gap
    courses: tuple[tuple[PlannedStone, ...], ...]
    cost: float  # What the plan was found to cost, lower is better
