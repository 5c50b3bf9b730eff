"""Generated walls for tests of the limit analysis."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from drystone.statics.contacts.given import model_from_json
from drystone.statics.model import RigidBlockModel

Labels = NDArray[np.uint32]


def stacked(*blocks: tuple[int, int, int]) -> Labels:
    """Blocks (width, height, left) on top of each other, the first one lowest, numbered from 1."""
    height = sum(block[1] for block in blocks)
    labels = np.zeros((height, max(left + width for width, _, left in blocks)), np.uint32)
    bottom = height
    for number, (width, tall, left) in enumerate(blocks, start=1):
        labels[bottom - tall : bottom, left : left + width] = number
        bottom -= tall
    return labels


def coursed(seed: int, courses: int, length_px: int, gap_px: int = 0) -> Labels:
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


def brick_model(courses: int, bricks: int, height: float, mu: float) -> RigidBlockModel:
    """Running bond of bricks 2 x `height` with half bricks at the ends of every other course."""
    rows = []
    for course in range(courses):
        edges = [2.0 * i for i in range(bricks + 1)]
        if course % 2:
            edges = [0.0, *(edge + 1.0 for edge in edges[:-1]), edges[-1]]
        y = course * height
        rows += [[left, y, right - left, height] for left, right in pairwise(edges)]
    return model_from_json({"blocks_xywh": rows, "mu": mu})


def irregular(seed: int, count: int, width_px: int, height_px: int) -> Labels:
    """Cells nearest to random points: every joint tilted, no gaps."""
    points = np.random.default_rng(seed).random((count, 2)) * (height_px, width_px)
    row, col = np.mgrid[:height_px, :width_px]
    distance = (row[..., None] - points[:, 0]) ** 2 + (col[..., None] - points[:, 1]) ** 2
    return (distance.argmin(axis=-1) + 1).astype(np.uint32)
