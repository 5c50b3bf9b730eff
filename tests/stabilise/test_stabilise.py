"""Support, rotation first, wedging second (§3.7, Figs. 9 and 20, DESIGN 4.6), and remembering."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import drystone.stabilise.memory as memory_module
from drystone.model.placement import Placement
from drystone.model.stone import Stone
from drystone.model.wall import Group
from drystone.poses import PoseBook
from drystone.stabilise.memory import StabiliseMemory
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.stabilise import (
    WedgeStock,
    falls_to,
    make_stable,
    rotate_to_rest,
    wedge_under,
)
from tests.naive import support as naive
from tests.naive.overlap import lowered, overlaps
from tests.strategies import posed_on_walls, repeatable

BOOK = PoseBook()
BAR = BOOK.pose(Stone(1, np.ones((6, 30), bool)), 0.0)
BLOCK = BOOK.pose(Stone(2, np.tril(np.ones((14, 14), bool))), 0.0)
_Y, _X = np.mgrid[-5:6, -13:14]
PEBBLE = BOOK.pose(Stone(3, (_X / 13.5) ** 2 + (_Y / 5.5) ** 2 <= 1), 0.0)


def ledge(height=4, width=14, site=(24, 50)):
    """Ground with a step at the left."""
    occupied = np.zeros(site, bool)
    occupied[site[0] - height :, :width] = True
    return occupied


def bar_on_the_ledge(occupied):
    """A bar that lies on the ledge and overhangs to the right."""
    return BAR, int(np.flatnonzero(occupied[:, 2])[0]) - 6, 2


@st.composite
def stairs(draw):
    """Steps down from a pillar to both sides, and a stone on top that overhangs them, or hangs."""
    posed = draw(st.sampled_from([BAR, BLOCK, PEBBLE]))
    step, sides = st.tuples(st.integers(1, 9), st.integers(0, 4)), []
    for _ in range(2):
        widths, drops = zip(*draw(st.lists(step, min_size=4, max_size=8)), strict=True)
        tops = np.repeat(20 + np.cumsum(drops), widths)[:35]
        ground = min(63, int(tops[-1]) + draw(st.integers(0, 12)))
        sides.append(np.pad(tops, (0, 35 - tops.size), constant_values=ground))
    pillar = np.full(draw(st.integers(1, 12)), 20)
    occupied = np.arange(64)[:, None] >= np.concatenate([sides[0][::-1], pillar, sides[1]])
    col = 35 + draw(st.integers(1 - posed.width_px, pillar.size - 1))
    row = lowered(occupied, posed.mask, col)
    assert row is not None
    return occupied, (posed, row - draw(st.sampled_from([0, 0, 0, 3])), col)


@given(
    scene=stairs(),
    settings=st.sampled_from(
        [
            StabiliseSettings(),
            StabiliseSettings(margin=0.1, max_turn_deg=70.0, step_deg=2.0),
            StabiliseSettings(max_turn_deg=40.0, max_pivots=2, new_pivot_px=0, max_shift_px=5),
            StabiliseSettings(new_pivot_px=60),
            StabiliseSettings(max_turn_deg=5.0),
        ]
    ),
)
def test_it_turns_as_a_walk_from_angle_to_angle_does(scene, settings):
    occupied, trial = scene
    result = rotate_to_rest(occupied, trial, BOOK, settings)
    expected = naive.rotated(occupied, trial, BOOK, settings)
    assert (result.pose and (result.pose, result.pivots)) == expected


@st.composite
def high_walls(draw):
    """Walls of columns that are the same for some way down and differ further down."""
    steps = draw(st.lists(st.integers(0, 40), min_size=5, max_size=5))
    skyline = np.repeat(steps, draw(st.sampled_from([12, 13, 14])))
    top = np.arange(70)[:, None] >= 24 + skyline
    top[draw(st.integers(30, 69)), : draw(st.integers(0, skyline.size))] = True
    walls = [top]
    for depth in draw(st.lists(st.integers(28, 70), min_size=1, max_size=3)):
        below = np.zeros((draw(st.sampled_from([1, 15, 60])), skyline.size), bool)
        below[:, :: draw(st.integers(1, 9))] = True
        walls.append(np.vstack([top[:depth], below]))
    return walls


def stabilise(occupied, trial, side, stock, settings):
    """Stabilise a stone without memory."""
    if falls_to(occupied, trial, settings) == 0:
        return Group(Placement(*trial, side))
    return make_stable(occupied, trial, side, BOOK, stock, settings).stabilised


def told(outcome):
    """Everything that an outcome says, comparable."""
    if outcome is None:
        return None
    at = outcome.placement
    wedges = [(w.id, w.under, w.mask.tobytes(), w.row, w.col) for w in outcome.wedges]
    return at.posed.mask.tobytes(), at.row, at.col, at.side, at.rotation_moves, wedges


def slow_wedges(occupied, trial, mean_height_px, settings):
    """Pixels of a wedge on the side to which a stone falls, and of another where it then falls."""
    posed, row, col = trial
    x_c, margin = col + posed.anchor[0], settings.margin * posed.width_px
    least = settings.min_wedge_px
    sizes = least, int(max(least, settings.max_wedge_height * mean_height_px))
    scene, cut = occupied.copy(), []
    while side := naive.fall(scene, trial, settings):
        # Columns that bring the centre of mass inside the support.
        helps = [
            k
            for k in range(posed.width_px)
            if (col + k + 1 >= x_c + margin if side > 0 else col + k <= x_c - margin)
        ]
        columns = (helps[0], helps[-1] + 1) if helps else (0, 0)
        gap = naive.gap_pixels(scene, posed.mask, (row, col), columns, sizes)
        if len(cut) == 2 or not gap or np.ptp([at for at, _ in gap]) >= sizes[1]:
            return None
        cut.append(gap)
        scene[tuple(np.transpose(list(gap)))] = True
    return cut


def slowly(occupied, trial, mean_height_px, settings):
    """Where a stone is stable, about how many points it was turned, and its wedges."""
    falls = naive.fall(occupied, trial, settings)
    if not falls:
        return None if falls is None else (trial, 0, [])
    if settings.method in ("both", "rotation"):
        turned = naive.rotated(occupied, trial, BOOK, settings)
        if turned is not None:
            return (*turned, [])
    if settings.method in ("both", "wedge"):
        cut = slow_wedges(occupied, trial, mean_height_px, settings)
        return None if cut is None else (trial, 0, cut)
    return None


def pixels(wedge):
    return {(wedge.row + i, wedge.col + k) for i, k in np.argwhere(wedge.mask).tolist()}


@repeatable(250)
@given(
    scene=stairs() | posed_on_walls().map(lambda on: (on[0].occupied, on[1:])),
    method=st.sampled_from(["both", "rotation", "wedge", "none"]),
    margin=st.sampled_from([0.0, 0.1, 0.2]),
    limits=st.sampled_from(
        [
            {},
            {"max_turn_deg": 70.0, "step_deg": 2.0, "min_wedge_px": 1},
            {"max_turn_deg": 40.0, "max_pivots": 2, "new_pivot_px": 0, "max_shift_px": 5},
            {"new_pivot_px": 60, "min_wedge_px": 3},
            {"max_turn_deg": 5.0},
        ]
    ),
    mean_height_px=st.sampled_from([5.0, 8.0, 12.0, 16.0, 60.0]),
)
def test_a_stone_is_turned_or_wedged_as_slow_twins_do_it(
    scene, method, margin, limits, mean_height_px
):
    occupied, trial = scene
    settings = StabiliseSettings(method=method, margin=margin, **limits)
    stock = WedgeStock(100, mean_height_px)
    result = stabilise(occupied, trial, "right", stock, settings)
    expected = slowly(occupied, trial, mean_height_px, settings)
    assert (result is None) == (expected is None)
    if result is not None:
        at = result.placement
        assert ((at.posed, at.row, at.col), at.rotation_moves) == expected[:2]
        assert at.side == "right"
        assert [pixels(wedge) for wedge in result.wedges] == expected[2]
        told_of = [(wedge.id, wedge.under) for wedge in result.wedges]
        assert told_of == [(100 + k, trial[0].stone.id) for k in range(len(told_of))]
    if max(occupied.shape) <= 28:  # all of it is in the window of a memory
        memory = StabiliseMemory(BOOK, mean_height_px, settings)
        for _ in range(2):
            assert told(memory.stabilise(occupied, trial, "right", 100)) == told(result)


@pytest.mark.parametrize(("depth", "held"), [(29, True), (30, True), (31, False), (40, False)])
def test_a_gap_higher_than_a_wedge_may_be_is_not_taken_for_the_ground(depth, held):
    occupied, settings = ledge(height=depth, site=(60, 50)), StabiliseSettings(method="wedge")
    trial = bar_on_the_ledge(occupied)
    outcome = make_stable(occupied, trial, "left", BOOK, WedgeStock(100, 60.0), settings)
    assert (outcome.stabilised is not None) is held
    assert outcome.depth == trial[1] + 6 + 30 + 1


@pytest.mark.parametrize(("mean", "found"), [(12.0, False), (16.0, True)])
def test_between_sloping_faces_the_whole_wedge_counts(mean, found):
    """Three pixels of gap, in a wedge of six columns that is eight pixels high."""
    bottoms = [12] * 4 + [2] * 10 + [4, 5, 6, 7, 8, 9]
    mask = np.arange(12)[:, None] < bottoms
    occupied = np.ones((24, 30), bool)
    for column, bottom in enumerate(bottoms):
        occupied[: 6 + bottom + (3 if column >= 14 else 0 if column < 4 else 9), column] = False
    posed = BOOK.pose(Stone(5, mask), 0.0)
    occupied[:18, 20:] = False
    settings = StabiliseSettings(margin=0.2)
    wedge = wedge_under(occupied, (posed, 6, 0), 70_000, mean, settings)
    assert (wedge is not None) is found
    assert wedge is None or wedge.mask.shape == (8, 6)


def afresh(occupied, trial, settings, mean_height_px=12.0):
    """Stabilise from the left in the window that reaches down to the ground, wedges from 50 on."""
    posed, row, col = trial
    reach = memory_module._reach_px(posed)
    top, left = max(0, row - reach), max(0, col - reach)
    window = occupied[top:, left : col + posed.width_px + reach]
    local = posed, row - top, col - left
    found = stabilise(window, local, "left", WedgeStock(50, mean_height_px), settings)
    return memory_module._moved(found, top, left, "left", 50)


@pytest.mark.parametrize(
    ("method", "max_turn_deg", "mean_height_px"),
    [("rotation", 15.0, 1.0), ("rotation", 70.0, 1.0), ("wedge", 0.0, 12.0), ("both", 30.0, 70.0)],
)
def test_walls_that_differ_far_below_are_told_apart_where_it_matters(
    method, max_turn_deg, mean_height_px
):
    """One memory for all: what it remembers from one wall must hold in the next."""
    settings = StabiliseSettings(method=method, margin=0.1, max_turn_deg=max_turn_deg)
    memory = StabiliseMemory(BOOK, mean_height_px, settings)

    @given(walls=high_walls(), posed=st.sampled_from([BAR, BLOCK]), col=st.integers(0, 30))
    def check(walls, posed, col):
        row = lowered(walls[0], posed.mask, col)
        for wall in walls:
            if row is None or overlaps(wall, posed.mask, row, col):
                continue
            trial = (posed, row, col)
            expected = afresh(wall, trial, settings, mean_height_px)
            assert told(memory.stabilise(wall, trial, "left", 50)) == told(expected)

    check()
    assert memory._outcomes.held_bytes > 0  # it did remember


def test_the_same_surroundings_elsewhere_are_not_worked_out_again(monkeypatch):
    worked_out = []

    def counted(*arguments):
        worked_out.append(make_stable(*arguments))
        return worked_out[-1]

    monkeypatch.setattr(memory_module, "make_stable", counted)
    memory = StabiliseMemory(BOOK, 12.0, StabiliseSettings(method="wedge"))
    found = []
    for offset, air, side, wedge_id in ((60, 30, "left", 90), (100, 47, "right", 95)):
        site = np.pad(np.roll(ledge(site=(24, 200)), offset, axis=1), ((air, 0), (0, 0)))
        found.append(memory.stabilise(site, (BAR, air + 14, offset + 2), side, wedge_id))
    assert len(worked_out) == 1
    here, there = found
    assert (there.placement.col - here.placement.col, here.placement.row) == (40, 44)
    assert (here.placement.side, there.placement.side) == ("left", "right")
    assert there.wedges[0].col - here.wedges[0].col == 40
    assert [one.wedges[0].row - one.placement.row for one in found] == [6, 6]  # right below it
    assert (here.wedges[0].id, there.wedges[0].id) == (90, 95)
    memory.stabilise(np.roll(site, 1, axis=1), (BAR, 61, 102), "right", 95)
    assert len(worked_out) == 2, "another ledge is another scene"


def test_the_place_in_a_window_that_is_cut_off_at_the_ends_matters():
    site, settings = ledge(site=(24, 40)), StabiliseSettings(method="wedge")
    memory = StabiliseMemory(BOOK, 12.0, settings)
    for col in (2, 4, 2, 6):
        trial = (BAR, 14, col)
        expected = afresh(site, trial, settings)
        assert told(memory.stabilise(site, trial, "left", 50)) == told(expected)
