"""The limit analysis by scipy.optimize.linprog, from the start for each tilt: the reference."""

import numpy as np
from scipy.optimize import linprog

from drystone.statics.lp.program import assemble
from drystone.statics.model import RigidBlockModel

TOLERANCE = 1e-10
"""Primal and dual feasibility; with those of SciPy, 1e-7, alpha is off by up to 6e-8."""

Range = tuple[float, float] | None
"""Least and greatest alpha; None when no alpha holds the blocks up."""


def fresh_linprog(model: RigidBlockModel) -> Range:
    """Solve both tilts, each from the start.

    Parameters
    ----------
    model : RigidBlockModel
        With at least one free block.

    Returns
    -------
    Range

    Raises
    ------
    RuntimeError
        When linprog neither solves a program nor finds that it has no solution.

    Examples
    --------
    >>> from drystone.contacts.given import model_from_json
    >>> pile = model_from_json({"blocks_xywh": [[0, 0, 1, 2]], "mu": 0.58})
    >>> least, greatest = fresh_linprog(pile)
    >>> round(least, 9), round(greatest, 9)
    (-0.5, 0.5)
    """
    program = assemble(model)
    bounds = np.zeros((program.column_count, 2))
    bounds[:, 1] = np.inf
    bounds[0, 0] = -np.inf
    costs = np.zeros(program.column_count)
    ends = []
    for sign in (-1.0, 1.0):
        costs[0] = -sign
        answer = linprog(
            costs,
            A_eq=program.matrix,
            b_eq=program.rhs,
            bounds=bounds,
            options={
                "primal_feasibility_tolerance": TOLERANCE,
                "dual_feasibility_tolerance": TOLERANCE,
            },
        )
        if answer.status == 2:
            return None
        if answer.status != 0:
            raise RuntimeError(f"linprog gave up: {answer.message}")
        ends.append(float(answer.x[0]))
    return ends[0], ends[1]
