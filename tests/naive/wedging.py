"""How fast a mechanism violates the contacts of a wedge, block by block and point by point."""

import numpy as np


class NaiveMotion:
    """How the blocks of a wall move in a mechanism."""

    def __init__(self, model, mechanism):
        self.model = model
        self.velocity = dict(zip(mechanism.block_ids, mechanism.velocity.tolist(), strict=True))
        self.centroid = {block.id: block.centroid for block in model.blocks}

    def at(self, block, points):
        """Return the velocity of a block at some points; the ground stays."""
        if block not in self.velocity:
            return np.zeros_like(points)
        x, y, turning = self.velocity[block]
        arm = points - self.centroid[block]
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
            needed = self.model.friction(interface) * np.abs(apart @ (y, -x)) - apart @ (x, y)
            worst = max(worst, float(needed.max()))
        return worst
