"""What the planner tells while it works."""

from dataclasses import dataclass
from typing import Literal

from drystone.model.frames3d import Pose3d, metres_of, photo_pose, wall_pose
from drystone.model.settings import typed
from drystone.planner.build import Build, Candidate


@dataclass(frozen=True, eq=False)
class Step:
    """One chosen action, as :meth:`drystone.planner.planner.Planner.steps` yields it.

    Poses are in metres (:mod:`drystone.model.frames3d`); without a scale of the site they raise
    UsageError (E131).
    """

    number: int  # 1 for the first stone
    action: Candidate  # stone, placement, wedges, indices and resistance
    build: Build  # the state after it
    candidates: int  # how many candidates were evaluated for it

    def __repr__(self) -> str:
        x_px, y_px = self.action.stabilised.placement.centroid(self.build.wall.site.height_px)
        return f"<Step {self.number}: {self.action.said}, centroid at ({x_px:.1f}, {y_px:.1f}) px>"

    @property
    def stone_id(self) -> int:
        """Id of the stone."""
        return self.action.stone_id

    @property
    def pose3d(self) -> Pose3d:
        """Where the centroid of its front face goes in the wall (frame W), of any thickness.

        A robot asks :meth:`place_pose` and :meth:`pick_pose`, with one thickness for both: they
        are of one point of the stone.
        """
        return self.place_pose()

    @typed
    def place_pose(self, thickness_m: float = 0.0) -> Pose3d:
        """Return where the centroid of the stone goes in the wall (frame W), and how it is turned.

        The centroid is half of the wall's thickness behind the front face.  UsageError (E131): the
        site has no scale; E138: the thickness is negative or not finite.
        """
        site, placement = self.build.wall.site, self.action.stabilised.placement
        x, y = placement.centroid(site.height_px)
        metres = metres_of(1.0 / site.scale, site.px_per_m)
        return wall_pose(x * metres, y * metres, thickness_m, placement.posed.angle_deg)

    @typed
    def pick_pose(self, thickness_m: float = 0.0) -> Pose3d:
        """Return where the stone lies in the picture that it was read from (frame P).

        Its centroid is half of its thickness above the ground.  The face that the camera sees is
        the front of the wall, a whole one above it.  Errors are those of :meth:`place_pose`.
        """
        x, y = self.action.stabilised.placement.posed.stone.centroid
        metres = metres_of(1.0, self.build.wall.site.px_per_m)
        return photo_pose(x * metres, y * metres, thickness_m)


@dataclass(frozen=True)
class Stopped:
    """Why construction ended."""

    # design goal reached, all stones placed, too many failures in a row, left so by a search,
    # stopped by the user, or by the time limit
    reason: Literal["filled", "stones", "failures", "search", "interrupted", "time"]
    text: str


INTERRUPTED = Stopped("interrupted", "interrupted")
OUT_OF_TIME = Stopped("time", "the time limit struck")

UNFINISHED = (INTERRUPTED.text, OUT_OF_TIME.text)
"""What a plan says of a wall that was cut short, and that can be gone on with."""


@dataclass(frozen=True)
class Incumbent:
    """The best wall of a search so far (:mod:`drystone.search`)."""

    walls: int  # how many have been built: the budget that repeats it
    stones: int  # placed in the best one
    merit: float  # what the goal makes of it; higher is better
    # its figures of merit at the working resolution
    F_SF: float
    F_LR: float
    F_AV: float
    F_AH: float
    repairs: int = 0  # turns in which repairs of it were looked for, once the search has ended


class Callbacks:
    """Told of everything the planner does; does nothing.  Subclass it to follow along."""

    def on_step(self, step: Step) -> None:
        """Follow the first pass: an action was chosen."""

    def on_walls(self, incumbent: Incumbent) -> None:
        """Follow the search: more walls have been built, or repairs of the best looked for."""
