"""How fast a mechanism violates the contacts of a wedge, block by block and point by point."""

from dataclasses import dataclass

import numpy as np

from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.result import Mechanism


@dataclass(frozen=True, eq=False)
class NaiveMotion:
    """How the blocks of a wall move in a mechanism."""

    model: RigidBlockModel
    mechanism: Mechanism

    def at(self, block, points):
        """Return the velocity of a block at some points; the ground stays."""
        if block == GROUND or block not in self.mechanism.block_ids:
            return np.zeros_like(points)
        row = self.mechanism.block_ids.index(block)
        x, y, turning = self.mechanism.velocity[row].tolist()
        arm = points - next(b.centroid for b in self.model.blocks if b.id == block)
        return np.column_stack([x - turning * arm[:, 1], y + turning * arm[:, 0]])

    def resisted_by(self, interfaces):
        """Return the rate at the worst point, along with the best neighbour."""
        others = sorted({interface.other for interface in interfaces})
        return min((self._violated(carrier, interfaces) for carrier in others), default=0.0)

    def _violated(self, carrier, interfaces):
        worst = 0.0
        for interface in interfaces:
            points = interface.points
            apart = self.at(carrier, points) - self.at(interface.other, points)
            x, y = interface.normal
            opening = apart[:, 0] * x + apart[:, 1] * y
            sliding = np.abs(apart[:, 0] * y - apart[:, 1] * x)
            needed = self.model.friction(interface) * sliding - opening
            worst = max(worst, float(needed.max()))
        return worst
