"""Small stone sets and planners."""

import json
from itertools import combinations, islice

import numpy as np
import pytest
import shapely

from drystone import Planner, Site, Stone, StoneSet, generate, method_settings
from drystone.io.plan_json import plan_from_json, plan_to_json
from drystone.kernels.polygons import on_grid, turn
from drystone.model.stone import Source
from drystone.model.wall import outlined
from drystone.planner.deadline import Deadline
from drystone.planner.events import Stopped
from drystone.search.plan_result import finish as finished
from drystone.settle import rest
from drystone.settle.placing import settled_placement
from drystone.settle.settings import SettleSettings
from drystone.verify.check import check_plan

RUBBLE_SITE = Site(100, 36)
"""What :func:`rubble` is for."""

ROUNDED = generate.fourier_stones(
    generate.FourierSettings(count=16, smallest_radius_px=9, largest_radius_px=36, D2=0.15),
    np.random.default_rng(2),
)
ROUNDED_SITE = Site.from_source(330, 130, 0.5)
"""Rounded stones, large and small, of which some fall where no trial is made of their places."""

WITH_WEDGES = {
    "selection_rule": "algorithm2",
    "stabilise": {"method": "wedge", "min_wedge_px": 1, "margin": 0.3, "max_wedge_height": 0.9},
    "wedge": {"thickness": 0.02, "thickness_mm": 1.0, "height": 0.9, "area": 0.9},
    "two_sided": False,
}
"""Changes with which many stones stand on wedges, of any size, on pixels and on outlines."""


def rubble(seed=0, count=8):
    """Rubble of two courses."""
    settings = generate.RubbleSettings(count=count, width_px=100, height_px=36, courses=2)
    return generate.rubble_stones(settings, np.random.default_rng(seed))


def few_stones():
    """Some of these get wedges with :data:`WITH_WEDGES`."""
    size = generate.RubbleSettings(count=5, width_px=90, height_px=30, courses=2)
    return generate.rubble_stones(size, np.random.default_rng(4))


def bricks(count=6, halves=0):
    """Bricks of 20 x 10 px."""
    settings = generate.BrickSettings(count=count, height_px=10, aspect=2, halves=halves)
    return generate.brick_stones(settings, np.random.default_rng(0))


def stones_of_masks(masks):
    """Stones with given ids, side by side in a source image."""
    stones, left = [], 1
    for stone_id, mask in masks.items():
        stones.append(Stone(stone_id, mask, left_px=left, bottom_px=2))
        left += mask.shape[1] + 2
    return StoneSet(tuple(stones), Source("stones.png", "ab" * 32, left, 60))


def blocks(sizes):
    """Rectangular stones: id to (width, height)."""
    return stones_of_masks({i: np.ones((h, w), bool) for i, (w, h) in sizes.items()})


def settled_at(wall, stone, corner, angle_deg=0.0, side="left"):
    """Place a stone in a wall of outlines, the bottom-left corner of its box at a place."""
    outline = stone.outline_within(SettleSettings().outline_px)
    x, y = on_grid(np.array(corner) - turn(outline, angle_deg).min(axis=0)).tolist()
    settled = rest.settled_at(outline, angle_deg, x, y)
    return settled_placement(wall.exact, wall.site, stone, angle_deg, settled, side, 0)


def greedy(changes=None):
    """The default method without a search."""
    return method_settings("best").updated({"search": {"budget": 1}, **(changes or {})})


RASTER = greedy({"geometry": "raster"})
GEOMETRIES = pytest.mark.parametrize("settings", [greedy(), RASTER], ids=["exact", "raster"])
RULES = pytest.mark.parametrize("rule", ["score", "algorithm2"])


def watched(monkeypatch, owner, name):
    """Keep the arguments and the results of all calls of a method from now on."""
    calls, plain = [], getattr(owner, name)

    def spied(*arguments, **named):
        calls.append((arguments, plain(*arguments, **named)))
        return calls[-1][1]

    monkeypatch.setattr(owner, name, spied)
    return calls


def ids(planner):
    """The stones in the order of placement."""
    return [action.stone_id for action in planner.build.actions]


def order(planner):
    """Stone, angle, row, column and side of every action."""
    placements = [action.stabilised.placement for action in planner.build.actions]
    return [(p.stone_id, p.posed.angle_deg, p.row, p.col, p.side) for p in placements]


class Ticks:
    """A clock that goes on by one whenever it is looked at."""

    def __init__(self):
        self.count = 0

    def __call__(self):
        self.count += 1
        return float(self.count)


def after_looks(count):
    """A time limit that has not struck yet when it is looked at so many times."""
    return Deadline(float(count), Ticks())


def finish(planner, steps=None):
    """Take all steps, or so many."""
    for _ in islice(planner.steps(), steps):
        pass
    return planner


def careless(seed, site=ROUNDED_SITE):
    """A planner that has laid rounded stones without trials: in rehearsals some of them fall."""
    settings = greedy({"search": {"budget": 2}, "settle": {"trials": 0}})
    return finish(Planner(ROUNDED, site, seed=seed, settings=settings))


def of_rubble(settings=None, steps=None, *, seed=0, **more):
    """A planner of :func:`rubble` that has taken all its steps, or so many."""
    return finish(Planner(rubble(), RUBBLE_SITE, seed=seed, settings=settings, **more), steps)


def result_of(planner):
    """The result with what a planner has built, whatever for."""
    provenance = {"version": "0", "method": "custom", "seed": 1}
    provenance["settings"] = planner.settings.as_dict()
    stopped = planner.stopped or Stopped("interrupted", "asked for")
    return finished(planner, stopped, provenance, 0.0)


def read_again(plan):
    """A plan as it is written and read."""
    return plan_from_json(json.loads(json.dumps(plan_to_json(plan))))


def proven(result, stones):
    """See that a plan, written and read again, is true; return what was checked."""
    report = check_plan(read_again(result.plan), stones, wall_labels=result.wall.labels)
    assert report.problems == ()
    return report


def kept_apart(wall, clearance_px):
    """See that stones and wedges of a wall of outlines keep apart; return their shapes."""
    shapes = [
        shapely.Polygon(corners)
        for group in wall.groups
        for _, corners in outlined(group.placement, group.wedges)
    ]
    for one, other in combinations(shapes, 2):
        assert one.distance(other) >= 0.49 * clearance_px
    return shapes


def outlines(planner):
    """Ids and corners of stones and wedges that are outlines, in the order of placement."""
    groups = planner.build.wall.groups if planner.build.wall.outlines else ()
    blocks = (block for group in groups for block in outlined(group.placement, group.wedges))
    return [(block_id, corners.tobytes()) for block_id, corners in blocks]


def done(planner):
    """All that a planner did, with its figures."""
    figures = [
        (a.indices, a.resistance.left.alpha, a.resistance.right.alpha, a.course_height_px, a.sturdy)
        for a in planner.build.actions
    ]
    placed = [
        (group.placement.rotation_moves, [(wedge.id, wedge.under) for wedge in group.wedges])
        for group in planner.build.wall.groups
    ]
    labels = planner.build.wall.labels.tobytes()
    return order(planner), figures, placed, outlines(planner), labels, planner.stopped


def same(one, other):
    """Say whether two planners did the same, with the same figures."""
    return done(one) == done(other)
