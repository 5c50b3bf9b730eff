"""Walls that are planned on outlines and on pixels, shared by suites."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from drystone.generate.brick import BrickSettings, brick_stones
from drystone.generate.fourier import FourierSettings, fourier_stones
from drystone.generate.polygon import PolygonSettings, polygon_stones
from drystone.io.published import published_file
from drystone.io.read_stones import read_stones
from drystone.kernels.polygons import Points
from drystone.model.stone import StoneSet
from drystone.planner.settings import PlannerSettings, method_settings
from drystone.search.plan_result import PlanResult
from drystone.search.plan_wall import plan_wall
from drystone.verify.outlines import Group, plan_polygons
from drystone_lab.table import BenchSettings

Geometry = str
Outlined = tuple[int, Points]

NOISES = (10, 20, 40, 50, 70)
"""Noise of the published polygons of Thangavelu et al. (2018), %."""


@dataclass(frozen=True)
class Target:
    """A stone set and the wall to be built of it.

    Parameters
    ----------
    name : str
        For people.
    source : str or callable
        Path in the published data, or what makes the stones from a generator of random numbers.
    width, height : float
        Of the wall, source px; 0 for those of the source image.
    scale : float
        Working resolution over source resolution.
    """

    name: str
    source: str | Callable[[Generator], StoneSet]
    width: float
    height: float
    scale: float

    def stones(self, settings: BenchSettings) -> StoneSet | None:
        """Return the stones; None when the published data are not there."""
        if not isinstance(self.source, str):
            return self.source(np.random.default_rng(settings.seed))
        path = None if settings.data is None else published_file(settings.data, self.source)
        return read_stones(path) if path is not None and path.exists() else None

    def size(self, stones: StoneSet) -> tuple[float, float]:
        """Return the width and height of the wall, source px."""
        source = stones.source
        return self.width or float(source.width_px), self.height or float(source.height_px)


def _fourier(rng: Generator) -> StoneSet:
    sizes = FourierSettings(count=40, smallest_radius_px=15, largest_radius_px=35, D2=0.2)
    return fourier_stones(sizes, rng)


def _polygons(rng: Generator) -> StoneSet:
    return polygon_stones(PolygonSettings(count=30, noise=0.2), rng)


def _bricks(rng: Generator) -> StoneSet:
    return brick_stones(BrickSettings(count=9), rng)


TARGETS = (
    Target("R", "almeida/R.png", 1445, 395, 0.2),
    Target("PR 600x160", "almeida/PR.png", 600, 160, 0.5),
    Target("PR 560x160", "almeida/PR.png", 560, 160, 0.5),
    Target("IR", "almeida/IR.png", 1443, 383, 0.3),
    *(Target(f"noise {n} %", f"thangavelu/noise_{n}.png", 0, 0, 0.3) for n in NOISES),
    Target("Fourier", _fourier, 400, 200, 0.6),
    Target("polygons", _polygons, 800, 460, 0.3),
)

QUICK = (Target("bricks", _bricks, 108, 36, 1.0),)
"""What every suite can do in a second or two."""


def targets(settings: BenchSettings, count: int | None = None) -> tuple[Target, ...]:
    """Return the targets of a suite, the first `count` unless it shall be quick."""
    return QUICK if settings.quick else TARGETS[:count]


@dataclass(frozen=True, eq=False)
class BuiltWall:
    """A wall of one target, geometry and seed.

    Parameters
    ----------
    target : Target
        What was to be built.
    geometry : {"exact", "raster"}
        Of the plan.
    seed : int
        Of the plan.
    stones : StoneSet
        What it was made from.
    result : PlanResult
        What came out.
    """

    target: Target
    geometry: Geometry
    seed: int
    stones: StoneSet
    result: PlanResult

    @property
    def name(self) -> str:
        """What tells it from the others."""
        return f"{self.target.name}, {self.geometry}, seed {self.seed}"

    @property
    def groups(self) -> tuple[Group, ...]:
        """Ids and outlines of the stones with their wedges, in order, source px.

        Of a plan on pixels they are the outlines of the stones in the planned poses.
        """
        return plan_polygons(self.result.plan, self.stones)


def one_pass(geometry: Geometry, budget: int = 1) -> PlannerSettings:
    """Return the settings of `best` on a geometry, with so many walls tried."""
    best = method_settings("best")
    return replace(best, geometry=geometry, search=replace(best.search, budget=budget))  # type: ignore[arg-type]


def built_walls(
    settings: BenchSettings,
    geometries: tuple[Geometry, ...] = ("exact", "raster"),
    seeds: int = 5,
    budget: int = 1,
) -> Iterator[BuiltWall]:
    """Plan walls, one after another.

    Parameters
    ----------
    settings : BenchSettings
        Without the folder of the published data only generated stones are used.  `quick` plans
        one wall of generated stones.
    geometries : tuple of str
        Each wall is planned on each.
    seeds : int
        How many walls of each target, from the seed of the settings on.
    budget : int
        Walls that are tried for each; 1 is one pass.
    """
    for target in targets(settings):
        stones = target.stones(settings)
        if stones is None:
            continue
        width, height = target.size(stones)
        for geometry in geometries:
            for seed in range(settings.seed, settings.seed + (1 if settings.quick else seeds)):
                result = plan_wall(
                    stones,
                    width,
                    height,
                    seed=seed,
                    settings=one_pass(geometry, budget),
                    scale=target.scale,
                )
                yield BuiltWall(target, geometry, seed, stones, result)
