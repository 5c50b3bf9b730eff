"""Turned stones, and what they stand on."""

from statistics import fmean

import pytest
from tests.naive import raster as naive_raster
from tests.naive import support as naive_support

from benchmarks.conftest import Row, Timer
from benchmarks.scenes import Scene, Stock, places
from benchmarks.work import samples
from drystone.poses import PoseBook
from drystone.stabilise.stabilise import support_polyline

ANGLE_DEG = 7.0
SCALE = 0.5
POSE = "turning and rasterising a stone"
SUPPORT = "support polyline"


def mean_pixels(stones: Stock) -> float:
    """Return the mean area of stones at the source resolution."""
    return stones.stones.total_area_px / len(stones.stones)


def pose_row(stones: Stock, count: int, twin: str | None = None) -> Row:
    """Describe a pose."""
    area = mean_pixels(stones)
    each = fmean(samples(stone, SCALE) for stone in stones.stones)
    size = f"{area:.0f} px, scale {SCALE}"
    return Row(POSE, size, area, twin, count, each, "sample points of the box")


def test_pose(timer: Timer, stones: Stock) -> None:
    """Turn every stone for the first time."""

    def call() -> None:
        book = PoseBook(SCALE)
        for stone in stones.stones:
            book.pose(stone, ANGLE_DEG)

    timer.often(pose_row(stones, len(stones.stones)), call)


@pytest.mark.slow
def test_pose_slowly(timer: Timer, stones: Stock) -> None:
    """Clip the polygons of two stones by every pixel."""
    book = PoseBook(SCALE)
    some = [(stone, book.pose(stone, ANGLE_DEG)) for stone in list(stones.stones)[:2]]

    def call() -> None:
        for stone, posed in some:
            phase = (posed.anchor[0] % 1.0, posed.anchor[1] % 1.0)
            left, bottom = round(phase[0] - posed.anchor[0]), round(phase[1] - posed.anchor[1])
            window = (left, bottom, left + posed.width_px, bottom + posed.height_px)
            naive_raster.coverage(stone.mask, stone.local_centroid, ANGLE_DEG, SCALE, phase, window)

    timer.times(2, pose_row(stones, len(some), "polygons clipped by every pixel"), call)


def test_support(timer: Timer, scene: Scene) -> None:
    """What stones stand on in their best places."""
    occupied, found = scene.wall.occupied, places(scene)

    def call() -> None:
        for posed, row, col in found:
            support_polyline(occupied, posed, row, col)

    each = fmean(posed.mask.size for posed, _, _ in found)
    item = "pixels of the stone's box"
    timer.often(Row(SUPPORT, scene.name, scene.pixels, None, len(found), each, item), call)


@pytest.mark.slow
def test_support_slowly(timer: Timer, scene: Scene) -> None:
    """The same pixel by pixel."""
    occupied, found = scene.wall.occupied, places(scene)

    def call() -> None:
        for posed, row, col in found:
            naive_support.support_ends(occupied, posed.mask, row, col)

    row = Row(SUPPORT, scene.name, scene.pixels, "loops over its pixels", len(found))
    timer.times(2, row, call)
