"""Blocks that are put down not quite as planned, and what that does to those that carry them."""

import numpy as np
import pytest
import shapely

from drystone.kernels.as_built import Built
from drystone.model.builder import HAND, BuilderErrors, as_planned, stratified
from drystone.search.rehearsal import rehearse, rehearse_in_engine
from drystone.settle.putting import bare_wall, fallen_share, lost
from drystone.settle.settings import SettleSettings
from tests.naive.as_built import SlowWall
from tests.polygons import box_of as box
from tests.search.test_rehearsal import NO_ENGINE, NONE

SETTLE = SettleSettings()
BARE = bare_wall(0.58, SETTLE)
BOTH = pytest.mark.parametrize(
    "once", [rehearse, pytest.param(rehearse_in_engine, marks=NO_ENGINE)]
)


def brick(x, y, angle_deg=0.0, width=40.0):
    """A brick with its centroid at a place."""
    return Built(box(-width / 2, -10.0, width), x, y, angle_deg, (20.0 * width) ** 0.5)


def put(built, *around, mu=0.58):
    """Return how a block comes to rest, and by how much which others are pushed."""
    others = {i: as_planned(corners) for i, corners in enumerate(around)}
    wall = bare_wall(mu, SETTLE).held(others).put([(-1, built)])
    pushed = {i: wall.get(i).x - other.x for i, other in others.items()}
    return wall.get(-1), {i: x for i, x in pushed.items() if x}


def test_a_brick_comes_to_lie_flat_aside_where_there_is_room_and_on_what_is_below():
    rest, _ = put(brick(0.0, 10.0, -6.0))
    assert (rest.y, rest.angle_deg) == pytest.approx((10.0, 0.0), abs=0.4)
    beside, below = box(-58.0, 0.0), box(-30.0, 0.0, 60.0)
    for y, around, ends in ((10.0, beside, (2.0, 10.0)), (29.0, below, (0.0, 30.0))):
        rest, pushed = put(brick(0.0, y), around)
        assert (rest.x, rest.y) == pytest.approx(ends, abs=0.3)
        assert pushed == {}


def test_what_finds_no_rest_falls_and_how_near_to_that_another_is():
    slope = np.array([[-30.0, 0.0], [30.0, 0.0], [30.0, 20.0], [-30.0, -1.0]])
    assert put(brick(0.0, 30.0), slope, mu=0.1) == (None, {})  # it slides
    assert put(brick(0.0, 30.0), box(5.0, 0.0)) == (None, {})  # its centroid is beyond the edge
    assert fallen_share(0.3, 0.4, 0.0, 4.0) == pytest.approx(0.5)
    assert fallen_share(0.0, 0.0, 348.0, 4.0) == pytest.approx(1.0)


def test_what_rests_nowhere_else_is_lifted_by_a_quarter_of_its_size_and_more():
    rest, _ = put(brick(0.0, 10.0), box(-30.0, -11.8, 60.0))
    assert (rest.x, rest.y, rest.angle_deg) == pytest.approx((0.0, 18.2, 0.0), abs=0.1)


@pytest.mark.parametrize(("lower", "turn_deg"), [(0.5, -1.15), (2.0, 0.0)])
def test_what_leans_on_an_upright_face_goes_down_to_a_bed_that_is_near(lower, turn_deg):
    """It lies on a post, and friction on a face that leans over holds it above the ledge."""
    post, ledge = box(0.0, 0.0, 15.0), box(30.0, 0.0, 10.0, 20.0 - lower)
    pier = np.array([(44.03, 0.0), (70.0, 0.0), (70.0, 40.0), (36.03, 40.0)])
    stone = as_planned(np.array([(0.0, 20.03), (40.0, 20.03), (34.0, 40.0), (0.0, 40.0)]))
    rest, _ = put(stone, post, ledge, pier)
    assert rest.angle_deg == pytest.approx(turn_deg, abs=0.15)


