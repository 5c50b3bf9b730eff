"""What wedges cannot help carrying."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.program import assemble


def least_wedge_loads(
    model: RigidBlockModel, wedge_ids: frozenset[int]
) -> Mapping[int, float] | None:
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
    mapping of int to float, or None
        By id, the vertical force from what lies on the wedge, in weights of the model; None when
        the wall does not stand by its own weight.

    Examples
    --------
    >>> from drystone.statics.contacts.given import model_from_json
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
        cost = _vertical(model, wedge)
        found = linprog(
            cost, A_eq=program.matrix[:, 1:], b_eq=program.rhs, bounds=(0, None), method="highs"
        )
        if not found.success:
            return None
        loads[wedge] = max(0.0, float(found.fun)) * program.weight
    return loads


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
