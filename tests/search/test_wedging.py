"""Wedges in the gaps of finished walls: they raise the resistance, and the plan stays true."""

import math
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
import shapely

from drystone.kernels.polygons import on_grid
from drystone.model.placement import Settled, Wedge
from drystone.model.site import Site
from drystone.model.wall import Group, outlined
from drystone.planner.build import Solves
from drystone.planner.deadline import Deadline, TimeIsUp
from drystone.planner.planner import Planner
from drystone.planner.replay import Replayed, replayed
from drystone.search import yard
from drystone.search.wedge_draft import WedgeDraft
from drystone.search.wedging import wedged_up
from drystone.search.yard import Yard
from drystone.settle.placing import settled_placement
from drystone.settle.rest import placed_outline
from tests.planner.scenes import (
    Ticks,
    after_looks,
    gave_up,
    greedy,
    proven,
    result_of,
    stones_of_masks,
)
from tests.polygons import box
from tests.search.wedge_walls import LARGE, all_places, limits_of, small_walls

NOTHING = np.zeros((0, 0), bool)
SITE = Site(100, 40)
ENDS = (10, 0.01, 0.01), (11, 93.0, 0.01)
"""Low blocks at both ends of the wall, so that something is beside every wedge."""


def toadstool(stem, height, under):
    """A block 20 px wide on a stem."""
    mask = np.ones((height + under, 20), bool)
    mask[height:] = False
    mask[height:, stem] = True
    return mask


STONES = stones_of_masks(
    {
        1: toadstool(slice(8, 12), 10, 3),
        2: toadstool(slice(0, 16), 10, 3),
        3: np.ones((2, 5), bool),
        4: toadstool(slice(0, 8), 10, 8),
        5: np.ones((10, 20), bool),
        6: toadstool(slice(0, 11), 10, 3),
        7: toadstool(slice(8, 12), 10, 3),
        8: toadstool(slice(4, 11), 24, 3),
        9: toadstool(slice(8, 16), 24, 3),
        10: np.ones((5, 6), bool),
        11: np.ones((5, 6), bool),
        12: toadstool(slice(0, 8), 10, 5),
    }
)


LEANING = box(65, 0.01, 68, 8.0)
"""A wedge under the end of stone 4 at 50."""


def planner():
    return Planner(STONES, SITE, settings=LARGE)


def wedged(made, most):
    return wedged_up(made.build, Yard.of(made), most)[0]


def built(*places, wedges=None):
    """A wall of stones: id, left end and lower end of each, and outlines of wedges under them.

    Between two blocks at its ends.
    """
    made = planner()
    groups = []
    for stone_id, left, low in (*ENDS, *places):
        outline = made.workshop.outlines.outline(STONES.by_id(stone_id))
        x, y = on_grid(np.array([left, low]) - outline.min(axis=0)).tolist()
        settled = Settled(x, y, placed_outline(outline, 0.0, x, y))
        outlines = made.build.wall.exact
        placement = settled_placement(
            outlines, SITE, STONES.by_id(stone_id), 0.0, settled, "left", 0
        )
        own = (wedges or {}).get(stone_id, [])
        under = tuple(Wedge(0, stone_id, NOTHING, 0, 0, on_grid(corners)) for corners in own)
        groups.append(Group(placement, under))
    made.build, left_out, _ = replayed(made.build, groups, {}, made.workshop, made.settings)
    assert left_out == ()
    return made


def outlines_of(build):
    return [wedge.corners for wedge in build.wall.wedges if wedge.corners is not None]


def value(build):
    return build.actions[-1].resistance.value


def check(made, build, stones):
    """See that the plan of a wall, written and read again, is true, and that stones keep apart."""
    made.build = build
    assert proven(result_of(made), stones).overlap_depth == 0.0
    shapes = [
        shapely.Polygon(corners)
        for group in build.wall.groups
        for _, corners in outlined(group.placement, group.wedges)
    ]
    for one, other in combinations(shapes, 2):
        assert one.distance(other) >= 0.49 * made.settings.settle.clearance_px


def test_wedges_on_both_sides_keep_a_stone_from_toppling():
    made = built((1, 30.0, 0.01))
    before = value(made.build)
    # The centre of mass is 7.3 px high, the stem 4 wide.
    assert before < 0.5
    after = wedged(made, 2)
    assert value(after) == pytest.approx(1.0)
    assert [(w.under, w.id) for w in after.wall.wedges] == [(1, 13), (1, 14)]
    centres = sorted(float(corners[:, 0].mean()) for corners in outlines_of(after))
    assert centres[0] < 38.0
    assert centres[1] > 42.0
    check(made, after, STONES)
    assert wedged(made, 3) is after  # two wedges are the most under a stone
    made = planner()
    assert wedged(made, 3) is made.build