@pytest.mark.parametrize(("above", "ends"), [(0.7, 5.0), (1.0, 6.0)])
def test_what_hangs_between_two_faces_goes_down_to_a_bed_that_is_near(above, ends):
    rest, _ = put(as_planned(box(39.0, above, 22.0, 10.0)), box(0.0, 0.0), box(60.0, 0.0))
    assert rest.y == pytest.approx(ends, abs=0.1)


def test_what_was_put_down_askew_may_turn_back_past_the_plan():
    slope = np.array([(-60.0, 0.0), (60.0, 0.0), (60.0, 2.0), (-60.0, 20.0)])  # 8.5 degrees
    rest, _ = put(brick(0.0, 23.0, 6.0), slope)
    assert rest.angle_deg == pytest.approx(-8.5, abs=0.1)


def test_neighbours_on_both_sides_are_pushed_apart_and_push_on():
    walls = box(-58.0, 0.0), box(18.0, 0.0), box(58.5, 0.0), box(110.0, 0.0)
    rest, pushed = put(brick(0.0, 10.0), *walls)
    assert rest.y == pytest.approx(10.0, abs=0.3)
    assert pushed == {i: pytest.approx(x, abs=0.3) for i, x in enumerate((-2.0, 2.0, 1.5))}


def test_neighbours_that_lean_over_are_pushed_apart_where_a_lifted_brick_is():
    left = np.array([[-60.0, 3.0], [-20.0, 3.0], [-15.0, 33.0], [-60.0, 33.0]])
    right = left[::-1] * (-1.0, 1.0)
    rest, pushed = put(brick(0.0, 10.0), box(-60.0, -17.0, 120.0), left, right)
    assert 12.9 < rest.y < 13.8  # the bed is higher than planned; they hold it where they can
    room = 5.0 * 20.0 / 30.0  # that is missing at the top of the brick where it lies
    assert pushed == {1: pytest.approx(-room, abs=0.7), 2: pytest.approx(room, abs=0.7)}


def test_blocks_come_to_rest_and_push_as_by_the_twin():
    rng, rests = np.random.default_rng(3), [0, 0, 0]
    for _ in range(20):
        left, right, aside = rng.normal(0.0, 2.0, 3).tolist()
        tilts = rng.normal(0.0, 3.0, 3).tolist()
        pair = [brick(left - 41.0, 14.0, tilts[0]), brick(right + 41.0, 14.0, tilts[1])]
        bed = as_planned(box(-90.0, rng.uniform(-20.0, -16.0), 180.0))
        block = brick(4.0 * aside, 13.0, tilts[2])
        before = BARE.held(dict(enumerate((bed, *pair))))
        twin = SlowWall(0.58, BARE.how, before.laid).put([(3, block)])
        assert places(before.put([(3, block)])) == about(twin)
        pushed = any(was.x != twin.laid[i].x for i, was in before.laid.items())
        rests[0 if 3 not in twin.laid else 2 if pushed else 1] += 1
    assert min(rests) > 2, rests


def places(wall):
    return {i: (one.x, one.y, one.angle_deg) for i, one in wall.laid.items()}


def about(wall):
    return {i: pytest.approx(place, abs=0.05) for i, place in places(wall).items()}


POST, PLANK = box(0.0, 0.0, 20.0), box(-20.0, 20.0, 60.0, 10.0)
"""A brick on the ground, and a plank in balance on it."""


def built(*blocks):
    """A wall of blocks that are put down one after the other as planned, numbered from 1."""
    wall = BARE
    for i, corners in enumerate(blocks, 1):
        wall = wall.put([(i, as_planned(corners))]).loaded(i)
    return wall


def fallen(once, *blocks):
    """Which of some blocks fall, numbered from 1."""
    groups = [[(i, corners)] for i, corners in enumerate(blocks, 1)]
    return {end.stone for end in once(groups, NONE, np.random.default_rng(0)).stones if end.fallen}


