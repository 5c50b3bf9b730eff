"""Where a wedge could go in a finished wall, and whether it would stand in the way of its failure.

In an associative limit analysis a contact that is added can only raise the load multiplier, and
does so only if the mechanism in which the wall fails would close it, or slide along it without
opening it as much as friction asks for.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

import numpy as np

from drystone.kernels.polygons import Points, area_and_centroid
from drystone.model.wall import Wall
from drystone.settle.wedge import WedgeLimits, rests, wedges_below
from drystone.statics.model import GROUND, Interface, RigidBlockModel
from drystone.statics.result import Mechanism

MOST_UNDER_ONE = 2
"""Wedges under one stone; ids are left for so many (:mod:`drystone.planner.workshop`)."""


@dataclass(frozen=True, eq=False)
class WedgePlace:
    """A wedge that has room in a finished wall.

    Parameters
    ----------
    step : int
        Which step places the stone that would lie on it.
    corners : (n, 2) float array
        Its outline in the wall frame, counter-clockwise, source px.
    """

    step: int
    corners: Points

    @cached_property
    def area_px(self) -> float:
        """Its area, square source px."""
        return area_and_centroid(self.corners)[0]


def wedge_places(wall: Wall, limits: WedgeLimits) -> Iterator[WedgePlace]:
    """List wedges under the stones of a wall.

    They overlap nothing that is there, and rest on what was there before the stone.

    Parameters
    ----------
    wall : Wall
        Of outlines.
    limits : WedgeLimits
        What a wedge may be.
    """
    assert wall.outlines is not None  # noqa: S101 - for walls of outlines only
    polygons, width = wall.outlines.polygons, wall.site.extent_px[0]
    firsts = accumulate((1 + len(group.wedges) for group in wall.groups), initial=0)
    for step, (group, first) in enumerate(zip(wall.groups, firsts, strict=False)):
        if len(group.wedges) >= MOST_UNDER_ONE:
            continue
        for corners in wedges_below(polygons, first, limits):
            if rests(corners, polygons.leading(first), width, limits):
                yield WedgePlace(step, corners)


@dataclass(frozen=True, eq=False)
class Motion:
    """How the blocks of a wall move in a mechanism.

    Parameters
    ----------
    model : RigidBlockModel
        The wall.
    mechanism : Mechanism
        Of its failure.
    """

    model: RigidBlockModel
    mechanism: Mechanism

    def at(self, block: int, points: Points) -> Points:
        """Return the velocity of a block at some points; the ground stays."""
        if block == GROUND or block not in self.mechanism.block_ids:
            return np.zeros_like(points)
        row = self.mechanism.block_ids.index(block)
        x, y, turning = self.mechanism.velocity[row].tolist()
        arm = points - self._centroids[block]
        return np.column_stack([x - turning * arm[:, 1], y + turning * arm[:, 0]])

    @cached_property
    def _centroids(self) -> dict[int, tuple[float, float]]:
        return {block.id: block.centroid for block in self.model.blocks}

    def resisted_by(self, wedge: int, interfaces: Sequence[Interface]) -> float:
        """Return how fast the mechanism violates the contacts of a wedge.

        Parameters
        ----------
        wedge : int
            Its id.
        interfaces : sequence of Interface
            All between it and what it touches, normals into it.

        Returns
        -------
        rate : float
            At the point where it is violated most, when the wedge moves along with the one of its
            neighbours with which it is violated least.  0 or less: the wall fails as it did.
        """
        others = {interface.other for interface in interfaces}
        assert all(interface.block == wedge for interface in interfaces)  # noqa: S101
        return min((self._violated(carrier, interfaces) for carrier in sorted(others)), default=0.0)

    def _violated(self, carrier: int, interfaces: Sequence[Interface]) -> float:
        """Return how fast contacts are violated by a block that moves along with another."""
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
