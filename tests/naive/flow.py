"""Slow, obvious twins of drystone.statics.flow: all sets of states of the contact points."""

import numpy as np
from scipy.optimize import linprog

from tests.naive.statics import contact_matrices

UNBOUNDED = 3
"""Status of linprog."""

NO_POWER = 1e-6
"""Of free fall of a block of weight 1."""


def least_limit(model, direction):
    """Least load multiplier of the non-associative problem, by all sets of contact states."""
    points = _Points(model)
    live = np.roll(points.dead, -1) * (1.0 if direction == "left" else -1.0)
    still = np.zeros((points.size, points.size))
    # The live load does work; alpha times it is in balance with the weight and the forces.
    work = np.concatenate((live, np.zeros(points.count), [0.0]))
    balance = np.column_stack((still, points.rates.T, live))
    alpha = np.eye(len(work))[-1]
    return points.least(alpha, (np.vstack((work, balance)), [1.0, *-points.dead]), np.inf, {})


def falls(model):
    """Whether weight does work on an acceleration that obeys Newton and Coulomb."""
    points = _Points(model)
    costs = np.concatenate((-points.dead, np.zeros(points.count)))
    newton = np.hstack((np.diag(points.mass), -points.rates.T))
    return points.least(costs, (newton, points.dead), -NO_POWER, {}) < -NO_POWER


class _Points:
    """Unknown are how blocks move, and a normal and a tangential force at every contact point."""

    def __init__(self, model):
        free = [block for block in model.blocks if not block.fixed]
        normal, tangent = contact_matrices(model)
        self.rates = np.stack((normal.T, tangent.T), axis=1).reshape(-1, len(normal))
        self.count, self.size = self.rates.shape
        self.mu = [model.friction(i) for i in model.interfaces for _ in i.points]
        self.mass = np.array([[b.weight, b.weight, b.weight * b.area / 6.0] for b in free]).ravel()
        self.dead = np.array([[0.0, -b.weight, 0.0] for b in free]).ravel()

    def least(self, costs, equations, best, states):
        """Least costs of all sets of states, or the best that is known.

        States are given to one contact point after another that needs one; a branch ends where
        nothing better is left, whatever the other points do.
        """
        found = self.optimum(costs, equations, states)
        least = {0: found.fun, UNBOUNDED: -np.inf}.get(found.status, np.inf)
        undecided = [k for k in range(len(self.mu)) if k not in states]
        if least < best - 1e-9 and undecided and found.status == 0:
            opening, slip = (self.rates @ found.x[: self.size]).reshape(-1, 2).T
            normal, along = found.x[self.size : self.size + self.count].reshape(-1, 2).T
            spare = self.mu * normal + np.sign(slip) * along
            wrong = np.maximum(np.minimum(opening, normal), np.minimum(np.abs(slip), spare))
            undecided = [k for k in np.argsort(-wrong) if wrong[k] > 1e-7 and k not in states]
        if not undecided:
            return min(least, best)
        if least < best - 1e-9:
            for state in ("open", "stick", "slide+", "slide-"):
                best = self.least(costs, equations, best, {**states, undecided[0]: state})
        return best

    def optimum(self, costs, equations, states):
        """Solve with the states of some contact points given; "slide+" is along the tangent."""
        above, zero = [], []  # combinations of the unknowns that are at least 0, and that are 0
        unknown = np.eye(len(costs))
        rates = self.rates @ unknown[: self.size]
        forces = unknown[self.size : self.size + self.count]
        for k, mu in enumerate(self.mu):
            (opening, slip), (normal, along) = rates[2 * k : 2 * k + 2], forces[2 * k : 2 * k + 2]
            above += [opening, normal, mu * normal - along, mu * normal + along]
            state = states.get(k, "")
            if state == "open":
                zero += [normal, along]
            elif state:
                zero.append(opening)
            if state == "stick":
                zero.append(slip)
            elif state == "slide+":
                above.append(slip)
                zero.append(along + mu * normal)
            elif state == "slide-":
                above.append(-slip)
                zero.append(along - mu * normal)
        matrix, values = equations
        return linprog(
            costs,
            A_ub=-np.array(above),
            b_ub=np.zeros(len(above)),
            A_eq=np.vstack((matrix, *zero)),
            b_eq=np.concatenate((values, np.zeros(len(zero)))),
            bounds=(None, None),
            options={"presolve": False},  # with it, some unbounded problems are called infeasible
        )
