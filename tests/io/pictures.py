"""Small pictures that the tests of the readers share."""

import json

import numpy as np
from PIL import Image


def two_stones(first=300, second=70000, dtype=np.uint32):
    """A 40 x 60 label image of two stones of 375 and 600 px."""
    labels = np.zeros((40, 60), dtype)
    labels[5:20, 5:30] = first
    labels[22:37, 10:50] = second
    return labels


def many_stones(rows=6, cols=8, *, size=24, gap=6, first=1, step=3):
    """A label image of rows x cols squares with ids first, first + step ..."""
    ids = first + step * np.arange(rows * cols, dtype=np.uint32).reshape(rows, cols)
    square = np.pad(np.ones((size, size), np.uint32), ((gap, 0), (gap, 0)))
    return np.pad(np.kron(ids, square), ((0, gap), (0, gap)))


def discs(shape, centres, radius):
    """A mask of discs, four times as fine in both directions for anti-aliasing."""
    rows, cols = np.mgrid[: shape[0] * 4, : shape[1] * 4] / 4 + 0.125
    fine = np.zeros(rows.shape, bool)
    for row, col in centres:
        fine |= np.hypot(rows - row, cols - col) < radius
    return fine.reshape(shape[0], 4, shape[1], 4).mean(axis=(1, 3))


def codes(stones):
    return [notice.code for notice in stones.notices]


def said(given):
    """All that is said of stones or of a wall."""
    return " ".join(map(str, given.notices))


def areas(stones):
    return {stone.id: stone.area_px for stone in stones}


def written(folder, content, name="stones.json"):
    """Write bytes, a text, or what becomes JSON."""
    if not isinstance(content, str | bytes):
        content = json.dumps(content)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder / name


def save_mask(path, mask):
    Image.fromarray(np.asarray(mask, np.uint8) * np.uint8(255)).save(path)
