"""Slow, obvious twins of the readers of stones."""

import numpy as np
from scipy.spatial.distance import cdist
from skimage.measure import label


def holes(mask):
    """Pixels outside the mask that no 4-connected way leads out of."""
    air = np.pad(~mask, 1, constant_values=True)
    pieces = label(air, connectivity=1)
    return (air & (pieces != pieces[0, 0]))[1:-1, 1:-1]


def neck_width(mask):
    """Twice the smallest erosion, px, that leaves two thick parts of some size; None without."""
    depth = np.zeros(mask.shape)
    depth[mask] = cdist(np.argwhere(mask) + 1, np.argwhere(~np.pad(mask, 1))).min(axis=1)
    for half in range(int(depth.max() / 1.6) + 1 if depth.max() >= 3.2 else 0):
        labels, count = label(depth > half, connectivity=1, return_num=True)
        parts = [labels == i for i in range(1, count + 1)]
        thick = [part for part in parts if depth[part].max() >= 1.6 * max(half, 1)]
        if sum(part.sum() >= 0.15 * (depth > half).sum() for part in thick) > 1:
            return 2 * half
    return None
