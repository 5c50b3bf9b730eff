"""Slow, obvious twin of drystone.statics.flow.nonassociative: all sets of contact states."""

import highspy
import numpy as np
from scipy.sparse import csc_array

from tests.naive.statics import contact_matrices

STATES = ("open", "stick", "slide+", "slide-")
"""Of a contact point; "slide+" along its tangent."""

INF = highspy.kHighsInf
ANSWERS = (highspy.HighsModelStatus.kOptimal, highspy.HighsModelStatus.kInfeasible)

MOTION = {
    "open": ((0.0, INF), (-INF, INF)),
    "stick": ((0.0, 0.0), (0.0, 0.0)),
    "slide+": ((0.0, 0.0), (0.0, INF)),
    "slide-": ((0.0, 0.0), (-INF, 0.0)),
}
"""Bounds of the rates of opening and slip."""


def all_limits(model, direction):
    """Least load multipliers of the non-associative problem, one for each set of contact states.

    States are given to one contact point after another; a branch ends where no forces or no
    motion are left, whatever the other points do.
    """
    normal, tangent = contact_matrices(model)
    dead, live = np.zeros((2, len(normal)))
    live[0::3] = dead[1::3] = [-block.weight for block in model.blocks]
    live = live if direction == "left" else -live
    forces = _forces(normal, tangent, live, dead, model.mu)
    return list(_branch(normal.shape, _motions(normal, tangent, live), forces, []))


def _branch(shape, motions, forces, states):
    size, count = shape
    if _least(motions, 0, 0.0) is None:
        return
    least = _least(forces, 0, 1.0)
    if least is None:
        return
    k = len(states)
    if k == count:
        yield least
        return
    normal, up, down = 1 + 2 * k, size + 2 * k, size + 2 * k + 1
    for state in STATES:
        opens, slips = MOTION[state]
        motions.changeRowBounds(k, *opens)
        motions.changeRowBounds(count + k, *slips)
        forces.changeColBounds(normal, 0.0, 0.0 if state == "open" else INF)
        # Full friction against the slip: t = -mu n along the tangent, t = mu n against it.
        forces.changeRowBounds(up, 0.0 if state == "slide-" else -INF, 0.0)
        forces.changeRowBounds(down, 0.0 if state == "slide+" else -INF, 0.0)
        yield from _branch(shape, motions, forces, [*states, state])
    motions.changeRowBounds(k, 0.0, INF)
    motions.changeRowBounds(count + k, -INF, INF)
    forces.changeColBounds(normal, 0.0, INF)
    forces.changeRowBounds(up, -INF, 0.0)
    forces.changeRowBounds(down, -INF, 0.0)


def _motions(normal, tangent, live):
    """Rates of opening, rates of slip, and the power of the live load by velocities of blocks."""
    count = normal.shape[1]
    rows = np.vstack((normal.T, tangent.T, live))
    least = np.concatenate((np.zeros(count), np.full(count, -INF), [1.0]))
    greatest = np.concatenate((np.full(2 * count, INF), [1.0]))
    free = np.full(len(live), INF)
    return _program(rows, least, greatest, -free, free)


def _forces(normal, tangent, live, dead, mu):
    """Equilibrium, and t - mu n and -t - mu n at each point, by alpha and all n and t."""
    size, count = normal.shape
    rows = np.zeros((size + 2 * count, 1 + 2 * count))
    rows[:size, 0], rows[:size, 1::2], rows[:size, 2::2] = live, normal, tangent
    for k in range(count):
        rows[size + 2 * k, 1 + 2 * k : 3 + 2 * k] = (-mu, 1.0)
        rows[size + 2 * k + 1, 1 + 2 * k : 3 + 2 * k] = (-mu, -1.0)
    least = np.concatenate((-dead, np.full(2 * count, -INF)))
    greatest = np.concatenate((-dead, np.zeros(2 * count)))
    lowest = np.full(1 + 2 * count, -INF)
    lowest[1::2] = 0.0
    return _program(rows, least, greatest, lowest, np.full(1 + 2 * count, INF))


def _least(highs, column, cost):
    """Least of cost times one unknown, or None when nothing is feasible."""
    highs.changeColCost(column, cost)
    highs.run()
    if highs.getModelStatus() not in ANSWERS:
        highs.clearSolver()  # a warm start that went wrong
        highs.run()
    status = highs.getModelStatus()
    assert status in ANSWERS
    feasible = status == highspy.HighsModelStatus.kOptimal
    return cost * highs.getSolution().col_value[column] if feasible else None


def _program(rows, least, greatest, lowest, highest):
    highs = highspy.Highs()
    for name, value in (("output_flag", False), ("presolve", "off"), ("threads", 1)):
        highs.setOptionValue(name, value)
    table = csc_array(rows)
    count, columns = rows.shape
    highs.passModel(
        columns, count, table.nnz, 1, 1, 0.0, np.zeros(columns), lowest, highest, least, greatest,
        table.indptr.astype(np.int32), table.indices.astype(np.int32), table.data,
        np.zeros(columns, np.int32),
    )  # fmt: skip
    return highs
