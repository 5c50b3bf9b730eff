"""The program of the limit analysis for the simplex kernel: loose blocks, columns in arrays."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.cones import GROUND_BODY, Body, cone_edges
from drystone.kernels.simplex import Added, Cones
from drystone.statics.lp.program import Units
from drystone.statics.model import GROUND, Addition, Block

Ints = NDArray[np.int32]

NONE_CLOSED = np.empty(0, np.int32)
NONE_CLOSED.flags.writeable = False


@dataclass(frozen=True, eq=False)
class ConeProgram:
    """Equilibrium of loose blocks on the tilting table, as :mod:`drystone.kernels.simplex` has it.

    Its numbers are those of :class:`drystone.statics.lp.program.EquilibriumProgram`.
    """

    units: Units
    bodies: Mapping[int, Body]  # of every block and of the ground, by id
    weights: NDArray[np.float64]  # (n,): of the blocks, in units of weight
    cones: Cones
    interfaces: Ints  # (N,): place of the interface of each column in the model

    @classmethod
    def empty(cls, units: Units) -> "ConeProgram":
        """Return the program of no blocks."""
        none = NONE_CLOSED
        cones = Cones(none, none, np.empty((6, 0)))
        return cls(units, {GROUND: GROUND_BODY}, np.empty(0), cones, none)

    @cached_property
    def centroid_x(self) -> NDArray[np.float64]:
        """Where the blocks are along the wall, in the order of their places."""
        return np.array([x for place, x, _ in self.bodies.values() if place >= 0])

    def columns_of(self, addition: Addition) -> Added | None:
        """Return what a stone and its wedges add to the program.

        None when a block is fixed or held, or weighs nothing, or when an interface is not between a
        block and another one or the ground: that is for other solvers.
        """
        new = self._new_bodies(addition.blocks)
        if new is None:
            return None
        old = self.bodies
        bodies, normals, frictions, points = [], [], [], []
        for interface in addition.interfaces:
            one, two = interface.block, interface.other
            first = new.get(one) or old.get(one)
            second = new.get(two) or old.get(two)
            if first is None or second is None or first[0] < 0:
                return None
            bodies.append((first, second))
            normals.append(interface.normal)
            frictions.append(addition.base.friction(interface))
            points.append(interface.points)
        cones = Cones(*cone_edges(bodies, normals, frictions, points, self.units.length))
        weight = self.units.weight
        weights = np.array([block.weight / weight for block in addition.blocks], np.float64)
        gone = NONE_CLOSED
        if addition.closed:
            gone = np.flatnonzero(np.isin(self.interfaces, addition.closed)).astype(np.int32)
        return Added(weights, cones, gone)

    def appended(self, addition: Addition, added: Added) -> "ConeProgram":
        """Return the program with a stone and its wedges, as :meth:`columns_of` has them."""
        bodies = self._new_bodies(addition.blocks)
        assert bodies is not None  # noqa: S101 - or there would be no columns
        weights = np.concatenate((self.weights, added.weights))
        bodies, cones = {**self.bodies, **bodies}, added.joined(self.cones)
        left = np.delete(self.interfaces, added.closed)
        left -= np.searchsorted(addition.closed, left).astype(np.int32)
        first = len(addition.base.interfaces) - len(addition.closed)
        new = np.arange(first, first + len(addition.interfaces), dtype=np.int32)
        counts = [2 * len(interface.points) for interface in addition.interfaces]
        interfaces = np.concatenate((left, np.repeat(new, counts)))
        return ConeProgram(self.units, bodies, weights, cones, interfaces)

    def _new_bodies(self, blocks: tuple[Block, ...]) -> dict[int, Body] | None:
        place = len(self.weights)
        new: dict[int, Body] = {}
        for block in blocks:
            if block.fixed or block.held or not block.weight > 0.0:
                return None
            x, y = block.centroid
            new[block.id] = (place, x, y)
            place += 1
        return new
