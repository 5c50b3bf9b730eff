"""Walls that this project plans from the published stone sets, shared by suites."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from drystone.io.published import published_file
from drystone.io.read_stones import read_stones
from drystone.model.plan import Plan
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels
from drystone.search.plan_wall import plan_wall
from drystone.statics.model import RigidBlockModel
from drystone.verify.lengths import plan_settings
from drystone.verify.replay import Stage, replay_plan
from drystone.verify.stability import wall_model
from drystone_lab.table import BenchSettings

SETS = (("PR", 0.5, 560.0, 160.0), ("R", 0.2, 1445.0, 395.0), ("IR", 0.3, 1443.0, 383.0))
"""Stone set of Almeida et al. (2021), working scale, width and height of the wall in px."""


@dataclass(frozen=True, eq=False)
class PlannedWall:
    """A plan, and the wall after every step.

    Parameters
    ----------
    name : str
        Set, method and seed.
    plan : Plan
        The plan.
    stones : StoneSet
        What it was made from.
    """

    name: str
    plan: Plan
    stones: StoneSet

    @cached_property
    def stages(self) -> tuple[Labels, ...]:
        """Label image at the working scale after each stone and its wedges."""
        return tuple(stage.after.labels for stage in self._replayed)

    @cached_property
    def models(self) -> tuple[RigidBlockModel, ...]:
        """Models of the same walls on the geometry of the plan: of its pixels or its outlines."""
        settings, _ = plan_settings(self.plan)
        found = (wall_model(stage.after, settings) for stage in self._replayed)
        return tuple(model for model in found if model is not None)

    @cached_property
    def _replayed(self) -> tuple[Stage, ...]:
        return replay_plan(self.plan, self.stones).stages

    @property
    def mu(self) -> float:
        """Coefficient of friction of the plan."""
        return float(self.plan.settings["mu"])


def planned_walls(
    settings: BenchSettings, methods: tuple[str, ...] = ("paper", "best"), seeds: int = 1
) -> Iterator[PlannedWall]:
    """Plan walls from the published sets, one after another.

    Parameters
    ----------
    settings : BenchSettings
        `data` is the folder of the published sets; without it there are no walls.  `quick` plans
        only the smallest wall, by the first method.
    methods : tuple of str
        Of the planner.
    seeds : int
        Walls of each set and method, from the seed of the settings on.
    """
    if missing_data(settings):
        return
    assert settings.data is not None  # noqa: S101 - nothing is missing
    for name, scale, width, height in SETS[:1] if settings.quick else SETS:
        stones = read_stones(published_file(settings.data, f"almeida/{name}.png"))
        for method in methods[:1] if settings.quick else methods:
            for seed in range(settings.seed, settings.seed + (1 if settings.quick else seeds)):
                result = plan_wall(stones, width, height, seed=seed, method=method, scale=scale)
                yield PlannedWall(f"{name}, {method}, seed {seed}", result.plan, stones)


def missing_data(settings: BenchSettings) -> tuple[str, ...]:
    """Say in a note that rows are missing for want of data."""
    if settings.data is not None and (settings.data / "almeida").is_dir():
        return ()
    return ("Rows need the published stone sets: name their folder with --data.",)
