"""Walls that are built again with a builder's errors, in open loop and in closed loop."""

from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest
import shapely

from drystone.model.builder import HAND, ROBOT, BuilderErrors, stratified
from drystone.search.closed_loop import rehearse_closed
from drystone.search.rehearsal import mean_size, rehearse, rehearse_in_engine, tilt_as_built
from tests.polygons import box_of as box

NONE = BuilderErrors(placement=0.0, angle_deg=0.0, outline=0.0)
TURNED = BuilderErrors(placement=0.0, angle_deg=10.0, outline=0.0)

BOND = [
    [(10 * row + k, box(40.0 * k + 20.0 * row, 20.0 * row))]
    for row in range(3)
    for k in range(4 - row)
]
"""Nine bricks in bond."""

TOWER = [*BOND, [(99, box(66.0, 60.0, 8.0, 30.0))], [(100, box(54.5, 90.0, 38.0, 10.0))]]
"""A brick on a post on top."""


def runs(groups, precision, count=8, once=rehearse):
    errors = BuilderErrors.of_precision(precision, mean_size(groups))
    return [once(groups, errors, np.random.default_rng(seed)) for seed in range(count)]


NO_ENGINE = pytest.mark.skipif(find_spec("pymunk") is None, reason="pymunk is not installed")


@pytest.mark.parametrize("once", [rehearse, pytest.param(rehearse_in_engine, marks=NO_ENGINE)])
def test_where_a_stone_ends_is_asked_not_how_it_was_put(once):
    (end,) = once([[(1, box(0.0, 0.0))]], TURNED, np.random.default_rng(6)).stones
    drawn = stratified(np.random.default_rng(6), 1, 1)[0]
    (put,) = TURNED.all_built(box(0.0, 0.0), drawn)
    assert abs(put.angle_deg) > 5.0
    assert (end.fallen, end.turn_deg) == (False, pytest.approx(0.0, abs=0.5))


@pytest.mark.parametrize(
    ("groups", "once"),
    [
        (BOND, rehearse),
        (TOWER, rehearse),
        pytest.param(BOND[:5], rehearse_in_engine, marks=NO_ENGINE),
    ],
)
def test_without_errors_a_wall_stays_as_planned(groups, once):
    run = once(groups, NONE, np.random.default_rng(0))
    assert run.first_fall is None
    assert [end.stone for end in run.stones] == [group[0][0] for group in groups]
    assert max(end.share for end in run.stones) < 0.02
    assert {i for i, _ in run.blocks} == {i for group in groups for i, _ in group}


def test_bricks_in_bond_survive_a_robot_and_a_brick_on_a_post_does_not_survive_a_hand():
    assert all(run.first_fall is None for run in runs(BOND, ROBOT))
    fallen = [{end.stone for end in run.stones if end.fallen} for run in runs(TOWER, HAND)]
    assert sum(bool(stones & {99, 100}) for stones in fallen) >= 3
    # What has fallen does not lie in the wall.
    run = next(run for run in runs(TOWER, HAND) if run.first_fall is not None)
    assert run.first_fall not in {i for i, _ in run.blocks}


def test_falls_begin_with_the_stone_under_whose_load_another_falls():
    plank_and_load = [[(1, box(0.0, 0.0))], [(2, box(5.0, 20.0, 60.0, 10.0))]]
    run = rehearse(plank_and_load, NONE, np.random.default_rng(0))
    assert (run.first_fall, run.begins) == (None, None)
    plank_and_load += [[(3, box(45.0, 30.0, 20.0, 20.0))], [(4, box(5.0, 30.0, 20.0, 10.0))]]
    run = rehearse(plank_and_load, NONE, np.random.default_rng(0))
    assert (run.first_fall, run.begins) == (2, 3)


def test_the_engine_judges_the_same_errors():
    pytest.importorskip("pymunk")
    (pile,) = runs([BOND[0], [(1, box(0.0, 20.0))]], ROBOT, 1, rehearse_in_engine)
    assert pile.first_fall is None
    assert pile.tilt == pytest.approx(1.0, abs=0.1)  # it slides
    (tower,) = runs(TOWER, 0.1, 1, rehearse_in_engine)
    assert tower.tilt is None
    assert tower.first_fall not in {None, *(i for i, _ in tower.blocks)}


def test_wedges_come_before_their_stone():
    """A brick that only a wedge keeps level."""
    leaning = [(2, box(4.0, 25.0)), (3, box(30.0, 20.0, 10.0, 5.0))]
    low = np.array([[0.0, 0], [60, 0], [60, 20], [20, 20], [20, 25], [0, 25]])
    run = rehearse([[(1, low)], leaning], NONE, np.random.default_rng(0))
    assert run.first_fall is None
    assert run.stones[1].turn_deg == pytest.approx(0.0, abs=0.5)


def fallen(run):
    return [end.stone for end in run.stones if end.fallen]


