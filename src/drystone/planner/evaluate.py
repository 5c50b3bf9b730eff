"""Trial placement, stabilisation and indices of one candidate (Algorithm 1, lines 7-16)."""

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
from drystone.model.pose import PosedStone
from drystone.placement.best import best_spots
from drystone.placement.feasible import can_be_lowered
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.craft import action_craft
from drystone.planner.profile import Profile
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Rest, Stock
from drystone.selection.scored import craft_cost
from drystone.stabilise.memory import StabiliseMemory
from drystone.stabilise.stabilise import Stabilised
from drystone.statics.contacts.blocks import model_with
from drystone.statics.result import LateralResistance


@dataclass(frozen=True, eq=False)
class Trial:
    """What is to be tried: one stone, from one side.

    Parameters
    ----------
    poses : tuple of PosedStone
        The stone as it may be turned for the trial; the placement rule picks one.
    landscape : Landscape
        What is built, seen from the side.
    rest : Rest or None
        What the stones that are left could fill; None when no choice depends on it.
    """

    poses: tuple[PosedStone, ...]
    landscape: Landscape
    rest: Rest | None


@dataclass(frozen=True, eq=False)
class Evaluator:
    """Turns trials into proposals, and proposals into candidates.

    Parameters
    ----------
    settings : PlannerSettings
        Of the planner.
    memory : StabiliseMemory
        Stabilises stones.
    stock : Stock
        Sizes of the set.
    profile : Profile
        Told where the time goes.
    """

    settings: PlannerSettings
    memory: StabiliseMemory
    stock: Stock
    profile: Profile = field(default_factory=Profile)

    def propose(self, build: Build, trial: Trial) -> Proposal | None:
        """Return the best stable placement of a stone; None when there is none (lines 8-15).

        Of the best positions by the placement rule, the first at which the stone can be made
        stable is taken; with `tries` = 1 that is the paper's single trial.  With `compare` = True
        all of them are stabilised, and the one of the least craft cost is taken.
        """
        landscape = trial.landscape
        with self.profile.part("placement"):
            views = [landscape.view(posed) for posed in trial.poses]
            spots = best_spots(landscape, views, self.settings.placement)
        best: Proposal | None = None
        for spot in spots:
            posed = trial.poses[spot.pose]
            with self.profile.part("stabilisation"):
                stabilised = self.memory.stabilise(
                    build.wall.occupied,
                    (posed, spot.row, landscape.view_col(posed, spot.col)),
                    landscape.side,
                    self.stock.largest_id + len(build.wall.wedges) + 1,
                )
            if stabilised is None or not self._reached(landscape, stabilised):
                continue
            proposal = self._proposal(trial, posed.angle_deg, stabilised)
            if not self.settings.placement.compare:
                return proposal
            if best is None or proposal.cost < best.cost - 1e-12:
                best = proposal
        return best

    def _reached(self, landscape: Landscape, stabilised: Stabilised) -> bool:
        """Say whether a stone that was turned can still be put where it is."""
        if self.settings.placement.reach == "any":
            return True
        placement = stabilised.placement
        posed, col = placement.posed, landscape.view_col(placement.posed, placement.col)
        return can_be_lowered(landscape, landscape.view(posed), placement.row, col)

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
            model = model_with(
                analysis.model,
                build.wall.labels,
                stabilised.placement,
                stabilised.wedges,
                build.points,
            )
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
        return Candidate(
            proposal, indices, course_height, model, grown.resistance, grown.solved_cold
        )

    def compared(self, landscape: Landscape, proposal: Proposal, judged: Candidate) -> Candidate:
        """Return a candidate that was judged before, compared with other candidates (Eq. 8)."""
        if proposal.course_height_px == judged.proposal.course_height_px:
            return judged
        nhr, course_height = first_or_next(
            landscape, proposal.stabilised.placement, proposal.course_height_px
        )
        indices = replace(judged.indices, NHR=nhr)
        return replace(judged, proposal=proposal, indices=indices, course_height_px=course_height)

    def _proposal(self, trial: Trial, trial_angle_deg: float, stabilised: Stabilised) -> Proposal:
        cost = 0.0
        if self.settings.weighs_craft:
            assert trial.rest is not None  # noqa: S101 - the attempt gives it then
            with self.profile.part("indices"):
                craft = action_craft(trial.landscape, stabilised, self.stock, trial.rest)
            cost = craft_cost(craft, self.settings.score)
        return Proposal(stabilised, trial_angle_deg, cost=cost)


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
