"""A small wall, its plan and a mechanism, made by hand for the tests of pictures and reports."""

import numpy as np

from drystone.model.placement import Placement, Wedge
from drystone.model.plan import Plan, PlanMetrics, StoneStep, WedgeStep
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Source, Stone, StoneSet
from drystone.model.wall import Wall
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus, Mechanism

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
    stones, left = [], 2
    for stone_id, mask in masks.items():
        stones.append(Stone(stone_id, mask, left_px=left, bottom_px=3))
        left += mask.shape[1] + 2
    return StoneSet(tuple(stones), Source("<b>PR.png", "0" * 64, left, 14))


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
    built = built or wall()
    stones, units = stone_set(), built.site.units_per_px
    indices = {"SF": 1.0, "LFR": 0.95, "GDS": 0.9, "NHR": 0.1, "IWR": 0.4, "IS": 0.0, "LLC": 0.7}
    steps = []
    for group in built.groups:
        placement = group.placement
        x, y = placement.centroid(built.site.height_px)
        done = not group.wedges
        source = stones.by_id(placement.stone_id).centroid
        steps.append(
            StoneStep(
                len(steps) + 1, placement.stone_id, -12.5, source, (x * units, y * units),
                placement.side, CLUSTERS[placement.stone_id], placement.rotation_moves, indices,
                None, 0.41 if done else None, 0.39 if done else None,
            )
        )  # fmt: skip
        for wedge in group.wedges:
            box = ((20, 6), (23, 6), (23, 8), (20, 8))
            polygon = tuple((x * units, y * units) for x, y in box)
            steps.append(WedgeStep(len(steps) + 1, wedge.id, wedge.under, polygon, 0.41, 0.39))
    source = {
        "path": "<b>PR.png", "sha256": "0" * 64, "stones": len(stones),
        "width_px": stones.source.width_px, "height_px": stones.source.height_px,
    }  # fmt: skip
    usual = PlanMetrics(0.4773, None, 4.25, 0.6724, 0.31, 0.12, 0.41, 0.39, 6.0 * units**2)
    return Plan(
        "0.1.0", "paper", 7,
        {"mu": 0.58, "placement": {"rule": "eq12", "note": "<script>alert(1)</script>"}},
        "m" if built.site.px_per_m else "px", built.site.px_per_m, built.site.scale, source,
        built.site.width_px * units, built.site.height_px * units, tuple(steps), (UNUSED,),
        "no acceptable place was found five times in a row", metrics or usual,
    )  # fmt: skip
