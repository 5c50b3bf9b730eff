"""A small wall, its plan and a mechanism, made by hand for the tests of pictures and reports."""

from dataclasses import replace

import numpy as np

from drystone.model.placement import Placement, Wedge
from drystone.model.plan import PlanMetrics
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus, Mechanism
from tests.verify.examples import SETTINGS, in_a_row, plan_of

CLUSTERS = {3: 1, 5: 2, 8: 1, 12: 3, 300: 2}
UNUSED = 40
WEDGE = 301


def stone_set():
    masks = {
        3: np.ones((8, 14), bool),
        5: np.ones((6, 16), bool),
        8: np.ones((8, 10), bool),
        12: np.ones((8, 12), bool),
        300: np.ones((4, 20), bool),
        UNUSED: np.ones((2, 2), bool),
    }
    masks[12][:4, 6:] = False  # an L
    return in_a_row(masks, "<b>PR.png", "0" * 64, 14)


def wall(px_per_m=None):
    """Three stones on the ground, an L and a slab on top, a wedge under the slab."""
    stones = stone_set()
    site = Site(44, 20, scale=1.0, px_per_m=px_per_m)
    built = Wall.empty(site)
    for stone_id, row, col in ((3, 12, 0), (5, 14, 14), (8, 12, 30), (12, 4, 0)):
        built = built.add(Placement(_posed(stones.by_id(stone_id)), row, col))
    wedge = Wedge(WEDGE, 300, np.ones((2, 3), bool), 12, 20)
    slab = Placement(_posed(stones.by_id(300)), 8, 20, side="right", rotation_moves=1)
    return built.add(slab, (wedge,))


def _posed(stone):
    return PosedStone(stone, 0.0, 1.0, stone.mask.copy(), stone.local_centroid)


def mechanism():
    """The L slides to the left, the slab turns counter-clockwise."""
    velocity = np.zeros((6, 3))
    velocity[3] = (-1.0, 0.0, 0.0)
    velocity[4] = (-0.3, 0.4, 0.05)
    return Mechanism((3, 5, 8, 12, 300, WEDGE), velocity)


def resistance():
    left = LimitResult(LimitStatus.OPTIMAL, "left", 0.41, mechanism())
    right = LimitResult(LimitStatus.FAILED, "right", message="gave up")
    return LateralResistance(left, right, 0.58)


def plan(built=None, metrics=None):
    """Of the wall, or of another one, with results and words that tests look for."""
    built = built or wall()
    made = plan_of(built, stone_set(), SETTINGS, {}).plan
    area = 6.0 * built.site.units_per_px**2
    usual = PlanMetrics(0.4773, None, 4.25, 0.6724, 0.31, 0.12, 0.41, 0.39, area)
    placement = {"rule": "eq12", "note": "<script>alert(1)</script>"}
    settings = {**made.settings, "placement": placement}
    stopped = "no acceptable place was found five times in a row"
    return replace(made, settings=settings, stopped=stopped, metrics=metrics or usual)
