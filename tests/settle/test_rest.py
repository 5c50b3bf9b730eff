"""Stones that come to rest: from both sides, by both methods, or not at all."""

import math

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
)
from drystone.kernels.raster import turn
from drystone.kernels.settling import Status, settle
from drystone.settle.rest import (
    SettlingScene,
    Turned,
    come_to_rest,
    lay,
    let_go,
    placed_outline,
    repose,
    rests,
    touch_down,
    ways,
)
from drystone.settle.settings import SettleSettings
from tests.polygons import box_about as box
from tests.polygons import moved
from tests.settle.piles import WIDTH, piles
from tests.strategies import repeatable

MU = 0.58
SIDES = ("left", "right")
METHODS = ("energy", "pivot")
CLEAR = 0.01
FINE = 2e-5
"""Settling ends where a step gains less than 4e-6 of the size of a stone."""


BRICK = box(20.0, 10.0)


def scene_of(others, side="left", width=200.0):
    """The scene of outlines that are given as the side sees them."""
    seen = no_polygons().added(others)
    return SettlingScene.of(seen if side == "left" else seen.mirrored(width), width, side, MU)


def turned(outline, angle_deg=0.0, side="left"):
    """An outline that a side sees turned by so much; from the right the mirrored one."""
    size = math.sqrt(area_and_centroid(outline)[0])
    if side == "right":
        outline, angle_deg = mirrored_polygon(outline, 0.0), -angle_deg
    return Turned.of(outline, angle_deg, side, size)


def seen(found, side, width=200.0):
    """Where a stone rests, and its angle, as the side sees it."""
    x, y = found.settled.x_px, found.settled.y_px
    return (x, y, found.angle_deg) if side == "left" else (width - x, y, -found.angle_deg)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("method", METHODS)
def test_without_a_neighbour_it_rests_where_it_is_let_go(side, method):
    settings = SettleSettings(method=method)
    found = come_to_rest(turned(BRICK, side=side), scene_of([], side), (50.0, 12.0), settings)
    x, y, angle_deg = seen(found, side)
    assert (x, angle_deg, found.turned) == (50.0, 0.0, False)
    assert y == pytest.approx(5.0 + CLEAR, abs=FINE)
    assert found.margin == pytest.approx(1.0, abs=1e-2)  # it slides before it tips


@pytest.mark.parametrize("side", SIDES)
def test_energy_closes_the_joint_on_the_building_side_and_pivot_does_not(side):
    scene = scene_of([moved(BRICK, 40.0, 5.0 + CLEAR)], side)
    stone = turned(BRICK, side=side)
    pushed = come_to_rest(stone, scene, (62.0, 12.0), SettleSettings())
    assert seen(pushed, side) == pytest.approx((60.0 + CLEAR, 5.0 + CLEAR, 0.0), abs=1e-3)
    stays = come_to_rest(stone, scene, (62.0, 12.0), SettleSettings(method="pivot"))
    assert seen(stays, side) == pytest.approx((62.0, 5.0 + CLEAR, 0.0), abs=FINE)
    # Too far for a push, which is then not made at all.
    far = come_to_rest(stone, scene, (70.0, 12.0), SettleSettings())
    assert seen(far, side)[0] == 70.0


@pytest.mark.parametrize("side", SIDES)
def test_pivot_rolls_about_the_point_that_touches_first(side):
    stone, scene = turned(BRICK, 5.0, side), scene_of([], side)
    corner, low = turn(BRICK, 5.0)[0].tolist()
    start = (50.0, 2 * CLEAR - low)
    rolled = come_to_rest(stone, scene, start, SettleSettings(method="pivot"))
    assert rolled.turned
    x, y, angle_deg = seen(rolled, side)
    # It stops as soon as both corners are near enough to carry it.
    assert abs(angle_deg) < math.degrees(0.05 / 20.0)
    assert y == pytest.approx(5.0 + CLEAR, abs=0.03)
    assert x - 10.0 == pytest.approx(50.0 + corner, abs=0.02)
    fallen = come_to_rest(stone, scene, start, SettleSettings())
    assert seen(fallen, side) == pytest.approx((50.0, 5.0 + CLEAR, 0.0), abs=2e-3)


def ramp(slope_deg):
    """It goes up to the right from x = 20, and ends at 120."""
    return np.array(
        [[20.0, CLEAR], [120.0, CLEAR], [120.0, 100 * math.tan(math.radians(slope_deg))]]
    )


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("slope_deg", "rests"), [(20.0, True), (27.0, False), (45.0, False)])
def test_what_slides_away_is_nowhere(side, method, slope_deg, rests):
    settings = SettleSettings(method=method, margin=0.3)
    start = (70.0, 50.0 * math.tan(math.radians(slope_deg)) + 8.0)
    scene = scene_of([ramp(slope_deg)], side)
    found = come_to_rest(turned(BRICK, slope_deg, side), scene, start, settings)
    assert (found is not None) == rests
    if found is not None:
        # Gravity may lean until the friction angle is reached.
        lean = math.tan(math.atan(MU) - math.radians(slope_deg))
        assert found.margin == pytest.approx(lean / MU, abs=1e-3)
        assert seen(found, side)[2] == pytest.approx(slope_deg, abs=0.3)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("method", METHODS)
