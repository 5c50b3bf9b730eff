"""Drafts of walls with wedges carry what the walls would carry."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.contacts.settled import PlacedPolygons, model_of_outlines
from drystone.model.wall import outlined
from drystone.planner.planner import Planner
from drystone.search import wedge_draft
from drystone.search.wedge_draft import Draft, analysis_of
from drystone.search.wedge_places import Motion
from drystone.statics.incremental import HighsAnalysis, SimplexAnalysis
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import Direction
from tests.kernels.simplex_walls import needs_kernel
from tests.search.wedge_walls import all_places, limits_of, small_walls

WALLS = pytest.mark.parametrize("wall", range(4))
OPEN_WALLS = pytest.mark.parametrize("wall", range(2))
"""Those in which wedges have room."""


def drafted(wall: int) -> tuple[Planner, Draft]:
    made = small_walls()[wall][1]
    return made, Draft.of(made.build, limits_of(made))


def whole(draft: Draft) -> float | None:
    """What the blocks of a draft carry, solved from the start."""
    return lateral_resistance(model_of_outlines(draft.placed)).value


def all_move(draft: Draft) -> Motion:
    blocks = draft.analysis.model.blocks
    centroids = {block.id: block.centroid for block in blocks}
    return Motion.of({block.id: (1.0, 0.0, 0.0) for block in blocks}, centroids, 0.58)


@OPEN_WALLS
def test_a_wedge_is_added_in_the_order_of_construction(wall: int) -> None:
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
            assert draft.alpha_with(model, direction) == side.alpha  # type: ignore[arg-type]


@OPEN_WALLS
def test_places_are_looked_for_again_only_where_a_wedge_is_new(wall: int) -> None:
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
def test_nothing_is_looked_for_where_nothing_moves(wall: int) -> None:
    _, draft = drafted(wall)
    still = replace(all_move(draft), twists=dict.fromkeys([0, *draft.placed.ids], (0.0, 0.0, 0.0)))
    assert list(draft.looked_at(still).places()) == []


@WALLS
def test_an_idle_wedge_is_none(wall: int) -> None:
    made, begun = drafted(wall)
    number = made.workshop.next_wedge(made.build)
    for place in all_places(made.build, begun.limits)[::5]:
        draft = begun.wedged(number, place, begun.model_with(number, place))
        model = draft.idle(number)
        after = draft.analysis.resistance_with(model).resistance
        assert after.value == pytest.approx(begun.resistance.value, abs=1e-9)
        assert draft.without(model).resistance.value == after.value
    for k, wedge in enumerate(made.build.wall.wedges):
        others = [block for block in made.build.wall.outlines.blocks if block[0] != wedge.id]  # type: ignore[union-attr]
        without = lateral_resistance(model_of_outlines(PlacedPolygons.of(others))).value
        idle = begun.analysis.resistance_with(begun.idle(wedge.id)).resistance.value
        assert (idle or 0.0) == pytest.approx(without or 0.0, abs=1e-7), k


@needs_kernel
@OPEN_WALLS
def test_other_solvers_say_the_same(wall: int) -> None:
    made, draft = drafted(wall)
    assert isinstance(draft.analysis, SimplexAnalysis)
    units = draft.analysis.program.units
    other = replace(draft, analysis=HighsAnalysis.of(draft.analysis.model, units))
    number = made.workshop.next_wedge(made.build)
    directions: tuple[Direction, Direction] = ("left", "right")
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
def test_a_mechanism_fails_under_the_load_that_the_wall_carries(wall: int) -> None:
    _, draft = drafted(wall)
    blocks = draft.analysis.model.blocks
    for direction, sign in (("left", -1.0), ("right", 1.0)):
        motion = draft.motion(direction)  # type: ignore[arg-type]
        assert motion is not None
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
def test_walls_of_many_blocks_are_analysed_by_the_kernel(
    wall: int, monkeypatch: pytest.MonkeyPatch
) -> None:
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
