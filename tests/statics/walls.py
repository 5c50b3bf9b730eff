"""Generated walls for tests of the limit analysis."""

import math
from itertools import pairwise

import numpy as np

from drystone.contacts.given import model_from_json
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from tests.polygons import box_of


def stacked(*blocks):
    """Blocks (width, height, left) on top of each other, the first one lowest, numbered from 1."""
    height = sum(block[1] for block in blocks)
    labels = np.zeros((height, max(left + width for width, _, left in blocks)), np.uint32)
    bottom = height
    for number, (width, tall, left) in enumerate(blocks, start=1):
        labels[bottom - tall : bottom, left : left + width] = number
        bottom -= tall
    return labels


def coursed(seed, courses, length_px, gap_px=0):
    """Courses of stones of random lengths; gaps of up to `gap_px` open some head joints."""
    rng = np.random.default_rng(seed)
    heights = rng.integers(8, 16, courses)
    labels = np.zeros((int(heights.sum()), length_px), np.uint32)
    bottom, number = labels.shape[0], 0
    for height in heights.tolist():
        left = int(rng.integers(0, 4)) if gap_px else 0
        while length_px - left >= 8:
            width = min(int(rng.integers(10, 28)), length_px - left)
            if length_px - left - width < 8:
                width = length_px - left
            number += 1
            labels[bottom - height : bottom, left : left + width] = number
            left += width + int(rng.integers(0, gap_px + 1))
        bottom -= height
    return labels


def boxes(*rows, fixed=(), mu=0.58):
    """The model of boxes x, y, width, height, numbered from 1; some are fixed."""
    blocks = [
        {"id": i, "polygon": box_of(*row).tolist(), "fixed": i in fixed}
        for i, row in enumerate(rows, start=1)
    ]
    return model_from_json({"blocks": blocks, "mu": mu})


def brick_model(courses, bricks, height, mu):
    """Running bond of bricks 2 x `height` with half bricks at the ends of every other course."""
    rows = []
    for course in range(courses):
        edges = [2.0 * i for i in range(bricks + 1)]
        if course % 2:
            edges = [0.0, *(edge + 1.0 for edge in edges[:-1]), edges[-1]]
        y = course * height
        rows += [[left, y, right - left, height] for left, right in pairwise(edges)]
    return boxes(*rows, mu=mu)


def between_piers(pier=1.0, height=4.0, gap=1.0, mu=0.58, *, covered=False, unit=1.0):
    """A brick, 3, between two piers that stand free; a slab, 4, may cover them."""
    rows = [[0, 0, pier, height], [pier + gap, 0, pier, height], [pier, 1, gap, 1]]
    if covered:
        rows.append([0, height, 2 * pier + gap, 1])
    return boxes(*(np.array(rows) * unit), mu=mu)


def slot(left, right, mu):
    """A block, 2, between two fixed ones, whose upper corners lie so far right of the lower."""
    outlines = (
        [[-2, 1], [0, 1], [left, 2], [-2, 2]],
        [[0, 1], [1, 1], [1 + right, 2], [left, 2]],
        [[1, 1], [3, 1], [3, 2], [1 + right, 2]],
    )
    return with_one_free(outlines, mu)


def under_a_roof(slope_deg, mu):
    """A block, 2, between fixed faces that lean over it by so many degrees from the vertical."""
    lean = math.tan(math.radians(slope_deg))
    outlines = (
        [[-1, 2], [lean - 1, 3], [-3, 3], [-3, 2]],
        [[-1, 2], [-1, 1], [1, 1], [1, 2], [1 - lean, 3], [lean - 1, 3]],
        [[1, 2], [3, 2], [3, 3], [1 - lean, 3]],
    )
    return with_one_free(outlines, mu)


def with_one_free(outlines, mu, free=2):
    blocks = [
        {"id": i, "polygon": corners, "fixed": i != free} for i, corners in enumerate(outlines, 1)
    ]
    return model_from_json({"blocks": blocks, "mu": mu})


def irregular(seed, count, width_px, height_px):
    """Cells nearest to random points: every joint tilted, no gaps."""
    points = np.random.default_rng(seed).random((count, 2)) * (height_px, width_px)
    row, col = np.mgrid[:height_px, :width_px]
    distance = (row[..., None] - points[:, 0]) ** 2 + (col[..., None] - points[:, 1]) ** 2
    return (distance.argmin(axis=-1) + 1).astype(np.uint32)


def empty(mu=0.58):
    return RigidBlockModel((), (), mu)


def with_block(built, *blocks, whole):
    """The model with more blocks of a whole wall: a stone, or a stone and its wedge."""
    new = {block.id for block in blocks}
    there = {GROUND, *new, *(b.id for b in built.blocks)}
    touching = [i for i in whole.interfaces if new & {i.block, i.other}]
    return built.with_added(blocks, tuple(i for i in touching if {i.block, i.other} <= there))


def told(interfaces):
    """What interfaces say, to compare."""
    return [
        (i.block, i.other, [tuple(point) for point in i.points.tolist()], i.normal)
        for i in interfaces
    ]


def alphas(model, **how):
    """Both ends of the resistance of a wall."""
    both = lateral_resistance(model, **how)
    return both.left.alpha, both.right.alpha


def gave_up(mu=0.58):
    """What a solver says that gave up on both directions."""
    left, right = (LimitResult(LimitStatus.FAILED, side) for side in ("left", "right"))
    return LateralResistance(left, right, mu)


def limit_load(model, direction, loads=None, **how):
    """One direction of the resistance of a wall."""
    return getattr(lateral_resistance(model, loads, **how), direction)