@pytest.mark.parametrize("groups", [BOND, TOWER])
def test_without_errors_it_is_the_wall_of_open_loop(groups):
    run = rehearse_closed(groups, NONE, np.random.default_rng(0))
    plain = rehearse(groups, NONE, np.random.default_rng(0))
    assert (run.again, fallen(run)) == (0, [])
    assert [end.stone for end in run.stones] == [group[0][0] for group in groups]
    for (one, corners), (other, expected) in zip(run.blocks, plain.blocks, strict=True):
        assert one == other
        np.testing.assert_allclose(corners, expected, atol=1e-9)


def test_fewer_walls_lose_a_stone_than_in_open_loop():
    closed, plain = (runs(TOWER, 0.04, 16, once) for once in (rehearse_closed, rehearse))
    assert sum(map(bool, map(fallen, plain))) >= 3
    assert sum(map(bool, map(fallen, closed))) == 0
    assert any(run.again for run in closed)


NEEDLE = np.array([[-2.0, 220.0], [0.0, 20.0], [2.0, 220.0], [0.0, 420.0]])
"""It rests on no point."""


@pytest.mark.parametrize(
    ("boxes", "again", "lost", "lowest"),
    [
        # Planned in the air beside a wall of one course, which has no other room.
        ([box(0, 0), box(41, 0), box(82, 0), box(100, 70)], 0, [], {4: 20.0}),
        # Onto the end of a plank on a post, or in between two bricks that leave no room.
        ([box(0, 0, 20), box(-20, 20, 60, 10), box(24, 30, 20, 30)], 0, [], {}),
        ([box(0, 0), box(64, 0), box(32, 0)], 2, [], {}),
        # A tall one planned in the air; then another comes where alone it can stand.
        ([box(0, 0, 40, 36), box(42, 17, 40, 110), box(42, 0, 60, 40)], 1, [], {2: 0.0}),
        # Lying it would be longer than the wall.
        ([box(-20, 0), NEEDLE], 0, [2], {}),
    ],
    ids=["in the air", "thrown down", "pushed away", "in the way", "no place"],
)
def test_what_falls_or_is_in_the_way_is_laid_again_elsewhere(boxes, again, lost, lowest):
    groups = [[(number, corners)] for number, corners in enumerate(boxes, 1)]
    assert rehearse(groups, NONE, np.random.default_rng(0)).first_fall is not None
    run = rehearse_closed(groups, NONE, np.random.default_rng(0))
    blocks = dict(run.blocks)
    assert (fallen(run), run.again) == (lost, again)
    assert blocks.keys() | {*lost} == {*range(1, len(boxes) + 1)}
    assert {i: blocks[i][:, 1].min() for i in lowest} == pytest.approx(lowest, abs=0.1)
    # What lies in the wall overlaps nothing.
    shapes = [shapely.Polygon(corners) for corners in blocks.values()]
    assert sum(one.area for one in shapes) == pytest.approx(shapely.union_all(shapes).area)


def test_a_wall_as_it_was_built_is_tilted():
    pytest.importorskip("pymunk")
    low = [[(k + 1, box(41.0 * k, 0.0))] for k in range(2)]
    (run,) = runs(low, HAND, 1, rehearse_closed)
    assert tilt_as_built(low, run) == pytest.approx(1.0, abs=0.1)  # it slides
    # A column that is thrice as high as wide topples at a third; one on an edge falls at once.
    column, wedge = [[(1, box(0.0, 0.0, 20.0, 60.0))]], (2, box(50.0, 40.0, 5.0, 5.0))
    high = rehearse(column, NONE, np.random.default_rng(0))
    topples = pytest.approx(0.333 / 0.58, abs=0.05)
    assert tilt_as_built(column, high) == topples
    # A wedge that comes out is lost, a stone is not.
    out = replace(high, blocks=(*high.blocks, wedge))
    assert tilt_as_built([[*column[0], wedge]], out) == topples
    two = replace(out, stones=(*high.stones, replace(high.stones[0], stone=2)))
    assert tilt_as_built([*column, [(2, box(90.0, 0.0, 5.0, 5.0))]], two) == 0


def test_what_goes_a_short_way_or_into_its_planned_place_has_not_fallen():
    pytest.importorskip("pymunk")
    # Far for the small stone, and a seventh of its own size for the large one.
    small, large = [(1, box(0.0, 0.0, 20.0, 20.0))], [(2, box(60.0, 8.0, 80.0, 40.0))]
    run = rehearse([small, large], NONE, np.random.default_rng(0))
    run = replace(run, blocks=(*small, *large))
    assert tilt_as_built([small, large], run) > 0.5
    planned, high = [[(1, box(0.0, y))] for y in (0.0, 10.0)]
    run = replace(rehearse([planned], NONE, np.random.default_rng(0)), blocks=tuple(high))
    assert tilt_as_built([planned], run) == pytest.approx(1.0, abs=0.1)
    assert tilt_as_built([high], run) == 0
