"""Slow, obvious twins of what finds contacts in label images (§4.2)."""

import math
from itertools import pairwise

import numpy as np
from scipy import ndimage

from tests.naive.statics import diagonal_touches

TOLERANCE_PX = math.sqrt(2.0)


def interfaces(labels):
    """Larger id, smaller id, points and normal of every interface, in their order."""
    found = []
    for (high, low), edges in sorted(directed_edges(labels).items()):
        for chain in chains(edges):
            for piece in split(chain):
                run = without_hooks(piece)
                points = [tuple(map(float, node)) for node in (run[0], run[-1])]
                found.append((high, low, points, fitted_normal(run)))
    touches = sorted(diagonal_touches(labels), key=lambda touch: (-touch[3], touch[2]))
    for high, low, x, y in touches:
        found.append((high, low, [(float(x), float(y))], normal_at_point(labels, x, y)))
    return found


def directed_edges(labels):
    """Unit edges in the wall frame for each pair of labels, with the larger one to the left."""
    height, width = labels.shape
    edges = {}
    for y in range(-1, height):
        for x in range(-1, width):
            here = pixel(labels, x, y)
            for there, ends in (
                (pixel(labels, x, y + 1), ((x + 1, y + 1), (x, y + 1))),  # here to the left
                (pixel(labels, x + 1, y), ((x + 1, y), (x + 1, y + 1))),
            ):
                if here == there or min(here, there) < 0:
                    continue
                directed = ends if here > there else ends[::-1]
                edges.setdefault((max(here, there), min(here, there)), set()).add(directed)
    return edges


def pixel(labels, x, y):
    """Label of the pixel whose lower left corner is (x, y): 0 for the ground, -1 for nothing."""
    height, width = labels.shape
    if y < 0:
        return 0
    inside = 0 <= x < width and y < height
    return int(labels[height - 1 - y, x]) or -1 if inside else -1


def chains(edges):
    """Edges one after the other, turning left where there is a choice."""

    def following(edge):
        (x0, y0), (x1, y1) = edge
        choices = [other for other in edges if other[0] == (x1, y1)]
        turns = {
            (x1 - x0) * (y2 - y1) - (y1 - y0) * (x2 - x1): (start, (x2, y2))
            for start, (x2, y2) in choices
        }
        return turns[max(turns)] if turns else None

    left = set(edges)
    followed = {following(edge) for edge in edges}
    closed_starts = sorted(edge for edge in edges if edge in followed)  # leftmost, then lowest
    found = []
    for start in [*sorted(edges - followed), *closed_starts]:
        if start not in left:
            continue
        nodes, at = [start[0]], start
        while at in left:
            left.remove(at)
            nodes.append(at[1])
            at = following(at)
        found.append(nodes)
    return sorted(found, key=lambda nodes: (nodes[0][1], nodes[0][0]))


def split(points):
    """Douglas and Peucker (1973), by distances."""
    (x0, y0), (x1, y1) = points[0], points[-1]
    length = math.hypot(x1 - x0, y1 - y0)

    def away(point):
        x, y = point[0] - x0, point[1] - y0
        if length == 0.0:
            return math.hypot(x, y) + TOLERANCE_PX
        return abs((x1 - x0) * y - (y1 - y0) * x) / length

    distances = [away(point) for point in points[1:-1]]
    if not distances or max(distances) <= TOLERANCE_PX:
        return [points]
    middle = 1 + distances.index(max(distances))
    return split(points[: middle + 1]) + split(points[middle:])


def without_hooks(run):
    """Leave out an edge that turns off after three edges in one direction, at both ends."""
    for _ in range(2):
        steps = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(run)]
        if len(steps) >= 4 and steps[-4] == steps[-3] == steps[-2]:
            (x0, y0), (x1, y1) = steps[-2], steps[-1]
            if x0 * x1 + y0 * y1 == 0:
                run = run[:-1]
        run = run[::-1]
    return run


def fitted_normal(run):
    """Unit normal to the left of the line fitted to the midpoints of edges, by an angle."""
    nodes = np.array(run, float)
    x, y = ((nodes[1:] + nodes[:-1]) / 2.0).T
    x, y = x - x.mean(), y - y.mean()
    xx, xy, yy = float((x * x).sum()), float((x * y).sum()), float((y * y).sum())
    chord_x, chord_y = nodes[-1] - nodes[0]
    angle = math.atan2(chord_y, chord_x)
    if max(abs(xx - yy), abs(xy)) > 1e-9:
        angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    along_x, along_y = math.cos(angle), math.sin(angle)
    sign = -1.0 if along_x * chord_x + along_y * chord_y < -1e-9 else 1.0
    return -sign * along_y, sign * along_x


def normal_at_point(labels, x, y):
    """First moments of two stones around their common corner; up where these say nothing."""
    on_right = pixel(labels, x, y) > 0
    above, below = pixel(labels, x - (not on_right), y), pixel(labels, x - on_right, y - 1)
    normal = np.zeros(2)
    for stone, sign in ((above, 1), (below, -1)):
        arms = [
            (right, up)
            for right in np.arange(-2.5, 3.0)
            for up in np.arange(-2.5, 3.0)
            if pixel(labels, math.floor(x + right), math.floor(y + up)) == stone
        ]
        toward = sign if on_right else -sign
        outside = [arm for arm in arms if not (arm[0] * toward > 0 and arm[1] * sign > 0)]
        normal += sign * len(outside) * np.sum(arms, axis=0)
    if not normal.any():
        normal = np.array([0.0, 1.0])
    if above < below:
        normal = -normal
    right, up = (normal / math.hypot(*normal)).tolist()
    return right, up


def pieces_apart(labels):
    """For each id in several pieces: its pixels that are not in the largest one."""
    apart = {}
    for block in np.unique(labels[labels > 0]).tolist():
        pieces, count = ndimage.label(labels == block, np.ones((3, 3)))
        sizes = np.bincount(pieces.ravel())[1:]
        if count > 1:
            apart[block] = int(sizes.sum() - sizes.max())
    return apart
