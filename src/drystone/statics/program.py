"""The linear program of the limit analysis as arrays (Eq. 23-24), free of any solver."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.statics.model import GROUND, Block, RigidBlockModel

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class EquilibriumProgram:
    """Equilibrium of the free blocks: alpha live + contact forces = -dead, contact forces >= 0.

    Column 0 is alpha, positive towards +x and free; then come two columns for each contact
    point, the forces along the two edges of its friction cone.  Rows 3 i, 3 i + 1, 3 i + 2 are
    the horizontal and vertical forces on block i and their moment about its centroid.  The
    matrix is stored by columns.

    Parameters
    ----------
    block_ids : (n,) tuple of int
        Free blocks in the order of the rows.
    start : (m + 2,) int array
        Where each column starts in `index` and `value`.
    index : int array
        Rows.
    value : float array
        Coefficients.
    rhs : (3 n,) float array
        Right-hand side.
    length : float
        Characteristic length: moments are divided by it, so that all rows are of one size.
    """

    block_ids: tuple[int, ...]
    start: Ints
    index: Ints
    value: Floats
    rhs: Floats
    length: float

    @property
    def column_count(self) -> int:
        """Number of unknowns."""
        return len(self.start) - 1


def assemble(model: RigidBlockModel) -> EquilibriumProgram:
    """Set up Eq. 23-24 in scaled units: weights of mean 1, lengths over the root of the mean area.

    A force f at point p on block i, centroid c, enters its rows as (f, (p - c) x f); the block
    on the other side takes -f, the ground and fixed blocks nothing.  The cone |t| <= mu n,
    n >= 0 of a contact point is spanned by the forces normal +- mu tangent.

    Parameters
    ----------
    model : RigidBlockModel
        With at least one free block.

    Examples
    --------
    >>> from drystone.statics.model import Block
    >>> assemble(RigidBlockModel((Block(1, 4.0, (1.0, 1.0)),), ())).column_count
    1
    """
    free = [block for block in model.blocks if not block.fixed]
    weight = np.array([block.weight for block in free])
    weight = weight / weight.mean()
    length = float(np.sqrt(np.mean([block.area for block in free])))
    force, arm, blocks = _cone_edges(model, free)

    value = np.empty((len(force), 2, 3))
    value[:, :, :2] = np.array([[1.0], [-1.0]]) * force[:, None, :]
    arm = arm / length
    value[:, :, 2] = arm[:, :, 0] * value[:, :, 1] - arm[:, :, 1] * value[:, :, 0]
    index = 3 * blocks[:, :, None] + np.arange(3)
    moving = blocks >= 0

    count = len(free)
    entries = np.concatenate(([count], 3 * moving.sum(axis=1)))
    rhs = np.zeros(3 * count)
    rhs[1::3] = weight
    return EquilibriumProgram(
        block_ids=tuple(block.id for block in free),
        start=np.concatenate(([0], np.cumsum(entries))).astype(np.int32),
        index=np.concatenate((3 * np.arange(count), index[moving].ravel())).astype(np.int32),
        value=np.concatenate((weight, value[moving].ravel())),
        rhs=rhs,
        length=length,
    )


def _cone_edges(model: RigidBlockModel, free: list[Block]) -> tuple[Floats, Floats, Ints]:
    """List the two edges of the friction cone at every contact point.

    Returns
    -------
    force : (m, 2) float array
        On the block that the normal points into.
    arm : (m, 2, 2) float array
        From the centroids of that block and of the other one to the point; anything for the
        ground.
    blocks : (m, 2) int array
        Their places in `free`, -1 for what does not move.
    """
    place = {block.id: -1 for block in model.blocks}
    place[GROUND] = -1
    place.update((block.id, i) for i, block in enumerate(free))
    points = [interface.points for interface in model.interfaces]
    repeats = 2 * np.array([len(ends) for ends in points], np.int64)
    at = np.repeat(np.concatenate([np.empty((0, 2)), *points]), 2, axis=0)
    pairs = [(place[i.block], place[i.other]) for i in model.interfaces]
    blocks = np.repeat(np.array(pairs, np.int32).reshape(-1, 2), repeats, axis=0)
    normals = [interface.normal for interface in model.interfaces]
    normal = np.repeat(np.array(normals, float).reshape(-1, 2), repeats, axis=0)
    tangent = np.column_stack((normal[:, 1], -normal[:, 0]))
    friction = np.tile([model.mu, -model.mu], len(at) // 2)
    centroid = np.array([block.centroid for block in free])
    return normal + friction[:, None] * tangent, at[:, None, :] - centroid[blocks], blocks
