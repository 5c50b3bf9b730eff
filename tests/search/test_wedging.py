"""Wedges in the gaps of finished walls: they raise the resistance, and the plan stays true."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import shapely

from drystone import Planner, Site, lateral_resistance
from drystone.contacts.settled import PlacedPolygons, model_of_outlines, model_with_outlines
from drystone.generate import PolygonSettings, RubbleSettings, polygon_stones, rubble_stones
from drystone.kernels.polygons import on_grid
from drystone.model.placement import Wedge
from drystone.model.wall import Group, outlined
from drystone.planner.build import Solves
from drystone.planner.deadline import Deadline, TimeIsUp
from drystone.planner.replay import Replayed, replayed
from drystone.search import wedge_draft, yard
from drystone.search.wedge_draft import (
    MOST_UNDER_ONE,
    Motion,
    WedgeDraft,
    analysis_of,
    wedge_places,
)
from drystone.search.wedging import wedged_up
from drystone.search.yard import Yard
from drystone.statics.incremental import HighsAnalysis, SimplexAnalysis
from drystone.statics.model import GROUND
from tests.kernels.simplex_walls import needs_kernel
from tests.naive.wedging import NaiveMotion
from tests.planner import scenes
from tests.polygons import box
from tests.statics.walls import gave_up

LARGE = scenes.greedy(
    {
        "wedge": {"thickness": 0.04, "height": 0.5, "area": 0.3},
        "search": {"budget": 2},
        "settle": {"margin": 0.2, "trials": 0},
    }
)
"""With larger wedges than usual, of which small walls have some; places need not be sure."""


def all_places(build, limits):
    """Wedges under all stones that may get one more."""
    placed = PlacedPolygons(build.wall.exact.ids, build.wall.exact.polygons)
    width = build.wall.site.extent_px[0]
    found = []
    for step, group in enumerate(build.wall.groups):
        if len(group.wedges) < MOST_UNDER_ONE:
            first = placed.ids.index(group.placement.stone_id)
            found += wedge_places(placed, step, first, width, limits)
    return found


@cache
def small_walls():
    """Walls of stones about 20 px wide, most of which gain by wedges."""
    rubble = RubbleSettings(count=8, width_px=90, height_px=40, courses=2)
    plain, sharp = (
        PolygonSettings(count=8, width_px=28, height_px=18, noise=noise) for noise in (0.2, 0.4)
    )
    made = []
    for kind, seed, scale in ((sharp, 3, 0.5), (plain, 4, 0.5), (sharp, 8, 0.5), (rubble, 0, 1.0)):
        rng = np.random.default_rng(seed)
        generated = isinstance(kind, RubbleSettings)
        stones = rubble_stones(kind, rng) if generated else polygon_stones(kind, rng)
        site = Site.from_source(90.0, 48.0, scale)
        made.append((stones, scenes.finish(Planner(stones, site, seed=seed, settings=LARGE))))
    return tuple(made)


WALLS = pytest.mark.parametrize("wall", range(4))
OPEN_WALLS = pytest.mark.parametrize("wall", range(2))
"""Those in which wedges have room."""


def drafted(wall):
    """A finished wall, its draft, and the number of its next wedge."""
    made = small_walls()[wall][1]
    draft = WedgeDraft.of(made.build, made.workshop.limits)
    return made, draft, made.workshop.next_wedge(made.build)


def all_move(draft):
    blocks = draft.analysis.model.blocks
    centroids = {block.id: block.centroid for block in blocks}
    return Motion.of({block.id: (1.0, 0.0, 0.0) for block in blocks}, centroids, 0.58)


@OPEN_WALLS
def test_a_wedge_is_added_in_the_order_of_construction(wall):
    made, draft, number = drafted(wall)
    draft = draft.looked_at(all_move(draft))
    places = list(draft.places())
    assert [p.corners.tolist() for p in places] == [
        p.corners.tolist() for p in all_places(made.build, draft.limits)
    ]
    for place in (places[len(places) // 2], places[-1], places[0]):
        model = draft.model_with(number, place)
        after = draft.wedged(number, place, model)
        at = after.placed.ids.index(number)
        group = made.build.wall.groups[place.step]
        before = [block for block, _ in outlined(group.placement, group.wedges)]
        assert after.placed.ids[at - len(before) : at] == tuple(before)
        assert after.placed.polygons.polygon(at).tolist() == place.corners.tolist()
        assert after.added == ((number, place),)
        touching = draft.limits.contact_px, draft.limits.setback
        blocks = [(i, after.placed.polygons.polygon(k)) for k, i in enumerate(after.placed.ids)]
        whole = lateral_resistance(model_of_outlines(blocks, 0.58, *touching))
        assert after.resistance.value == pytest.approx(whole.value, abs=1e-7)
        for direction in ("left", "right"):
            side = getattr(after.resistance, direction)
            assert draft.value_with(model, direction) == side.alpha / 0.58


@OPEN_WALLS
def test_places_are_looked_for_again_only_where_a_wedge_is_new(wall):
    _, draft, number = drafted(wall)
    draft = draft.looked_at(all_move(draft))
    for place in draft.places():
        after = draft.wedged(number, place, draft.model_with(number, place))
        fresh = replace(after, known=(None,) * len(after.known)).looked_at(all_move(after))
        again = after.looked_at(all_move(after))
        assert any(known is None for known in after.known)
        for one, other in zip(again.places(), fresh.places(), strict=True):
            assert one.step == other.step
            for name in ("corners", "others", "points"):
                assert getattr(one, name).tolist() == getattr(other, name).tolist()


@OPEN_WALLS
def test_nothing_is_looked_for_where_nothing_moves(wall):
    _, draft, _ = drafted(wall)
    still = replace(all_move(draft), twists=dict.fromkeys([0, *draft.placed.ids], (0.0, 0.0, 0.0)))
    assert list(draft.looked_at(still).places()) == []
    for moving in ((0.0, 0.0, -1.0), (0.0, -1e-6, 0.0), (1.0, 0.0, 0.0)):
        motion = Motion.of({1: moving}, {1: (2.0, 2.0), 2: (4.0, 2.0)}, 0.5)
        assert (motion.stands_still([GROUND, 2]), motion.stands_still([GROUND, 1])) == (True, False)


@WALLS
def test_an_idle_wedge_is_none(wall):
    made, begun, number = drafted(wall)
    for place in all_places(made.build, begun.limits)[::5]:
        draft = begun.wedged(number, place, begun.model_with(number, place))
        model = draft.idle(number)
        after = draft.analysis.resistance_with(model).resistance
        assert after.value == pytest.approx(begun.resistance.value, abs=1e-9)
        assert draft.without(model).resistance.value == after.value
    for k, wedge in enumerate(made.build.wall.wedges):
        others = [block for block in made.build.wall.outlines.blocks if block[0] != wedge.id]
        without = lateral_resistance(model_of_outlines(others)).value
        idle = begun.analysis.resistance_with(begun.idle(wedge.id)).resistance.value
        assert (idle or 0.0) == pytest.approx(without or 0.0, abs=1e-7), k


@needs_kernel
@OPEN_WALLS
def test_other_solvers_say_the_same(wall):
    made, draft, number = drafted(wall)
    assert isinstance(draft.analysis, SimplexAnalysis)
    units = draft.analysis.program.units
    other = replace(draft, analysis=HighsAnalysis.of(draft.analysis.model, units))
    for direction in ("left", "right"):
        motions = draft.motion(direction), other.motion(direction)
        largest = [max(np.hypot(x, y) for x, y, _ in m.twists.values()) for m in motions]
        assert min(largest) > 0.1
        for place in all_places(made.build, draft.limits)[::9]:
            values = [d.value_with(d.model_with(number, place), direction) for d in (draft, other)]
            assert values[0] == pytest.approx(values[1], abs=1e-7)


@WALLS
def test_a_mechanism_fails_under_the_load_that_the_wall_carries(wall):
    _, draft, _ = drafted(wall)
    blocks = draft.analysis.model.blocks
    for direction, sign in (("left", -1.0), ("right", 1.0)):
        motion = draft.motion(direction)
        pushed = raised = 0.0
        for block in blocks:
            along, up, turning = motion.twists[block.id]
            x, y = block.centroid
            pushed += sign * block.weight * (along - turning * y)
            raised += block.weight * (up + turning * x)
        assert raised == pytest.approx(getattr(draft.resistance, direction).alpha * pushed)
        assert pushed > 0.0


@needs_kernel
@WALLS
def test_walls_of_many_blocks_are_analysed_by_the_kernel(wall, monkeypatch):
    """From the last state that the kernel has, on."""
    build = small_walls()[wall][1].build
    states = build.states()
    few = states[3]
    assert isinstance(few.analysis, SimplexAnalysis)
    limited = replace(few.analysis, most=len(few.model.blocks))
    monkeypatch.setitem(few.__dict__, "analysis", limited)
    for after in states[4:]:
        large = HighsAnalysis.of(after.model, limited.program.units)
        monkeypatch.setitem(after.__dict__, "analysis", large)
    again = analysis_of(build)
    assert isinstance(again, SimplexAnalysis)
    assert again.most == wedge_draft.MOST_BLOCKS
    assert again.result.resistance.value == pytest.approx(build.actions[-1].resistance.value)


def test_what_the_mechanism_does_not_violate_does_not_help():
    seen = {True: 0, False: 0}
    for _, made in small_walls():
        wall, model = made.build.wall, made.build.model
        both = lateral_resistance(model, mechanism=True)
        one = both.left if both.left.alpha <= both.right.alpha else both.right
        told = zip(one.mechanism.block_ids, one.mechanism.velocity.tolist(), strict=True)
        centroids = {block.id: block.centroid for block in model.blocks}
        motion = Motion.of(dict(told), centroids, model.mu)
        assert motion.resisted_by([]).tolist() == []
        lax = replace(made.workshop.limits, least_thickness=0.1, greatest_height=12.0, mu=3.0)
        places = all_places(made.build, lax)
        naive = NaiveMotion(model, one.mechanism)
        for place, rate in zip(places, motion.resisted_by(places).tolist(), strict=True):
            new, near_px = [(999, place.corners)], made.workshop.limits.contact_px
            model = model_with_outlines(made.build.model, new, wall.exact, near_px)
            assert rate == pytest.approx(naive.resisted_by(model.added.interfaces), abs=1e-9)
            violated = rate > 1e-9
            # The weight of the wedge is another thing: here it has none.
            weightless = replace(model.blocks[-1], density=1e-9)
            after = lateral_resistance(replace(model, blocks=(*model.blocks[:-1], weightless)))
            alpha = after.left.alpha if one.direction == "left" else after.right.alpha
            assert violated or alpha <= one.alpha + 1e-6
            seen[violated] += 1
    assert min(seen.values()) > 3


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


STONES = scenes.stones_of_masks(
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
    """A wall of stones between blocks at its ends: id, left and lower end of each, wedges."""
    made, groups = planner(), []
    for stone_id, left, low in (*ENDS, *places):
        placement = scenes.settled_at(made.build.wall, STONES.by_id(stone_id), (left, low))
        own = (wedges or {}).get(stone_id, [])
        under = tuple(Wedge(0, stone_id, NOTHING, 0, 0, on_grid(corners)) for corners in own)
        groups.append(Group(placement, under))
    made.build, left_out, _ = replayed(made.build, groups, {}, made.workshop, made.settings)
    assert left_out == ()
    return made


def outlines_of(build):
    return [wedge.corners for wedge in build.wall.wedges]


def value(build):
    return build.actions[-1].resistance.value


def check(made, build, stones):
    """See that the plan of a wall, written and read again, is true, and that stones keep apart."""
    made.build = build
    assert scenes.proven(scenes.result_of(made), stones).overlap_depth == 0.0
    scenes.kept_apart(build.wall, made.settings.settle.clearance_px)


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
    made, clock = built((1, 30.0, 0.01)), scenes.Ticks()
    after, _ = wedged_up(made.build, Yard.of(made, Deadline(math.inf, clock)), 2)
    assert len(after.wall.wedges) == 2
    assert clock.count > 8
    for looks in range(clock.count):
        with pytest.raises(TimeIsUp):
            wedged_up(made.build, Yard.of(made, scenes.after_looks(looks)), 2)
    assert made.build.wall.wedges == ()


def test_a_wedge_with_nothing_beside_it_is_none():
    """At its other side is the stem of the stone."""
    left, right, stone = built((1, 30.0, 0.01)).build.wall.groups
    for beside, sides in (([], set()), ([left], {False}), ([right], {True})):
        made = planner()
        steps = [*beside, stone]
        made.build, _, _ = replayed(made.build, steps, {}, made.workshop, made.settings)
        places = all_places(made.build, made.workshop.limits)
        assert {bool(place.corners[0, 0] > 40.0) for place in places} == sides
        assert sides or wedged(made, 2) is made.build


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
        made.build, replace(made.workshop.limits, greatest_height=20.0, greatest_area=99.0)
    )
    under = [p for p in places if p.step == 2]
    later = shapely.Polygon(made.build.wall.groups[3].placement.settled.corners)
    assert under
    for place in under:
        shape = shapely.Polygon(place.corners)
        assert shape.distance(later) >= 0.0049
        # Over the stone that comes later there is a gap 3 px high, which is not filled.
        assert place.corners[:, 1].min() == pytest.approx(0.01, abs=1e-5)


@WALLS
def test_walls_that_are_wedged_up_are_true(wall):
    stones, made = small_walls()[wall]
    before = made.build
    after = wedged(made, 3)
    check(made, after, stones)
    made.build = before
    assert value(after) >= value(before) - 1e-6
    if wall == 0:
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


@OPEN_WALLS
def test_the_first_wedge_is_the_best_one(wall):
    """Of all with which all steps can be taken."""
    _, made = small_walls()[wall]
    gained = [value(made.build)]
    for place in all_places(made.build, made.workshop.limits):
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


def refusing(monkeypatch, refused):
    """Let some steps not be taken again."""

    def refuse(start, groups, *rest, **named):
        if refused(groups):
            return Replayed(start, (groups[0].placement.stone_id,), Solves(failed=1))
        return replayed(start, groups, *rest, **named)

    monkeypatch.setattr(yard, "replayed", refuse)


def test_of_wedges_that_do_as_much_the_smallest_is_cut_and_another_when_it_is_barred(monkeypatch):
    """The stone then slides before it topples over a wedge anywhere under its end."""
    made = built((6, 30.0, 0.01))
    best = wedged(made, 1)
    assert value(best) == pytest.approx(1.0)
    (outline,) = outlines_of(best)
    assert np.ptp(outline[:, 0]) == pytest.approx(1.25 * 2.99, abs=1e-5)
    barred = outline.tobytes()
    refusing(
        monkeypatch,
        lambda groups: any(w.corners.tobytes() == barred for g in groups for w in g.wedges),
    )
    after = wedged(made, 1)
    assert value(after) == pytest.approx(value(best))
    assert [one.tobytes() == barred for one in outlines_of(after)] == [False]


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
