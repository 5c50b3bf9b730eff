"""Slow, obvious twins of drystone.metrics: loops over pixels, one rule a line."""

import math

import numpy as np
from skimage.graph import MCP_Geometric


def reduce_labels(labels, scale):
    height, width = labels.shape
    rows = max(1, math.floor(height * scale + 0.5))
    cols = max(1, math.floor(width * scale + 0.5))
    return np.array(
        [[labels[i * height // rows, j * width // cols] for j in range(cols)] for i in range(rows)],
        labels.dtype,
    )


def joint_mask(labels):
    height, width = labels.shape
    joint = np.ones((height + 3, width + 3), bool)
    for row in range(height):
        for col in range(width):
            around = {
                int(labels[r, c])
                for r in range(max(0, row - 1), min(height, row + 2))
                for c in range(max(0, col - 1), min(width, col + 2))
            }
            inside = around == {int(labels[row, col])} and labels[row, col] > 0
            joint[row + 1, col + 1] = not inside
    return joint


def shortest_to(joint, start, ends):
    """Length of the shortest way over joint pixels to the nearest of some; None without a path."""
    if not joint[start]:
        return None
    lengths, _ = MCP_Geometric(np.where(joint, 1.0, -1.0)).find_costs([start])
    shortest = min(lengths[end] for end in ends)
    return shortest if math.isfinite(shortest) else None


def vertical_lengths(joint):
    height, width = joint.shape
    lengths, column = [], 10
    while column < width - 10:
        length = shortest_to(joint, (0, column), {(height - 1, column)})
        if length is not None:
            lengths.append(length)
        column += width // 10
    return sorted(lengths)


def vertical_arrangement(joint):
    """F_AV as DESIGN 5 words it; F_AH is that of the transposed joint image."""
    straight = joint.shape[0] - 1
    smallest = vertical_lengths(joint)[:5]
    if not smallest:
        return None
    return sum(100 * (length - straight) / straight for length in smallest) / len(smallest)


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
    excesses = []
    for start, end in ((0, last), (last, 0)):
        ends = {(end, column) for column in range(side)}
        for column in columns:
            length = shortest_to(joint, (start, column), ends)
            if length is None:
                return None
            excesses.append(100 * (length - last) / last)
    return sum(excesses) / len(excesses)


def level_deviation(labels, mean_stone_height):
    height, width = labels.shape
    profile = []
    for col in range(width):
        filled = [row for row in range(height) if labels[row, col]]
        profile.append(height - filled[0] if filled else 0)
    mean = sum(profile) / width
    return sum(abs(top - mean) for top in profile) / width / mean_stone_height


def flush_deviation(labels, left, right, mean_stone_width):
    gaps = []
    for row in labels:
        filled = [col for col in range(len(row)) if row[col]]
        if filled:
            gaps += [abs(filled[0] - left), abs(right - (filled[-1] + 1))]
    return sum(gaps) / len(gaps) / mean_stone_width


def mean_sizes(labels, wedge_ids):
    """Mean height and width of the stones' bounding boxes."""
    heights, widths = [], []
    for stone in {int(value) for value in labels.ravel()} - {0} - set(wedge_ids):
        rows, cols = np.nonzero(labels == stone)
        heights.append(rows.max() - rows.min() + 1)
        widths.append(cols.max() - cols.min() + 1)
    return sum(heights) / len(heights), sum(widths) / len(widths)
