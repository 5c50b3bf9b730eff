"""Heaps of random stones, each let go above those that rest already."""

import math
from typing import NamedTuple

import numpy as np

from drystone.kernels import polygons
from drystone.kernels.settling import SettlingRules, Status, settle
from tests.naive.settling import Pose, placed
from tests.polygons import centred, convex, random_polygon

WIDTH = 160.0


class Drop(NamedTuple):
    """A stone that is let go."""

    outline: polygons.Points
    pose: Pose
    around: polygons.Polygons
    rules: SettlingRules

    def settled(self):
        edges = polygons.polygon_edges(self.outline)
        return settle(self.outline, edges, self.pose, self.around, WIDTH, self.rules)


def rules(size, **changes):
    """Those of exact settling, with lengths by a stone's size."""
    usual = SettlingRules(
        lean=0.3,
        stop=-1.0,
        mu=0.58,
        clearance=0.01,
        tolerance=0.1,
        corner=0.3,
        near=0.04 * size,
        far=0.08 * size,
        turn=math.radians(40.0),
        shift=2.0 * size,
        gain=4e-6 * size,
        overlap=0.5,
        steep=-1.0,
        beyond=0.0,
        sticks=False,
        turns=True,
        steps=200,
    )
    return usual._replace(**changes)


WAYS = (
    {},
    {"lean": 0.0},
    {"lean": 0.0, "stop": 0.2},
    {"lean": 0.0, "stop": 0.2, "sticks": True},
    {"turns": False},
)
"""Ways of settling: pushed aside, frictionless, as soon as it rests, rolling, without turning."""


def random_outline(rng):
    """Convex, concave, with many corners, a thin sliver, or one that is bent."""
    kind, size = int(rng.integers(5)), float(rng.uniform(8.0, 50.0))
    if kind == 0:
        return centred(convex(random_polygon(rng, int(rng.integers(4, 20)), size)))
    if kind == 1:
        a, b = size / 2.0, float(rng.uniform(0.5, 2.0))
        return np.array([[-a, -b], [a, -b], [a, b], [-a, b]])
    if kind == 2:
        a, b, bend = size / 2.0, float(rng.uniform(1.0, 3.0)), float(rng.uniform(-0.5, 0.5)) * size
        return centred(
            np.array([[-a, 0.0], [0.0, bend], [a, 0.0], [a, b], [0.0, bend + b], [-a, b]])
        )
    return centred(random_polygon(rng, int(rng.integers(3, 9) if kind == 3 else 30), size))


def drops(seed, count):
    """Stones let go one after the other; those that rest stay."""
    rng = np.random.default_rng(seed)
    around = polygons.no_polygons()
    for _ in range(count):
        outline = placed(random_outline(rng), (0.0, 0.0, float(rng.uniform(-3.0, 3.0))))
        size = math.sqrt(polygons.area_and_centroid(outline)[0])
        (left, low), (right, _) = outline.min(axis=0), outline.max(axis=0)
        x = float(rng.uniform(0.1 - left, WIDTH - right - 0.1))
        under = (around.boxes[:, 0] < x + right) & (around.boxes[:, 2] > x + left)
        top = float(around.boxes[under, 3].max(initial=0.0))
        way = WAYS[int(rng.integers(len(WAYS)))]
        drop = Drop(outline, (x, top - float(low) + 0.05, 0.0), around, rules(size, **way))
        found = drop.settled()
        yield drop, found
        if found.status == Status.RESTS:
            around = around.added([placed(outline, found[1:4])])