@pytest.mark.parametrize(("left", "falls"), [(0.0, False), (24.0, True), (-24.0, True)])
@BOTH
def test_a_plank_tips_where_it_and_what_lies_on_it_act_beside_its_post(once, left, falls):
    brick = box(left, 30.0, 20.0, 30.0)  # as heavy as the plank
    assert fallen(once, POST, PLANK, brick) == ({2, 3} if falls else set())


@pytest.mark.parametrize(("end", "falls"), [(31.0, False), (45.0, True)])
@BOTH
def test_a_stone_on_a_post_is_held_by_a_beam_that_another_bears_too(once, end, falls):
    """The beam acts beside the post; a beam on the stone alone would tip it."""
    post, stone = box(40.0, 0.0, 10.0, 10.0), box(30.0, 10.0, 30.0, 10.0)
    beam = box(-25.0, 20.0, end + 25.0, 10.0)
    other = [] if falls else [box(-30.0, 0.0, 20.0, 20.0)]
    assert bool(fallen(once, *other, post, stone, beam)) == falls


@BOTH
def test_a_cobble_is_held_where_what_lies_on_it_soon_lies_on_others(once):
    """The brick's load rolls the cobble, but the beam then comes to lie on the whole pier."""
    pier = np.array([[0, 0], [60, 0], [60, 29], [44, 30], [0, 30]], float)
    round_below = [[78, 0], [82, 0], [94, 8], [96, 22], [90, 28], [68, 30], [64, 10]]
    cobble = np.array(round_below, float)
    beam, brick = box(0.0, 30.0, 110.0, 12.0), box(50.0, 42.0, 30.0, 60.0)
    assert not fallen(once, pier, cobble, beam, brick)


@BOTH
def test_a_stone_does_not_tip_further_than_what_lies_on_it_lets_it(once):
    """The beam bears on a peak beside the post; once that sinks it bears on the other end."""
    post, pier, beam = box(35.0, 0.0, 30.0), box(150.0, 0.0, 30.0, 42.0), box(10.0, 42.0, 190.0)
    peak = [(100.0, 40.0), (94.0, 40.0), (94.0, 42.0), (90.0, 42.0), (90.0, 40.0)]
    stone = np.array([(20.0, 20.0), (100.0, 20.0), *peak, (20.0, 40.0)])
    assert not fallen(once, post, pier, stone, beam)


def test_a_plank_does_not_rock_under_a_stone_that_cannot_rise():
    post, plank = box(40.0, 0.0, 20.0, 5.0), box(0.0, 5.0, 100.0, 15.0)
    before = built(post, plank, box(10.0, 20.0, 20.0, 30.0))
    brick = as_planned(box(70.0, 20.0, 30.0, 70.0))
    free = before.put([(6, brick)]).loaded(6)
    assert free.laid[2].angle_deg < -5.0
    assert free.laid[3].y > before.laid[3].y + 2.0  # it rides on the plank
    assert free.laid[3].angle_deg == pytest.approx(free.laid[2].angle_deg, abs=0.1)
    held = before.held({4: as_planned(box(0.0, 50.1, 40.0))})
    after = held.put([(6, brick)]).loaded(6)
    assert (after.laid[2], after.laid[3]) == (before.laid[2], before.laid[3])


def test_an_upright_face_carries_a_part_of_what_leans_on_it():
    """The brick's own weight acts beside the post's foot; half of it hangs on the face."""
    post = np.array([(65.0, 0.0), (79.0, 0.0), (86.0, 40.0), (58.0, 40.0)])
    before = built(box(0.0, 0.0, 40.0, 80.0), post)
    after = before.put([(3, as_planned(box(40.0, 40.0, 22.0, 50.0)))]).loaded(3)
    assert after.laid[3].y == pytest.approx(65.0, abs=0.5)
    assert (list(after.without([1]).laid), list(after.without([2]).laid)) == ([2, 3], [1])
    assert after.laid[2] is before.laid[2]


