"""Slow, obvious twins of drystone.statics and drystone.kernels.boundary."""

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csc_array

from drystone.statics.model import GROUND

Pair = tuple[int, int]
Edge = frozenset[tuple[int, int]]


def pixel_edges(labels):
    """Unit edges between each pair of labels, as sets of two wall-frame corners (x, y)."""
    height, width = labels.shape
    edges = {}

    def label(x, y):
        """Of the pixel whose lower left corner is (x, y); -1 where nothing is."""
        if y < 0:
            return GROUND
        inside = 0 <= x < width and y < height
        return int(labels[height - 1 - y, x]) or -1 if inside else -1

    for x in range(width):
        for y in range(height):
            for (dx, dy), ends in (
                ((0, -1), ((x, y), (x + 1, y))),
                ((1, 0), ((x + 1, y), (x + 1, y + 1))),
            ):
                a, b = label(x, y), label(x + dx, y + dy)
                if a != b and min(a, b) >= 0:
                    edges.setdefault((max(a, b), min(a, b)), set()).add(frozenset(ends))
    return edges


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


def limit_alphas(model):
    """Least upper bounds of alpha to the left and right; None when unstable by itself.

    Forces are normal and tangential, friction is two inequalities (Eq. 23c), nothing is scaled.
    """
    rows = {block.id: 3 * i for i, block in enumerate(model.blocks)}
    contacts = [(i, p) for i in model.interfaces for p in i.points]
    count = 1 + 2 * len(contacts)
    equilibrium = np.zeros((3 * len(model.blocks), count))
    friction = np.zeros((2 * len(contacts), count))
    dead = np.zeros(3 * len(model.blocks))
    for block in model.blocks:
        equilibrium[rows[block.id], 0] = block.weight
        dead[rows[block.id] + 1] = block.weight
    centroid = {block.id: block.centroid for block in model.blocks}
    for k, (interface, (px, py)) in enumerate(contacts):
        nx, ny = interface.normal
        for column, (fx, fy) in ((1 + 2 * k, (nx, ny)), (2 + 2 * k, (ny, -nx))):
            for block, sign in ((interface.block, 1), (interface.other, -1)):
                if block == GROUND:
                    continue
                cx, cy = centroid[block]
                moment = (px - cx) * fy - (py - cy) * fx
                at = rows[block]
                equilibrium[at : at + 3, column] = sign * np.array([fx, fy, moment])
        friction[2 * k, 1 + 2 * k : 3 + 2 * k] = (-model.mu, 1)
        friction[2 * k + 1, 1 + 2 * k : 3 + 2 * k] = (-model.mu, -1)
    forces = [bounds for _ in contacts for bounds in ((0, None), (None, None))]

    def solve(sign, highest):
        push = equilibrium.copy()
        push[:, 0] *= sign
        answer = linprog(
            np.eye(count)[0] * -1,
            A_ub=friction,
            b_ub=np.zeros(len(friction)),
            A_eq=push,
            b_eq=dead,
            bounds=[(0, highest), *forces],
        )
        assert answer.status in (0, 2)
        return -answer.fun if answer.status == 0 else None

    if solve(1.0, 0.0) is None:
        return None
    left, right = solve(-1.0, None), solve(1.0, None)
    assert left is not None
    assert right is not None
    return left, right


def cone_program(model):
    """Matrix and right-hand side of the tilting table, entry by entry.

    Column 0 is alpha, then come the two edges of the friction cone of every contact point; mean
    weight and mean area of the blocks are 1.
    """
    weight = sum(block.weight for block in model.blocks) / len(model.blocks)
    length = (sum(block.area for block in model.blocks) / len(model.blocks)) ** 0.5
    place = {block.id: 3 * i for i, block in enumerate(model.blocks)}
    centroid = {block.id: block.centroid for block in model.blocks}
    dead = np.zeros(3 * len(model.blocks))
    entries = []
    for block in model.blocks:
        entries.append((place[block.id], 0, block.weight / weight))
        dead[place[block.id] + 1] = block.weight / weight
    column = 0
    for interface in model.interfaces:
        mu = model.friction(interface)
        nx, ny = interface.normal
        for px, py in interface.points.tolist():
            for along in (mu, -mu):
                column += 1
                for block_id, sign in ((interface.block, 1), (interface.other, -1)):
                    if block_id == GROUND:
                        continue
                    fx, fy = sign * (nx + along * ny), sign * (ny - along * nx)
                    cx, cy = centroid[block_id]
                    moment = ((px - cx) * fy - (py - cy) * fx) / length
                    at = place[block_id]
                    entries += [(at, column, fx), (at + 1, column, fy), (at + 2, column, moment)]
    rows, columns, values = zip(*entries, strict=True)
    return csc_array((values, (rows, columns)), shape=(dead.size, column + 1)), dead


def alphas_by_linprog(model):
    """alpha to the left and right, each from the start; None when the blocks do not stand."""
    matrix, dead = cone_program(model)
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