def test_it_must_rest_with_a_margin(side, method):
    scene, stone = scene_of([moved(BRICK, 50.0, 5.0 + CLEAR)], side), turned(BRICK, side=side)
    firm = 1.0 / 5.0 / MU  # what is left of the support over the height of the centroid

    def found(margin):
        settings = SettleSettings(method=method, margin=margin)
        return come_to_rest(stone, scene, (59.0, 16.0), settings, turns=False)

    rests = found(firm - 0.01)
    assert rests.margin == pytest.approx(firm, abs=0.005)
    assert seen(rests, side)[0] == 59.0
    assert found(firm + 0.01) is None


@pytest.mark.parametrize("method", METHODS)
def test_what_lies_too_deep_in_others_is_not_let_go(method):
    scene, settings = scene_of([moved(BRICK, 50.0, 5.0)]), SettleSettings(method=method)
    assert come_to_rest(turned(BRICK), scene, (53.0, 14.4), settings) is None
    # A little is brought apart.
    apart = come_to_rest(turned(BRICK), scene, (53.0, 14.6), settings)
    assert seen(apart, "left") == pytest.approx((53.0, 15.0 + CLEAR, 0.0), abs=1e-3)


def test_it_does_not_turn_further_than_it_may():
    stone, scene = turned(BRICK, 5.0), scene_of([])
    assert come_to_rest(stone, scene, (50.0, 12.0), SettleSettings(max_turn_deg=4.0)) is None
    assert come_to_rest(stone, scene, (50.0, 12.0), SettleSettings(max_turn_deg=6.0)) is not None
    # On one corner.
    assert come_to_rest(stone, scene, (50.0, 12.0), SettleSettings(), turns=False) is None


@pytest.mark.parametrize("side", SIDES)
def test_touching_down_needs_no_balance(side):
    scene, stone = scene_of([moved(BRICK, 50.0, 5.0 + CLEAR)], side), turned(BRICK, side=side)
    settings = SettleSettings(margin=0.9)
    low = touch_down(stone, scene, (62.0, 18.0), settings)
    assert seen(low, side) == pytest.approx((62.0, 15.0 + 2 * CLEAR, 0.0), abs=FINE)
    assert (low.margin, low.turned) == (-1.0, False)
    firm = touch_down(stone, scene, (52.0, 18.0), settings)
    assert firm.margin == pytest.approx(1.0, abs=1e-2)
    assert come_to_rest(stone, scene, (62.0, 18.0), SettleSettings()) is None


@pytest.mark.parametrize("side", SIDES)
def test_what_slides_away_does_not_touch_down(side):
    scene, start = scene_of([ramp(20.0)], side), (70.0, 27.0)
    assert touch_down(turned(BRICK, 20.0, side), scene, start, SettleSettings()) is None
    deep = scene_of([moved(BRICK, 50.0, 5.0)], side)
    assert touch_down(turned(BRICK, side=side), deep, (50.0, 10.0), SettleSettings()) is None


def test_ways_to_settle():
    settings, stone, scene = SettleSettings(), turned(BRICK), scene_of([])
    size = math.sqrt(200.0)
    first, second, third = ways(stone, scene, settings)
    assert first._replace(lean=0.0) == second
    assert second._replace(stop=settings.margin) == third
    assert (first.lean, first.stop, first.sticks, first.turns) == (0.3, -1.0, False, True)
    assert first.tolerance == 0.05  # half of what touches in statics
    assert (first.clearance, first.mu, first.steps) == (0.01, MU, 60)
    assert (first.steep, first.beyond) == (0.3, 0.25)
    assert first.turn == pytest.approx(math.radians(12.0))
    assert first.shift == pytest.approx(0.5 * size)
    assert (first.near, first.far) == pytest.approx((0.04 * size, 0.08 * size))
    (only,) = ways(stone, scene, SettleSettings(method="pivot"), turns=False)
    assert only == third._replace(sticks=True, turns=False)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("side", SIDES)
def test_all_ways_are_tried_but_for_those_that_lead_nowhere(side, method):
    rng = np.random.default_rng(5)
    settings = SettleSettings(method=method)
    patterns = set()
    for _ in range(60):
        height = rng.uniform(4.0, 16.0)
        post = moved(BRICK * [rng.uniform(0.2, 0.6), height / 10.0], 50.0, 0.5 * height)
        scene = scene_of([post, moved(box(20.0, 40.0), 32.0, 20.0)], side)
        stone = turned(BRICK, float(rng.uniform(-25.0, 25.0)), side)
        start = float(rng.uniform(50.0, 66.0)), height + float(rng.uniform(1.0, 9.0))
        found = [let_go(stone, scene, start, rules) for rules in ways(stone, scene, settings)]
        good = [one.status == Status.RESTS and one.margin >= settings.margin for one in found]
        expected = [one for one, rest in zip(found, good, strict=True) if rest]
        assert list(rests(stone, scene, start, settings)) == expected
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


