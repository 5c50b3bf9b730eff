"""The linear program of the limit analysis as arrays (Eq. 23-24), free of any solver."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from drystone.errors import InputError
from drystone.kernels.cones import GROUND_BODY, cone_edges
from drystone.statics.loads import Loads, tilting_table
from drystone.statics.model import FREEDOMS, GROUND, RigidBlockModel
from drystone.statics.result import LimitStatus, Mechanism

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


@dataclass(frozen=True)
class Units:
    """What lengths and forces are measured in."""

    length: float
    weight: float


def units_of(model: RigidBlockModel) -> Units:
    """Return the units in which free blocks, of which there is one, have mean weight and area 1."""
    free = [block for block in model.blocks if not block.fixed]
    area = np.mean([block.area for block in free])
    return Units(float(np.sqrt(area)), float(np.mean([block.weight for block in free])))


@dataclass(frozen=True, eq=False)
class EquilibriumProgram:
    """Equilibrium of the free blocks: alpha live + contact forces = -dead, contact forces >= 0.

    Column 0 is alpha and free; then come two columns for each contact point, the forces along the
    two edges of its friction cone, normal + mu tangent and normal - mu tangent.  Each free block
    has up to three rows, the horizontal and vertical forces on it and their moment about its
    centroid; what it is held in has no row.  The matrix is stored by columns.
    """

    block_ids: tuple[int, ...]  # (n,): free blocks
    rows: Ints  # (n, 3): row of each freedom of each free block; -1 for what is held
    start: Ints  # (2 m + 2,): where each column starts in `index` and `value`
    index: Ints
    value: Floats
    rhs: Floats
    friction: Floats  # (m,): coefficient of friction at each contact point
    length: float
    """Characteristic length: moments are divided by it, so that all rows are of one size."""
    weight: float  # unit of force: mean weight of the free blocks

    @property
    def column_count(self) -> int:
        """Number of unknowns."""
        return len(self.start) - 1

    @cached_property
    def matrix(self) -> csc_array:
        """The equations as a sparse matrix."""
        shape = (len(self.rhs), self.column_count)
        return csc_array((self.value, self.index, self.start), shape=shape)

    def mechanism(self, velocity: Floats) -> Mechanism:
        """Return how the blocks move, from a velocity for each row (§4.1)."""
        by_block = np.zeros((len(self.rows), 3))
        by_block[self.rows >= 0] = velocity
        by_block[:, 2] /= self.length
        fastest = float(np.hypot(by_block[:, 0], by_block[:, 1]).max())
        # Of blocks that only turn about their centroids the rate of turning says how fast.
        return Mechanism(self.block_ids, by_block / (fastest or float(np.abs(by_block).max())))

    def forces(self, edges: Floats) -> Floats:
        """Add up the edges (m, 2) of every cone: normal part, and part along mu t."""
        first, second = self.weight * edges.T
        return np.column_stack((first + second, self.friction * (first - second)))

    def save(self, path: Path) -> None:
        """Write the program as NPZ, for a report of what no solver could solve (E140)."""
        arrays = {name: getattr(self, name) for name in _ARRAYS}
        scales = np.array([self.length, self.weight])
        ids = np.array(self.block_ids, np.int64)
        with path.open("wb") as file:
            np.savez_compressed(file, block_ids=ids, scales=scales, **arrays)

    @classmethod
    def load(cls, path: Path) -> "EquilibriumProgram":
        """Read what :meth:`save` wrote."""
        with np.load(path) as saved:  # noqa: TID251 - what this module wrote
            length, weight = saved["scales"].tolist()
            arrays = {name: saved[name] for name in _ARRAYS}
            ids = tuple(saved["block_ids"].tolist())
        return cls(block_ids=ids, length=length, weight=weight, **arrays)


@dataclass(frozen=True, eq=False)
class Solution:
    """Answer to: minimise costs . x subject to the program."""

    status: LimitStatus  # OPTIMAL; UNSTABLE when the program has no solution; UNBOUNDED; FAILED
    columns: Floats | None
    """Unknowns; for UNBOUNDED a ray along which the costs fall for ever, if the solver has it."""
    duals: Floats | None
    """Of the rows, y with costs - y . column >= 0; for UNSTABLE a ray with y . column <= 0 and y .
    rhs > 0, if the solver has it."""
    said: str  # status in the solver's words
    solver: str

    @property
    def optimum(self) -> tuple[Floats, Floats]:
        """Unknowns and duals of an optimal solution."""
        assert self.columns is not None  # noqa: S101 - it has both
        assert self.duals is not None  # noqa: S101
        return self.columns, self.duals


_ARRAYS = ("rows", "start", "index", "value", "rhs", "friction")


def assemble(
    model: RigidBlockModel, loads: Loads | None = None, units: Units | None = None
) -> EquilibriumProgram:
    """Set up Eq. 23-24 in scaled units, those of :func:`units_of` unless given.

    A force f at point p on block i, centroid c, enters its rows as (f, (p - c) x f); the block on
    the other side takes -f, the ground and fixed blocks nothing.  The cone |t| <= mu n, n >= 0 of a
    contact point is spanned by the forces normal +- mu tangent.
    """
    loads = tilting_table(model) if loads is None else loads
    if len(loads.dead) != len(model.blocks):
        what = f"there are loads on {len(loads.dead)} blocks, and {len(model.blocks)} blocks."
        raise InputError("E308", what, where="loads", cure="Give one row for each block.")
    places = [i for i, block in enumerate(model.blocks) if not block.fixed]
    free = [model.blocks[i] for i in places]
    units = units_of(model) if units is None else units
    unit = units.weight * np.array([1.0, 1.0, units.length])
    moves = [[freedom not in block.held for freedom in FREEDOMS] for block in free]
    moving = np.array(moves, bool).reshape(-1, 3)
    rows = np.full(moving.shape, -1, np.int32)
    rows[moving] = np.arange(np.count_nonzero(moving))
    bodies = dict.fromkeys((GROUND, *(block.id for block in model.blocks)), GROUND_BODY)
    bodies |= {block.id: (i, *block.centroid) for i, block in enumerate(free)}
    faces = model.interfaces
    friction = [model.friction(face) for face in faces]
    first, second, entries = cone_edges(
        [(bodies[face.block], bodies[face.other]) for face in faces],
        [face.normal for face in faces],
        friction,
        [face.points for face in faces],
        units.length,
    )
    # The last row, that of -1, is for what does not move.
    index = np.vstack((rows, np.full(3, -1, np.int32)))[np.column_stack((first, second))]
    kept = index >= 0

    live = (loads.live[places] / unit)[moving]
    pushed = np.flatnonzero(live)
    counts = np.concatenate(([len(pushed)], kept.sum(axis=(1, 2))))
    return EquilibriumProgram(
        block_ids=tuple(block.id for block in free),
        rows=rows,
        start=np.concatenate(([0], np.cumsum(counts))).astype(np.int32),
        index=np.concatenate((pushed, index[kept])).astype(np.int32),
        value=np.concatenate((live[pushed], entries.T.reshape(-1, 2, 3)[kept])),
        rhs=-(loads.dead[places] / unit)[moving],
        friction=np.array(friction, float)[model.contact_interfaces],
        length=units.length,
        weight=units.weight,
    )
