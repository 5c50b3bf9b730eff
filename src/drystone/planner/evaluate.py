"""Resistance and indices of one candidate (Algorithm 1, line 16)."""

from dataclasses import dataclass, field, replace

from drystone.indices.dice_score import geometrical_dice_score_at
from drystone.indices.interlocking import interlocking_width_ratio
from drystone.indices.inward_slope import inward_slope, is_boundary
from drystone.indices.load_coefficient import limit_load_coefficient
from drystone.indices.local_filling import local_filling_ratio_at
from drystone.indices.neighbour_height import left_neighbour, neighbour_height_ratio
from drystone.indices.shape_factor import shape_factor
from drystone.indices.values import Indices
from drystone.model.landscape import Landscape, view_box
from drystone.model.placement import Placement
from drystone.model.wall import outlined
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.profile import Profile
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Stock
from drystone.planner.sturdy import sturdy_model_with
from drystone.stabilise.stabilise import Stabilised
from drystone.statics.contacts.blocks import model_with
from drystone.statics.contacts.settled import model_with_outlines
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance


@dataclass(frozen=True, eq=False)
class Evaluator:
    """Turns proposals into candidates.

    Parameters
    ----------
    settings : PlannerSettings
        Of the planner.
    stock : Stock
        Sizes of the set.
    profile : Profile
        Told where the time goes.
    """

    settings: PlannerSettings
    stock: Stock
    profile: Profile = field(default_factory=Profile)

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
        stabilised, analysis = proposal.stabilised, build.analysis
        with self.profile.part("contacts"):
            model = self._model(build, stabilised)
        with self.profile.part("limit analysis"):
            grown = analysis.resistance_with(model)
        with self.profile.part("indices"):
            indices, course_height = action_indices(
                landscape,
                stabilised,
                grown.resistance,
                proposal.course_height_px,
                self.stock.narrowest_px,
            )
        candidate = Candidate(
            proposal, indices, course_height, model, grown.resistance, grown.solved_cold,
            failed=grown.resistance.failed,
        )  # fmt: skip
        return self._sturdily(build, candidate)

    def _sturdily(self, build: Build, candidate: Candidate) -> Candidate:
        """Judge a wall of outlines by its sturdy model, too."""
        outlines, analysis = build.wall.outlines, build.sturdy_analysis
        if outlines is None or analysis is None:
            return candidate
        stabilised = candidate.stabilised
        with self.profile.part("contacts"):
            blocks = outlined(stabilised.placement, stabilised.wedges)
            model = sturdy_model_with(analysis.model, blocks, outlines, self.settings.settle)
        with self.profile.part("limit analysis"):
            grown = analysis.resistance_with(model)
        return replace(
            candidate,
            sturdy_model=model,
            sturdy=grown.resistance.stable,
            solved_cold=candidate.solved_cold or grown.solved_cold,
            failed=candidate.failed or grown.resistance.failed,
        )

    def _model(self, build: Build, stabilised: Stabilised) -> RigidBlockModel:
        """Return the model of the wall with an action done."""
        placement, wedges = stabilised.placement, stabilised.wedges
        model, wall = build.analysis.model, build.wall
        if wall.outlines is None:
            return model_with(model, wall.labels, placement, wedges, build.points)
        blocks = outlined(placement, wedges)
        tolerance_px = self.settings.settle.contact_px
        return model_with_outlines(model, blocks, wall.outlines, tolerance_px)

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
        LLC=limit_load_coefficient(resistance),
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
