"""Slow, obvious twins of the readers of stones."""

import numpy as np


def components(mask):
    """8-connected components by flood fill, numbered by their first pixel in row order."""
    labels = np.zeros(mask.shape, int)
    count = 0
    for row in range(mask.shape[0]):
        for col in range(mask.shape[1]):
            if mask[row, col] and not labels[row, col]:
                count += 1
                _flood(mask, labels, (row, col), count, diagonal=True)
    return labels, count


def holes(mask):
    """Pixels outside the mask that no 4-connected way leads out of."""
    air = np.pad(~mask, 1, constant_values=True)
    outside = np.zeros(air.shape, int)
    _flood(air, outside, (0, 0), 1, diagonal=False)
    return (air & (outside == 0))[1:-1, 1:-1]


def neck_width(mask):
    """Twice the smallest erosion, px, that leaves two thick parts of some size; None without."""
    air = np.argwhere(~np.pad(mask, 1))
    depth = (
        np.array(
            [[np.hypot(*(air - place).T).min() for place in row] for row in places(mask.shape)]
        )
        * mask
    )
    for half in range(int(depth.max() / 1.6) + 1 if depth.max() >= 3.2 else 0):
        labels, count = np.zeros(mask.shape, int), 0
        for row, col in np.argwhere(depth > half):
            if not labels[row, col]:
                count += 1
                _flood(depth > half, labels, (row, col), count, diagonal=False)
        parts = [labels == i for i in range(1, count + 1)]
        thick = [part for part in parts if depth[part].max() >= 1.6 * max(half, 1)]
        if sum(part.sum() >= 0.15 * (depth > half).sum() for part in thick) > 1:
            return 2 * half
    return None


def places(shape):
    """Places in a picture of this shape with a rim around it."""
    return [[(row + 1, col + 1) for col in range(shape[1])] for row in range(shape[0])]


def colour_id(red, green, blue):
    """DESIGN 4.1, one pixel."""
    return red if red == green == blue else red + 256 * green + 65536 * blue


def _flood(mask, labels, start, value, *, diagonal):
    todo = [start]
    while todo:
        row, col = todo.pop()
        inside = 0 <= row < mask.shape[0] and 0 <= col < mask.shape[1]
        if not inside or not mask[row, col] or labels[row, col]:
            continue
        labels[row, col] = value
        steps = [(dr, dc) for dr in (-1, 0, 1) for dc in (-1, 0, 1)]
        todo += [(row + dr, col + dc) for dr, dc in steps if diagonal or 0 in (dr, dc)]


def areas(labels):
    """Pixels of every id but 0."""
    return {int(i): int((labels == i).sum()) for i in np.unique(labels) if i}


def index_of(labels):
    """1 + position of every value among the sorted different values."""
    values = sorted(set(labels.ravel().tolist()))
    place = {value: i + 1 for i, value in enumerate(values)}
    return np.array([[place[v] for v in row] for row in labels.tolist()]), values
