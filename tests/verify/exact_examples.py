"""A small wall of outlines made by hand, with a plan that claims what is true of it."""

import json
from functools import cache

import numpy as np

from drystone.contacts.settled import model_of_outlines
from drystone.io.plan_folder import blocks_to_json
from drystone.kernels.polygons import on_grid
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.model.wedge_shape import WedgeSettings
from drystone.planner.settings import PlannerSettings
from drystone.settle.placing import settled_wedge
from tests.planner.scenes import settled_at, stones_of_masks
from tests.polygons import box
from tests.verify.examples import LAID, SLAB, WALL_PX, WEDGE, plan_of, stone_set

GAP_PX = 0.01
"""Between all that touches."""

SETTINGS = PlannerSettings(
    geometry="exact",
    orientations="quarter",
    two_sided=True,
    wedge=WedgeSettings(height=0.4, area=0.2),
)


@cache
def exact_example(scale=1.0, px_per_m=None, *, count=5):
    """Return the wall of `example` on outlines, or its first `count` stones."""
    stones, site = stone_set(), Site.from_source(*WALL_PX, scale, px_per_m)
    wall = Wall.empty(site, exact=True)
    for stone_id, angle_deg, left, bottom in LAID[:count]:
        low = bottom + (2 * GAP_PX if stone_id == SLAB else GAP_PX)
        wall = with_stone(wall, stones, (stone_id, angle_deg), (left, low))
    return plan_of(wall, stones, SETTINGS, {})


def hanging_example():
    """Return a stone that hangs between two blocks by friction on their upright faces."""
    masks = {1: np.ones((30, 30), bool), 2: np.ones((30, 30), bool), 3: np.ones((20, 20), bool)}
    stones = stones_of_masks(masks)
    wall = Wall.empty(Site.from_source(*WALL_PX), exact=True)
    for stone_id, left, bottom in ((1, 0.0, GAP_PX), (2, 50.02, GAP_PX), (3, 30.01, 9.0)):
        wall = with_stone(wall, stones, (stone_id, 0.0), (left, bottom))
    return plan_of(wall, stones, SETTINGS, {})


def with_stone(wall, stones, turned, corner):
    """Add a stone, the bottom-left corner of its box at a place; the slab with its wedge."""
    stone_id, angle_deg = turned
    side = "right" if stone_id == 300 else "left"
    placement = settled_at(wall, stones.by_id(stone_id), corner, angle_deg, side)
    if stone_id != SLAB:
        return wall.add(placement)
    # Between the lower pillar and the slab, 8 px wide and nearly 4 px high.
    wedge = on_grid(box(42, 16 + 2 * GAP_PX, 50, 20 + GAP_PX))
    above = wall.add(placement).outlines
    return wall.add(placement, (settled_wedge(above, wall.site, WEDGE, SLAB, wedge),))


def block_model(made):
    """Return what blocks.json beside the plan of a wall of outlines says, read again."""
    settle = SETTINGS.settle
    model = model_of_outlines(made.wall.exact.blocks, SETTINGS.mu, settle.contact_px)
    return json.loads(json.dumps(blocks_to_json(made.wall, model)))