@pytest.mark.parametrize(("slope_deg", "falls"), [(20.0, False), (50.0, True)])
@BOTH
def test_a_stone_on_a_slope_pushes_what_else_bears_it(once, slope_deg, falls):
    """It lies on a pier and on a post; a slope within the friction angle pushes nothing."""
    rise = np.tan(np.radians(slope_deg))
    pier = np.array([(-80, 0), (0, 0), (0, 20), (-25, 20 + 25 * rise), (-80, 20 + 25 * rise)])
    post = box(18.0, 0.0, 4.0, 30.0)
    low, high = (-2.0, 20.0 + 2.0 * rise), (-20.0, 20.0 + 20.0 * rise)
    stone = np.array([low, (18.0, 30.0), (24.0, 30.0), (24.0, 60.0), (-20.0, 60.0), high])
    assert bool(fallen(once, pier, post, stone)) == falls


def test_what_was_pushed_into_another_is_put_down_again():
    """A stone in balance is pushed into the peak that it has a notch for."""
    peak = np.array([(20.0, 0.0), (40.0, 0.0), (33.0, 14.0), (27.0, 14.0)])
    notch = [(19.0, 2.0), (26.0, 14.0), (34.0, 14.0), (41.0, 2.0)]
    stone = np.array([(-10.0, 2.0), *notch, (70.0, 2.0), (70.0, 30.0), (-10.0, 30.0)])
    wall = built(box(-80.0, 0.0, 40.0, 30.0), peak, stone)
    laid = wall.put([(4, as_planned(box(-46.0, 0.0, 42.0, 30.0)))])
    after = laid.loaded(4)
    bodies = [[shapely.Polygon(one.laid[i].corners) for i in (2, 3)] for one in (laid, after)]
    deep, apart = (one.intersection(other).area for one, other in bodies)
    assert deep > 20.0
    assert apart < 0.5


def test_what_cannot_get_out_under_a_stone_that_was_pushed_into_it_stays():
    """A brick pushes a beam against the slope of a stone that a post and a face hold."""
    left, base = box(-90.0, 0.0, 59.0, 60.0), box(-30.0, 0.0, 50.0, 37.0)
    post, right = box(40.0, 0.0, 20.0), box(110.2, 0.0, 40.0, 60.0)
    stone = np.array([(30.0, 20.0), (110.0, 20.0), (110.0, 40.0), (60.0, 40.0), (30.0, 34.0)])
    beams = box(0.0, 37.0, 45.0, 23.0), box(46.0, 40.0, 50.0, 15.0)
    before = built(left, base, post, right, stone, *beams)
    laid = before.put([(9, as_planned(box(-32.5, 37.0, 34.0)))])
    assert laid.laid[6].x > before.laid[6].x + 1.0
    assert laid.loaded(9).laid[5] is laid.laid[5]


def test_a_stone_far_above_tips_what_carries_all():
    """Each brick has its centroid on the one below; three together hang over the lowest."""
    stairs = [box(15.0 * k, 20.0 * k) for k in range(4)]
    assert list(built(*stairs[:2]).laid) == [1, 2]
    assert len(fallen(rehearse, *stairs)) >= 2


@pytest.mark.parametrize(("x", "stays"), [(2.0, True), (20.06, True), (21.0, False)])
def test_what_stays_is_not_touched(x, stays):
    """Also where the load of the plank acts at the very edge of its post, 0.03 px beside it."""
    before = built(POST, PLANK)
    after = before.put([(3, as_planned(box(x, 30.0, 20.0, 30.0)))]).loaded(3)
    assert list(after.laid) == ([1, 2, 3] if stays else [1])
    assert not stays or all(after.laid[i] is before.laid[i] for i in (1, 2))


def test_what_lies_on_a_stone_that_is_pushed_away_falls():
    """A brick in a gap that is too narrow pushes the one aside on which another is in balance."""
    before = built(box(-60.0, 0.0), box(0.0, 0.0), box(-9.5, 20.0, 20.0, 10.0))
    after = before.put([(4, as_planned(box(-22.0, 0.0, 24.0, 15.0)))]).loaded(4)
    assert after.laid[2].x > before.laid[2].x + 1.0
    assert lost(before, after) == [3]


