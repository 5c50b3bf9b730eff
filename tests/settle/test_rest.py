"""Stones that come to rest: from both sides, by both methods, or not at all."""

import math
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.polygons import (
    GRID,
    area_and_centroid,
    mirrored_polygon,
    no_polygons,
    on_grid,
    polygon_edges,
    turn,
)
from drystone.kernels.profiles import hanging
from drystone.kernels.settling import Status, settle
from drystone.model.outline import stone_outline
from drystone.model.stone import Stone
from drystone.settle.book import OutlineBook
from drystone.settle.rest import (
    SettlingScene,
    Turned,
    come_to_rest,
    lay,
    let_go,
    repose,
    rests,
    settled_at,
    touch_down,
    ways,
)
from drystone.settle.settings import SettleSettings
from tests.polygons import box_about as box
from tests.polygons import moved
from tests.settle.piles import WIDTH, piles
from tests.strategies import repeatable

TRAPEZE = Stone(7, np.tri(9, 14, 5, dtype=bool))


@pytest.mark.parametrize(("angle_deg", "tolerance_px"), [(0.0, 0.1), (90.0, 0.35), (-33.0, 2.0)])
def test_hung_outlines_are_turned_then_mirrored_for_the_right(angle_deg, tolerance_px):
    book = OutlineBook(tolerance_px, 2.0)
    outline = book.outline(TRAPEZE)
    assert (outline == stone_outline(TRAPEZE.mask, tolerance_px)).all()
    left, right = (book.hung(TRAPEZE, angle_deg, side) for side in ("left", "right"))
    assert (left.turned.corners == turn(outline, angle_deg)).all()
    assert (right.turned.corners == mirrored_polygon(left.turned.corners, 0.0)).all()
    for hung, side in ((left, "left"), (right, "right")):
        assert (hung.turned.outline == outline).all()
        assert (hung.turned.angle_deg, hung.turned.side) == (angle_deg, side)
        assert hung.turned.size_px == pytest.approx(np.sqrt(TRAPEZE.area_px))
        assert (hung.turned.edges == polygon_edges(hung.turned.corners)).all()
        for mine, expected in zip(hung.profile, hanging(hung.turned.corners, 2.0), strict=True):
            assert np.array_equal(mine, expected)


MU = 0.58
METHODS = ("energy", "pivot")
CLEAR = 0.01
FINE = 2e-5
"""Settling ends where a step gains less than 4e-6 of the size of a stone."""

BRICK = box(20.0, 10.0)
ENERGY = SettleSettings()


def scene_of(*others):
    """What is seen from the left; that from the right it is the same is a property below."""
    return SettlingScene.of(no_polygons().added(others), 200.0, "left", MU)


def turned(outline=BRICK, angle_deg=0.0):
    return Turned.of(outline, angle_deg, "left", math.sqrt(area_and_centroid(outline)[0]))


def seen(found):
    """Where a stone rests, and its angle."""
    return found.settled.x_px, found.settled.y_px, found.angle_deg


LOW = moved(BRICK, 50.0, 5.0 + CLEAR)
"""A brick on the ground."""


held = partial(come_to_rest, turns=False)


def rested(at, *others, stone=None, way=come_to_rest, **changes):
    """What becomes of a stone, else the brick, that is let go among others."""
    return way(stone or turned(), scene_of(*others), at, SettleSettings(**changes))


@pytest.mark.parametrize("method", METHODS)
def test_a_brick_rests_where_it_is_let_go_if_it_rests_firmly(method):
    found = rested((50.0, 12.0), method=method)
    x, y, angle_deg = seen(found)
    assert (x, angle_deg, found.turned) == (50.0, 0.0, False)
    assert y == pytest.approx(5.0 + CLEAR, abs=FINE)
    assert found.margin == pytest.approx(1.0, abs=1e-2)  # it slides before it tips
    firm = 1.0 / 5.0 / MU  # what is left of the support over the height of the centroid
    rests = rested((59.0, 16.0), LOW, way=held, method=method, margin=firm - 0.01)
    assert (rests.margin, rests.settled.x_px) == (pytest.approx(firm, abs=0.005), 59.0)
    assert rested((59.0, 16.0), LOW, way=held, method=method, margin=firm + 0.01) is None
    # What lies too deep in others is not let go.  A little is brought apart.
    low = moved(BRICK, 50.0, 5.0)
    assert rested((53.0, 14.4), low, method=method) is None
    apart = rested((53.0, 14.6), low, method=method)
    assert seen(apart) == pytest.approx((53.0, 15.0 + CLEAR, 0.0), abs=1e-3)


