"""A wall of the paper's method step by step, and where the next stone could rest."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from drystone.indices import (
    geometrical_dice_score_at,
    interlocking_width_ratio,
    inward_slope,
    is_boundary,
    joints_below,
    left_neighbour,
    local_filling_ratio_at,
    neighbour_height_ratio,
    peak_columns,
    shape_factor,
    swept_pixels,
)
from drystone.kernels.lowering import Positions
from drystone.model.landscape import Box, Landscape, view_box
from drystone.model.pose import PosedStone
from drystone.model.wall import Wall
from drystone.placement.best import best_spots
from drystone.placement.feasible import feasible_positions
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.stabilise.stabilise import falls_to
from drystone.stabilise.support import Pose
from drystone.verify.replay import Stage, replay_plan
from drystone_lab.pictures.action import ActionView, NeighbourBox
from drystone_lab.reproduce.item import Context
from drystone_lab.runs.spec import RunSpec


@dataclass(frozen=True, eq=False)
class Moment:
    """A state of construction, before one of the stones that were placed."""

    number: int  # Of the stone that comes next, from 1
    wall: Wall
    workshop: Workshop  # All stones of the set
    settings: PlannerSettings

    @cached_property
    def landscape(self) -> Landscape:
        """What is built, seen from the left."""
        return Landscape.of(self.wall)

    @property
    def remaining(self) -> tuple[int, ...]:
        """Ids of the stones that are left and fit into the wall."""
        placed = {placement.stone_id for placement in self.wall.placements}
        return tuple(i for i in self.workshop.fitting if i not in placed)

    def positions(self, posed: PosedStone) -> Positions:
        """Return the feasible positions of a pose (§3.6), rows and columns of its mask."""
        return feasible_positions(self.landscape, posed, self.settings.placement.reach)

    def trial(self, stone_id: int) -> Pose | None:
        """Return where the rule of placement puts a stone; None when it fits nowhere."""
        poses = self.workshop.poses(stone_id)
        spots = best_spots(self.landscape, poses, self.settings.placement)
        return (poses[spots[0].pose], spots[0].row, spots[0].col) if spots else None


@dataclass(frozen=True, eq=False)
class Construction:
    """A finished run, to be looked at step by step."""

    stages: tuple[Stage, ...]  # The wall before and after each stone
    workshop: Workshop  # The stones
    settings: PlannerSettings

    @property
    def moments(self) -> Sequence[Moment]:
        """The states before each stone that was placed."""
        return [self.moment(number) for number in range(1, len(self.stages) + 1)]

    @property
    def halfway(self) -> Moment:
        """The state in which half of the stones that will be placed are there."""
        return self.moment(len(self.stages) // 2 + 1)

    @property
    def wall(self) -> Wall:
        """The finished wall."""
        return self.stages[-1].after

    def moment(self, number: int) -> Moment:
        """Return the state before a stone, counted from 1."""
        wall = self.stages[number - 1].before
        return Moment(number, wall, self.workshop, self.settings)


def construction(context: Context, spec: RunSpec) -> Construction:
    """Do a run of pixels from the left, and take it apart."""
    (outcome,) = context.run((spec,))
    stones = spec.source.stones(context.data)
    replay = replay_plan(outcome.as_plan, stones)
    workshop = Workshop.prepare(stones, replay.site, replay.settings)
    return Construction(replay.stages, workshop, replay.settings)


@dataclass(frozen=True, eq=False)
class RestingPlace:
    """A stone where it would rest."""

    posed: PosedStone  # The stone
    row: int  # row, col: Top-left corner of its mask
    col: int
    # SF, LFR, GDS, NHR, IWR and IS that have a meaning here: NHR beside a neighbour, IWR of an
    # inner stone over two joints, IS of a boundary stone
    values: Mapping[str, float]

    @property
    def order(self) -> tuple[int, int, int]:
        """Lower places first, then those further to the left, then the smaller id."""
        return -(self.row + self.posed.height_px), self.col, self.posed.stone.id


def resting_places(moment: Moment) -> tuple[RestingPlace, ...]:
    """Return every feasible position of every stone that is left at which it rests by itself."""
    occupied, settings = moment.wall.occupied, moment.settings.stabilise
    found = []
    for stone_id in moment.remaining:
        for posed in moment.workshop.poses(stone_id):
            factor = shape_factor(posed)
            found += [
                place_of(moment, posed, row, col, factor)
                for row, col in moment.positions(posed).tolist()
                if falls_to(occupied, (posed, row, col), settings) == 0
            ]
    return tuple(found)


def place_of(moment: Moment, posed: PosedStone, row: int, col: int, factor: float) -> RestingPlace:
    """Return a place with its indices."""
    landscape, end_px = moment.landscape, moment.workshop.stock.narrowest_px
    box = view_box(posed, row, col, landscape.height_px)
    values = {
        "SF": factor,
        "LFR": local_filling_ratio_at(landscape, posed, row, col),
        "GDS": geometrical_dice_score_at(landscape, posed, row),
    }
    neighbour = left_neighbour(landscape, box)
    if neighbour is not None:
        values["NHR"] = neighbour_height_ratio(box, neighbour, None)
    if is_boundary(landscape, box, end_px):
        values["IS"] = inward_slope(landscape, posed, col)
    elif box.bottom > 0 and None not in joints_below(landscape, box, end_px):
        values["IWR"] = interlocking_width_ratio(landscape, box, end_px)
    return RestingPlace(posed, row, col, values)


def extreme(places: Sequence[RestingPlace], name: str, *, best: bool) -> RestingPlace | None:
    """Return the place where an index is best, or worst; None when it has a meaning nowhere.

    Of equal ones the lowest, then that furthest to the left, then that of the smaller id.
    """
    meant = [place for place in places if name in place.values]
    # NHR is best at 0, the others when they are large.
    sign = 1.0 if (name == "NHR") == best else -1.0
    return min(meant, key=lambda p: (sign * p.values[name], p.order), default=None)


def amid_course(built: Construction) -> tuple[Moment, RestingPlace]:
    """Return a stone of a run that has a left neighbour and two joints below, and when it came.

    The first in the second half of the run, or else the stone that comes next halfway; where it
    was placed.
    """
    halfway = built.halfway.number
    steps = [(built.moment(n + 1), built.stages[n]) for n in range(halfway - 1, len(built.stages))]
    found = []
    for moment, stage in steps:
        at = stage.group.placement
        place = place_of(moment, at.posed, at.row, at.col, shape_factor(at.posed))
        if {"NHR", "IWR"} <= place.values.keys():
            return moment, place
        found.append((moment, place))
    return found[0]


def action_at(moment: Moment, posed: PosedStone, row: int, col: int) -> ActionView:
    """Return what the indices of a stone at a place measure, to be drawn."""
    landscape, end_px = moment.landscape, moment.workshop.stock.narrowest_px
    box = view_box(posed, row, col, landscape.height_px)
    ids = [placement.stone_id for placement in moment.wall.placements]

    def beside(found: Box | None) -> NeighbourBox | None:
        return None if found is None else NeighbourBox(ids[landscape.boxes.index(found)], found)

    below1, below2 = joints_below(landscape, box, end_px)
    return ActionView(
        labels=moment.wall.labels,
        posed=posed,
        row=row,
        col=col,
        swept=swept_pixels(landscape, posed, row, col),
        built_height=landscape.built_height_px,
        neighbour=beside(left_neighbour(landscape, box)),
        below=(beside(below1), beside(below2)),
        peaks=peak_columns(posed),
    )
