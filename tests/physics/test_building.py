"""Walls built up stone by stone: piles stand or fall, and what falls is named."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.physics.building import ROUNDED, BuildSettings, Watch, build_up, tilt_of
from drystone.physics.scatter import Variation
from drystone.physics.scene import EngineScene, EngineSettings
from drystone.physics.table import TiltingTable
from drystone.physics.tilt import TiltSettings
from tests.polygons import box_of as rectangle

pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")


def single(*rectangles):
    """One stone a group, numbered from 1."""
    return [[(number, rectangle(*r))] for number, r in enumerate(rectangles, 1)]


COURSES = single(
    *((40.0 * i, 0.0, 40.0, 20.0) for i in range(3)),
    *((20.0 + 40.0 * i, 20.0, 40.0, 20.0) for i in range(2)),
    (40.0, 40.0, 40.0, 20.0),
)


def test_a_pile_stands_and_stays_where_it_is():
    told = []
    built = build_up(COURSES, on_group=told.append)
    assert told == [move.id for move in built.moves] == [1, 2, 3, 4, 5, 6]
    assert (built.stands, built.rests) == (True, True)
    assert (built.fallen, built.first_fall, built.restless) == ((), None, ())
    # Blocks sink by the overlap that the engine leaves, a thousandth of 28 px each.
    assert max(*(move.move_px for move in built.moves), *built.found_moved_px) < 0.1
    assert built.found_moved_px[0] == 0.0
    for ((block, corners),) in COURSES:
        assert np.abs(corners - built.outlines[block]).max() < 0.1


def test_an_overhanging_stone_falls_and_is_named():
    groups = single((0, 0, 40, 20), (50, 0, 40, 20), (22, 20, 40, 20), (60, 40, 40, 20))
    built, again = build_up(groups), build_up(groups)
    assert built.moves == again.moves
    assert (built.fallen, built.first_fall) == ((4,), 4)
    top = built.moves[-1]
    assert top.fell
    assert top.turn_deg > 10
    assert top.share == pytest.approx(top.move_px / np.sqrt(800))
    # It went down at its right end.
    assert built.outlines[4][:, 1].min() < 30
    assert tilt_of(built) is None


def test_the_order_of_placement_matters():
    """The counterweight must come before what it holds."""
    base, counterweight = (1, rectangle(0, 0, 40, 20)), (3, rectangle(10, 40, 20, 40))
    long = (2, rectangle(10, 20, 70, 20))
    assert build_up([[base], [long], [counterweight]]).first_fall == 2
    assert build_up([[base], [long, counterweight]]).stands
    # A stone on the end of another tips one that stood; the step that brings it down is its own.
    built = build_up(single((0, 0, 40, 20), (16, 20, 40, 10), (46, 30, 20, 20)))
    assert (built.first_fall, set(built.fallen)) == (3, {2, 3})


def test_a_wedge_keeps_its_stone_and_a_turn_alone_is_a_fall():
    pillars = single((0, 0, 20, 20), (60, 0, 20, 14))
    slab, wedge = (3, rectangle(2, 20, 76, 12)), (9, rectangle(66, 14, 10, 6))
    assert build_up([*pillars, [slab]]).fallen == (3,)
    built = build_up([*pillars, [slab]], settings=BuildSettings(moved_share=10.0, turned_deg=3.0))
    assert built.fallen == (3,)
    # About (20, 20), until its end at x = 78 lies on the lower pillar.
    assert built.moves[2].turn_deg == pytest.approx(np.degrees(np.arctan(6 / 58)), rel=0.05)
    held = build_up([*pillars, [slab, wedge]])
    assert held.stands
    last = held.moves[-1]
    assert last.id == 9
    # A wedge is judged by the size of its stone.
    assert last.share == pytest.approx(last.move_px / np.sqrt(76 * 12))


def test_an_overlap_is_pushed_apart_and_nothing_is_thrown():
    built = build_up(single((0, 0, 40, 20), (0, 18, 40, 20)))
    lower, upper = built.moves
    assert lower.overlap_px == pytest.approx(0.0, abs=1e-6)
    assert upper.overlap_px == pytest.approx(2.0, abs=0.01)
    # It goes up by the overlap, but for what the engine leaves, .003 of the size of the blocks.
    assert upper.move_px == pytest.approx(2.0, abs=0.15)
    assert upper.turn_deg < 0.1
    assert built.stands


def test_who_comes_last_makes_room():
    """A stone that is put 3 px into its neighbour goes aside; between two, all three are pushed."""
    stood, came = build_up(single((0, 0, 40, 20), (37, 0, 40, 20))).moves
    assert (stood.overlap_px, came.overlap_px) == pytest.approx((0.0, 3.0), abs=0.01)
    assert stood.move_px < 0.2
    assert came.move_px == pytest.approx(3.0, abs=0.2)
    between = build_up(single((0, 0, 40, 20), (76, 0, 40, 20), (38, 0, 40, 20)))
    assert between.stands
    left, middle, right = (between.outlines[block][:, 0].mean() for block in (1, 3, 2))
    assert np.diff([left, middle, right]) == pytest.approx(40.0, abs=0.2)
    # A wedge comes before its stone, which is lifted by it.
    slab, wedge = (3, rectangle(2, 20, 76, 12)), (9, rectangle(66, 14, 10, 8))
    lifted = build_up([*single((0, 0, 20, 20), (60, 0, 20, 14)), [slab, wedge]]).moves
    assert [move.overlap_px for move in lifted[2:]] == pytest.approx([2.0, 0.0], abs=0.01)
    assert lifted[3].move_px < 0.2


def test_what_came_before_may_have_moved():
    """A stone set 3 px too high drops; the next one is put where it was planned all the same."""
    built = build_up(single((0, 3, 40, 20), (0, 23, 40, 20)))
    assert built.found_moved_px[0] == 0.0
    # The engine leaves it .003 of the size of the blocks deep in the ground.
    assert built.found_moved_px[1] == pytest.approx(3.0, abs=0.1)
    # It lands at some speed, and sinks in for a moment.
    assert built.moves[1].move_px == pytest.approx(3.0, abs=0.25)
    # A movement alone is a fall.
    groups = single((0, 3, 40, 20))
    assert build_up(groups, settings=BuildSettings(moved_share=0.05)).fallen == (1,)
    assert build_up(groups, settings=BuildSettings(moved_share=0.2)).stands


def test_what_does_not_rest_is_said():
    settings = BuildSettings(longest_rest=0.5, resting_time=0.25)
    built = build_up(single((0, 30, 40, 20)), settings=settings)
    assert built.restless == (1,)
    assert not built.rests
    assert tilt_of(built) is None
    assert tilt_of(build_up([])) is None


def test_faces_that_touch_exactly_are_not_found_to_be_deep_in_each_other():
    """Sharp polygons are, at some units of length, which a third block changes here."""
    face = 675.0658410386717, 82.07608080758175
    left = [(450, 0), (675, 0), face, (635.0067604611938, 85.21316892956254), (450, 85)]
    right = [(675, 0), (895, 0), (895, 80), (880, 80), (690, 80), face]
    outlines = {1: np.array(left, float), 2: np.array(right, float)}
    for size in np.linspace(20, 300, 40):
        scene = EngineScene({**outlines, 3: rectangle(1000, 0, size, size)}, 0.58)
        table = TiltingTable(scene, ROUNDED, placed=(1,))
        assert table.put_down(scene, 2, 0.2) < 1e-6


def test_the_tilt_starts_where_the_wall_came_to_rest():
    """A column planned 2 px above the ground would have to settle by that first."""
    built = build_up(single((0, 2, 20, 40)), 0.7)
    tilts = tilt_of(built, (Variation("rough", ROUNDED, TiltSettings(coarse=0.1, fine=0.05)),))
    assert [tilt.direction for tilt in tilts] == ["left", "right"]
    for tilt in tilts:
        (trial,) = tilt.trials
        assert trial.settled_shift < 0.1
        assert trial.alpha == pytest.approx(0.5, abs=0.06)
        assert trial.resolution <= 0.025


@pytest.mark.parametrize("seed", [2, 4])
@pytest.mark.parametrize("engine", [EngineSettings(), ROUNDED], ids=["sharp", "rounded"])
def test_corners_on_a_line_do_not_move_contacts(seed, engine):
    """A slab on a slope lies still however its faces are divided; engines take edges for faces."""
    rng = np.random.default_rng(seed)

    def divided(corners):
        sides = zip(np.array(corners), np.roll(corners, -1, axis=0), strict=True)
        shares = [np.append(0.0, np.sort(rng.uniform(0.02, 0.98, 3))) for _ in corners]
        return np.vstack(
            [a + t[:, None] * (b - a) for (a, b), t in zip(sides, shares, strict=True)]
        )

    ramp = divided([(0, 0), (100, 0), (100, 50), (0, 20)])
    left, right = np.sort(rng.uniform(5, 95, 2)).tolist() if seed == 4 else (20.0, 75.0)
    low, high = 20 + 0.3 * left, 20 + 0.3 * right
    slab = divided([(left, low), (right, high), (right, high + 20), (left, low + 20)])
    built = build_up([[(1, ramp)], [(2, slab)]], 0.58, BuildSettings(engine=engine))
    assert max(move.move_px for move in built.moves) < 0.02


SCENE = EngineScene({3: rectangle(0, 0, 4, 4), 5: rectangle(10, 0, 4, 4)})
"""Two squares of 4 x 4; the unit of length of the engine is 4."""


def table(places):
    """Blocks where a test puts them: x, y of the centroid above the ground in units of 4, turn."""
    return SimpleNamespace(ids=tuple(places), poses=lambda: np.array(list(places.values())))


@given(st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(-7, 7)), min_size=1))
def test_the_largest_way_of_the_furthest_corner_counts_and_not_the_last(poses):
    watch, found, expected = Watch(SCENE), [], []
    for along, up, angle in poses:
        found.append(watch.look(table({3: (0.5 + along, 0.5 + up, angle)})))
        turn = np.exp(1j * angle) - 1
        ends = [4 * (along + up * 1j) + turn * (x + 1j * y) for x in (-2, 2) for y in (-2, 2)]
        expected.append(max(map(abs, ends)))
    assert found == pytest.approx(expected)
    largest = max(expected), max(abs(np.degrees(angle)) for _, _, angle in poses)
    assert (watch.moves[3], watch.turns_deg[3]) == pytest.approx(largest)
    # The other one has not come yet.
    assert (watch.moves[5], watch.turns_deg[5]) == (0.0, 0.0)
