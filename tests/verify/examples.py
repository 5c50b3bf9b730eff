"""Small walls made by hand, with plans that claim what is true of them."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from drystone.model.placement import Placement, Wedge
from drystone.model.plan import Plan
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall
from drystone.planner.events import Stopped
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.poses import PoseBook
from drystone.search.plan_result import finish
from tests.planner.scenes import stones_of_masks

SETTINGS = PlannerSettings(orientations="quarter", two_sided=True)
WEDGE, SLAB, L_STONE = 301, 7, 12
WALL_PX = (84.0, 30.0)
LAID = (
    (3, 0.0, 0, 0),
    (5, 0.0, 40, 0),
    (SLAB, 180.0, 10, 20),
    (L_STONE, 90.0, 64, 0),
    (300, -90.0, 74, 0),
)
"""Stones, how they are turned, and where their boxes begin."""


@dataclass(frozen=True)
class Example:
    """A plan that is true, its stones and its wall."""

    plan: Plan
    stones: StoneSet
    wall: Wall


def stone_set():
    """Two pillars of different height, a slab, an L, and a small stone that is not used."""
    l_shape = np.ones((8, 12), bool)
    l_shape[:4, 6:] = False
    masks = {
        3: np.ones((20, 20), bool),
        5: np.ones((16, 20), bool),
        SLAB: np.ones((6, 40), bool),
        L_STONE: l_shape,
        300: np.ones((10, 12), bool),
        9: np.ones((4, 4), bool),
    }
    return stones_of_masks(masks)


@cache
def example(scale=1.0, px_per_m=None):
    """Return a slab on two pillars with a wedge on the lower one, an L beside them turned by 90.

    At a scale of 1 the site is 84 x 30 px; other scales must keep all edges on whole px.
    """
    stones, site = stone_set(), Site.from_source(*WALL_PX, scale, px_per_m)
    built = Wall.empty(site)
    for stone_id, angle_deg, left, bottom in LAID:
        posed = PoseBook(scale).pose(stones.by_id(stone_id), angle_deg)
        row = site.height_px - round(bottom * scale) - posed.height_px
        side = "right" if stone_id == 300 else "left"
        wedges = ()
        if stone_id == SLAB:
            shape, at = np.array([[4, 8], [14 - 4, 42]]) * scale
            mask = np.ones(shape.astype(int), bool)
            wedges = (Wedge(WEDGE, SLAB, mask, int(at[0]), int(at[1])),)
        built = built.add(Placement(posed, row, round(left * scale), side), wedges)
    heights = {placement.stone_id: 11.5 * scale for placement in built.placements}
    return plan_of(built, stones, SETTINGS, heights)


def plan_of(wall, stones, settings, heights):
    """Return the plan of a wall of 84 x 30 px, with what the planner finds true of it."""
    planner = Planner(stones, wall.site, settings=settings)
    planner.restore(wall, heights)
    provenance = {"version": "0.1.0", "method": "custom", "seed": 1, "settings": settings.as_dict()}
    stopped = Stopped("stones", "all stones that fit are placed")
    made = finish(planner, stopped, provenance, 0.0)
    return Example(made.plan, stones, wall)
