"""Oracles of the simplex kernel: the whole program, written out, and solved in fractions."""

from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.naive import columns

OPTIMAL, UNSTABLE, UNBOUNDED = 0, 1, 2


class Whole(NamedTuple):
    """matrix x + alpha live = rhs, x >= 0, alpha free."""

    matrix: NDArray[np.float64]
    live: NDArray[np.float64]
    rhs: NDArray[np.float64]


def whole(optimum, added):
    """The program of a wall with a stone, without what is closed."""
    return Whole(*columns.program(optimum.cones, optimum.weights, added))


def exactly_solved(program, sign):
    """Status and alpha in fractions, without rounding: alpha as the difference of two unknowns."""
    live = program.live[:, None]
    costs = [0] * program.matrix.shape[1] + [-sign, sign]
    table = np.column_stack((program.matrix, live, -live))
    status, value = exact_minimum(table, program.rhs, costs)
    return status, None if value is None else -sign * value


def exact_minimum(columns, rhs, costs):
    """Least costs . x for columns x = rhs, x >= 0: tableau, two phases, Bland's rule, fractions."""
    rows, count = columns.shape
    table = []
    for i in range(rows):
        flip = -1 if rhs[i] < 0 else 1
        line = [flip * Fraction(float(v)) for v in columns[i]]
        line += [Fraction(int(i == j)) for j in range(rows)]
        table.append([*line, flip * Fraction(float(rhs[i]))])
    basic = list(range(count, count + rows))
    first = [Fraction(0)] * count + [Fraction(1)] * rows
    _bland(table, basic, first, count + rows)
    if any(table[i][-1] > 0 for i in range(rows) if basic[i] >= count):
        return UNSTABLE, None
    for i in range(rows):  # artificial ones that are left are 0, and go if they can
        if basic[i] >= count:
            for j in range(count):
                if table[i][j] != 0:
                    _pivot(table, basic, i, j)
                    break
    second = [Fraction(float(c)) for c in costs] + [Fraction(0)] * rows
    if not _bland(table, basic, second, count):
        return UNBOUNDED, None
    return OPTIMAL, sum((second[h] * table[i][-1] for i, h in enumerate(basic)), Fraction(0))


def _bland(table, basic, costs, allowed):
    while True:
        rows = range(len(table))
        entering = next(
            (
                j
                for j in range(allowed)
                if costs[j] - sum((costs[basic[i]] * table[i][j] for i in rows), Fraction(0)) < 0
            ),
            None,
        )
        if entering is None:
            return True
        able = [i for i in rows if table[i][entering] > 0]
        if not able:
            return False
        leaving = min(able, key=lambda i: (table[i][-1] / table[i][entering], basic[i]))
        _pivot(table, basic, leaving, entering)


def _pivot(table, basic, row, column):
    pivot = table[row][column]
    table[row] = [v / pivot for v in table[row]]
    for i, line in enumerate(table):
        if i != row and line[column] != 0:
            factor = line[column]
            table[i] = [v - factor * w for v, w in zip(line, table[row], strict=True)]
    basic[row] = column


def errors(optimum, added, answer):
    """What is wrong with the vectors of an answer, whatever it claims of itself."""
    program, v = whole(optimum, added), answer.velocity
    largest = max(1.0, np.abs(v).max())
    opening = program.matrix.T @ v
    if answer.status == UNSTABLE:
        v, opening = v / np.abs(v).max(), opening / np.abs(v).max()
        return {
            "closes": max(0.0, -opening.min(initial=0.0)),
            "live work": abs(program.live @ v),
            "no fall": max(0.0, 1e-6 + program.rhs @ v),
        }
    x = answer.forces
    balance = program.matrix @ x + answer.alpha * program.live - program.rhs
    return {
        "residual": np.abs(balance).max(),
        "violation": max(0.0, -x.min(initial=0.0)),
        "closes": max(0.0, -opening.min(initial=0.0)) / largest,
        "power": abs(optimum.sign * (program.live @ v) - 1.0) / largest,
        "gap": abs(optimum.sign * (program.rhs @ v) - answer.alpha),
    }
