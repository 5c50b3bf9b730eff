"""Drafts of walls with wedges carry what the walls would carry."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.contacts.settled import PlacedPolygons, model_of_outlines, model_with_outlines
from drystone.model.wall import outlined
from drystone.search import wedge_draft
from drystone.search.wedge_draft import Motion, WedgeDraft, analysis_of
from drystone.statics.incremental import HighsAnalysis, SimplexAnalysis
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND
from tests.kernels.simplex_walls import needs_kernel
from tests.naive.wedging import NaiveMotion
from tests.search.wedge_walls import all_places, limits_of, small_walls

WALLS = pytest.mark.parametrize("wall", range(4))
OPEN_WALLS = pytest.mark.parametrize("wall", range(2))
"""Those in which wedges have room."""


def drafted(wall):
    made = small_walls()[wall][1]
    return made, WedgeDraft.of(made.build, limits_of(made))


def whole(draft):
    """What the blocks of a draft carry, solved from the start."""
    return lateral_resistance(model_of_outlines(draft.placed)).value


def all_move(draft):
    blocks = draft.analysis.model.blocks
    centroids = {block.id: block.centroid for block in blocks}
    return Motion.of({block.id: (1.0, 0.0, 0.0) for block in blocks}, centroids, 0.58)


@OPEN_WALLS
def test_a_wedge_is_added_in_the_order_of_construction(wall):
    made, draft = drafted(wall)
    draft = draft.looked_at(all_move(draft))
    places = list(draft.places())
    assert [p.corners.tolist() for p in places] == [
        p.corners.tolist() for p in all_places(made.build, draft.limits)
    ]
    number = made.workshop.next_wedge(made.build)
    for place in (places[len(places) // 2], places[-1], places[0]):
        model = draft.model_with(number, place)
        after = draft.wedged(number, place, model)
        at = after.placed.ids.index(number)
        group = made.build.wall.groups[place.step]
        before = [block for block, _ in outlined(group.placement, group.wedges)]
        assert after.placed.ids[at - len(before) : at] == tuple(before)
        assert after.placed.polygons.polygon(at).tolist() == place.corners.tolist()
        assert after.added == ((number, place),)
        assert after.resistance.value == pytest.approx(whole(after), abs=1e-7)
        for direction in ("left", "right"):
            side = after.resistance.left if direction == "left" else after.resistance.right
            assert draft.alpha_with(model, direction) == side.alpha


@OPEN_WALLS
def test_places_are_looked_for_again_only_where_a_wedge_is_new(wall):
    made, draft = drafted(wall)
    draft = draft.looked_at(all_move(draft))
    number = made.workshop.next_wedge(made.build)
    for place in draft.places():
        after = draft.wedged(number, place, draft.model_with(number, place))
        fresh = replace(after, known=(None,) * len(after.known)).looked_at(all_move(after))
        again = after.looked_at(all_move(after))
        assert any(known is None for known in after.known)
        for one, other in zip(again.places(), fresh.places(), strict=True):
            assert one.step == other.step
            assert one.corners.tolist() == other.corners.tolist()
            assert one.others.tolist() == other.others.tolist()
            assert one.points.tolist() == other.points.tolist()


@OPEN_WALLS
def test_nothing_is_looked_for_where_nothing_moves(wall):
    _, draft = drafted(wall)
    still = replace(all_move(draft), twists=dict.fromkeys([0, *draft.placed.ids], (0.0, 0.0, 0.0)))
    assert list(draft.looked_at(still).places()) == []


@WALLS
def test_an_idle_wedge_is_none(wall):
    made, begun = drafted(wall)
    number = made.workshop.next_wedge(made.build)
    for place in all_places(made.build, begun.limits)[::5]:
        draft = begun.wedged(number, place, begun.model_with(number, place))
        model = draft.idle(number)
        after = draft.analysis.resistance_with(model).resistance
        assert after.value == pytest.approx(begun.resistance.value, abs=1e-9)
        assert draft.without(model).resistance.value == after.value
    for k, wedge in enumerate(made.build.wall.wedges):
        others = [block for block in made.build.wall.outlines.blocks if block[0] != wedge.id]
        without = lateral_resistance(model_of_outlines(PlacedPolygons.of(others))).value
        idle = begun.analysis.resistance_with(begun.idle(wedge.id)).resistance.value
        assert (idle or 0.0) == pytest.approx(without or 0.0, abs=1e-7), k


@needs_kernel
@OPEN_WALLS
def test_other_solvers_say_the_same(wall):
    made, draft = drafted(wall)
    assert isinstance(draft.analysis, SimplexAnalysis)
    units = draft.analysis.program.units
    other = replace(draft, analysis=HighsAnalysis.of(draft.analysis.model, units))
    number = made.workshop.next_wedge(made.build)
    directions = ("left", "right")
    for direction in directions:
        one, two = draft.motion(direction), other.motion(direction)
        assert one is not None
        assert two is not None
        largest = [max(np.hypot(x, y) for x, y, _ in m.twists.values()) for m in (one, two)]
        assert min(largest) > 0.1
        for place in all_places(made.build, draft.limits)[::9]:
            alphas = [d.alpha_with(d.model_with(number, place), direction) for d in (draft, other)]
            assert alphas[0] == pytest.approx(alphas[1], abs=1e-7)


@WALLS
def test_a_mechanism_fails_under_the_load_that_the_wall_carries(wall):
    _, draft = drafted(wall)
    blocks = draft.analysis.model.blocks
    for direction, sign in (("left", -1.0), ("right", 1.0)):
        motion = draft.motion(direction)
        pushed = raised = 0.0
        for block in blocks:
            along, up, turning = motion.twists[block.id]
            x, y = block.centroid
            pushed += sign * block.weight * (along - turning * y)
            raised += block.weight * (up + turning * x)
        side = draft.resistance.left if direction == "left" else draft.resistance.right
        assert raised == pytest.approx(side.alpha * pushed)
        assert pushed > 0.0


@needs_kernel
@WALLS
def test_walls_of_many_blocks_are_analysed_by_the_kernel(wall, monkeypatch):
    """From the last state that the kernel has, on."""
    made = small_walls()[wall][1]
    build = made.build
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
        lax = replace(limits_of(made), least_thickness=0.1, greatest_height=12.0, mu=3.0)
        places = all_places(made.build, lax)
        naive = NaiveMotion(model, one.mechanism)
        for place, rate in zip(places, motion.resisted_by(places).tolist(), strict=True):
            new, near_px = [(999, place.corners)], limits_of(made).contact_px
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


@pytest.mark.parametrize("moving", [(0.0, 0.0, -1.0), (0.0, -1e-6, 0.0), (1.0, 0.0, 0.0)])
def test_blocks_stand_still_that_do_not_move(moving):
    motion = Motion.of({1: moving}, {1: (2.0, 2.0), 2: (4.0, 2.0)}, 0.5)
    assert motion.stands_still([GROUND, 2])
    assert not motion.stands_still([GROUND, 1])