def test_time_that_is_up_leaves_the_wall_as_it_is():
    made, clock = built((1, 30.0, 0.01)), Ticks()
    after, _ = wedged_up(made.build, Yard.of(made, Deadline(math.inf, clock)), 2)
    assert len(after.wall.wedges) == 2
    assert clock.count > 8
    for looks in range(clock.count):
        with pytest.raises(TimeIsUp):
            wedged_up(made.build, Yard.of(made, after_looks(looks)), 2)
    assert made.build.wall.wedges == ()


def test_a_wedge_with_nothing_beside_it_is_none():
    """At its other side is the stem of the stone."""
    left, right, stone = built((1, 30.0, 0.01)).build.wall.groups
    for beside, sides in (([], set()), ([left], {False}), ([right], {True})):
        made = planner()
        steps = [*beside, stone]
        made.build, _, _ = replayed(made.build, steps, {}, made.workshop, made.settings)
        places = all_places(made.build, limits_of(made))
        assert {bool(place.corners[0, 0] > 40.0) for place in places} == sides
        assert sides or wedged(made, 2) is made.build


def test_of_wedges_that_do_as_much_the_smallest_is_cut():
    """The stone then slides before it topples over a wedge anywhere under its end."""
    made = built((6, 30.0, 0.01))
    after = wedged(made, 1)
    assert value(after) == pytest.approx(1.0)
    (corners,) = outlines_of(after)
    assert np.ptp(corners[:, 0]) == pytest.approx(1.25 * 2.99, abs=1e-5)


def test_the_direction_that_was_the_weaker_one_gains_all_it_can():
    """The other direction is then that in which another stone topples, wherever the wedge is."""
    alone = built((9, 50.0, 0.01)).build.actions[-1].resistance
    made = built((8, 15.0, 0.01), (9, 50.0, 0.01))
    before, after = (b.actions[-1].resistance for b in (made.build, wedged(made, 1)))
    assert before.right.alpha == pytest.approx(0.58 * value(made.build))
    assert after.left.alpha == pytest.approx(alone.left.alpha)
    assert after.right.alpha == pytest.approx(alone.right.alpha)


def test_no_more_are_added_than_asked_for():
    two = built((1, 15.0, 0.01), (7, 50.0, 0.01))  # both topple at once: one is of no use
    assert wedged(two, 1) is two.build
    made = built((1, 15.0, 0.01), (6, 50.0, 0.01))
    assert wedged(made, 0) is made.build
    counts = [len(wedged(made, most).wall.wedges) for most in range(5)]
    assert all(count <= most for most, count in enumerate(counts))
    assert counts[4] > counts[1]


@pytest.mark.parametrize(
    ("places", "wedges", "stay"),
    [
        # The stone slides before it topples over its wide stem.
        (((2, 30.0, 0.01),), {2: [box(47, 0.01, 49.5, 3.0)]}, []),
        # Without its wedge the stone falls, whatever the wall beside it carries.
        (((5, 12.0, 0.01), (4, 50.0, 0.01)), {4: [LEANING]}, [65.0]),
        (((5, 12.0, 0.01), (4, 50.0, 0.01)), {4: [box(60, 0.01, 62, 8.0), LEANING]}, [65.0]),
        # The block on its other end keeps it from falling; but until it comes...
        (((4, 50.0, 0.01), (5, 40.5, 18.02)), {4: [LEANING]}, [65.0]),
    ],
)
def test_wedges_that_do_not_matter_are_dropped(places, wedges, stay):
    made = built(*places, wedges=wedges)
    after = wedged(made, 0)
    assert [float(corners[:, 0].min()) for corners in outlines_of(after)] == stay
    assert value(after) >= value(made.build) - 1e-6


def test_wedges_keep_clear_of_what_comes_later_and_do_not_rest_on_it():
    made = built((12, 30.0, 0.01), (3, 44.9, 0.01), wedges={12: [box(38.1, 0.01, 39.6, 5.0)]})
    places = all_places(
        made.build, replace(limits_of(made), greatest_height=20.0, greatest_area=99.0)
    )
    under = [p for p in places if p.step == 2]
    later = shapely.Polygon(made.build.wall.groups[3].placement.settled.corners)
    assert under
    for place in under:
        shape = shapely.Polygon(place.corners)
        assert shape.distance(later) >= 0.0049
        # Over the stone that comes later there is a gap 3 px high, which is not filled.
        assert place.corners[:, 1].min() == pytest.approx(0.01, abs=1e-5)


