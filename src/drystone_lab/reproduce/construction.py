"""A wall of the paper's method step by step, with what the next stone could do at each."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from drystone.kernels.lowering import Positions
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.model.wall import Wall
from drystone.placement.best import best_spots
from drystone.placement.feasible import feasible_positions
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.stabilise.support import Pose
from drystone.verify.replay import Stage, replay_plan
from drystone_lab.reproduce.item import Context
from drystone_lab.runs.spec import RunSpec


@dataclass(frozen=True, eq=False)
class Moment:
    """A state of construction, before one of the stones that were placed.

    Parameters
    ----------
    number : int
        Of the stone that comes next, from 1.
    wall : Wall
        What is built.
    workshop : Workshop
        All stones of the set.
    settings : PlannerSettings
        Of the run.
    """

    number: int
    wall: Wall
    workshop: Workshop
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
    """A finished run, to be looked at step by step.

    Parameters
    ----------
    stages : tuple of Stage
        The wall before and after each stone.
    workshop : Workshop
        The stones.
    settings : PlannerSettings
        Of the run.
    """

    stages: tuple[Stage, ...]
    workshop: Workshop
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
