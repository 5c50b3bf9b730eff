"""Support, rotation first, wedging second (§3.7, Figs. 9 and 20, DESIGN 4.6), and remembering."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

import drystone.stabilise.memory as memory_module
from drystone.model.placement import Placement
from drystone.model.stone import Stone
from drystone.model.wall import Group
from drystone.poses import PoseBook
from drystone.stabilise.memory import StabiliseMemory
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.stabilise import (
    Support,
    WedgeStock,
    falling_side,
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
BLOCK = BOOK.pose(Stone(2, np.tril(np.ones((14, 18), bool))), 0.0)
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


def holds(occupied, pose, wedges, margin=0.0):
    posed, row, col = pose
    scene = occupied.copy()
    for wedge in wedges:
        scene[wedge.window] |= wedge.mask
    x_c, margin_px = col + posed.anchor[0], margin * posed.width_px
    return naive.rests_stably(scene, posed.mask, row, col, x_c, margin_px)


def mirrored(occupied, pose):
    """The same scene with the stone's own mirror image, as another stone."""
    posed, row, col = pose
    other = BOOK.pose(Stone(posed.stone.id + 1, posed.stone.mask[:, ::-1]), 0.0)
    return occupied[:, ::-1].copy(), (other, row, occupied.shape[1] - col - posed.width_px)


@st.composite
def stairs(draw):
    """Steps down from a pillar to one side, and a stone on top that overhangs them."""
    posed = draw(st.sampled_from([BAR, BLOCK, PEBBLE]))
    widths = draw(st.lists(st.integers(1, 9), min_size=4, max_size=8))
    drops = draw(st.lists(st.integers(0, 4), min_size=len(widths), max_size=len(widths)))
    tops = np.repeat(20 + np.cumsum(drops), widths)
    skyline = np.full(70, min(63, int(tops[-1]) + draw(st.integers(0, 12))))
    skyline[20 : 20 + tops.size] = tops[:50]
    occupied = np.arange(64)[:, None] >= skyline
    occupied[20:, 10 : 20 + draw(st.integers(1, 6))] = True
    col = draw(st.integers(12, 20))
    row = lowered(occupied, posed.mask, col)
    assert row is not None
    if draw(st.booleans()):
        occupied, col = np.ascontiguousarray(occupied[:, ::-1]), 70 - col - posed.width_px
        row = lowered(occupied, posed.mask, col)
        assert row is not None
    return occupied, (posed, row, col)


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


STOCK = WedgeStock(next_id=100, mean_height_px=12.0)
METHODS = ("both", "rotation", "wedge", "none")


def stabilise(occupied, trial, side, stock, settings):
    """Stabilise a stone without memory."""
    if falls_to(occupied, trial, settings) == 0:
        return Group(Placement(*trial, side))
    return make_stable(occupied, trial, side, BOOK, stock, settings).stabilised


def test_methods_select_rotation_wedging_both_or_neither():
    """Wedging comes when rotation fails, and starts from the trial pose."""

    def stabilised(method, **limits):
        occupied, settings = ledge(), StabiliseSettings(method=method, **limits)
        return stabilise(occupied, bar_on_the_ledge(occupied), "left", STOCK, settings)

    assert stabilised("none") is None
    rotated = stabilised("rotation")
    assert rotated.placement.posed.angle_deg < 0
    assert rotated.placement.rotation_moves >= 1
    assert rotated.wedges == ()
    assert stabilised("both").placement.posed.angle_deg == rotated.placement.posed.angle_deg
    assert stabilised("rotation", max_turn_deg=5.0) is None
    for wedged in (stabilised("wedge"), stabilised("both", max_turn_deg=5.0)):
        assert (wedged.placement.posed.angle_deg, wedged.placement.rotation_moves) == (0.0, 0)
        assert [wedge.id for wedge in wedged.wedges] == [100]


def check_wedge(occupied, pose, wedge, largest_px, settings):
    """What DESIGN 4.6 asks of a wedge."""
    posed, row, col = pose
    stone = np.zeros_like(occupied)
    stone[row : row + posed.height_px, col : col + posed.width_px] = posed.mask
    cut = np.zeros_like(occupied)
    cut[wedge.window] = wedge.mask
    assert not (cut & (stone | occupied)).any()
    assert ndimage.label(wedge.mask)[1] == 1
    assert wedge.under == posed.stone.id
    for column in range(wedge.mask.shape[1]):
        rows = np.flatnonzero(cut[:, wedge.col + column])
        assert settings.min_wedge_px <= rows.size <= largest_px
        assert rows.size == rows[-1] - rows[0] + 1
        assert stone[rows[0] - 1, wedge.col + column]  # touches the stone all along
        under = rows[-1] + 1
        assert under == len(occupied) or occupied[under, wedge.col + column]  # and what is below
    assert wedge.mask.shape[1] >= settings.min_wedge_px


def told(outcome):
    """Everything that an outcome says, comparable."""
    if outcome is None:
        return None
    at = outcome.placement
    wedges = [(w.id, w.under, w.mask.tobytes(), w.row, w.col) for w in outcome.wedges]
    return at.posed.mask.tobytes(), at.row, at.col, at.side, at.rotation_moves, wedges


