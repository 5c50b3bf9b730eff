"""What the suites "search" and "packing" build: published stones, and sets made for them alone."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.random import Generator

from drystone.errors import UsageError
from drystone.generate.brick import BrickSettings, brick_stones
from drystone.generate.fourier import FourierSettings, fourier_stones
from drystone.generate.polygon import PolygonSettings, polygon_stones
from drystone.generate.rubble import RubbleSettings, rubble_stones
from drystone.model.stone import StoneSet
from drystone_lab.exact_walls import QUICK, TARGETS, Geometry, Target
from drystone_lab.table import BenchSettings

MASONS = TARGETS[:4]
"""Walls of the published stones of Almeida et al. (2021), whose masons' walls are known."""

Source = Callable[[Generator], StoneSet]


@dataclass(frozen=True)
class SearchTarget:
    """A wall that is searched.

    Parameters
    ----------
    target : Target
        Stones and size.
    geometry : {"exact", "raster"}
        Of its stones.
    """

    target: Target
    geometry: Geometry

    @property
    def name(self) -> str:
        """What tells it from the others."""
        return f"{self.target.name}, {self.geometry}"


Named = TypeVar("Named", Target, SearchTarget)


def _fixed(make: Callable[[Generator], StoneSet], seed: int) -> Source:
    """Make the same stones whatever the seed of the suite is, which is that of the search."""
    return lambda _: make(np.random.default_rng(seed))


def _fourier(rng: Generator) -> StoneSet:
    sizes = FourierSettings(count=45, smallest_radius_px=16, largest_radius_px=34, D2=0.15)
    return fourier_stones(sizes, rng)


def _polygons(noise: float) -> Source:
    return lambda rng: polygon_stones(PolygonSettings(count=40, noise=noise), rng)


def _rubble_60(rng: Generator) -> StoneSet:
    return rubble_stones(RubbleSettings(count=60, width_px=900, height_px=300, courses=5), rng)


def _rubble_120(rng: Generator) -> StoneSet:
    return rubble_stones(RubbleSettings(count=120, width_px=1400, height_px=420, courses=7), rng)


def _bricks(rng: Generator) -> StoneSet:
    return brick_stones(BrickSettings(count=40, height_px=24, aspect=2.5, halves=8), rng)


UNSEEN = (
    Target("Fourier, 45", _fixed(_fourier, 9301), 621, 200, 0.6),
    Target("polygons 20 %, 40", _fixed(_polygons(0.2), 9302), 1462, 400, 0.3),
    Target("polygons 60 %, 40", _fixed(_polygons(0.6), 9303), 1462, 400, 0.25),
    Target("rubble, 60", _fixed(_rubble_60, 9304), 990, 300, 0.5),
    Target("rubble, 120", _fixed(_rubble_120, 9305), 1437, 450, 0.45),
    Target("bricks, 48", _fixed(_bricks, 9306), 550, 144, 0.6),
)
"""Sets that no setting had been tuned on when they were measured; walls of their area over .8."""


def search_targets(settings: BenchSettings) -> tuple[SearchTarget, ...]:
    """Return the walls of the suite "search", those of published stones on both geometries."""
    published = QUICK if settings.quick else MASONS
    walls = [
        *(
            SearchTarget(target, geometry)
            for geometry in ("exact", "raster")
            for target in published
        ),
        *(SearchTarget(target, "exact") for target in UNSEEN if not settings.quick),
    ]
    return chosen(walls, settings)


def chosen(walls: Sequence[Named], settings: BenchSettings) -> tuple[Named, ...]:
    """Return the walls that are asked for by the beginnings of their names.

    Raises
    ------
    UsageError
        E138 when there is none that begins so.
    """
    names = [wall.name for wall in walls]
    unknown = [part for part in settings.only if not any(n.startswith(part) for n in names)]
    if unknown:
        raise UsageError(
            "E138",
            f"no wall begins with {unknown[0]!r}.",
            where="--only",
            cure=f"There are {'; '.join(names)}.",
        )
    only = settings.only or ("",)
    return tuple(wall for wall in walls if wall.name.startswith(only))
