"""Growing walls by HiGHS: any model, and any number of blocks.

Each tilt is solved by the primal simplex method from the optimal basis of the same tilt of the
wall, in a solver that knows nothing else, so that answers do not depend on what was asked before.
"""

from dataclasses import dataclass

import numpy as np
from highspy import HighsBasis

from drystone.statics.appending import OpenProgram, Units, columns_of
from drystone.statics.asking import Answer, answered
from drystone.statics.certificate import of_fall
from drystone.statics.ends import End
from drystone.statics.grown import Grown
from drystone.statics.limit import lateral_resistance, resistance_between
from drystone.statics.model import RigidBlockModel
from drystone.statics.program import EquilibriumProgram
from drystone.statics.result import LimitStatus
from drystone.statics.solvers.highs import TOLERANCE, HighsSession
from drystone.statics.solvers.refined import RefinedSession
from drystone.statics.solvers.warm import Basis, read_basis

MANY_BLOCKS_AT_ONCE = 100
"""From here on a model that does not grow gets its first bases by an interior point method."""


@dataclass(frozen=True, eq=False)
class Bases:
    """Where the two tilts start: towards the least alpha (left) and the greatest (right)."""

    least: Basis
    greatest: Basis


@dataclass(frozen=True, eq=False)
class Answers:
    """Both tilts of a wall."""

    least: Answer
    greatest: Answer


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
    answers : Answers or None
        Of the wall; None without free blocks.
    """

    model: RigidBlockModel
    grown: Grown
    open_program: OpenProgram
    bases: Bases
    answers: Answers | None = None

    def resistance_with(self, model: RigidBlockModel) -> Grown:
        """See :meth:`GrowingAnalysis.resistance_with`."""
        if model is self.model:
            return self.grown
        program, starts = self.prepared(model)
        if not program.seats:
            return Grown(lateral_resistance(model))
        return _told(model, program.program, _tilted(program.program, starts))

    def extended(self, model: RigidBlockModel) -> "WarmGrowth":
        """See :meth:`GrowingAnalysis.extended`."""
        if model is self.model:
            return self
        return _grown_to(model, *self.prepared(model))

    def prepared(self, model: RigidBlockModel) -> tuple[OpenProgram, Bases]:
        """Return the program of another model, and bases to start from.

        Parameters
        ----------
        model : RigidBlockModel
            Where it is made from :attr:`model`, what is new is appended.
        """
        added = model.added
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


def begun(model: RigidBlockModel, units: Units) -> WarmGrowth:
    """Begin with a wall, which may be empty; see :func:`drystone.statics.growing.growing`."""
    program, starts = _anew(model, units)
    if len(program.seats) >= MANY_BLOCKS_AT_ONCE:
        starts = _by_interior_point(program.program, starts)
    return _grown_to(model, program, starts)


def end(program: OpenProgram, starts: Bases, sign: int) -> End | None:
    """Find one end of the range of alpha; None without a certificate, or where it has no end.

    Parameters
    ----------
    program, starts
        See :meth:`WarmGrowth.prepared`.
    sign : int
        1 for the greatest alpha, -1 for the least.
    """
    session = RefinedSession(program.program)
    answer = _asked(program.program, session, starts.greatest if sign > 0 else starts.least, sign)
    solution, certificate = answer.solution, answer.certificate
    if certificate is None or solution.duals is None or answer.status is LimitStatus.FAILED:
        return None
    if answer.status is LimitStatus.UNSTABLE:
        return End(float("nan"), certificate, certificate, solution.solver)
    falls = None
    if sign * answer.alpha < -TOLERANCE:
        falls = of_fall(program.program, -solution.duals)
        if not falls.holds:
            return None
    return End(answer.alpha, certificate, falls, solution.solver)


@dataclass(frozen=True, eq=False)
class Tilts:
    """Both tilts of one program, and the bases that they ended with, as HiGHS has them."""

    least: Answer
    greatest: Answer
    lower: HighsBasis
    upper: HighsBasis


def _tilted(program: EquilibriumProgram, starts: Bases) -> Tilts:
    """Solve each tilt from its own basis, both in a solver that knows nothing else."""
    session = RefinedSession(program)
    greatest = _asked(program, session, starts.greatest, 1)
    upper = session.basis()
    if greatest.status is LimitStatus.UNSTABLE:  # no alpha holds the blocks up
        return Tilts(greatest, greatest, upper, upper)
    least = _asked(program, session, starts.least, -1)
    return Tilts(least, greatest, session.basis(), upper)


def _asked(program: EquilibriumProgram, session: RefinedSession, start: Basis, sign: int) -> Answer:
    """Solve one tilt from a basis; once more from the last one if there is no certificate.

    Thousands of blocks can cost the factors of the basis their last digits; then they are made
    anew.
    """
    session.start_from(start)
    answer = answered(program, session, float(sign))
    last = read_basis(session.basis())
    unproved = answer.status is LimitStatus.FAILED and answer.solution.status is LimitStatus.OPTIMAL
    if last is None or not unproved:
        return answer
    session.start_from(last)
    return answered(program, session, float(sign))


def _told(model: RigidBlockModel, program: EquilibriumProgram, tilts: Tilts) -> Grown:
    """Tell the resistance; by the ordinary solvers when the answers cannot be certified."""
    both = resistance_between(program, tilts.least, tilts.greatest, model.mu)
    if both.failed:
        return Grown(lateral_resistance(model), solved_cold=True)
    return Grown(both)


def _grown_to(model: RigidBlockModel, program: OpenProgram, starts: Bases) -> WarmGrowth:
    model = model.forgetting()  # or every model would keep all those before it
    if not program.seats:
        return WarmGrowth(model, Grown(lateral_resistance(model)), program, starts)
    tilts = _tilted(program.program, starts)
    bases = Bases(
        read_basis(tilts.lower) or starts.least, read_basis(tilts.upper) or starts.greatest
    )
    answers = Answers(tilts.least, tilts.greatest)
    return WarmGrowth(model, _told(model, program.program, tilts), program, bases, answers)


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