@repeatable(80)
@given(
    scene=posed_on_walls(), method=st.sampled_from(METHODS), margin=st.sampled_from([0.0, 0.1, 0.2])
)
def test_whatever_comes_out_is_a_stable_rigid_copy_inside_the_site(scene, method, margin):
    wall, posed, row, col = scene
    settings, stock = StabiliseSettings(method=method, margin=margin), WedgeStock(100, 8.0)
    result = stabilise(wall.occupied, (posed, row, col), "right", stock, settings)
    # On a site within its window a memory says the same, also when it is asked again.
    memory = StabiliseMemory(BOOK, 8.0, settings)
    for _ in range(2):
        again = memory.stabilise(wall.occupied, (posed, row, col), "right", 100)
        assert told(again) == told(result)
    stable = naive.rests_stably(
        wall.occupied, posed.mask, row, col, col + posed.anchor[0], margin * posed.width_px
    )
    if result is None:
        assert not stable
        return
    placed = result.placement
    pose = placed.posed, placed.row, placed.col
    wall.add(placed, result.wedges)  # refuses what overlaps or leaves the site
    assert np.array_equal(
        placed.posed.mask, PoseBook().pose(posed.stone, placed.posed.angle_deg).mask
    )
    assert placed.side == "right"
    assert abs(placed.posed.angle_deg) <= settings.max_turn_deg
    assert holds(wall.occupied, pose, result.wedges, margin)
    for k, wedge in enumerate(result.wedges):
        assert wedge.id == 100 + k
        check_wedge(wall.occupied, pose, wedge, 4.0, settings)
    if stable:
        assert (placed.row, placed.col, result.wedges) == (row, col, ())
    if method in ("none", "rotation"):
        assert result.wedges == ()
    if method in ("none", "wedge"):
        assert placed.posed.angle_deg == posed.angle_deg
    if result.wedges:
        assert placed.rotation_moves == 0


@pytest.mark.parametrize(("depth", "held"), [(29, True), (30, True), (31, False), (40, False)])
def test_a_gap_higher_than_a_wedge_may_be_is_not_taken_for_the_ground(depth, held):
    occupied, settings = ledge(height=depth, site=(60, 50)), StabiliseSettings(method="wedge")
    trial = bar_on_the_ledge(occupied)
    outcome = make_stable(occupied, trial, "left", BOOK, WedgeStock(100, 60.0), settings)
    assert (outcome.stabilised is not None) is held
    assert outcome.depth == trial[1] + 6 + 30 + 1


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


def test_a_stone_in_the_air_does_not_rest():
    trial = (BAR, 3, 10)
    assert rotate_to_rest(ledge(), trial, BOOK, StabiliseSettings()).pose is None
    assert stabilise(ledge(), trial, "left", STOCK, StabiliseSettings()) is None


@pytest.mark.parametrize(
    ("height", "mean", "smallest", "found"),
    [(2, 8.0, 2, True), (2, 8.0, 3, False), (5, 9.0, 2, False), (5, 10.0, 2, True)],
)
def test_smallest_and_largest_size(height, mean, smallest, found):
    occupied = ledge(height=height)
    settings = StabiliseSettings(min_wedge_px=smallest)
    wedge = wedge_under(occupied, bar_on_the_ledge(occupied), 70_000, mean, settings)
    assert (wedge is not None) is found


@pytest.mark.parametrize("side", ["right", "left"])
@pytest.mark.parametrize(("shelf", "taken"), [((16, 18), (16, 18)), ((15, 18), (16, 18))])
def test_the_column_at_the_centre_of_mass_is_the_first_that_helps(side, shelf, taken):
    occupied = ledge()
    occupied[-2:, slice(*shelf)] = True
    trial = bar_on_the_ledge(occupied)
    if side == "left":
        occupied, trial = mirrored(occupied, trial)
        taken = (50 - taken[1], 50 - taken[0])
    wedge = wedge_under(occupied, trial, 70_000, 12.0, StabiliseSettings())
    assert (wedge.col, wedge.col + wedge.mask.shape[1]) == taken
    assert holds(occupied, trial, (wedge,))


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


def test_a_stone_balanced_on_a_point_is_wedged_on_both_sides_with_ids_in_a_row():
    """With a margin, a support too narrow for it must be widened to both sides."""
    pillar = np.zeros((24, 50), bool)
    pillar[20:, 16:18] = True
    settings = StabiliseSettings(method="wedge", margin=0.1)
    found = StabiliseMemory(BOOK, 12.0, settings).stabilise(pillar, (BAR, 14, 2), "left", 70)
    assert [wedge.id for wedge in found.wedges] == [70, 71]
    assert holds(pillar, (BAR, 14, 2), found.wedges, 0.1)


def test_where_a_support_is_too_short_for_both_margins_the_nearer_end_decides():
    support, settings = Support(2, 6, 9, 9), StabiliseSettings(margin=0.1)
    wide = (SimpleNamespace(anchor=(x, 3.0), width_px=30) for x in (0.9, 2.9, 3.1, 5.1))
    assert [falling_side(support, (one, 0, 1), settings) for one in wide] == [-1, -1, 1, 1]
