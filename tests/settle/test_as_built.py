"""What a block that is put down does to those that carry it."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.model.builder import HAND, BuilderErrors, as_planned, stratified
from drystone.search.rehearsal import mean_size, rehearse
from drystone.settle import as_built
from drystone.settle.as_built import BuiltWall
from drystone.settle.putting import touching
from tests.naive import as_built as naive
from tests.polygons import box_of as box
from tests.search.test_rehearsal import BOND, BOTH, NONE
from tests.settle.test_putting import SETTLE

POST, PLANK = [(1, box(0.0, 0.0, 20.0))], [(2, box(-20.0, 20.0, 60.0, 10.0))]
"""A brick on the ground, and a plank in balance on it."""


def built(groups, errors=NONE):
    wall, rng = BuiltWall(0.58, SETTLE), np.random.default_rng(0)
    for (block, corners), *_ in groups:
        put = errors.all_built(corners, stratified(rng, 1, 1)[0])
        wall = wall.put([(block, *put)]).loaded(block)
    return wall


@pytest.mark.parametrize(("left", "falls"), [(0.0, False), (24.0, True), (-24.0, True)])
@BOTH
def test_a_plank_tips_where_it_and_what_lies_on_it_act_beside_its_post(once, left, falls):
    brick = [(3, box(left, 30.0, 20.0, 30.0))]  # as heavy as the plank
    run = once([POST, PLANK, brick], NONE, np.random.default_rng(0))
    assert {end.stone for end in run.stones if end.fallen} == ({2, 3} if falls else set())


@pytest.mark.parametrize(("end", "falls"), [(31.0, False), (45.0, True)])
@BOTH
def test_a_stone_on_a_post_is_held_by_a_beam_that_another_bears_too(once, end, falls):
    """The beam acts beside the post; a beam on the stone alone would tip it."""
    post, stone = [(1, box(40.0, 0.0, 10.0, 10.0))], [(2, box(30.0, 10.0, 30.0, 10.0))]
    beam = [(3, box(-25.0, 20.0, end + 25.0, 10.0))]
    other = [] if falls else [[(4, box(-30.0, 0.0, 20.0, 20.0))]]
    run = once([*other, post, stone, beam], NONE, np.random.default_rng(0))
    assert any(one.fallen for one in run.stones) == falls


def test_a_plank_does_not_rock_under_a_stone_that_cannot_rise():
    post, plank = [(1, box(40.0, 0.0, 20.0, 5.0))], [(2, box(0.0, 5.0, 100.0, 15.0))]
    before = built([post, plank, [(3, box(10.0, 20.0, 20.0, 30.0))]])
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
    pier = [(1, box(0.0, 0.0, 40.0, 80.0))]
    post = [(2, np.array([(65.0, 0.0), (79.0, 0.0), (86.0, 40.0), (58.0, 40.0)]))]
    brick = as_planned(box(40.0, 40.0, 22.0, 50.0))
    before = built([pier, post])
    after = before.put([(3, brick)]).loaded(3)
    assert after.laid[3].y == pytest.approx(65.0, abs=0.5)
    bed = after.beds[3]
    assert {point.below for point in bed.points} == {2}
    assert {point.below for point in bed.faced} == {1, 2}
    assert after.laid[2] is before.laid[2]


def test_what_was_pushed_into_another_is_put_down_again():
    """As when domes are pushed: it sinks into what it lies on, where nothing bears it."""
    plank, step = [(1, box(0.0, 0.0, 60.0, 20.0))], [(2, box(0.0, 20.0, 20.0, 8.0))]
    wall = built([plank, step])
    stone = as_planned(box(16.0, 19.4))
    pushed = replace(
        wall, laid={**wall.laid, 3: stone}, polygons=wall.polygons.added([stone.corners])
    )
    after = pushed.put([(4, as_planned(box(30.0, 40.0, 20.0, 30.0)))]).loaded(4)
    assert (after.laid[3].x, after.laid[3].y) == pytest.approx((40.0, 30.0), abs=0.1)
    assert after.laid[4].y == pytest.approx(55.0, abs=0.1)


def test_a_stone_far_above_tips_what_carries_all():
    """Each brick has its centroid on the one below; three together hang over the lowest."""
    stairs = [[(k, box(15.0 * k, 20.0 * k))] for k in range(4)]
    assert list(built(stairs[:2]).laid) == [0, 1]
    run = rehearse(stairs, NONE, np.random.default_rng(0))
    assert sum(end.fallen for end in run.stones) >= 2


def test_what_stays_is_not_touched():
    before = built([POST, PLANK])
    brick = as_planned(box(2.0, 30.0, 20.0, 30.0))
    after = before.put([(3, brick)]).loaded(3)
    assert list(after.laid) == [1, 2, 3]
    assert all(after.laid[i] is before.laid[i] for i in (1, 2))


def test_what_lies_on_a_stone_that_is_pushed_away_falls():
    """A brick in a gap that is too narrow pushes the one aside on which another is in balance."""
    row = [[(1, box(-60.0, 0.0))], [(2, box(0.0, 0.0))], [(3, box(-9.5, 20.0, 20.0, 10.0))]]
    before = built(row)
    after = before.put([(4, as_planned(box(-22.0, 0.0, 24.0, 15.0)))]).loaded(4)
    assert after.laid[2].x > before.laid[2].x + 1.0
    assert after.lost(before) == [3]


def test_what_is_held_stays_and_carries_what_comes():
    before = built([POST, PLANK])
    brick, aside = (as_planned(box(x, 30.0, 20.0, 30.0)) for x in (24.0, 200.0))
    assert sorted(before.put([(3, brick)]).loaded(3).lost(before)) == [2]
    held = before.held({2: before.laid[2], 4: aside})
    after = held.put([(3, brick)]).loaded(3)
    assert list(after.laid) == [1, 2, 4, 3]
    assert not after.lost(held)
    assert after.laid[4] is aside  # in the air


def test_what_is_taken_up_takes_along_what_lies_on_it():
    wall = built([POST, PLANK, [(3, box(90.0, 0.0))], [(4, box(90.0, 20.0))]])
    assert list(wall.without([1]).laid) == [3, 4]
    left = wall.without([4])
    assert list(left.laid) == [1, 2, 3]
    assert left.polygons.corners.tolist() == wall.polygons.leading(3).corners.tolist()
    assert sorted(left.lost(wall)) == [4]


def test_what_hangs_between_upright_faces_is_taken_up_with_either():
    wall = built([[(1, box(0.0, 0.0))], [(2, box(60.0, 0.0))], [(3, box(39.0, 5.0, 22.0, 10.0))]])
    assert wall.laid[3].y == pytest.approx(10.0, abs=0.1)
    assert (list(wall.without([1]).laid), list(wall.without([2]).laid)) == ([2], [1])


def test_a_wedge_that_waits_for_its_stone_is_not_put_down_again():
    wedge, aside = (as_planned(box(x, 0.0)) for x in (0.0, 90.0))
    wall = BuiltWall(0.58, SETTLE).put([(5, wedge)]).put([(5, aside)])
    assert (wall.laid[5].x, len(wall.polygons)) == (pytest.approx(20.0, abs=0.1), 1)


@pytest.mark.parametrize("precision", [0.0, HAND])
def test_loads_act_where_they_do_block_by_block(precision):
    wall = built(BOND, BuilderErrors.of_precision(precision, mean_size(BOND)))
    loads = as_built._loads(wall, wall.laid)
    assert len(loads) == len(BOND)
    for block, load in loads.items():
        assert load == pytest.approx(naive.load(block, wall.laid, wall.beds))
    # A brick in bond bears on two others.
    assert wall.beds[20].below == {10, 11}


def test_blocks_bear_their_loads_as_by_the_twin():
    """Bricks of many widths, so badly laid that some would roll and some are held."""
    told = set()
    for seed in range(60):
        rng = np.random.default_rng(seed)
        places = [(row, k) for row in range(4) for k in range(4 - row)]
        left, width = rng.uniform(-9.0, 9.0, 10), rng.uniform(22.0, 40.0, 10)
        bricks = [
            box(40.0 * k + 20.0 * row + x, 20.0 * row, across)
            for (row, k), x, across in zip(places, left, width, strict=True)
        ]
        wall = BuiltWall(0.58, SETTLE)
        errors = BuilderErrors.of_precision(2.0 * HAND, 25.0)
        for block, corners in enumerate(bricks):
            put = errors.all_built(corners, stratified(rng, 1, 1)[0])
            wall = as_built._with_beds(wall.put([(block, *put)]))
        loads = as_built._loads(wall, wall.laid)
        for block, built in wall.laid.items():
            near, on = touching(built.size, SETTLE), wall.beds[block].points
            stays = as_built._stays(wall, block, loads)
            assert stays == naive.stays(block, wall.laid, wall.beds, 0.58, near)
            told.add((stays, bool(on) and on[0].x <= loads[block].x <= on[-1].x))
    assert told == {(True, True), (True, False), (False, False)}


def test_a_load_at_the_very_edge_does_not_roll_a_block():
    brick = as_planned(
        box(20.06, 30.0, 20.0, 30.0)
    )  # the plank's load acts 0.03 px beside its post
    wall = built([POST, PLANK]).put([(3, brick)])
    assert wall.loaded(3).laid[2] is wall.laid[2]
    farther = built([POST, PLANK]).put([(3, as_planned(box(21.0, 30.0, 20.0, 30.0)))])
    assert 2 not in farther.loaded(3).laid
