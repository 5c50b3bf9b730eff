"""The state of construction: what is built, and what it carries."""

from dataclasses import dataclass

from drystone.indices.values import Indices
from drystone.model.placement import Side
from drystone.model.wall import Wall
from drystone.stabilise.stabilise import Stabilised
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance


@dataclass(frozen=True, eq=False)
class Proposal:
    """A stone, stabilised somewhere; whether the wall then stands is not known yet.

    Parameters
    ----------
    stabilised : Stabilised
        Placement and wedges.
    trial_angle_deg : float
        Angle of the pose that was tried, before stabilisation.
    other_heights_px : tuple of float
        Heights of the other candidates of the step (Eq. 8).
    cost : float
        Weighted craft cost (:mod:`drystone.selection.scored`); 0 when no rule asks for it.
    """

    stabilised: Stabilised
    trial_angle_deg: float
    other_heights_px: tuple[float, ...] = ()
    cost: float = 0.0

    @property
    def stone_id(self) -> int:
        """Id of the stone."""
        return self.stabilised.placement.stone_id

    @property
    def side(self) -> Side:
        """End of the wall from which it is placed."""
        return self.stabilised.placement.side


@dataclass(frozen=True, eq=False)
class Candidate:
    """One evaluated action (M_m, S_m).

    Parameters
    ----------
    proposal : Proposal
        The action.
    indices : Indices
        Of the action.
    course_height_px : float or None
        Mean height of the other candidates when the stone begins a course (Eq. 8).
    model : RigidBlockModel
        Of the wall with the action done.
    resistance : LateralResistance
        Of that model.
    """

    proposal: Proposal
    indices: Indices
    course_height_px: float | None
    model: RigidBlockModel
    resistance: LateralResistance

    @property
    def stabilised(self) -> Stabilised:
        """Placement and wedges."""
        return self.proposal.stabilised

    @property
    def stone_id(self) -> int:
        """Id of the stone."""
        return self.proposal.stone_id

    @property
    def side(self) -> Side:
        """End of the wall from which it is placed."""
        return self.proposal.side


@dataclass(frozen=True, eq=False)
class Build:
    """What is built after some steps; immutable.

    Parameters
    ----------
    wall : Wall
        Stones and wedges placed.
    model : RigidBlockModel
        Of the wall.
    actions : tuple of Candidate
        The chosen actions, in order.
    """

    wall: Wall
    model: RigidBlockModel
    actions: tuple[Candidate, ...] = ()

    def add(self, action: Candidate) -> "Build":
        """Return the state after one more action (Eq. 1)."""
        wall = self.wall.add(action.stabilised.placement, action.stabilised.wedges)
        return Build(wall, action.model, (*self.actions, action))

    def count(self, side: Side) -> int:
        """How many stones were placed from a side."""
        return sum(action.side == side for action in self.actions)
