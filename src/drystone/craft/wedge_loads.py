"""What wedges cannot help carrying."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, linprog
from scipy.sparse import csr_array, hstack

from drystone.statics.lp.program import EquilibriumProgram, assemble
from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.result import LimitStatus

INFEASIBLE = 2
"""Status of scipy's linprog when there are no forces in equilibrium."""


def least_wedge_loads(
    model: RigidBlockModel, wedge_ids: frozenset[int]
) -> Mapping[int, float] | LimitStatus:
    """Return the least load that each wedge passes on while the wall stands by its own weight.

    The forces between dry stones are not known from their weights alone.  For each wedge the
    state of equilibrium within friction is found in which that wedge carries least; so 0 means
    that the wall would stand without leaning on it.

    Parameters
    ----------
    model : RigidBlockModel
        Of the whole wall.
    wedge_ids : frozenset of int
        Blocks that are wedges.

    Returns
    -------
    mapping of int to float, or LimitStatus
        By id, the vertical force from what lies on the wedge, in weights of the model; UNSTABLE
        when the wall does not stand by its own weight, FAILED when the solver gave up.

    Examples
    --------
    >>> from drystone.contacts.given import model_from_json
    >>> pier, slab = [0, 0, 1, 1], [0, 1, 4, 1]
    >>> found = least_wedge_loads(model_from_json({"blocks_xywh": [pier, slab, [3, 0, 1, 1]]}),
    ...                           frozenset({3}))
    >>> round(found[3], 6)
    1.333333
    """
    if all(block.fixed for block in model.blocks):
        return dict.fromkeys(sorted(wedge_ids), 0.0)
    program = assemble(model)
    loads = {}
    for wedge in sorted(wedge_ids):
        found = _least_above_zero(_vertical(model, wedge), program)
        if not found.success:
            return LimitStatus.UNSTABLE if found.status == INFEASIBLE else LimitStatus.FAILED
        loads[wedge] = float(found.fun) * program.weight
    return loads


def _least_above_zero(costs: NDArray[np.float64], program: EquilibriumProgram) -> OptimizeResult:
    """Minimise what is the greater: 0, or costs . forces in equilibrium.

    A wedge between steep faces may be pulled down by friction as hard as one likes, so the costs
    alone need not have a least value.
    """
    forces = program.matrix[:, 1:]
    nothing = csr_array((forces.shape[0], 1))
    return linprog(
        np.append(np.zeros(len(costs)), 1.0),
        A_ub=csr_array(np.append(costs, -1.0)[None]),
        b_ub=[0.0],
        A_eq=hstack((forces, nothing)),
        b_eq=program.rhs,
        bounds=(0, None),
        method="highs",
    )


def _vertical(model: RigidBlockModel, wedge: int) -> NDArray[np.float64]:
    """Return what each edge of a friction cone presses onto a wedge from above."""
    values: list[float] = []
    for face in model.interfaces:
        normal, tangent = face.normal[1], -face.normal[0] * model.friction(face)
        on_it = 0.0
        if GROUND not in (face.block, face.other):
            if face.other == wedge and normal > 0:
                on_it = 1.0  # the force on what lies above is `block`'s
            elif face.block == wedge and normal < 0:
                on_it = -1.0
        for _ in face.points:
            values += [on_it * (normal + tangent), on_it * (normal - tangent)]
    return np.array(values)
