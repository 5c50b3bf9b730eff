"""Resistance and indices of one candidate (Algorithm 1, line 16)."""

from dataclasses import dataclass, field, replace

from drystone.contacts.blocks import model_with
from drystone.contacts.settled import model_with_outlines
from drystone.indices import (
    Indices,
    geometrical_dice_score_at,
    interlocking_width_ratio,
    inward_slope,
    is_boundary,
    left_neighbour,
    local_filling_ratio_at,
    neighbour_height_ratio,
    shape_factor,
)
from drystone.model.landscape import Landscape, view_box
from drystone.model.outlines import Outlined
from drystone.model.placement import Placement
from drystone.model.wall import outlined
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.profile import Profile
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Stock
from drystone.planner.sturdy import falls_when_let_go, sturdy_model_with
from drystone.stabilise.stabilise import Stabilised
from drystone.statics.incremental import IncrementalResult
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance


@dataclass(frozen=True, eq=False)
class Loaded:
    """A wall with one more stone, and what it carries."""

    model: RigidBlockModel
    grown: IncrementalResult  # its resistance, and how that was found


@dataclass(frozen=True, eq=False)
class Evaluator:
    """Turns proposals into candidates."""

    settings: PlannerSettings
    stock: Stock  # sizes of the set
    profile: Profile = field(default_factory=Profile)  # told where the time goes
    until: Deadline = NEVER  # looked at for every wall that is judged: `TimeIsUp` ends the judging

    def judge(self, build: Build, landscape: Landscape, proposal: Proposal) -> Candidate:
        """Return the candidate of a proposal: all indices, with the wall's resistance after it.

        Parameters
        ----------
        build : Build
            Before the action.
        landscape : Landscape
            Of its wall, seen from the side from which the stone is placed.
        proposal : Proposal
            The action.
        """
        if build.wall.outlines is None:
            return self.candidate(landscape, proposal, self._of_pixels(build, proposal.stabilised))
        placement, wedges = proposal.stabilised.placement, proposal.stabilised.wedges
        blocks = outlined(placement, wedges)
        loaded = self.loaded(build, blocks)
        return self.candidate(landscape, proposal, loaded, self.sturdily(build, blocks))

    def candidate(
        self, landscape: Landscape, proposal: Proposal, loaded: Loaded, sturdy: Loaded | None = None
    ) -> Candidate:
        """Return the candidate of a proposal of which it is known what the wall carries after it.

        Parameters
        ----------
        landscape : Landscape
            Of the wall before the action, seen from the side from which the stone is placed.
        proposal : Proposal
            The action.
        loaded : Loaded
            The wall after it.
        sturdy : Loaded or None
            Its sturdy model; None for pixels.
        """
        resistance = loaded.grown.resistance
        with self.profile.part("indices"):
            indices, course_height = action_indices(
                landscape,
                proposal.stabilised,
                resistance,
                proposal.course_height_px,
                self.stock.narrowest_px,
            )
        candidate = Candidate(
            proposal, indices, course_height, loaded.model, resistance, loaded.grown.solved_cold,
            failed=resistance.failed,
        )  # fmt: skip
        if sturdy is None:
            return candidate
        with self.profile.part("limit analysis"):
            stands = sturdy.grown.resistance.stable and not falls_when_let_go(loaded.model)
        return replace(
            candidate,
            sturdy_model=sturdy.model,
            sturdy=stands,
            solved_cold=candidate.solved_cold or sturdy.grown.solved_cold,
            failed=candidate.failed or sturdy.grown.resistance.failed,
        )

    def loaded(self, build: Build, blocks: list[Outlined]) -> Loaded:
        """Return what a wall of outlines carries with a stone and its wedges.

        Parameters
        ----------
        build : Build
            The wall without them.
        blocks : list of (int, (n, 2) float array)
            Ids and outlines of the stone and its wedges, source px.
        """
        self.until.look()
        outlines, analysis = build.wall.outlines, build.analysis
        assert outlines is not None  # noqa: S101 - its caller knows
        with self.profile.part("contacts"):
            settle = self.settings.settle
            model = model_with_outlines(
                analysis.model, blocks, outlines, settle.contact_px, settle.setback
            )
        with self.profile.part("limit analysis"):
            return Loaded(model, analysis.resistance_with(model))

    def sturdily(self, build: Build, blocks: list[Outlined]) -> Loaded | None:
        """Return the same of its sturdy model; None when nothing is known of that of the wall."""
        outlines, analysis = build.wall.outlines, build.sturdy_analysis
        if outlines is None or analysis is None:
            return None
        with self.profile.part("contacts"):
            model = sturdy_model_with(analysis.model, blocks, outlines, self.settings.settle)
        with self.profile.part("limit analysis"):
            return Loaded(model, analysis.resistance_with(model))

    def _of_pixels(self, build: Build, stabilised: Stabilised) -> Loaded:
        self.until.look()
        analysis, labels = build.analysis, build.wall.labels
        placement, wedges = stabilised.placement, stabilised.wedges
        with self.profile.part("contacts"):
            model = model_with(analysis.model, labels, placement, wedges, build.points)
        with self.profile.part("limit analysis"):
            return Loaded(model, analysis.resistance_with(model))

    def compared(self, landscape: Landscape, proposal: Proposal, judged: Candidate) -> Candidate:
        """Return a candidate that was judged before, compared with other candidates (Eq. 8)."""
        if proposal.course_height_px == judged.proposal.course_height_px:
            return judged
        nhr, course_height = first_or_next(
            landscape, proposal.stabilised.placement, proposal.course_height_px
        )
        indices = replace(judged.indices, NHR=nhr)
        return replace(judged, proposal=proposal, indices=indices, course_height_px=course_height)


def action_indices(
    landscape: Landscape,
    stabilised: Stabilised,
    resistance: LateralResistance,
    course_height_px: float | None,
    narrowest_px: float,
) -> tuple[Indices, float | None]:
    """Return the indices of an action, and the mean height of Eq. 8 if it was used.

    Parameters
    ----------
    landscape : Landscape
        Before the action, seen from the side from which the stone is placed.
    stabilised : Stabilised
        The action.
    resistance : LateralResistance
        Of the wall after it.
    course_height_px : float or None
        Mean height of the other candidates; None when there are none.
    narrowest_px : float
        Width of the narrowest stone of the set.
    """
    placement = stabilised.placement
    posed = landscape.view(placement.posed)
    col = landscape.view_col(placement.posed, placement.col)
    box = view_box(posed, placement.row, col, landscape.height_px)
    nhr, course_height = first_or_next(landscape, placement, course_height_px)
    indices = Indices(
        SF=shape_factor(placement.posed),
        LFR=local_filling_ratio_at(landscape, posed, placement.row, col),
        GDS=geometrical_dice_score_at(landscape, posed, placement.row),
        NHR=nhr,
        IWR=interlocking_width_ratio(landscape, box, narrowest_px),
        IS=inward_slope(landscape, posed, col),
        LLC=resistance.value,
        boundary=is_boundary(landscape, box, narrowest_px),
    )
    return indices, course_height


def first_or_next(
    landscape: Landscape, placement: Placement, course_height_px: float | None
) -> tuple[float, float | None]:
    """Return NHR, and the mean height of Eq. 8 when the stone begins a course."""
    posed = landscape.view(placement.posed)
    col = landscape.view_col(placement.posed, placement.col)
    box = view_box(posed, placement.row, col, landscape.height_px)
    neighbour = left_neighbour(landscape, box)
    nhr = neighbour_height_ratio(box, neighbour, course_height_px)
    return nhr, course_height_px if neighbour is None else None
