"""Interfaces between polygons: common pieces of edges, and corners that stand on an edge (§4.1)."""

import numpy as np

from drystone.kernels.polygons import Points
from drystone.statics.model import Interface


def touching_interfaces(
    block: int, polygon: Points, other: int, neighbour: Points, tolerance: float
) -> list[Interface]:
    """Find where two polygons touch; normals point into `block`.

    `polygon` and `neighbour` are (n, 2), counter-clockwise and closed: the first corner is repeated
    at the end.  A line that is not closed counts as well; its inside is to the left.  Gaps and
    overlaps up to the tolerance touch.  Straight pieces come in the order of the edges of
    `polygon`, then contacts at a point.  A corner that touches only a corner has no normal and is
    not a contact.
    """
    found = [
        Interface(block, other, ends, normal)
        for ends, normal in _common_pieces(polygon, neighbour, tolerance)
    ]
    taken = [interface.points for interface in found]
    resting = _corners_on_edges(polygon, neighbour, tolerance)
    carrying = [(p, (-x, -y)) for p, (x, y) in _corners_on_edges(neighbour, polygon, tolerance)]
    for point, normal in (*resting, *carrying):
        near = (np.hypot(*(ends - point).T).min() <= 2.0 * tolerance for ends in taken)
        if not any(near):
            found.append(Interface(block, other, point[None, :], normal))
            taken.append(point[None, :])
    return found


def _common_pieces(
    polygon: Points, neighbour: Points, tolerance: float
) -> list[tuple[Points, tuple[float, float]]]:
    """List the pieces on which edges run against each other, with the normal into `polygon`."""
    along, length, start = _edges(polygon)
    first_s, first_h = _in_edge_frames(along, start, neighbour[:-1])
    last_s, last_h = _in_edge_frames(along, start, neighbour[1:])
    run = last_s - first_s
    opposite = run < 0.0
    low, high = np.maximum(last_s, 0.0), np.minimum(first_s, length[:, None])
    slope = (last_h - first_h) / np.where(opposite, run, 1.0)
    gap = np.maximum(
        np.abs(first_h + slope * (low - first_s)), np.abs(first_h + slope * (high - first_s))
    )
    pieces = []
    for i, j in np.argwhere(opposite & (high - low > tolerance) & (gap <= tolerance)):
        ends = start[i] + np.outer([low[i, j], high[i, j]], along[i])
        pieces.append((ends, (float(-along[i, 1]), float(along[i, 0]))))
    return pieces


def _corners_on_edges(
    polygon: Points, neighbour: Points, tolerance: float
) -> list[tuple[Points, tuple[float, float]]]:
    """List the corners of `polygon` inside edges of `neighbour`, with the normal into `polygon`."""
    along, length, start = _edges(neighbour)
    s, h = _in_edge_frames(along, start, polygon[:-1])
    inside = (s > tolerance) & (s < length[:, None] - tolerance) & (np.abs(h) <= tolerance)
    return [
        (polygon[corner], (float(along[edge, 1]), float(-along[edge, 0])))
        for edge, corner in np.argwhere(inside)
    ]


def _edges(line: Points) -> tuple[Points, Points, Points]:
    """Return the unit vectors, lengths and starts of the edges of a line."""
    step = np.diff(line, axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    return step / length[:, None], length, line[:-1]


def _in_edge_frames(along: Points, start: Points, points: Points) -> tuple[Points, Points]:
    """Coordinates of points along (edges, points) and to the left of each edge."""
    relative = points[None, :, :] - start[:, None, :]
    s = relative @ along[:, :, None]
    h = along[:, None, 0] * relative[:, :, 1] - along[:, None, 1] * relative[:, :, 0]
    return s[:, :, 0], h
