"""Oracles of the simplex kernel: the whole program, written out, and solved by HiGHS."""

import numpy as np
from scipy.optimize import linprog

from tests.naive.columns import program

OPTIMAL, UNSTABLE, UNBOUNDED = 0, 1, 2


def solved(matrix, live, rhs, sign):
    """Status and alpha by HiGHS: first whether there is a solution at all, then the best."""
    equations = {
        "A_eq": np.column_stack((matrix, live)),
        "b_eq": rhs,
        "bounds": [(0, None)] * matrix.shape[1] + [(None, None)],
    }
    costs = np.zeros(matrix.shape[1] + 1)
    if linprog(costs, **equations).status != 0:
        return UNSTABLE, None
    costs[-1] = -sign
    found = linprog(costs, **equations)
    return (OPTIMAL, found.x[-1]) if found.status == 0 else (UNBOUNDED, None)


def errors(optimum, added, answer):
    """What is wrong with the vectors of an answer, whatever it claims of itself."""
    matrix, live, rhs = program(optimum.cones, optimum.weights, added)
    v = answer.velocity
    largest = max(1.0, np.abs(v).max())
    opening = matrix.T @ v
    if answer.status == UNSTABLE:
        v, opening = v / np.abs(v).max(), opening / np.abs(v).max()
        return {
            "closes": max(0.0, -opening.min(initial=0.0)),
            "live work": abs(live @ v),
            "no fall": max(0.0, 1e-6 + rhs @ v),
        }
    x = answer.forces
    balance = matrix @ x + answer.alpha * live - rhs
    return {
        "residual": np.abs(balance).max(),
        "violation": max(0.0, -x.min(initial=0.0)),
        "closes": max(0.0, -opening.min(initial=0.0)) / largest,
        "power": abs(optimum.sign * (live @ v) - 1.0) / largest,
        "gap": abs(optimum.sign * (rhs @ v) - answer.alpha),
    }
