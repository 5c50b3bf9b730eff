"""What the planner asks about outlines, beside slow twins."""

import numpy as np
import pytest
from tests.naive import coverage as naive_coverage
from tests.naive import crevice as naive_crevice
from tests.naive import drops as naive_drops
from tests.naive import meetings as naive_meetings
from tests.naive.as_built import SlowWall

from benchmarks.conftest import Row, Timer
from benchmarks.outlines import CELL, OutlineScene, outline_scene
from benchmarks.scenes import Stock
from drystone.kernels.as_built import BuiltWall
from drystone.kernels.coverage import coverage
from drystone.kernels.crevice import crevice
from drystone.kernels.drops import Wanted, drops
from drystone.kernels.meetings import meetings
from drystone.kernels.polygons import Points
from drystone.kernels.profiles import HeightProfile, bare, extremes, in_a_row, raised
from drystone.model.builder import as_planned
from drystone.settle.putting import bare_wall

SHARES = "share of every pixel that an outline covers"
PROFILE = "lowest and highest point of an outline over every column"
DROPS = "a stone dropped onto every column"
SETTLE = "settling of a dropped stone"
MEETINGS = "where a stone touches the wall"
CREVICE = "free space under a stone"
PUT = "a stone put down a little aside"

ROUNDS = 20


@pytest.fixture
def wall(stones: Stock) -> OutlineScene:
    """Return a wall of outlines half built."""
    return outline_scene(stones)


@pytest.fixture
def resting(wall: OutlineScene) -> list[Points]:
    """Return stones that came to rest on it."""
    return wall.resting()


def row(wall: OutlineScene, what: str, count: int, twin: str | None = None) -> Row:
    """Describe a function of one stone."""
    return Row(what, wall.name, 0.0, twin, count)


def test_shares(timer: Timer, wall: OutlineScene) -> None:
    """Cover pixels by outlines."""
    outlines = [corners / CELL for corners in wall.outlines]
    timer.times(
        ROUNDS, row(wall, SHARES, len(outlines)), lambda: [coverage(one) for one in outlines]
    )


@pytest.mark.slow
def test_shares_slowly(timer: Timer, wall: OutlineScene) -> None:
    """The same by the intersection with every pixel."""
    outlines = [corners / CELL for corners in wall.outlines]
    described = row(wall, SHARES, len(outlines), "Shapely, pixel by pixel")
    timer.times(1, described, lambda: [naive_coverage.coverage(one) for one in outlines])


def test_profile(timer: Timer, wall: OutlineScene) -> None:
    """Look at outlines column by column."""
    columns = len(wall.profile.tops)

    def call() -> None:
        for corners in wall.outlines:
            extremes(corners, 0.0, CELL, columns)

    timer.times(ROUNDS, row(wall, PROFILE, len(wall.polygons)), call)


@pytest.mark.slow
def test_profile_slowly(timer: Timer, wall: OutlineScene) -> None:
    """The same by the intersection with every column."""

    def call() -> None:
        for corners in wall.outlines:
            for column in range(len(wall.profile.tops)):
                naive_drops.column_span(corners, column * CELL, (column + 1) * CELL)

    timer.times(1, row(wall, PROFILE, len(wall.polygons), "Shapely, column by column"), call)


def test_view(timer: Timer, wall: OutlineScene) -> None:
    """Make the height profile of the whole wall."""

    def call() -> HeightProfile:
        profile = bare(len(wall.profile.tops))
        for index, corners in enumerate(wall.outlines):
            profile = raised(profile, corners, index, CELL)
        return profile

    timer.times(ROUNDS, row(wall, "height profile of the wall", 1), call)


def test_drops(timer: Timer, wall: OutlineScene) -> None:
    """Find the best places of stones."""
    stones = in_a_row([one.hung.profile for one in wall.let_go])
    apart_px = np.array([wall.settings.apart * one.hung.turned.size_px for one in wall.let_go])
    count = len(wall.let_go)
    wanted = Wanted(wall.settings.spots, apart_px, np.arange(count))
    timer.times(
        ROUNDS,
        row(wall, DROPS, count),
        lambda: drops(wall.profile, stones, wall.terms, np.zeros(count), wanted),
    )


@pytest.mark.slow
def test_drops_slowly(timer: Timer, wall: OutlineScene) -> None:
    """The same, place by place."""

    def call() -> None:
        for one in wall.let_go:
            naive_drops.all_drops(wall.profile, one.hung.profile, wall.terms, 0.0)

    timer.times(1, row(wall, DROPS, len(wall.let_go), "loops over places and columns"), call)


def test_settling(timer: Timer, wall: OutlineScene) -> None:
    """Let stones go where they were dropped."""
    timer.times(
        ROUNDS,
        row(wall, SETTLE, len(wall.let_go)),
        lambda: [wall.settled(one) for one in wall.let_go],
    )


def test_meetings(timer: Timer, wall: OutlineScene, resting: list[Points]) -> None:
    """Find the contacts of stones that rest."""
    tolerance = wall.settings.contact_px
    timer.times(
        ROUNDS,
        row(wall, MEETINGS, len(resting)),
        lambda: [meetings(corners, wall.polygons, tolerance) for corners in resting],
    )


@pytest.mark.slow
def test_meetings_slowly(timer: Timer, wall: OutlineScene, resting: list[Points]) -> None:
    """The same by points on the boundary, one each source px."""
    tolerance = wall.settings.contact_px

    def call() -> None:
        for corners in resting:
            for other in wall.outlines:
                naive_meetings.touching(corners, other, tolerance, 1.0)

    timer.times(1, row(wall, MEETINGS, len(resting), "Shapely, a point each px"), call)


def test_crevice(timer: Timer, wall: OutlineScene, resting: list[Points]) -> None:
    """Find where wedges could go."""
    clearance = wall.settings.clearance_px
    timer.times(
        ROUNDS,
        row(wall, CREVICE, len(resting)),
        lambda: [crevice(corners, wall.polygons, clearance) for corners in resting],
    )


@pytest.mark.slow
def test_crevice_slowly(timer: Timer, wall: OutlineScene, resting: list[Points]) -> None:
    """The same on one upright line each source px."""

    def call() -> None:
        for corners in resting:
            left, right = corners[:, 0].min(), corners[:, 0].max()
            # Between the corners of outlines, which are at fractions of a px that a line misses.
            for x in np.arange(left + 0.37, right, 1.0).tolist():
                naive_crevice.gap_at(corners, wall.polygons, x)

    timer.times(1, row(wall, CREVICE, len(resting), "an upright line each px"), call)


def put_down(built: BuiltWall | SlowWall, resting: list[Points]) -> None:
    """Put stones down a little aside of where they came to rest."""
    for corners in resting:
        built.put([(-1, as_planned(corners + np.array((4.0 * CELL, 0.0))))])


def test_put_down(timer: Timer, wall: OutlineScene, resting: list[Points]) -> None:
    """Press stones in between their neighbours, and let them go."""
    built = bare_wall(0.58, wall.settings).held(dict(enumerate(map(as_planned, wall.outlines))))
    timer.times(ROUNDS, row(wall, PUT, len(resting)), lambda: put_down(built, resting))


@pytest.mark.slow
def test_put_down_slowly(timer: Timer, wall: OutlineScene, resting: list[Points]) -> None:
    """The same lift by lift, and line by line beside each other."""
    how = bare_wall(0.58, wall.settings).how
    built = SlowWall(0.58, how, enumerate(map(as_planned, wall.outlines)))
    twin = "Shapely, lift by lift"
    timer.times(1, row(wall, PUT, len(resting), twin), lambda: put_down(built, resting))