WALLS = small_walls()
GAINING = {0}


@pytest.mark.parametrize("wall", range(len(WALLS)))
def test_walls_that_are_wedged_up_are_true(wall):
    stones, made = WALLS[wall]
    before = made.build
    after = wedged(made, 3)
    check(made, after, stones)
    made.build = before
    assert value(after) >= value(before) - 1e-6
    if wall in GAINING:
        assert value(after) > value(before) + 0.03
    assert len(after.wall.wedges) <= len(before.wall.wedges) + 3
    for one, other in zip(before.wall.groups, after.wall.groups, strict=True):
        assert one.placement.settled is other.placement.settled
        assert one.placement.posed.angle_deg == other.placement.posed.angle_deg
    assert len(after.states()) == len(after.actions) + 1
    assert all(action.sturdy for action in after.actions)
    # As good as without the states, which are then made again.
    alone, _, _ = replayed(
        before.states()[0], before.wall.groups, {}, made.workshop, made.settings, keep=False
    )
    again, _ = wedged_up(alone, Yard.of(made), 3)
    assert value(again) == pytest.approx(value(after))


@pytest.mark.parametrize("wall", range(2))
def test_the_first_wedge_is_the_best_one(wall):
    """Of all with which all steps can be taken."""
    _, made = WALLS[wall]
    gained = [value(made.build)]
    for place in all_places(made.build, limits_of(made)):
        group, *rest = made.build.wall.groups[place.step :]
        wedge = Wedge(0, group.placement.stone_id, NOTHING, 0, 0, place.corners)
        with_it = Group(group.placement, (*group.wedges, wedge))
        start = made.build.states()[place.step]
        build, left_out, _ = replayed(start, [with_it, *rest], {}, made.workshop, made.settings)
        if not left_out:
            gained.append(value(build))
    after = wedged(made, 1)
    assert value(after) >= max(gained) - 1e-2
    if value(after) > gained[0] + 1e-6:
        assert len(after.wall.wedges) <= len(made.build.wall.wedges) + 1


def test_a_wall_of_pixels_is_refused():
    settings = greedy({"geometry": "raster"})
    made = Planner(STONES, SITE, settings=settings)
    with pytest.raises(ValueError, match="outlines"):
        wedged(made, 3)


def refusing(monkeypatch, refused):
    """Let some steps not be taken again."""

    def refuse(start, groups, *rest, **named):
        if refused(groups):
            return Replayed(start, (groups[0].placement.stone_id,), Solves(failed=1))
        return replayed(start, groups, *rest, **named)

    monkeypatch.setattr(yard, "replayed", refuse)


def test_other_wedges_are_found_when_the_best_is_barred(monkeypatch):
    made = built((6, 30.0, 0.01))
    best = wedged(made, 1)
    (outline,) = outlines_of(best)
    refusing(
        monkeypatch,
        lambda groups: any(
            wedge.corners is not None and wedge.corners.tobytes() == outline.tobytes()
            for group in groups
            for wedge in group.wedges
        ),
    )
    after = wedged(made, 1)
    assert value(after) == pytest.approx(value(best))
    assert [one.tobytes() == outline.tobytes() for one in outlines_of(after)] == [False]


def test_what_cannot_be_dropped_stays(monkeypatch):
    """Both wedges may go as the finished wall is, but not one after the other."""
    two = {2: [box(46.5, 0.01, 48, 3.0), box(48.2, 0.01, 49.7, 3.0)]}
    made = built((2, 30.0, 0.01), (5, 55.0, 0.01), wedges=two)
    assert wedged(made, 0).wall.wedges == ()
    refusing(
        monkeypatch, lambda groups: len(groups) == 2 and not any(group.wedges for group in groups)
    )
    after, solves = wedged_up(made.build, Yard.of(made), 0)
    assert [one.tolist() for one in outlines_of(after)] == [on_grid(two[2][1]).tolist()]
    assert solves.failed > 1  # what was refused is counted


def test_a_solver_that_gives_up_is_no_reason_to_stop(monkeypatch):
    made = built((1, 30.0, 0.01))
    monkeypatch.setattr(WedgeDraft, "motion", lambda *_: None)
    assert wedged(made, 3) is made.build
    monkeypatch.setattr(WedgeDraft, "resistance", gave_up())
    assert wedged(built((2, 30.0, 0.01), wedges={2: [box(47, 0.01, 49.5, 3.0)]}), 3).wall.wedges
