"""Blocks that are held by their own squeeze: by friction on upright faces alone (DESIGN 4.8)."""

from dataclasses import replace

from drystone.statics.failing.mechanism import describe_mechanism
from drystone.statics.joints import slippery
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads
from drystone.statics.lp.extremes import Solver
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitStatus


def held_by_upright_faces(
    model: RigidBlockModel, loads: Loads | None = None, *, solver: Solver = "auto"
) -> tuple[int, ...] | None:
    """Name the blocks that fall when upright faces have no friction, in the order of the model.

    Equilibrium asks only whether forces exist, not what would press such faces together
    (docs/analysis.md).  Returned are the blocks that move in the mechanism, then with these held
    fast those of the next one, until the rest stands; None when a solver gave up.
    """
    smooth = replace(model, interfaces=slippery(model.interfaces, model.mu))
    fallen: set[int] = set()
    while True:
        found = lateral_resistance(smooth, loads, mechanism=True, solver=solver).left
        if found.status is LimitStatus.FAILED:
            return None
        if found.status is not LimitStatus.UNSTABLE:
            return tuple(block.id for block in model.blocks if block.id in fallen)
        assert found.mechanism is not None  # noqa: S101 - it was asked for, and is the proof
        fallen.update(describe_mechanism(smooth, found.mechanism).moving)
        blocks = (replace(b, fixed=b.fixed or b.id in fallen) for b in smooth.blocks)
        smooth = replace(smooth, blocks=tuple(blocks))
