"""Slow, obvious twins of drystone.statics and drystone.kernels.boundary."""

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csc_array

from drystone.statics.model import GROUND


def diagonal_touches(labels):
    """(larger id, smaller id, x, y) where two labels touch across two empty pixels."""
    height, width = labels.shape
    found = set()
    for row in range(1, height):
        for col in range(1, width):
            (a, b), (c, d) = labels[row - 1 : row + 1, col - 1 : col + 1].tolist()
            for first, second, beside, beneath in ((a, d, b, c), (b, c, a, d)):
                if first and second and first != second and not beside and not beneath:
                    found.add((max(first, second), min(first, second), col, height - row))
    return found


def contact_matrices(model):
    """How a unit normal and tangential force at each contact point act on the free blocks.

    Two matrices with three rows a block: force to the right, upwards, and moment.
    """
    free = [block for block in model.blocks if not block.fixed]
    rows = {block.id: 3 * i for i, block in enumerate(free)}
    centroid = {block.id: block.centroid for block in free}
    points = [(i, p) for i in model.interfaces for p in i.points]
    normal, tangent = np.zeros((2, 3 * len(free), len(points)))
    for k, (interface, (px, py)) in enumerate(points):
        nx, ny = interface.normal
        for matrix, (fx, fy) in ((normal, (nx, ny)), (tangent, (ny, -nx))):
            for block, side in ((interface.block, 1.0), (interface.other, -1.0)):
                if block in rows:
                    cx, cy = centroid[block]
                    moment = (px - cx) * fy - (py - cy) * fx
                    matrix[rows[block] : rows[block] + 3, k] = side * np.array([fx, fy, moment])
    return normal, tangent


def cones(model):
    """How forces along both edges of the friction cone of every contact point act, and its mu."""
    normal, tangent = contact_matrices(model)
    mu = np.array([model.friction(i) for i in model.interfaces for _ in i.points])
    edges = np.stack((normal + mu * tangent, normal - mu * tangent), axis=2)
    return edges.reshape(len(edges), -1), mu


def alphas_by_linprog(model):
    """alpha to the left and right, each from the start; None when the blocks do not stand.

    Unknown are alpha and the forces along both edges of the friction cone of every contact point;
    mean weight and mean area of the blocks are 1.
    """
    edges, _ = cones(model)
    live, dead = np.zeros((2, len(edges)))
    weights = np.array([block.weight for block in model.blocks])
    live[0::3] = dead[1::3] = weights / weights.mean()
    matrix = np.column_stack((live, edges))
    matrix[2::3] /= np.mean([block.area for block in model.blocks]) ** 0.5
    matrix = csc_array(matrix)
    costs = np.zeros(matrix.shape[1])
    bounds = [(None, None)] + [(0, None)] * (matrix.shape[1] - 1)
    tight = {"primal_feasibility_tolerance": 1e-9, "dual_feasibility_tolerance": 1e-9}
    ends = []
    for sign in (-1.0, 1.0):
        costs[0] = -sign
        answer = linprog(costs, A_eq=matrix, b_eq=dead, bounds=bounds, options=tight)
        assert answer.status in (0, 2), answer.message
        if answer.status == 2:
            return None
        ends.append(-answer.fun)
    # No load at all is the load 0.
    return (ends[0], ends[1]) if min(ends) >= -1e-9 else None


def least_wedge_loads(model):
    """What each block has to bear from above at least, from the start; none bears less than 0."""
    edges, mu = cones(model)
    faces = [face for face in model.interfaces for _ in face.points]
    matrix = np.column_stack((edges, np.zeros(len(edges))))
    dead = np.zeros(len(matrix))
    dead[1::3] = [block.weight for block in model.blocks]
    loads = {}
    for block in model.blocks:
        pressed = []
        for face, rough in zip(faces, mu, strict=True):
            (x, y), under = face.normal, {face.block: -1.0, face.other: 1.0}.get(block.id, 0.0)
            counts = under if under * y > 0 and GROUND not in (face.block, face.other) else 0.0
            pressed += [counts * (y - rough * x), counts * (y + rough * x)]
        last = [0.0] * len(pressed) + [1.0]
        answer = linprog(last, A_ub=[[*pressed, -1.0]], b_ub=[0.0], A_eq=matrix, b_eq=dead)
        loads[block.id] = answer.fun
    return loads