def test_energy_closes_the_joint_on_the_building_side_and_pivot_does_not():
    beside = moved(BRICK, 40.0, 5.0 + CLEAR)
    pushed, stays = (rested((62.0, 12.0), beside, method=method) for method in METHODS)
    assert seen(pushed) == pytest.approx((60.0 + CLEAR, 5.0 + CLEAR, 0.0), abs=1e-3)
    assert seen(stays) == pytest.approx((62.0, 5.0 + CLEAR, 0.0), abs=FINE)
    # Too far for a push, which is then not made at all.
    assert seen(rested((70.0, 12.0), beside))[0] == 70.0


def test_it_does_not_turn_further_than_it_may_and_touches_down_without_balance():
    tilted = turned(BRICK, 5.0)
    assert rested((50.0, 12.0), stone=tilted, max_turn_deg=4.0) is None
    fallen = rested((50.0, 12.0), stone=tilted, max_turn_deg=6.0)
    assert seen(fallen) == pytest.approx((50.0, 5.0 + CLEAR, 0.0), abs=2e-3)
    assert rested((50.0, 12.0), stone=tilted, way=held) is None  # on one corner
    low, firm = (rested((x, 18.0), LOW, way=touch_down, margin=0.9) for x in (62.0, 52.0))
    assert seen(low) == pytest.approx((62.0, 15.0 + 2 * CLEAR, 0.0), abs=FINE)
    assert (low.margin, low.turned) == (-1.0, False)
    assert firm.margin == pytest.approx(1.0, abs=1e-2)
    assert rested((62.0, 18.0), LOW) is None
    # What slides away or lies in another does not touch down.
    ramp = np.array([[20.0, CLEAR], [120.0, CLEAR], [120.0, 100 * math.tan(math.radians(20.0))]])
    assert rested((70.0, 27.0), ramp, stone=turned(BRICK, 20.0), way=touch_down) is None
    assert rested((50.0, 10.0), LOW, way=touch_down) is None


def test_ways_to_settle():
    size = math.sqrt(200.0)
    first, second, third = ways(turned(), scene_of(), ENERGY)
    assert first._replace(lean=0.0) == second
    assert second._replace(stop=ENERGY.margin) == third
    assert (first.lean, first.stop, first.sticks, first.turns) == (0.3, -1.0, False, True)
    assert first.tolerance == 0.05  # half of what touches in statics
    assert (first.clearance, first.mu, first.steps) == (0.01, MU, 60)
    assert (first.steep, first.beyond) == (0.3, 0.25)
    assert first.turn == pytest.approx(math.radians(12.0))
    assert first.shift == pytest.approx(0.5 * size)
    assert (first.near, first.far) == pytest.approx((0.04 * size, 0.08 * size))
    (only,) = ways(turned(), scene_of(), SettleSettings(method="pivot"), turns=False)
    assert only == third._replace(sticks=True, turns=False)


@pytest.mark.parametrize("method", METHODS)
def test_all_ways_are_tried_but_for_those_that_lead_nowhere(method):
    rng = np.random.default_rng(5)
    settings, patterns = SettleSettings(method=method), set()
    for _ in range(60):
        height = rng.uniform(4.0, 16.0)
        post = moved(BRICK * [rng.uniform(0.2, 0.6), height / 10.0], 50.0, 0.5 * height)
        scene = scene_of(post, moved(box(20.0, 40.0), 32.0, 20.0))
        stone = turned(BRICK, float(rng.uniform(-25.0, 25.0)))
        start = float(rng.uniform(50.0, 66.0)), height + float(rng.uniform(1.0, 9.0))
        found = [let_go(stone, scene, start, rules) for rules in ways(stone, scene, settings)]
        good = [one.status == Status.RESTS and one.margin >= settings.margin for one in found]
        expected = [one for one, rest in zip(found, good, strict=True) if rest]
        assert list(rests(stone, scene, start, settings, turns=True)) == expected
        first = come_to_rest(stone, scene, start, settings)
        assert (first is None) == (not expected)
        if first is not None:
            there = repose(stone, scene, expected[0])
            assert first.settled.corners.tobytes() == there.settled.corners.tobytes()
        patterns.add(tuple(good))
    if method == "energy":
        assert patterns >= {(True,) * 3, (False,) * 3, (False, False, True)}
        assert len(patterns) > 3
    else:
        assert patterns == {(True,), (False,)}