@pytest.mark.parametrize("side", SIDES)
def test_poses_are_on_a_grid_and_angles_in_one_turn(side):
    outline = BRICK + np.array([0.1, -0.03])
    found = come_to_rest(
        Turned.of(outline, 177.0, side, 14.0), scene_of([], side), (50.3, 12.0), SettleSettings()
    )
    assert -180.0 <= found.angle_deg < 180.0
    assert (found.angle_deg - 180.0 + 1.0) % 360.0 == pytest.approx(1.0, abs=1e-2)
    x, y = found.settled.x_px, found.settled.y_px
    assert (x * GRID, y * GRID) == (round(x * GRID), round(y * GRID))
    corners = placed_outline(outline, found.angle_deg, x, y)
    assert found.settled.corners.tobytes() == corners.tobytes()
    assert (corners == turn(outline, found.angle_deg) + np.array([x, y])).all()
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
@given(scene=released(), method=st.sampled_from(METHODS), turns=st.booleans())
def test_from_the_right_everything_is_mirrored(scene, method, turns):
    outline, start, around, angle_deg = scene
    settings = SettleSettings(method=method, margin=0.0, max_turn_deg=40.0)
    size = math.sqrt(area_and_centroid(outline)[0])
    left = SettlingScene.of(around, WIDTH, "left", MU)
    right = SettlingScene.of(around.mirrored(WIDTH), WIDTH, "right", MU)
    one = Turned.of(outline, angle_deg, "left", size)
    other = Turned.of(mirrored_polygon(outline, 0.0), -angle_deg, "right", size)
    for first, second in (
        (
            come_to_rest(one, left, start, settings, turns=turns),
            come_to_rest(other, right, start, settings, turns=turns),
        ),
        (touch_down(one, left, start, settings), touch_down(other, right, start, settings)),
    ):
        assert (first is None) == (second is None)
        if first is None or second is None:
            continue
        assert first.turned == second.turned
        assert first.margin == pytest.approx(second.margin, rel=1e-9)
        assert math.remainder(first.angle_deg + second.angle_deg, 360.0) == pytest.approx(
            0.0, abs=1e-9
        )
        assert first.settled.y_px == second.settled.y_px
        assert first.settled.x_px + second.settled.x_px == pytest.approx(WIDTH, abs=2.0 / GRID)
        mirrored = mirrored_polygon(second.settled.corners, WIDTH)
        assert mirrored == pytest.approx(first.settled.corners, abs=2e-6)


def test_rounding_is_no_turn(monkeypatch):
    """The linear programs of a stone that may not turn leave turns of about 1e-18."""
    slightly = "drystone.settle.rest.settle"
    monkeypatch.setattr(slightly, lambda *args: settle(*args)._replace(angle=4e-18))
    stone, scene = turned(BRICK), scene_of([])
    for found in (
        come_to_rest(stone, scene, (50.0, 12.0), SettleSettings(), turns=False),
        touch_down(stone, scene, (50.0, 12.0), SettleSettings()),
    ):
        assert (found.angle_deg, found.turned) == (0.0, False)
    free = come_to_rest(stone, scene, (50.0, 12.0), SettleSettings())
    assert free.turned


@pytest.mark.parametrize(
    ("x", "y", "rests_px", "abs_px"),
    [
        (52.0, 15.02, 15.02, 1e-6),  # where it is laid
        (52.0, 14.7, 15.02, 0.01),  # in another: it is brought apart
        (52.0, 14.0, None, 0.0),  # too deep
        (61.0, 15.02, None, 0.0),  # it falls
    ],
)
def test_a_stone_that_is_laid_stays_or_is_lost(x, y, rests_px, abs_px):
    found = lay(turned(BRICK), scene_of([moved(BRICK, 50.0, 5.01)]), (x, y), SettleSettings())
    assert (found is None) == (rests_px is None)
    if found is not None:
        assert found.settled.y_px == pytest.approx(rests_px, abs=abs_px)
        assert found.settled.x_px == pytest.approx(x, abs=1e-6)
        assert not found.turned


@pytest.mark.parametrize("side", SIDES)
def test_a_stone_keeps_a_joint_to_its_neighbour_where_it_rests_so(side):
    open_, closed = SettleSettings(joint_px=0.7), SettleSettings()
    scene = scene_of([BRICK + np.array((30.0, 5.0))], side)
    stone = Turned.of(BRICK, 0.0, side, math.sqrt(200.0))
    ends = []
    for settings in (closed, open_):
        rest = come_to_rest(stone, scene, (52.0, 6.0), settings)
        x = rest.settled.x_px if side == "left" else scene.width_px - rest.settled.x_px
        ends.append(x - 50.0)
        assert rest.settled.y_px == pytest.approx(5.0, abs=0.05)
    assert ends == pytest.approx([0.0, 0.7], abs=0.1)
    # The end of the wall is not a neighbour.
    alone = [come_to_rest(stone, scene_of([], side), (10.0, 6.0), one) for one in (closed, open_)]
    assert alone[0].settled.x_px == alone[1].settled.x_px
