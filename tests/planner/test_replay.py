"""Steps taken again are those that were taken, wherever they still stand."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from drystone.kernels.polygons import on_grid
from drystone.model.outlines import Outlines
from drystone.model.placement import Placement, Settled, Wedge
from drystone.model.site import Site
from drystone.model.wall import Group
from drystone.planner.evaluate import Evaluator
from drystone.planner.planner import Planner
from drystone.planner.replay import judged, replayed
from drystone.settle.placing import settled_placement
from drystone.settle.rest import placed_outline
from tests.planner import scenes

EXACT = scenes.greedy(scenes.WITH_WEDGES)
PLAIN = pytest.mark.parametrize(
    "settings", [scenes.greedy(), scenes.greedy({"geometry": "raster"})], ids=["exact", "raster"]
)


def wedged_wall():
    """A wall with wedges, and all states on the way."""
    settings = EXACT.updated({"search": {"budget": 2}})
    site = Site.from_source(84.0, 34.0, 0.5)
    return scenes.finish(Planner(scenes.few_stones(), site, seed=3, settings=settings))


def figures(build):
    """What was placed in each action, in which pixels, and what was found of it."""
    told = []
    for action in build.actions:
        placement, wedges = action.stabilised.placement, action.stabilised.wedges
        told.append(
            (
                placement.stone_id, placement.row, placement.col, placement.posed.mask.tobytes(),
                placement.side, placement.rotation_moves, placement.settled is None,
                tuple((w.id, w.under, w.row, w.col, w.mask.tobytes()) for w in wedges),
                action.indices, action.course_height_px,
                (action.resistance.left.alpha, action.resistance.right.alpha),
                action.sturdy, action.sturdy_model is None,
            )
        )  # fmt: skip
    return told


@pytest.mark.parametrize("kept", [0, 2])
def test_what_is_taken_down_is_built_again_as_it_was(kept):
    planner = wedged_wall()
    build = planner.build
    states = build.states()
    assert sum(len(g.wedges) for g in build.wall.groups[kept:]) > 0
    # Wedges are numbered in the order in which they come now, whatever they were.
    groups = [
        replace(g, wedges=tuple(replace(w, id=w.id + 100) for w in g.wedges))
        for g in build.wall.groups[kept:]
    ]
    again, left_out, _ = replayed(
        states[kept], groups, build.course_heights_px(), planner.workshop, planner.settings
    )
    assert left_out == ()
    assert figures(again) == figures(build)
    assert again.wall.labels.tobytes() == build.wall.labels.tobytes()
    assert [i.points.tobytes() for i in again.model.interfaces] == [
        i.points.tobytes() for i in build.model.interfaces
    ]
    assert all(one is other.before for one, other in pairwise(again.states()))
    assert again.states()[: kept + 1] == states[: kept + 1]


@PLAIN
def test_turned_stones_of_both_sides_are_built_again_as_they_were(settings):
    planner = scenes.of_rubble(settings, seed=1)
    build, start = planner.build, scenes.of_rubble(settings, 0).build
    assert {action.side for action in build.actions} == {"left", "right"}
    assert any(p.rotation_moves for p in build.wall.placements)
    again, left_out, _ = replayed(
        start, build.wall.groups, build.course_heights_px(), planner.workshop, planner.settings
    )
    assert left_out == ()
    assert figures(again) == figures(build)


STONES = scenes.blocks({1: (20, 10), 2: (20, 10), 3: (20, 10), 4: (20, 10)})


def laid(planner, stone_id, left, level):
    """A block with its left end at some x, on a level of the wall, alone in it."""
    stone, site = STONES.by_id(stone_id), planner.workshop.site
    if planner.settings.geometry == "raster":
        posed = planner.workshop.book.pose(stone, 0.0)
        return Group(Placement(posed, site.height_px - 10 * int(level) - 10, int(left)))
    x, y = left + 10.0, 5.0 + 10.01 * level + 0.01
    corners = placed_outline(planner.workshop.outlines.outline(stone), 0.0, x, y)
    outlines = Outlines.empty(site)
    placement = settled_placement(outlines, site, stone, 0.0, Settled(x, y, corners), "left", 0)
    return Group(placement)


def scene(settings):
    """Blocks on the ground, on each other, over each other, and in the air."""
    planner = Planner(STONES, Site(80, 40), settings=settings)
    return planner, {
        "ground": laid(planner, 1, 5, 0),
        "upon": laid(planner, 2, 9, 1),
        "over": laid(planner, 2, 20, 0),
        "far out": laid(planner, 2, 17, 1),
        "top": laid(planner, 3, 9, 2),
        "beside": laid(planner, 4, 35, 0),
    }


@PLAIN
@pytest.mark.parametrize(
    ("steps", "kept", "out"),
    [
        (["ground", "upon", "top", "beside"], [1, 2, 3, 4], ()),
        (["upon", "ground", "beside"], [1, 4], (2,)),  # nothing is below yet
        (["ground", "top", "upon", "beside"], [1, 2, 4], (3,)),
        (["ground", "over", "beside"], [1, 4], (2,)),  # lies in the first
        (["ground", "far out", "beside"], [1, 4], (2,)),  # falls
    ],
)
def test_what_cannot_stand_is_left_out(settings, steps, kept, out):
    planner, groups = scene(settings)
    chosen = [groups[name] for name in steps]
    build, left_out, _ = replayed(
        planner.build, chosen, {}, planner.workshop, planner.settings, strict=False
    )
    assert [action.stone_id for action in build.actions] == kept
    assert left_out == out
    strict, rest, _ = replayed(planner.build, chosen, {}, planner.workshop, planner.settings)
    ids = [group.placement.stone_id for group in chosen]
    first = ids.index(out[0]) if out else len(ids)
    assert [action.stone_id for action in strict.actions] == ids[:first]
    assert rest == tuple(ids[first:])


@PLAIN
def test_wedges_must_have_room_as_well(settings):
    planner, groups = scene(settings)
    placement = groups["beside"].placement
    for left, room in ((56, True), (21, False)):
        corners = np.array([[left, 0.01], [left + 2.0, 0.01], [left + 2.0, 2.0], [left, 2.0]])
        wedge = Wedge(
            9, 4, np.ones((2, 2), bool), 38, left,
            None if settings.geometry == "raster" else corners,
        )  # fmt: skip
        steps = [groups["ground"], Group(placement, (wedge,))]
        build, left_out, _ = replayed(planner.build, steps, {}, planner.workshop, planner.settings)
        assert left_out == (() if room else (4,))
        assert [w.id for w in build.wall.wedges] == ([5] if room else [])


def test_a_wedge_that_nothing_would_be_beside_is_not_taken_again():
    """The second block reaches over the end of the first, up to the end of the wall or not."""
    corners = np.array([[25.01, 0.01], [29.0, 0.01], [29.0, 10.01], [25.01, 10.01]])
    wedge = Wedge(9, 2, np.ones((10, 4), bool), 30, 25, on_grid(corners))
    for width, beside, room in ((80, False, True), (38, True, True), (38, False, False)):
        planner = Planner(STONES, Site(width, 40), settings=scenes.greedy())
        steps = [laid(planner, 1, 5, 0), Group(laid(planner, 2, 10, 1).placement, (wedge,))]
        steps[1:1] = [laid(planner, 3, width - 8.0, 0)] if beside else []
        _, left_out, _ = replayed(planner.build, steps, {}, planner.workshop, planner.settings)
        assert left_out == (() if room else (2,))


def test_what_needs_the_friction_of_upright_faces_is_left_out():
    planner, _ = scene(scenes.greedy())
    steps = [laid(planner, 1, 0.0, 0), laid(planner, 2, 40.02, 0), laid(planner, 3, 20.01, 0.4)]
    evaluator = Evaluator(planner.settings, planner.workshop.stock)
    piers, left_out, _ = replayed(planner.build, steps, {}, planner.workshop, planner.settings)
    assert left_out == (3,)
    assert judged(piers, steps[2], {}, evaluator).resistance.stable


def test_pixels_are_those_that_a_stone_fills_now():
    """Of a pixel that two stones share the one that comes second makes it more than half full."""
    planner = Planner(STONES, Site.from_source(60, 40, 0.1), settings=scenes.greedy())
    one, other = laid(planner, 1, 4, 0), laid(planner, 2, 26, 0)
    first, _, _ = replayed(planner.build, [one, other], {}, planner.workshop, planner.settings)
    second, _, _ = replayed(planner.build, [other, one], {}, planner.workshop, planner.settings)
    for build in (first, second):
        filled = sum(p.posed.area_px for p in build.wall.placements)
        assert filled == np.count_nonzero(build.wall.labels)
    areas = [{p.stone_id: p.posed.area_px for p in b.wall.placements} for b in (first, second)]
    assert areas[0] != areas[1]
    # What fills no pixel is left out.
    small = Planner(STONES, Site.from_source(60, 40, 0.02), settings=scenes.greedy())
    build, left_out, _ = replayed(small.build, [one], {}, small.workshop, small.settings)
    assert (build, left_out) == (small.build, (1,))


@PLAIN
def test_a_course_is_begun_with_the_height_it_was_begun_with(settings):
    planner, groups = scene(settings)
    steps = [groups["ground"], groups["upon"]]
    build, _, _ = replayed(planner.build, steps, {1: 8.0}, planner.workshop, planner.settings)
    assert [a.course_height_px for a in build.actions] == [8.0, None]
    assert build.actions[0].indices.NHR == pytest.approx(0.2)
