"""Slow, obvious twins of drystone.kernels.cones."""

import numpy as np


def dense(cones, bodies):
    """The columns as a full matrix, three rows a body."""
    matrix = np.zeros((3 * bodies, len(cones.first)))
    for column, (first, second) in enumerate(zip(cones.first, cones.second, strict=True)):
        matrix[3 * first : 3 * first + 3, column] += cones.entries[:3, column]
        if second >= 0:
            matrix[3 * second : 3 * second + 3, column] += cones.entries[3:, column]
    return matrix


def program(wall, weights, added):
    """Matrix, live and rhs of a wall with a stone."""
    weights = np.concatenate((weights, added.weights))
    left = np.delete(dense(wall, len(weights)), added.closed, axis=1)
    matrix = np.concatenate((left, dense(added.cones, len(weights))), axis=1)
    live, rhs = np.zeros(len(matrix)), np.zeros(len(matrix))
    live[0::3], rhs[1::3] = weights, weights
    return matrix, live, rhs


def figures(wall, weights, added, alpha, forces, velocity):
    """The seven figures, by linear algebra."""
    matrix, live, rhs = program(wall, weights, added)
    powers = matrix.T @ velocity
    of_forces = (0.0, 0.0, 0.0)
    if len(forces):
        left = matrix @ forces + alpha * live - rhs
        of_forces = (
            np.abs(left).max(initial=0.0), max(0.0, -forces.min(initial=0.0)), np.abs(forces).sum()
        )  # fmt: skip
    return (
        *of_forces,
        np.abs(velocity).max(initial=0.0),
        max(0.0, -powers.min(initial=0.0)),
        live @ velocity,
        rhs @ velocity,
    )
