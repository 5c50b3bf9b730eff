"""A wall planned course by course, before its stones are laid."""

from dataclasses import dataclass

from drystone.model.placement import Side


@dataclass(frozen=True)
class PlannedStone:
    """Where a stone shall lie, as far as height profiles tell.

    Parameters
    ----------
    stone_id : int
        Its id.
    angle_deg : float
        Counter-clockwise from the source image.
    side : {"left", "right"}
        From which end of the wall its course is laid up to it.
    x_px, y_px : float
        Its centroid in the wall frame, source px.
    left_px, right_px, top_px : float
        Its box there.
    """

    stone_id: int
    angle_deg: float
    side: Side
    x_px: float
    y_px: float
    left_px: float
    right_px: float
    top_px: float


@dataclass(frozen=True)
class CoursePlan:
    """A wall planned course by course.

    Parameters
    ----------
    courses : tuple of tuple of PlannedStone
        The lowest first; each in the order of laying: from both ends to the course's gap.
    cost : float
        What the plan was found to cost, lower is better.
    """

    courses: tuple[tuple[PlannedStone, ...], ...]
    cost: float
