"""The state of construction: what is built, and what it carries."""

from dataclasses import dataclass, field, replace
from functools import cached_property

from drystone.contacts.interfaces import PointContacts
from drystone.indices import Indices
from drystone.model.placement import Side
from drystone.model.site import Site
from drystone.model.wall import Group, Wall
from drystone.statics.incremental import IncrementalAnalysis, incremental_analysis
from drystone.statics.lp.program import Units
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance


@dataclass(frozen=True)
class Solves:
    """How often the solver had trouble with a candidate while walls were built."""

    failed: int = 0  # it gave up, and the candidate was passed over
    cold: int = 0  # it had to start anew, which costs time alone

    def __add__(self, other: "Solves") -> "Solves":
        return Solves(self.failed + other.failed, self.cold + other.cold)

    def __sub__(self, other: "Solves") -> "Solves":
        """Return the trouble since then."""
        return Solves(self.failed - other.failed, self.cold - other.cold)


@dataclass(frozen=True, eq=False)
class Proposal:
    """A stone, stabilised somewhere; whether the wall then stands is not known yet."""

    stabilised: Group
    trial_angle_deg: float  # angle of the pose that was tried, before stabilisation
    # mean height of the other candidates of the step (Eq. 8); None when there are none
    course_height_px: float | None = None
    cost: float = 0.0  # weighted craft cost (`scored`); 0 when no rule asks for it
    spot: int = 0  # which of the places that were tried with this pose

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
    """One evaluated action (M_m, S_m)."""

    proposal: Proposal
    indices: Indices
    # mean height of the other candidates when the stone begins a course (Eq. 8)
    course_height_px: float | None
    model: RigidBlockModel
    resistance: LateralResistance  # maybe one-sided, until it is built
    # the model of outlines with fewer and less able contacts, in which the wall must stand as
    # well (`sturdy`); None for pixels
    sturdy_model: RigidBlockModel | None = None
    sturdy: bool = True  # whether it does
    # 1 where the solver had trouble with either model
    solves: Solves = field(default_factory=Solves)

    def __repr__(self) -> str:
        return f"<Candidate: {self.said}>"

    @property
    def stands(self) -> bool:
        """Whether the wall stands with it, also with fewer contacts (Algorithm 2: LLC > 0)."""
        return self.sturdy and (self.indices.LLC or 0.0) > 0.0

    @property
    def said(self) -> str:
        """Which stone it is, how far it is turned, and on how many wedges it stands."""
        angle_deg = self.stabilised.placement.posed.angle_deg
        wedges = len(self.stabilised.wedges)
        return f"stone {self.stone_id} turned by {angle_deg:.1f} deg, {wedges} wedges"

    @property
    def stabilised(self) -> Group:
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
    """What is built after some steps; immutable."""

    wall: Wall
    model: RigidBlockModel
    actions: tuple[Candidate, ...] = ()
    # of the wall before the last action; None when nothing will be built on the wall
    grown_from: IncrementalAnalysis | None = None
    before: "Build | None" = None  # the state before the last action, if it was kept
    sturdy_model: RigidBlockModel | None = None  # of a wall of outlines: see `Candidate`
    sturdy_from: IncrementalAnalysis | None = None  # of its sturdy model before the last action
    grown: IncrementalAnalysis | None = None  # of the wall, where it is known already

    @classmethod
    def empty(cls, site: Site, mu: float, stone_area_px: float, *, exact: bool = False) -> "Build":
        """Return the state before the first stone; exact: stones are their outlines, source px.

        `stone_area_px` is the mean area of the stones of the set, working px: the unit of weight
        of the limit analysis, whatever is built.
        """
        area = stone_area_px / site.scale**2 if exact else stone_area_px
        model = RigidBlockModel((), (), mu)
        analysis = incremental_analysis(model, Units(area**0.5, area))
        wall = Wall.empty(site, exact=exact)
        if not exact:
            return cls(wall, model, grown_from=analysis)
        return cls(wall, model, grown_from=analysis, sturdy_model=model, sturdy_from=analysis)

    @cached_property
    def analysis(self) -> IncrementalAnalysis:
        """Limit analysis of the wall, ready for one more stone.

        It depends on the models of the actions, one after the other, and on nothing else.
        """
        assert self.grown_from is not None  # noqa: S101 - a wall that is built on began empty
        return self.grown or self.grown_from.extended(self.model)

    @cached_property
    def sturdy_analysis(self) -> IncrementalAnalysis | None:
        """Limit analysis of the sturdy model, ready for one more stone; None for pixels."""
        if self.sturdy_from is None or self.sturdy_model is None:
            return None
        return self.sturdy_from.extended(self.sturdy_model)

    @cached_property
    def points(self) -> PointContacts:
        """Contacts at a point, which a new stone may close in."""
        return PointContacts.of(self.model.interfaces)

    def add(self, action: Candidate, *, keep: bool = False) -> "Build":
        """Return the state after one more action (Eq. 1).

        `keep`: the new state knows this one, to go back to it.
        """
        wall = self.wall.add(action.stabilised.placement, action.stabilised.wedges)
        grown = None
        if action.resistance.one_sided:
            grown = self.analysis.extended(action.model)
            action = replace(action, resistance=grown.result.resistance)
        return Build(
            wall, action.model, (*self.actions, action), self.analysis, self if keep else None,
            action.sturdy_model, self.sturdy_analysis, grown,
        )  # fmt: skip

    def states(self) -> "tuple[Build, ...]":
        """Return the states of construction that were kept, in order, and this one."""
        states = [self]
        while (before := states[-1].before) is not None:
            states.append(before)
        return tuple(reversed(states))

    def course_heights_px(self) -> dict[int, float]:
        """Return what Eq. 8 compared the stones with that began a course, by their ids."""
        return {
            action.stone_id: action.course_height_px
            for action in self.actions
            if action.course_height_px is not None
        }
