"""Slow, obvious twin of drystone.statics.flow.release: all sets of contact states."""

import numpy as np
from scipy.optimize import linprog

from tests.naive.nonassociative import STATES
from tests.naive.statics import contact_matrices

UNBOUNDED = 3
"""Status of linprog."""

NO_POWER = 1e-6
"""Of free fall of a block of weight 1."""


def greatest_power_of_a_fall(model):
    """Most work that weight does on an acceleration that obeys Newton and Coulomb; 0 at rest.

    Unknown are the acceleration and a normal and a tangential force at every contact point.
    States are given to one contact point after another; a branch ends where no power is left,
    whatever the other points do.
    """
    return _branch(_Problem(model), [])


class _Problem:
    def __init__(self, model):
        free = [block for block in model.blocks if not block.fixed]
        normal, tangent = contact_matrices(model)
        self.rates = np.stack((normal.T, tangent.T), axis=1).reshape(-1, len(normal))
        self.mu = [model.friction(i) for i in model.interfaces for _ in i.points]
        mass = np.array([[b.weight, b.weight, b.weight * b.area / 6.0] for b in free])
        self.dead = np.array([[0.0, -b.weight, 0.0] for b in free]).ravel()
        self.newton = np.hstack((np.diag(mass.ravel()), -self.rates.T))


def _branch(problem, states):
    power = _power(problem, states)
    if power < NO_POWER:
        return 0.0
    if len(states) == len(problem.mu):
        return power
    return max(_branch(problem, [*states, state]) for state in STATES)


def _power(problem, states):
    """Greatest power with the states of the first contact points given; 0 where there is none."""
    size, rows = len(problem.dead), len(problem.rates)
    above = []  # combinations of the unknowns that are at least 0
    zero = []
    for k, mu in enumerate(problem.mu):
        opening, slip = (
            np.concatenate((r, np.zeros(rows))) for r in problem.rates[2 * k : 2 * k + 2]
        )
        normal, along = np.zeros((2, size + rows))
        normal[size + 2 * k] = along[size + 2 * k + 1] = 1.0
        above += [opening, normal, mu * normal - along, mu * normal + along]
        state = states[k] if k < len(states) else ""
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
    equations = np.vstack((problem.newton, *zero))
    found = linprog(
        -np.concatenate((problem.dead, np.zeros(rows))),
        A_ub=-np.array(above),
        b_ub=np.zeros(len(above)),
        A_eq=equations,
        b_eq=np.concatenate((problem.dead, np.zeros(len(zero)))),
        bounds=[(None, None)] * (size + rows),
        options={"presolve": False},  # with it, some unbounded problems are called infeasible
    )
    if found.status == UNBOUNDED:  # squeezed without end: decided contacts will tell
        return np.inf
    return -float(found.fun) if found.status == 0 else 0.0
