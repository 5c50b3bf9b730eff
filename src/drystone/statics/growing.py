"""Limit analysis of a wall that grows stone by stone, without starting anew (§4.1).

A step of the planner asks for the resistance of the wall with each of many stones on top, and
then places one of them.  A stone adds three equations and a few unknowns to the program of the
wall (:mod:`drystone.statics.appending`), and the mechanism of the wall is close to that of the
wall with the stone: each tilt is solved from the optimal basis of the same tilt of the wall.

Like all answers these count only with a certificate that holds; otherwise the wall with the
stone is solved from the start by :func:`drystone.statics.limit.lateral_resistance`.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from highspy import HighsBasis

from drystone.statics.appending import OpenProgram, Units, columns_of
from drystone.statics.asking import Answer, answered
from drystone.statics.limit import lateral_resistance, resistance_between
from drystone.statics.model import Addition, RigidBlockModel
from drystone.statics.program import EquilibriumProgram
from drystone.statics.result import LateralResistance, LimitStatus
from drystone.statics.solvers.highs import HighsSession
from drystone.statics.solvers.warm import Basis, WarmSession, read_basis

MANY_BLOCKS_AT_ONCE = 100
"""From here on a model that does not grow gets its first bases by an interior point method."""


@dataclass(frozen=True, eq=False)
class Grown:
    """Resistance of a wall with one more stone.

    Parameters
    ----------
    resistance : LateralResistance
        As :func:`drystone.statics.limit.lateral_resistance` gives it, to the last digits.
    solved_cold : bool
        True when a warm answer had no certificate, so that all was solved again from the start.
    """

    resistance: LateralResistance
    solved_cold: bool = False


class GrowingAnalysis(Protocol):
    """Limit analysis of a wall on the tilting table, ready for one more stone; immutable.

    Answers depend on the wall and on how it has grown, and not on what else was asked, in which
    order, or in which thread.
    """

    @property
    def model(self) -> RigidBlockModel:
        """The wall."""
        ...

    @property
    def grown(self) -> Grown:
        """Resistance of the wall."""
        ...

    def resistance_with(self, model: RigidBlockModel) -> Grown:
        """Return the resistance of the wall with one more stone, a candidate; nothing changes.

        Parameters
        ----------
        model : RigidBlockModel
            Made from :attr:`model` by :meth:`RigidBlockModel.with_added`, as
            :func:`drystone.statics.contacts.blocks.model_with` does.  Any other model is
            answered too, without the gain in time.
        """
        ...

    def extended(self, model: RigidBlockModel) -> "GrowingAnalysis":
        """Return the analysis of the wall with one more stone, the chosen one.

        Its `grown` equals what `resistance_with` returns for the same model, bit by bit.
        """
        ...


@dataclass(frozen=True, eq=False)
class Bases:
    """Where the two tilts start: towards the least alpha (left) and the greatest (right)."""

    least: Basis
    greatest: Basis


@dataclass(frozen=True, eq=False)
class WarmGrowth:
    """A :class:`GrowingAnalysis` by HiGHS: primal simplex from the bases of the wall.

    Parameters
    ----------
    model : RigidBlockModel
        The wall.
    grown : Grown
        Its resistance.
    open_program : OpenProgram
        Its equations.
    bases : Bases
        Optimal ones; where there is none, the last ones.
    """

    model: RigidBlockModel
    grown: Grown
    open_program: OpenProgram
    bases: Bases

    def resistance_with(self, model: RigidBlockModel) -> Grown:
        """See :meth:`GrowingAnalysis.resistance_with`."""
        program, starts = self._prepared(model)
        if not program.seats:
            return Grown(lateral_resistance(model))
        return _told(model, program.program, _tilted(program.program, starts))

    def extended(self, model: RigidBlockModel) -> "WarmGrowth":
        """See :meth:`GrowingAnalysis.extended`."""
        return _grown_to(model, *self._prepared(model))

    def _prepared(self, model: RigidBlockModel) -> tuple[OpenProgram, Bases]:
        """Append what is new to the program and to the bases."""
        added = Addition(model, (), ()) if model is self.model else model.added
        if added is None or added.base is not self.model:
            units = Units(self.open_program.program.length, self.open_program.program.weight)
            return _anew(model, units)
        old, bases = self.open_program, self.bases
        if added.closed:
            stay = np.ones(len(self.model.interfaces), bool)
            stay[list(added.closed)] = False
            repeats = [len(interface.points) for interface in self.model.interfaces]
            old = old.with_points(np.repeat(stay, repeats))
            columns = columns_of(np.repeat(stay, repeats))
            bases = Bases(bases.least.with_columns(columns), bases.greatest.with_columns(columns))
        program = old.appended(model, added.blocks, added.interfaces)
        return program, _appended(bases, program.program)


def growing(model: RigidBlockModel, units: Units) -> GrowingAnalysis:
    """Begin with a wall, which may be empty.

    Parameters
    ----------
    model : RigidBlockModel
        What is built.
    units : Units
        Of the equations, for as long as the wall grows: those of a typical stone.  Certificates
        are relative to their weight; alpha does not depend on them.

    Examples
    --------
    A stone on a stone, half as wide as high; the pile is as stable as a block of twice its height.

    >>> from drystone.statics.appending import units_of
    >>> from drystone.statics.contacts.given import model_from_json
    >>> pile = model_from_json({"blocks_xywh": [[0, 0, 1, 2], [0, 2, 1, 2]], "mu": 0.58})
    >>> first = RigidBlockModel(pile.blocks[:1], pile.interfaces[:1], pile.mu)
    >>> wall = growing(first, units_of(first))
    >>> round(wall.grown.resistance.right.alpha, 6)
    0.5
    >>> taller = wall.model.with_added(pile.blocks[1:], pile.interfaces[1:])
    >>> round(wall.resistance_with(taller).resistance.right.alpha, 6)
    0.25
    """
    program, starts = _anew(model, units)
    if len(program.seats) >= MANY_BLOCKS_AT_ONCE:
        starts = _by_interior_point(program.program, starts)
    return _grown_to(model, program, starts)


@dataclass(frozen=True, eq=False)
class Tilts:
    """Both tilts of one program, and the bases that they ended with, as HiGHS has them."""

    least: Answer
    greatest: Answer
    lower: HighsBasis
    upper: HighsBasis


def _tilted(program: EquilibriumProgram, starts: Bases) -> Tilts:
    """Solve each tilt from its own basis, both in a solver that knows nothing else."""
    session = WarmSession(program)
    session.start_from(starts.greatest)
    greatest = answered(program, session, 1.0)
    upper = session.basis()
    if greatest.status is LimitStatus.UNSTABLE:  # no alpha holds the blocks up
        return Tilts(greatest, greatest, upper, upper)
    session.start_from(starts.least)
    return Tilts(answered(program, session, -1.0), greatest, session.basis(), upper)


def _told(model: RigidBlockModel, program: EquilibriumProgram, tilts: Tilts) -> Grown:
    """Tell the resistance; by the ordinary solvers when the answers cannot be certified."""
    if LimitStatus.FAILED in (tilts.least.status, tilts.greatest.status):
        return Grown(lateral_resistance(model), solved_cold=True)
    return Grown(resistance_between(program, tilts.least, tilts.greatest, model.mu))


def _grown_to(model: RigidBlockModel, program: OpenProgram, starts: Bases) -> WarmGrowth:
    model = model.forgetting()  # or every model would keep all those before it
    if not program.seats:
        return WarmGrowth(model, Grown(lateral_resistance(model)), program, starts)
    tilts = _tilted(program.program, starts)
    bases = Bases(
        read_basis(tilts.lower) or starts.least, read_basis(tilts.upper) or starts.greatest
    )
    return WarmGrowth(model, _told(model, program.program, tilts), program, bases)


def _anew(model: RigidBlockModel, units: Units) -> tuple[OpenProgram, Bases]:
    program = OpenProgram.empty(units).appended(model, model.blocks, model.interfaces)
    return program, _appended(Bases(Basis(), Basis()), program.program)


def _appended(bases: Bases, program: EquilibriumProgram) -> Bases:
    size = program.column_count, len(program.rhs)
    return Bases(bases.least.appended(*size), bases.greatest.appended(*size))


def _by_interior_point(program: EquilibriumProgram, otherwise: Bases) -> Bases:
    """Find bases near the optimum by crossover: hundreds of times quicker for many blocks."""
    session = HighsSession(program, "ipm")
    answered(program, session, 1.0)
    greatest = read_basis(session.highs.getBasis())
    answered(program, session, -1.0)
    least = read_basis(session.highs.getBasis())
    return Bases(least or otherwise.least, greatest or otherwise.greatest)
