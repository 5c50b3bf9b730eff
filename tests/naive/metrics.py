"""Slow, obvious twins of drystone.metrics, one rule a line."""

import math

import numpy as np
from scipy import ndimage
from skimage.graph import MCP_Geometric


def reduce_labels(labels, scale):
    sizes = [(side, max(1, math.floor(side * scale + 0.5))) for side in labels.shape]
    return labels[np.ix_(*([k * side // size for k in range(size)] for side, size in sizes))]


def joint_mask(labels):
    of_one = ndimage.minimum_filter(labels, 3) == ndimage.maximum_filter(labels, 3)
    return np.pad(~of_one | (labels == 0), ((1, 2), (1, 2)), constant_values=True)


def shortest_to(joint, start, ends):
    """Length of the shortest way over joint pixels to the nearest of some; None without a path."""
    if not joint[start]:
        return None
    lengths, _ = MCP_Geometric(np.where(joint, 1.0, -1.0)).find_costs([start])
    shortest = min(lengths[end] for end in ends)
    return shortest if math.isfinite(shortest) else None


def vertical_arrangement(joint):
    """F_AV as DESIGN 5 words it; F_AH is that of the transposed joint image."""
    straight, width = joint.shape[0] - 1, joint.shape[1]
    columns = range(10, width - 10, max(1, width // 10))
    lengths = [shortest_to(joint, (0, column), {(straight, column)}) for column in columns]
    smallest = sorted(length for length in lengths if length is not None)[:5]
    return 100 * (np.mean(smallest) / straight - 1) if smallest else None


def second_definition(labels):
    """F_AV and F_AH as drystone_lab.second_arrangement words them."""
    rows = [row for row in range(labels.shape[0]) if labels[row].any()]
    cols = [col for col in range(labels.shape[1]) if labels[:, col].any()]
    stones = labels[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]
    inner = joint_mask(stones)[1:-2, 1:-2]
    upright = np.vstack([np.ones(inner.shape[1], bool), inner, np.ones(inner.shape[1], bool)])
    lying = np.vstack([np.ones(inner.shape[0], bool), inner.T, np.ones(inner.shape[0], bool)])
    return down_and_up(upright), down_and_up(lying)


def down_and_up(joint):
    """Mean excess of ten paths from the first row to the last and ten back, ends free."""
    last, side = joint.shape[0] - 1, joint.shape[1]
    columns = [math.floor((part + 0.5) * side / 10 + 1e-9) for part in range(5)]
    columns += [side - 1 - column for column in columns]
    lengths = [
        shortest_to(joint, (start, column), {(last - start, end) for end in range(side)})
        for start in (0, last)
        for column in columns
    ]
    return None if None in lengths else 100 * (np.mean(lengths) / last - 1)


def level_deviation(labels, mean_stone_height):
    tops = [len(column) - np.argmax([*column, True]) for column in labels.T > 0]
    return np.abs(tops - np.mean(tops)).mean() / mean_stone_height


def flush_deviation(labels, left, right, mean_stone_width):
    rows = [np.flatnonzero(row) for row in labels if row.any()]
    gaps = [(abs(filled[0] - left), abs(right - (filled[-1] + 1))) for filled in rows]
    return np.mean(gaps) / mean_stone_width


def mean_sizes(labels, wedge_ids):
    """Mean height and width of the stones' bounding boxes."""
    stones = set(labels.ravel().tolist()) - {0, *wedge_ids}
    return np.mean([np.ptp(np.argwhere(labels == i), axis=0) + 1 for i in stones], axis=0)