def test_poses_are_on_a_grid_and_angles_in_one_turn():
    outline = BRICK + np.array([0.1, -0.03])
    found = come_to_rest(Turned.of(outline, 177.0, "left", 14.0), scene_of(), (50.3, 12.0), ENERGY)
    x, y, angle_deg = seen(found)
    assert -180.0 <= angle_deg < 180.0
    assert (angle_deg - 180.0 + 1.0) % 360.0 == pytest.approx(1.0, abs=1e-2)
    assert (x * GRID, y * GRID) == (round(x * GRID), round(y * GRID))
    corners = settled_at(outline, angle_deg, x, y).corners
    assert found.settled.corners.tobytes() == corners.tobytes()
    assert (corners == turn(outline, angle_deg) + np.array([x, y])).all()
    with pytest.raises(ValueError, match="read-only"):
        found.settled.corners[0] = 0.0


@st.composite
def released(draw):
    """A stone from its centroid, where it is let go among others on the grid, and its angle."""
    stone, around = draw(piles())
    _, x, y = area_and_centroid(stone)
    others = no_polygons().added(on_grid(around.polygon(i)) for i in range(len(around)))
    start = on_grid(np.array([x, y + draw(st.sampled_from([0.0, 0.5]))])).tolist()
    angle_deg = draw(st.sampled_from([0.0, 90.0, 33.0, -120.0]))
    return turn(stone - np.array([x, y]), -angle_deg), (start[0], start[1]), others, angle_deg


@repeatable(25)
@given(
    scene=released(),
    method=st.sampled_from(METHODS),
    turns=st.booleans(),
    joint_px=st.sampled_from([0.0, 0.7]),
)
def test_from_the_right_everything_is_mirrored(scene, method, turns, joint_px):
    outline, start, around, angle_deg = scene
    settings = SettleSettings(method=method, margin=0.0, max_turn_deg=40.0, joint_px=joint_px)
    size = math.sqrt(area_and_centroid(outline)[0])
    left = SettlingScene.of(around, WIDTH, "left", MU)
    right = SettlingScene.of(around.mirrored(WIDTH), WIDTH, "right", MU)
    one = Turned.of(outline, angle_deg, "left", size)
    other = Turned.of(mirrored_polygon(outline, 0.0), -angle_deg, "right", size)
    for way in (partial(come_to_rest, turns=turns), touch_down, lay):
        first, second = (way(*on, start, settings) for on in ((one, left), (other, right)))
        assert (first is None) == (second is None)
        if first is None or second is None:
            continue
        way_deg = math.remainder(first.angle_deg - angle_deg, 360.0)
        assert first.turned == second.turned or abs(way_deg) < 1e-9  # by rounding alone
        assert first.margin == pytest.approx(second.margin, rel=1e-9)
        around_once = math.remainder(first.angle_deg + second.angle_deg, 360.0)
        assert around_once == pytest.approx(0.0, abs=1e-9)
        assert first.settled.y_px == second.settled.y_px
        assert first.settled.x_px + second.settled.x_px == pytest.approx(WIDTH, abs=2.0 / GRID)
        mirrored = mirrored_polygon(second.settled.corners, WIDTH)
        assert mirrored == pytest.approx(first.settled.corners, abs=2e-6)


def test_rounding_is_no_turn(monkeypatch):
    """The linear programs of a stone that may not turn leave turns of about 1e-18."""
    slightly = "drystone.settle.rest.settle"
    monkeypatch.setattr(slightly, lambda *args: settle(*args)._replace(angle=4e-18))
    for way in (held, touch_down):
        found = rested((50.0, 12.0), way=way)
        assert (found.angle_deg, found.turned) == (0.0, False)
    assert rested((50.0, 12.0)).turned


def test_a_stone_that_is_laid_stays_or_is_lost():
    for y, abs_px in ((15.02, 1e-6), (14.7, 0.01)):  # where it is laid; in another: brought apart
        found = rested((52.0, y), LOW, way=lay)
        assert found.settled.y_px == pytest.approx(15.02, abs=abs_px)
        assert found.settled.x_px == pytest.approx(52.0, abs=1e-6)
        assert not found.turned
    for at in ((52.0, 14.0), (61.0, 15.02)):  # too deep; it falls
        assert rested(at, LOW, way=lay) is None


def test_a_stone_keeps_a_joint_to_its_neighbour_where_it_rests_so():
    beside = BRICK + np.array((30.0, 5.0))
    ends = [rested((52.0, 6.0), beside, joint_px=joint_px).settled for joint_px in (0.0, 0.7)]
    assert [end.x_px - 50.0 for end in ends] == pytest.approx([0.0, 0.7], abs=0.1)
    assert [end.y_px for end in ends] == pytest.approx([5.0, 5.0], abs=0.05)
    # The end of the wall is not a neighbour.
    alone = [rested((10.0, 6.0), joint_px=joint_px).settled.x_px for joint_px in (0.0, 0.7)]
    assert alone[0] == alone[1]
