"""A wall of the paper's method step by step, and where the next stone could rest."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from drystone import indices
from drystone.kernels.lowering import Positions
from drystone.kernels.raster import Mask
from drystone.model.landscape import Box, Landscape, view_box
from drystone.model.placement import Placement
from drystone.model.pose import PosedStone
from drystone.model.wall import Wall
from drystone.placement.best import best_spots
from drystone.placement.feasible import feasible_positions
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.stabilise.stabilise import Pose
from drystone.verify.replay import Stage, replay_plan
from drystone_lab.reproduce.item import Context
from drystone_lab.walls import PR, Target


@dataclass(frozen=True, eq=False)
class Moment:
    """A state of construction, before one of the stones that were placed."""

    number: int  # Of the stone that comes next, from 1
    stage: Stage  # The wall before and after it
    workshop: Workshop  # All stones of the set
    settings: PlannerSettings

    @property
    def wall(self) -> Wall:
        """What is built."""
        return self.stage.before

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


def construction(context: Context, wall: Target = PR) -> Sequence[Moment]:
    """Do a run of pixels from the left, and return the states before each stone."""
    (outcome,) = context.run((wall.run(context.seed),))
    stones = wall.source.stones(context.data)
    replay = replay_plan(outcome.as_plan, stones)
    workshop = Workshop.prepare(stones, replay.site, replay.settings)
    stages = enumerate(replay.stages, 1)
    return [Moment(number, stage, workshop, replay.settings) for number, stage in stages]


@dataclass(frozen=True, eq=False)
class RestingPlace:
    """A stone where it would rest, and what its indices measure; working px."""

    moment: Moment  # Before it is placed
    posed: PosedStone  # The stone
    row: int  # row, col: Top-left corner of its mask
    col: int

    @cached_property
    def box(self) -> Box:
        """Bounding box of the stone, y up from the ground."""
        return view_box(self.posed, self.row, self.col, self.moment.landscape.height_px)

    @cached_property
    def neighbour(self) -> Box | None:
        """Left neighbour in its course."""
        return indices.left_neighbour(self.moment.landscape, self.box)

    @cached_property
    def below(self) -> tuple[Box | None, Box | None]:
        """Stones below1 and below2."""
        end_px = self.moment.workshop.stock.narrowest_px
        return indices.joints_below(self.moment.landscape, self.box, end_px)

    @cached_property
    def values(self) -> Mapping[str, float]:
        """SF, LFR, GDS, NHR, IWR and IS that have a meaning here.

        NHR has one beside a neighbour, IWR of an inner stone over two joints, IS of a boundary
        stone.
        """
        landscape, posed, box = self.moment.landscape, self.posed, self.box
        values = {
            "SF": indices.shape_factor(posed),
            "LFR": indices.local_filling_ratio_at(landscape, posed, self.row, self.col),
            "GDS": indices.geometrical_dice_score_at(landscape, posed, self.row),
        }
        if self.neighbour is not None:
            values["NHR"] = indices.neighbour_height_ratio(box, self.neighbour, None)
        end_px = self.moment.workshop.stock.narrowest_px
        if indices.is_boundary(landscape, box, end_px):
            values["IS"] = indices.inward_slope(landscape, posed, self.col)
        elif box.bottom > 0 and None not in self.below:
            values["IWR"] = indices.interlocking_width_ratio(landscape, box, end_px)
        return values

    @property
    def order(self) -> tuple[int, int, int]:
        """Lower places first, then those further to the left, then the smaller id."""
        return -(self.row + self.posed.height_px), self.col, self.posed.stone.id

    @property
    def pixels(self) -> Mask:
        """The stone in an image as large as the landscape."""
        image = np.zeros(self.moment.wall.labels.shape, bool)
        image[Placement(self.posed, self.row, self.col).window] = self.posed.mask
        return image


def amid_course(run: Sequence[Moment]) -> RestingPlace:
    """Return a stone of a run that has a left neighbour and two joints below, where it was placed.

    The first in the second half of the run, or else the stone that comes next halfway.
    """
    second_half = [(moment, moment.stage.group.placement) for moment in run[len(run) // 2 :]]
    places = [RestingPlace(moment, at.posed, at.row, at.col) for moment, at in second_half]
    return next((place for place in places if {"NHR", "IWR"} <= place.values.keys()), places[0])
