"""Positions of a pose, and the best of them by Eq. 12."""

from collections.abc import Callable
from statistics import fmean

import pytest
from tests.naive import placement as naive

from benchmarks.conftest import Row, Timer
from benchmarks.scenes import Scene
from benchmarks.work import look_ups, words
from drystone.kernels.raster import Mask
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.placement.best import best_spots
from drystone.placement.feasible import feasible_positions
from drystone.placement.settings import PlacementSettings

POSES = 8
"""Poses a call; each counts as one."""

EQ12 = PlacementSettings()
OVERLAP = "overlap and rest, all positions"
PLACE = "best place by Eq. 12, positions included"

Work = Callable[[Landscape, PosedStone], object]
Count = Callable[[Scene, PosedStone], float]


def is_large(scene: Scene) -> bool:
    """Say whether slow twins get a single pose."""
    return scene.pixels > 10**6


def each_pose(timer: Timer, scene: Scene, row: Row, work: Work) -> None:
    """Measure a function of a landscape that is prepared and of poses that were used before."""
    posed = scene.posed[: row.count]

    def prepared() -> tuple[Landscape]:
        landscape = scene.landscape()
        work(landscape, scene.posed[-1])
        return (landscape,)

    def call(landscape: Landscape) -> None:
        for stone in posed:
            work(landscape, stone)

    timer.times(3 if is_large(scene) else 20, row, call, prepared)


def each_mask(
    timer: Timer, scene: Scene, row: Row, work: Callable[[Mask, PosedStone], object]
) -> None:
    """Measure a slow twin on the same poses."""
    posed, occupied = scene.posed[: row.count], scene.wall.occupied

    def call() -> None:
        for stone in posed:
            work(occupied, stone)

    timer.times(1 if is_large(scene) else 2, row, call)


def fast_row(
    scene: Scene, what: str, items: Callable[[Scene, PosedStone], float], item: str
) -> Row:
    """Describe a function of poses by the mean of what they touch."""
    posed = scene.posed[:POSES]
    each = fmean(items(scene, stone) for stone in posed)
    return Row(what, scene.name, scene.pixels, None, len(posed), each, item)


def test_positions(timer: Timer, scene: Scene) -> None:
    """Where stones can stand."""
    row = fast_row(scene, OVERLAP, words, "64-bit words of the image, for every run of the stone")
    each_pose(timer, scene, row, feasible_positions)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("twin", "areas"),
    [
        ("two ndimage.convolve", naive.areas_by_convolution),
        ("two fftconvolve", naive.areas_by_fft),
    ],
)
def test_positions_slowly(timer: Timer, scene: Scene, twin: str, areas: naive.OverlapAreas) -> None:
    """The same by convolution."""
    count = 1 if is_large(scene) else POSES
    row = Row(OVERLAP, scene.name, scene.pixels, twin, min(count, len(scene.posed)))
    each_mask(
        timer, scene, row, lambda occupied, p: naive.resting_by_areas(occupied, p.mask, areas)
    )


def test_places(timer: Timer, scene: Scene) -> None:
    """Where stones stand best."""
    row = fast_row(scene, PLACE, look_ups, "prefix sums looked up")
    each_pose(timer, scene, row, lambda view, posed: best_spots(view, [posed], EQ12))


@pytest.mark.slow
def test_places_slowly(timer: Timer, scene: Scene) -> None:
    """The same by convolution and one painted image a position."""
    if is_large(scene):
        pytest.skip("takes minutes a pose")

    def best(occupied: Mask, posed: PosedStone) -> object:
        positions = naive.resting_by_areas(occupied, posed.mask, naive.areas_by_fft)
        return naive.best_by_eq12(occupied, posed.mask, posed.anchor[0], positions, EQ12.beta)

    row = Row(PLACE, scene.name, scene.pixels, "fftconvolve, an image a position", 2)
    each_mask(timer, scene, row, best)


def test_first_place(timer: Timer, scene: Scene) -> None:
    """The same with a landscape that is new: the first pose of a step."""
    row = Row("the same on a landscape that is new", scene.name, scene.pixels)

    def call(landscape: Landscape) -> object:
        return best_spots(landscape, scene.posed[:1], EQ12)

    timer.times(3 if is_large(scene) else 20, row, call, lambda: (scene.landscape(),))
