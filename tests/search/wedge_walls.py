"""Small finished walls, and where wedges have room in them."""

from functools import cache

import numpy as np

from drystone.contacts.settled import PlacedPolygons
from drystone.generate import PolygonSettings, RubbleSettings, polygon_stones, rubble_stones
from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.search.wedge_draft import MOST_UNDER_ONE, wedge_places
from drystone.search.yard import Yard
from tests.planner.scenes import finish, greedy

LARGE = greedy(
    {
        "wedge": {"thickness": 0.04, "height": 0.5, "area": 0.3},
        "search": {"budget": 2},
        "settle": {"margin": 0.2, "trials": 0},
    }
)
"""With larger wedges than usual, of which small walls have some; places need not be sure."""


def limits_of(made):
    return Yard.of(made).limits


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
    for kind, seed, scale in ((plain, 0, 0.5), (plain, 5, 0.5), (sharp, 4, 0.5), (rubble, 0, 1.0)):
        rng = np.random.default_rng(seed)
        generated = isinstance(kind, RubbleSettings)
        stones = rubble_stones(kind, rng) if generated else polygon_stones(kind, rng)
        site = Site.from_source(90.0, 48.0, scale)
        made.append((stones, finish(Planner(stones, site, seed=seed, settings=LARGE))))
    return tuple(made)
