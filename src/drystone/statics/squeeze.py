"""Blocks that are held by their own squeeze: by friction on upright faces alone (DESIGN 4.8)."""

from dataclasses import replace

import numpy as np
from scipy.sparse import csc_array

from drystone.statics.flow.release import CLEAR, masses
from drystone.statics.joints import slippery
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads
from drystone.statics.lp.clarabel import least_constraint
from drystone.statics.lp.extremes import Solver
from drystone.statics.lp.program import assemble
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitStatus


def held_by_upright_faces(
    model: RigidBlockModel, loads: Loads | None = None, *, solver: Solver = "auto"
) -> tuple[int, ...] | None:
    """Name the blocks that fall when upright faces have no friction, in the order of the model.

    Equilibrium asks only whether forces exist, not what would press such faces together
    (docs/analysis.md).  Mechanisms of such a wall are many, but by Gauss's principle it starts to
    fall, by associated flow, in one way only.  Returned are the blocks that move then: with these
    held fast the rest stands.  None when a solver gave up.
    """
    smooth = replace(model, interfaces=slippery(model.interfaces, model.mu))
    status = lateral_resistance(smooth, loads, solver=solver).left.status
    if status is not LimitStatus.UNSTABLE:
        return None if status is LimitStatus.FAILED else ()
    program = assemble(smooth, loads)
    edges = csc_array(program.matrix[:, 1:])
    fall = least_constraint(masses(smooth, program), -program.rhs, edges, np.zeros(edges.shape[1]))
    if fall is None:
        return None
    moves = np.abs(np.append(fall[0], 0.0)[program.rows]).max(axis=1)
    return tuple(np.array(program.block_ids)[moves > CLEAR * moves.max()].tolist())
