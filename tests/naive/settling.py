"""Slow, obvious twins of drystone.kernels.gaps and drystone.kernels.settling."""

import math
from itertools import pairwise

import numpy as np
import shapely
from scipy.optimize import linprog

Pose = tuple[float, float, float]


def placed(outline, pose):
    """An outline turned and moved."""
    turn = shapely.affinity.rotate(shapely.Polygon(outline), pose[2], (0, 0), use_radians=True)
    moved = shapely.affinity.translate(turn, pose[0], pose[1])
    return np.array(moved.exterior.coords)[:-1]


def distances(corners, around, width):
    """To each polygon, the ground and the two ends of the wall; below 0 beyond these."""
    shape = shapely.Polygon(corners)
    others = [shape.distance(shapely.Polygon(around.polygon(i))) for i in range(len(around))]
    left, low, right, _ = shape.bounds
    return [*others, low, left, width - right]


def overlap_area(corners, around):
    """What a polygon has in common with others."""
    shape = shapely.Polygon(corners)
    others = [shapely.Polygon(around.polygon(i)) for i in range(len(around))]
    return float(sum(shape.intersection(other).area for other in others))


def contacts(corners, around, tolerance):
    """Corners in front of edges, and pairs of corners with all normals that their edges have."""
    sure = [(x, y, 0.0, 1.0) for x, y in corners.tolist() if y <= tolerance]
    doubtful = []
    for i in range(len(around)):
        other = around.polygon(i)
        for a, b, sign in ((corners, other, 1.0), (other, corners, -1.0)):
            for x, y in a.tolist():
                near = _near_edges(b, x, y, tolerance)
                sure += [(x, y, sign * nx, sign * ny) for nx, ny in near]
        for x, y in corners.tolist():
            close = np.hypot(*(other - (x, y)).T) <= tolerance
            doubtful += [
                tuple((x, y, nx, ny) for nx, ny in _all_normals(corners, -1.0))
                + tuple((x, y, nx, ny) for nx, ny in _all_normals(other, 1.0))
                for _ in range(int(np.count_nonzero(close)))
            ]
    return sure, doubtful


def _near_edges(polygon, x, y, tolerance):
    """Outward normals of the edges that a point lies in front of, so near."""
    found = []
    for a, b in pairwise([*polygon.tolist(), polygon[0].tolist()]):
        length = math.dist(a, b)
        ux, uy = (b[0] - a[0]) / length, (b[1] - a[1]) / length
        along = (x - a[0]) * ux + (y - a[1]) * uy
        away = (x - a[0]) * uy - (y - a[1]) * ux
        if 0.0 <= along <= length and 0.0 <= away <= tolerance:
            found.append((uy, -ux))
    return found


def _all_normals(polygon, sign):
    """Normals of all edges: outwards, or inwards with sign -1."""
    along = np.roll(polygon, -1, axis=0) - polygon
    along /= np.hypot(*along.T)[:, None]
    return [(sign * uy, -sign * ux) for ux, uy in along.tolist()]


def unbalanced(points, centroid, arm, mu):
    """How much of a unit weight contact forces with friction cannot carry: 0 when it rests.

    Forces along both edges of each cone are sought that leave the least horizontal force,
    vertical force and moment over the arm, added up without their signs.
    """
    columns = []
    for x, y, nx, ny in points:
        for sign in (1.0, -1.0):
            fx, fy = nx + sign * mu * ny, ny - sign * mu * nx
            columns.append((fx, fy, ((x - centroid[0]) * fy - (y - centroid[1]) * fx) / arm))
    forces = np.array(columns).reshape(-1, 3).T
    rest = np.hstack([np.eye(3), -np.eye(3)])
    cost = np.concatenate([np.zeros(forces.shape[1]), np.ones(6)])
    found = linprog(cost, A_eq=np.hstack([forces, rest]), b_eq=[0.0, 1.0, 0.0], method="highs")
    assert found.status == 0
    return float(found.fun)
