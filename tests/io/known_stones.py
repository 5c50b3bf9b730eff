"""Seven stones with known outlines, and their label image by a rasteriser of another package.

No edge goes through the centre of a pixel, so every rule for edges gives the same pixels.
"""

import functools
import math
from dataclasses import replace

import numpy as np
from matplotlib.path import Path as Outline

from drystone.io.read_stones import ReadSettings, read_stones

WIDTH, HEIGHT = 320, 200

_ROUND = [(250 + 22 * math.cos(a), 150 + 18 * math.sin(a)) for a in np.arange(128) * (math.pi / 64)]

# id: polygons of an outer ring and holes, px, y down
STONES = {
    3: [[[(10, 10), (58.2, 12.3), (71.7, 40.1), (49.6, 63.8), (19.1, 55.3)]]],
    5: [[[(90, 12), (150, 12), (150, 30), (112, 30), (112, 70), (90, 70)]]],  # concave
    8: [
        [
            [(169.7, 10), (235, 14), (230, 74), (174, 70)],
            [(190, 32), (190, 52), (212, 52), (212, 32)],  # a hole
        ]
    ],
    13: [[[(10, 90), (60.3, 90), (70.2, 140), (10, 140)]]],  # touches the next one
    21: [[[(60.3, 90), (120, 90), (120, 140), (70.2, 140)]]],
    34: [
        [[(140, 100), (190, 100), (190, 140), (140, 140)]],
        [[(195, 104), (207, 104), (201, 135)]],
    ],
    300: [[_ROUND]],
}
PIECES = ReadSettings(pieces="keep-largest", holes="keep")
"""What the stone in two pieces and the one with a hole need."""
PX_PER_M = 500.0
METRIC = replace(PIECES, px_per_m=PX_PER_M)


@functools.cache
def masks():
    """Masks of all stones, by id."""
    rows, cols = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    centres = np.column_stack([cols.ravel(), rows.ravel()])
    found = {}
    for stone, polygons in STONES.items():
        rings = [Outline(ring) for rings in polygons for ring in rings]
        inside = np.logical_xor.reduce([ring.contains_points(centres) for ring in rings])
        found[stone] = inside.reshape(HEIGHT, WIDTH)
    return found


def label_image():
    """The masks as one image of ids."""
    labels = np.zeros((HEIGHT, WIDTH), np.uint16)
    for stone, mask in masks().items():
        labels[mask] = stone
    return labels


def compare(stones, settings=PIECES, ids=None):
    """Return the least IoU of a stone.

    The picture may be cut to the box of the stones; then it is compared with the cut truth.
    """
    truth = true_stones(settings)
    assert len(stones) == len(truth)
    left = min(stone.left_px for stone in truth) - min(stone.left_px for stone in stones)
    bottom = min(stone.bottom_px for stone in truth) - min(stone.bottom_px for stone in stones)
    ious = []
    for true in truth:
        found = stones.by_id(ids[true.id] if ids else true.id)
        mask, want = np.zeros((2, 2 * HEIGHT, 2 * WIDTH), bool)
        for image, stone, x, y in ((mask, found, left, bottom), (want, true, 0, 0)):
            rows, cols = stone.mask.shape
            row, col = 2 * HEIGHT - (stone.bottom_px + y) - rows, stone.left_px + x
            image[row : row + rows, col : col + cols] = stone.mask
        ious.append((mask & want).sum() / (mask | want).sum())
    return float(min(ious))


@functools.cache
def true_stones(settings):
    """The label image as it is read."""
    return read_stones(label_image(), settings=settings)


def close(stones, settings=PIECES):
    """Almost every pixel: edges through centres may go either way after a change of unit."""
    assert compare(stones, settings) > 0.9995


S = np.sqrt(0.5)
PLACES = {
    "top": ((1, 0, 0), (0, 1, 0), "z"),
    "below": ((-1, 0, 0), (0, 1, 0), "z-back"),
    "front": ((1, 0, 0), (0, 0, 1), "z"),
    "back": ((-1, 0, 0), (0, 0, 1), "z-back"),
    "right": ((0, 1, 0), (0, 0, 1), "z"),
    "left": ((0, -1, 0), (0, 0, 1), "z-back"),
    "slanting": ((S, S, 0), (0, 0, 1), "z"),
    "y, top": ((1, 0, 0), (0, 0, -1), "y"),
    "y, below": ((-1, 0, 0), (0, 0, -1), "y-back"),
    "y, front": ((1, 0, 0), (0, 1, 0), "y"),
    "y, back": ((-1, 0, 0), (0, 1, 0), "y-back"),
    "y, right": ((0, 0, -1), (0, 1, 0), "y"),
    "y, left": ((0, 0, 1), (0, 1, 0), "y-back"),
}
"""What points right and up in a picture of the stones, and the option that says so."""


def turn(place):
    right, up, _ = PLACES[place]
    return np.column_stack([right, up, np.cross(right, up)])


def corners(points, place="top", unit=1.0):
    flat = [(x, HEIGHT - y, 0.0) for x, y in points]
    return np.array(flat) @ turn(place).T / PX_PER_M / unit
