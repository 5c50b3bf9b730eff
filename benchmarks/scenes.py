"""What is timed: stones, walls half built, and walls with candidates on top."""

import os
from dataclasses import dataclass
from functools import cache
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.labels import coursed_labels, irregular_labels
from drystone.contacts.blocks import model_from_labels
from drystone.generate import RubbleSettings, rubble_stones
from drystone.io.published import published_file
from drystone.io.read_stones import read_stones
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall
from drystone.placement.best import best_spots
from drystone.planner.planner import Planner
from drystone.planner.settings import method_settings
from drystone.poses import PoseBook
from drystone.statics.incremental import IncrementalAnalysis, incremental_analysis
from drystone.statics.lp.program import units_of
from drystone.statics.model import GROUND, RigidBlockModel

WALL_PX = (560, 160)
"""Of the wall of the paper, px of the source image; 280 x 80 at the scale .5."""

LARGE_PX = 2048
"""Side of the large image."""

LARGE_FACTOR = 4
"""The stones of the large image are this many times 24 x 16 px."""


@dataclass(frozen=True)
class Stock:
    """Stones for a wall."""

    name: str  # Where they come from
    stones: StoneSet  # The stones
    wall_px: tuple[int, int]  # Width and height of the wall, px of the source image

    def site(self, scale: float) -> Site:
        """Return the site at a working resolution."""
        return Site.from_source(*self.wall_px, scale)


@dataclass(frozen=True)
class Scene:
    """A wall half built, and stones with the places where they would go."""

    name: str  # Size of the image
    wall: Wall  # What is built
    posed: tuple[PosedStone, ...]  # Stones that are left

    @property
    def pixels(self) -> int:
        """Size of the image."""
        return int(self.wall.labels.size)

    def landscape(self) -> Landscape:
        """Return a landscape of which nothing was asked yet."""
        return Landscape.of(self.wall)


def data_folder() -> Path | None:
    """Return the folder of the published stone sets, if it is there."""
    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("DRYSTONE_DATA", beside))
    return folder if (folder / "almeida").is_dir() else None


@cache
def stock(count: int | None = None) -> Stock:
    """Return the 32 stones PR of the paper, or generated ones.

    Parameters
    ----------
    count : int, optional
        That many generated ones, for a wall as much smaller or larger.
    """
    folder = data_folder()
    if count is None and folder is not None:
        return Stock("PR", read_stones(published_file(folder, "almeida/PR.png")), WALL_PX)
    wanted = 32 if count is None else count
    factor = (wanted / 32) ** 0.5
    width, height = round(factor * WALL_PX[0]), round(factor * WALL_PX[1])
    size = RubbleSettings(
        count=wanted, width_px=width, height_px=height, courses=max(1, round(4 * factor))
    )
    made = rubble_stones(size, np.random.default_rng(1))
    return Stock(f"generated rubble, {wanted} stones", made, (width, height))


@cache
def planned_scene(stones: Stock, scale: float) -> Scene:
    """Return the first half of a wall that the paper's method builds, and the stones left."""
    site = stones.site(scale)
    planner = Planner(stones.stones, site, seed=1, settings=method_settings("paper"))
    for _ in islice(planner.steps(), len(stones.stones) // 2):
        pass
    placed = {at.stone_id for at in planner.build.wall.placements}
    book = PoseBook(scale)
    left = [stone for stone in stones.stones if stone.id not in placed]
    posed = tuple(book.pose(stone, book.initial_angle(stone)) for stone in left)
    return Scene(f"{site.width_px} x {site.height_px}", planner.build.wall, posed)


@cache
def large_scene() -> Scene:
    """Return 2048 x 2048 px, half of it filled by stones of about 96 x 64 px."""
    labels = np.zeros((LARGE_PX, LARGE_PX), np.uint32)
    stones = np.kron(
        irregular_labels(np.random.default_rng(1), 400), np.ones((LARGE_FACTOR,) * 2, np.uint32)
    )
    height, width = min(stones.shape[0], LARGE_PX // 2), min(stones.shape[1], LARGE_PX)
    labels[-height:, :width] = stones[:height, :width]
    # The top is not level: every 64 columns end a little lower or higher.
    cut = np.random.default_rng(2).integers(0, 96, LARGE_PX // 64)
    skyline = LARGE_PX - height + np.repeat(cut, 64)
    labels[np.arange(LARGE_PX)[:, None] < skyline] = 0
    size = RubbleSettings(count=8, width_px=384, height_px=128, courses=2)
    book = PoseBook()
    posed = tuple(book.pose(s, 0.0) for s in rubble_stones(size, np.random.default_rng(1)))
    return Scene(f"{LARGE_PX} x {LARGE_PX}", Wall(Site(LARGE_PX, LARGE_PX), labels), posed)


def places(scene: Scene) -> list[tuple[PosedStone, int, int]]:
    """Return the best place of every stone by Eq. 12."""
    landscape, settings = scene.landscape(), method_settings("paper").placement
    found = [(posed, best_spots(landscape, [posed], settings)) for posed in scene.posed]
    return [(posed, spots[0].row, spots[0].col) for posed, spots in found if spots]


@dataclass(frozen=True, eq=False)
class Standing:
    """A wall that stands, and models of it with one more stone."""

    analysis: IncrementalAnalysis  # Of the wall
    candidates: tuple[RigidBlockModel, ...]  # Models with one more stone each; all stand


@cache
def standing(count: int, wanted: int = 8) -> Standing:
    """Return a coursed wall of so many stones with candidates on top."""
    return _standing(coursed_labels(np.random.default_rng(0), count), count, wanted)


def _standing(labels: NDArray[np.uint32], count: int, wanted: int) -> Standing:
    whole = model_from_labels(labels).model
    analysis = incremental_analysis(RigidBlockModel((), (), whole.mu), units_of(whole))
    candidates: list[RigidBlockModel] = []
    for stone in sorted(whole.blocks, key=lambda block: block.centroid[::-1]):
        there = {GROUND, stone.id, *(block.id for block in analysis.model.blocks)}
        touching = (i for i in whole.interfaces if stone.id in (i.block, i.other))
        new = tuple(i for i in touching if {i.block, i.other} <= there)
        model = analysis.model.with_added((stone,), new)
        extended = analysis.extended(model)
        if not extended.result.resistance.stable:
            continue
        if len(analysis.model.blocks) < count:
            analysis = extended
        elif len(candidates) < wanted:
            candidates.append(model)
    return Standing(analysis, tuple(candidates))
