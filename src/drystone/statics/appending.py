"""The linear program of the limit analysis, appended to block by block."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from drystone.statics.loads import tilting_table
from drystone.statics.model import FREEDOMS, GROUND, Block, Interface, RigidBlockModel
from drystone.statics.program import EquilibriumProgram

HELD = -1


@dataclass(frozen=True)
class Units:
    """What lengths and forces are measured in.

    Parameters
    ----------
    length : float
        About the root of the area of a block.
    weight : float
        About the weight of a block.
    """

    length: float
    weight: float


def units_of(model: RigidBlockModel) -> Units:
    """Return the units in which blocks have the mean weight 1 and the mean area 1.

    Parameters
    ----------
    model : RigidBlockModel
        With at least one free block.

    Examples
    --------
    >>> units_of(RigidBlockModel((Block(1, 4.0, (1.0, 1.0), density=2.0),), ()))
    Units(length=2.0, weight=8.0)
    """
    free = [block for block in model.blocks if not block.fixed]
    area = np.mean([block.area for block in free])
    return Units(float(np.sqrt(area)), float(np.mean([block.weight for block in free])))


@dataclass(frozen=True)
class Seat:
    """Where a free block is, and its rows: horizontal and vertical force, moment."""

    centroid: tuple[float, float]
    rows: tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class OpenProgram:
    """Equilibrium on the tilting table (Eq. 23-24) to which blocks can be appended; immutable.

    The units stay as they are while it grows.  But for them its program is the one that
    :func:`drystone.statics.program.assemble` makes of the whole model.

    Parameters
    ----------
    program : EquilibriumProgram
        Of the blocks so far.
    seats : mapping of int to Seat
        Free blocks by id.

    Examples
    --------
    >>> program = OpenProgram.empty(Units(2.0, 4.0))
    >>> block = Block(1, 8.0, (2.0, 1.0))
    >>> grown = program.appended(RigidBlockModel((block,), ()), (block,), ())
    >>> grown.program.rhs.shape, float(grown.program.rhs[1])
    ((3,), 2.0)
    """

    program: EquilibriumProgram
    seats: Mapping[int, Seat]

    @classmethod
    def empty(cls, units: Units) -> "OpenProgram":
        """Return the program of no blocks: one unknown, alpha, and no equations."""
        nothing = np.empty(0)
        program = EquilibriumProgram(
            block_ids=(),
            rows=np.empty((0, 3), np.int32),
            start=np.zeros(2, np.int32),
            index=np.empty(0, np.int32),
            value=nothing,
            rhs=nothing,
            friction=nothing,
            length=units.length,
            weight=units.weight,
        )
        return cls(program, {})

    def appended(
        self, model: RigidBlockModel, blocks: Sequence[Block], interfaces: Sequence[Interface]
    ) -> "OpenProgram":
        """Return the program with some more blocks and interfaces.

        Parameters
        ----------
        model : RigidBlockModel
            All blocks, for the friction.
        blocks : sequence of Block
            New ones.
        interfaces : sequence of Interface
            New ones, between any blocks.
        """
        old = self.program
        free = [block for block in blocks if not block.fixed]
        seats = {**self.seats, **_seats(free, len(old.rhs))}
        rows = np.array([seats[block.id].rows for block in free], np.int32).reshape(-1, 3)
        moving = rows != HELD
        # The moment of a load about the centroid is 0 on the tilting table.
        loads = tilting_table(RigidBlockModel(tuple(free), ()))
        live = loads.live[moving] / old.weight
        pushed = np.flatnonzero(live)
        first = old.start[1]
        counts, index, value, friction = _columns(model, interfaces, seats, old.length)
        ends = old.start[-1] + len(pushed) + np.cumsum(counts, dtype=np.int32)
        program = EquilibriumProgram(
            block_ids=(*old.block_ids, *(block.id for block in free)),
            rows=np.concatenate((old.rows, rows)),
            start=np.concatenate(([0], old.start[1:] + len(pushed), ends)).astype(np.int32),
            index=np.concatenate(
                (old.index[:first], rows[moving][pushed], old.index[first:], index)
            ),
            value=np.concatenate((old.value[:first], live[pushed], old.value[first:], value)),
            rhs=np.concatenate((old.rhs, -loads.dead[moving] / old.weight)),
            friction=np.concatenate((old.friction, friction)),
            length=old.length,
            weight=old.weight,
        )
        return OpenProgram(program, seats)

    def with_points(self, stay: NDArray[np.bool_]) -> "OpenProgram":
        """Return the program with some of its contact points only.

        Parameters
        ----------
        stay : (m,) bool array
            Which ones.
        """
        old = self.program
        columns = columns_of(stay)
        sizes = np.diff(old.start)
        entries = np.repeat(columns, sizes)
        start = np.concatenate(([0], np.cumsum(sizes[columns]))).astype(np.int32)
        program = replace(
            old,
            start=start,
            index=old.index[entries],
            value=old.value[entries],
            friction=old.friction[stay],
        )
        return OpenProgram(program, self.seats)


def columns_of(points: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which columns are alpha or belong to some contact points."""
    return np.concatenate(([True], np.repeat(points, 2)))


def _seats(free: Sequence[Block], row: int) -> dict[int, Seat]:
    """Give every freedom of new blocks a row, from `row` on; HELD for what is held."""
    seats = {}
    for block in free:
        rows = []
        for freedom in FREEDOMS:
            held = freedom in block.held
            rows.append(HELD if held else row)
            row += not held
        seats[block.id] = Seat(block.centroid, (rows[0], rows[1], rows[2]))
    return seats


def _columns(
    model: RigidBlockModel,
    interfaces: Sequence[Interface],
    seats: Mapping[int, Seat],
    length: float,
) -> tuple[list[int], NDArray[np.int32], NDArray[np.float64], list[float]]:
    """List the two edges of the friction cone at every contact point, as columns.

    Plain loops: one stone has a handful of contact points, too few for arrays to pay.

    Returns
    -------
    counts : list of int
        Number of entries of each column.
    index, value : arrays
        Rows and coefficients of the entries.
    friction : list of float
        Coefficient at each contact point.
    """
    counts: list[int] = []
    index: list[int] = []
    value: list[float] = []
    friction: list[float] = []
    for interface in interfaces:
        mu = model.friction(interface)
        normal_x, normal_y = interface.normal
        bodies = [(interface.block, 1.0), (interface.other, -1.0)]
        sides = [(seats[i], sign) for i, sign in bodies if i != GROUND and i in seats]
        for x, y in interface.points.tolist():
            friction.append(mu)
            for along in (mu, -mu):
                before = len(index)
                for seat, sign in sides:
                    force_x = sign * (normal_x + along * normal_y)
                    force_y = sign * (normal_y - along * normal_x)
                    arm_x = (x - seat.centroid[0]) / length
                    arm_y = (y - seat.centroid[1]) / length
                    entries = (force_x, force_y, arm_x * force_y - arm_y * force_x)
                    for row, entry in zip(seat.rows, entries, strict=True):
                        if row != HELD:
                            index.append(row)
                            value.append(entry)
                counts.append(len(index) - before)
    return counts, np.array(index, np.int32), np.array(value, np.float64), friction