def test_what_is_held_stays_and_carries_what_comes():
    before = built(POST, PLANK)
    brick, aside = (as_planned(box(x, 30.0, 20.0, 30.0)) for x in (24.0, 200.0))
    assert lost(before, before.put([(3, brick)]).loaded(3)) == [2]
    held = before.held({2: before.laid[2], 4: aside})
    after = held.put([(3, brick)]).loaded(3)
    assert list(after.laid) == [1, 2, 4, 3]
    assert not lost(held, after)
    assert after.laid[4] is aside  # in the air


def test_what_is_taken_up_takes_along_what_lies_on_it_or_hangs_on_it():
    wall = built(POST, PLANK, box(90.0, 0.0), box(90.0, 20.0))
    assert list(wall.without([1]).laid) == [3, 4]
    left = wall.without([4])
    assert list(left.laid) == [1, 2, 3]
    assert lost(wall, left) == [4]
    # Between upright faces it hangs on both.
    wall = built(box(0.0, 0.0), box(60.0, 0.0), box(39.0, 5.0, 22.0, 10.0))
    assert wall.laid[3].y == pytest.approx(10.0, abs=0.1)
    assert (list(wall.without([1]).laid), list(wall.without([2]).laid)) == ([2], [1])


def test_blocks_that_do_not_lie_change_nothing_and_any_ids_will_do():
    wall = built(POST, PLANK)
    assert wall.loaded(99).laid == wall.laid == wall.without([99]).laid
    assert (wall.with_burden(iter([1])), wall.with_burden([99])) == ({1, 2}, {99})
    assert BARE.loaded(5).laid == {}
    # The ground is no block, whatever number one has.
    apart = BARE.held({-1: as_planned(box(90.0, 0.0))}).put([(1, as_planned(box(0.0, 0.0)))])
    assert list(apart.without([-1]).laid) == [1]


def test_a_wedge_that_waits_for_its_stone_is_not_put_down_again():
    wedge, aside = (as_planned(box(x, 0.0)) for x in (0.0, 90.0))
    wall = bare_wall(0.58, SETTLE).put([(5, wedge)]).put([(5, aside)])
    assert (wall.laid[5].x, len(wall.laid)) == (pytest.approx(20.0, abs=0.1), 1)


@pytest.mark.parametrize(("taper", "narrowest"), [(0.0, 20.0), (10.0, 26.0), (4.0, 9.0)])
def test_walls_are_built_as_by_the_twin(taper, narrowest):
    """Bricks of many widths, so badly laid that some roll, some are held, and some fall.

    Some stand between bricks whose sides slope, and push these aside.
    """
    told = [0, 0, 0]
    for seed in range(24):
        rng = np.random.default_rng(seed)
        spots = [(row, k) for row in range(4) for k in range(4 - row)]
        left, width = rng.uniform(-13.0, 13.0, 10), rng.uniform(narrowest, 38.0, 10)
        errors = BuilderErrors.of_precision(2.0 * HAND, 25.0)
        wall, twin = BARE, SlowWall(0.58, BARE.how)
        for block, ((row, k), x, across) in enumerate(zip(spots, left, width, strict=True)):
            corners = box(40.0 * k + 20.0 * row + x, 20.0 * row, across)
            corners[2:, 0] += taper * np.array([-1.0, 1.0]) * (-1) ** block
            put = [(block, *errors.all_built(corners, stratified(rng, 1, 1)[0]))]
            laid = wall.put(put)
            wall = laid.loaded(block)
            twin = twin.put(put).loaded(block)
            assert places(wall) == about(twin)
            told[0 if wall.laid == laid.laid else 2 if lost(laid, wall) else 1] += 1
    assert min(told) > 2, told
