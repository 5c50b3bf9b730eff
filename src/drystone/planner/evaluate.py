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
from drystone.model.landscape import Box, Landscape
from drystone.model.outlines import Outlined
from drystone.model.wall import Group, outlined
from drystone.planner.build import Build, Candidate, Proposal, Solves
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.profile import Profile
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Stock
from drystone.planner.sturdy import falls_when_let_go, sturdy_model_with
from drystone.statics.incremental import IncrementalAnalysis, IncrementalResult
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

        The landscape is that of the wall before, seen from the side of the stone.
        """
        group, wall = proposal.stabilised, build.wall
        if wall.outlines is None:
            self.until.look()
            with self.profile.part("contacts"):
                model = model_with(
                    build.analysis.model, wall.labels, group.placement, group.wedges, build.points
                )
            return self.candidate(landscape, proposal, self._loaded(build.analysis, model))
        blocks = outlined(group.placement, group.wedges)
        loaded = self.loaded(build, blocks)
        return self.candidate(landscape, proposal, loaded, self.sturdily(build, blocks))

    def candidate(
        self, landscape: Landscape, proposal: Proposal, loaded: Loaded, sturdy: Loaded | None = None
    ) -> Candidate:
        """Return the candidate of a proposal of which it is known what the wall carries after it.

        `sturdy` is its sturdy model (:mod:`drystone.planner.sturdy`); None for pixels.
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
        judged = proposal, indices, course_height, loaded.model, resistance
        if sturdy is None:
            return Candidate(*judged, solves=trouble(loaded))
        with self.profile.part("limit analysis"):
            stands = sturdy.grown.resistance.stable and not falls_when_let_go(loaded.model)
        return Candidate(*judged, sturdy.model, stands, trouble(loaded, sturdy))

    def loaded(self, build: Build, blocks: list[Outlined]) -> Loaded:
        """Return what a wall of outlines carries with a stone and its wedges, source px."""
        self.until.look()
        settle = self.settings.settle
        with self.profile.part("contacts"):
            model = model_with_outlines(
                build.analysis.model, blocks, build.wall.exact, settle.contact_px, settle.setback
            )
        return self._loaded(build.analysis, model)

    def sturdily(self, build: Build, blocks: list[Outlined]) -> Loaded:
        """Return the same of its sturdy model."""
        analysis = build.sturdy_analysis
        assert analysis is not None  # noqa: S101 - a wall of outlines has one
        with self.profile.part("contacts"):
            model = sturdy_model_with(
                analysis.model, blocks, build.wall.exact, self.settings.settle
            )
        return self._loaded(analysis, model)

    def _loaded(self, analysis: IncrementalAnalysis, model: RigidBlockModel) -> Loaded:
        with self.profile.part("limit analysis"):
            return Loaded(model, analysis.resistance_with(model))

    def compared(self, landscape: Landscape, proposal: Proposal, judged: Candidate) -> Candidate:
        """Return a candidate that was judged before, compared with other candidates (Eq. 8)."""
        if proposal.course_height_px == judged.proposal.course_height_px:
            return judged
        box = landscape.box(proposal.stabilised.placement)
        nhr, course_height = _first_or_next(landscape, box, proposal.course_height_px)
        indices = replace(judged.indices, NHR=nhr)
        return replace(judged, proposal=proposal, indices=indices, course_height_px=course_height)


def trouble(*models: Loaded) -> Solves:
    """Count the trouble with a place, once in all of its models."""
    grown = [one.grown for one in models]
    failed, cold = (one.resistance.failed for one in grown), (one.solved_cold for one in grown)
    return Solves(int(any(failed)), int(any(cold)))


def action_indices(
    landscape: Landscape,
    group: Group,
    resistance: LateralResistance,
    course_height_px: float | None,
    narrowest_px: float,
) -> tuple[Indices, float | None]:
    """Return the indices of an action, and the mean height of Eq. 8 if it was used.

    The landscape is that before the action, seen from the side of the stone; the resistance that
    of the wall after it; `course_height_px` the mean height of the other candidates, None when
    there are none; `narrowest_px` the width of the narrowest stone of the set.
    """
    placement = group.placement
    posed, box = landscape.view(placement.posed), landscape.box(placement)
    nhr, course_height = _first_or_next(landscape, box, course_height_px)
    indices = Indices(
        SF=shape_factor(placement.posed),
        LFR=local_filling_ratio_at(landscape, posed, placement.row, box.left),
        GDS=geometrical_dice_score_at(landscape, posed, placement.row),
        NHR=nhr,
        IWR=interlocking_width_ratio(landscape, box, narrowest_px),
        IS=inward_slope(landscape, posed, box.left),
        LLC=resistance.value,
        boundary=is_boundary(landscape, box, narrowest_px),
    )
    return indices, course_height


def _first_or_next(
    landscape: Landscape, box: Box, course_height_px: float | None
) -> tuple[float, float | None]:
    """Return NHR, and the mean height of Eq. 8 when the stone begins a course."""
    neighbour = left_neighbour(landscape, box)
    nhr = neighbour_height_ratio(box, neighbour, course_height_px)
    return nhr, course_height_px if neighbour is None else None
