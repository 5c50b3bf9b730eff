"""Limit analysis of a wall that grows stone by stone, without starting anew (§4.1).

A step of the planner asks for the resistance of the wall with each of many stones on top, and
then places one of them.  A stone adds three equations and a few unknowns to the program of the
wall, and the mechanism of the wall is close to that of the wall with the stone: each end of the
range of alpha is found from where the same end of the wall was.  Three analyses do that, and what
one of them is not made for falls through to the next:

1. :class:`SimplexAnalysis`, the simplex method of our own, for loose stones, up to some hundred.
2. :class:`LocalAnalysis`, for more: small programs of what is below a stone.
3. :class:`HighsAnalysis`, for all else: fixed and guided blocks, walls that fell, models that were
   not made by adding, and all walls where the simplex kernel is not compiled.

Like all answers these count only with a certificate that holds; otherwise the wall with the
stone is solved from the start by :func:`drystone.statics.limit.lateral_resistance`.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import isnan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels import simplex
from drystone.kernels.cones import Figures, figures
from drystone.kernels.simplex import Added, Answer, Optimum
from drystone.statics.limit import MESSAGES, lateral_resistance, resistance_between
from drystone.statics.local_update import Near, PrimalDual, forces_at, local_update
from drystone.statics.lp.certificate import certified_fall, optimum_of
from drystone.statics.lp.cone_program import ConeProgram
from drystone.statics.lp.extremes import Extreme, certified_extreme
from drystone.statics.lp.highs import TOLERANCE, WARM, HighsSession, WarmBasis, WarmSession
from drystone.statics.lp.program import EquilibriumProgram, Units, assemble
from drystone.statics.model import GROUND, Addition, Direction, RigidBlockModel
from drystone.statics.result import Certificate, LateralResistance, LimitResult, LimitStatus

SIMPLEX = "simplex"
LOCAL = "HiGHS simplex below the stone"

NO_WEAKER = "It carries no less than on its weaker side."

MANY_BLOCKS = 120
"""Walls of more blocks are not for the simplex kernel.

At 120 the inverses of both ends take 4 MB, and all states that a plan may go back to, which it
keeps, 170 MB; at 200 it would be 800 MB.  In time the break-even is about 400.
"""

UNSOLVED = 8
"""After so many stones whose answers were found near them the whole wall is solved again."""

MANY_BLOCKS_AT_ONCE = 100
"""From here on a model that does not grow gets its first bases by an interior point method."""


@dataclass(frozen=True, eq=False)
class IncrementalResult:
    """Resistance of a wall with one more stone."""

    resistance: LateralResistance
    """As :func:`drystone.statics.limit.lateral_resistance` gives it, to the last digits.

    Of a candidate for a wall of many stones one side may be told only to be no weaker than the
    other: :attr:`LateralResistance.one_sided`.
    """
    solved_cold: bool = False
    """True when a warm answer had no certificate, so that all was solved again from the start."""


@dataclass(frozen=True, eq=False)
class IncrementalAnalysis(ABC):
    """Limit analysis of a wall on the tilting table, ready for one more stone; immutable.

    Answers depend on the wall and on how it has grown, and not on what else was asked, in which
    order, or in which thread.
    """

    model: RigidBlockModel
    result: IncrementalResult

    def resistance_with(self, model: RigidBlockModel) -> IncrementalResult:
        """Return the resistance of the wall with one more stone, a candidate; nothing changes.

        The model is made from :attr:`model` by :meth:`RigidBlockModel.with_added`.  Any other model
        is answered too, without the gain in time.
        """
        return self.result if model is self.model else self._result_with(model)

    def extended(self, model: RigidBlockModel) -> "IncrementalAnalysis":
        """Return the analysis of the wall with one more stone, the chosen one.

        Its `result` is what `resistance_with` returns for the same model, and never one-sided: to
        the last digits for many stones, else bit by bit.
        """
        return self if model is self.model else self._extended_to(model)

    @abstractmethod
    def _result_with(self, model: RigidBlockModel) -> IncrementalResult: ...

    @abstractmethod
    def _extended_to(self, model: RigidBlockModel) -> "IncrementalAnalysis": ...


@dataclass(frozen=True, eq=False)
class ConeAnalysis(IncrementalAnalysis):
    """A wall of loose stones, whose program grows in arrays; all else is for HiGHS."""

    program: ConeProgram

    def _grown(self, model: RigidBlockModel) -> tuple[Addition, Added] | None:
        """Return what is new; None when it is not for the cone program."""
        addition = model.added
        if addition is None or addition.base is not self.model or not model.blocks:
            return None
        added = self.program.columns_of(addition)
        return None if added is None else (addition, added)


def incremental_analysis(
    model: RigidBlockModel, units: Units, most: int = MANY_BLOCKS
) -> IncrementalAnalysis:
    """Begin with a wall, which may be empty; of more than `most` blocks without the simplex kernel.

    The units, those of a typical stone, are kept as long as the wall grows.  Certificates are
    relative to their weight; alpha does not depend on them.
    """
    if not simplex.AVAILABLE:
        return HighsAnalysis.of(model, units)
    if len(model.blocks) > most:
        return LocalAnalysis.of(model, units)
    # Block by block in the order of the model; what cannot be built in this order is for HiGHS.
    empty, program = RigidBlockModel((), (), model.mu), ConeProgram.empty(units)
    result = IncrementalResult(lateral_resistance(empty))
    ends = Optimum.of_nothing(1), Optimum.of_nothing(-1)
    analysis = SimplexAnalysis(empty, result, program, *ends, most)
    place = {GROUND: -1, **{block.id: i for i, block in enumerate(model.blocks)}}
    last = np.array([max(place[i.block], place[i.other]) for i in model.interfaces], np.int32)
    for i, block in enumerate(model.blocks):
        new = tuple(model.interfaces[k] for k in np.flatnonzero(last == i))
        extended = analysis.extended(analysis.model.with_added((block,), new))
        if not isinstance(extended, SimplexAnalysis):
            return HighsAnalysis.of(model, units)
        analysis = extended
    order = np.argsort(last, kind="stable").astype(np.int32)
    program = replace(analysis.program, interfaces=order[analysis.program.interfaces])
    return replace(analysis, model=model.forgetting(), program=program)


@dataclass(frozen=True, eq=False)
class SimplexAnalysis(ConeAnalysis):
    """What the inner loop of a planner asks: loose stones, by :mod:`drystone.kernels.simplex`."""

    greatest: Optimum
    least: Optimum
    most: int

    def _in_highs(self) -> "HighsAnalysis":
        """Begin anew: HiGHS has not followed this wall."""
        return HighsAnalysis.of(RigidBlockModel((), (), self.model.mu), self.program.units)

    def _result_with(self, model: RigidBlockModel) -> IncrementalResult:
        grown = self._grown(model)
        if grown is None:
            return self._in_highs().resistance_with(model)
        ends = self.greatest, self.least
        return _result_between(model, (self._bound(end, grown[1])[1] for end in ends))

    def _extended_to(self, model: RigidBlockModel) -> IncrementalAnalysis:
        grown = self._grown(model)
        if grown is None:
            return self._in_highs().extended(model)
        addition, added = grown
        greatest, upper = self._bound(self.greatest, added)
        least, lower = self._bound(self.least, added)
        result = _result_between(model, (upper, lower))
        program = self.program.appended(addition, added)
        model = model.forgetting()  # or every model would keep all those before it
        certified = upper is not None and lower is not None
        optimal = greatest.status == simplex.OPTIMAL and least.status == simplex.OPTIMAL
        if not (certified and optimal) or len(program.weights) > self.most:
            return replace(LocalAnalysis.of(model, program.units), result=result)
        ends = self.greatest.extended(added, greatest), self.least.extended(added, least)
        return SimplexAnalysis(model, result, program, *ends, self.most)

    def _bound(self, optimum: Optimum, added: Added) -> "tuple[Answer, Bound | None]":
        """Solve for one end; no bound without a certificate that holds."""
        answer = optimum.solved_with(added)
        if answer.status == simplex.FAILED:
            return answer, None
        return answer, _bound_of(self.program, added, answer, optimum.sign, SIMPLEX)


class LocalEnd(NamedTuple):
    """One end of the range of alpha of a wall, and where HiGHS looks for it from."""

    known: PrimalDual
    basis: WarmBasis
    unsolved: int = 0  # stones that HiGHS knows no more of than what carries them


@dataclass(frozen=True, eq=False)
class LocalAnalysis(ConeAnalysis):
    """Many loose stones: what a stone changes near it first, then the whole wall.

    See :mod:`drystone.statics.local_update` for the small programs.  An answer of theirs counts
    only with a certificate of the whole wall; without one HiGHS solves the whole program for that
    end.
    """

    greatest: LocalEnd
    least: LocalEnd

    @classmethod
    def of(cls, model: RigidBlockModel, units: Units) -> IncrementalAnalysis:
        """Begin with a wall of many stones."""
        by_highs = HighsAnalysis.of(model, units)
        addition = Addition(RigidBlockModel((), (), model.mu), model.blocks, model.interfaces)
        program = ConeProgram.empty(units)
        added = program.columns_of(addition)
        if added is None or by_highs.extremes is None:
            return by_highs
        if any(extreme.status is not LimitStatus.OPTIMAL for extreme in by_highs.extremes):
            return by_highs
        least, greatest = (
            LocalEnd(_known(sign, extreme), basis)
            for sign, extreme, basis in zip((-1, 1), by_highs.extremes, by_highs.bases, strict=True)
        )
        program = program.appended(addition, added)
        return cls(by_highs.model, by_highs.result, program, greatest, least)

    def _in_highs(self) -> "HighsAnalysis":
        bases = WarmBases(self.least.basis, self.greatest.basis)
        return HighsAnalysis(self.model, self.result, self.program.units, bases)

    def _result_with(self, model: RigidBlockModel) -> IncrementalResult:
        grown = self._grown(model)
        bounds = None if grown is None else self._bounds(model, grown[1])
        if bounds is None:
            return self._in_highs().resistance_with(model)
        return _result_between(model, bounds)

    def _extended_to(self, model: RigidBlockModel) -> IncrementalAnalysis:
        grown = self._grown(model)
        if grown is None:
            return self._in_highs().extended(model)
        addition, added = grown
        near = Near(self.program, added)
        ends, bounds = [], []
        for end, opposite in self._ends:
            found, bound = None, None
            if end.unsolved < UNSOLVED:
                found, bound = self._found_near(near, end.known, opposite.known)
            if found is not None and bound is not None:
                carried = found.forces[len(found.forces) - len(added.cones.first) :]
                # HiGHS is told of the stone without solving: the basis gets what carries it.
                basis = end.basis.without(added.closed)
                basis = basis.carrying(carried, 3 * len(added.weights))
                after = LocalEnd(found, basis, end.unsolved + 1)
            else:
                after, bound = self._solved(model, added, end)
            if bound is None or bound.falls:
                return self._in_highs().extended(model)
            ends.append(after)
            bounds.append(bound)
        program, result = self.program.appended(addition, added), _result_between(model, bounds)
        return LocalAnalysis(model.forgetting(), result, program, *ends)

    @property
    def _ends(self) -> tuple[tuple[LocalEnd, LocalEnd], ...]:
        """Both ends, each with the opposite one."""
        return (self.greatest, self.least), (self.least, self.greatest)

    def _found_near(
        self, near: Near, end: PrimalDual, opposite: PrimalDual
    ) -> "tuple[PrimalDual | None, Bound | None]":
        """Look near a stone; no bound without a certificate that holds."""
        found = local_update(near, end, opposite)
        if found is None:
            return None, None
        return found, _bound_of(self.program, near.added, found, end.sign, LOCAL)

    def _solved(
        self, model: RigidBlockModel, added: Added, end: LocalEnd
    ) -> "tuple[LocalEnd, Bound | None]":
        """Let HiGHS solve for one end of the whole wall with a stone."""
        program, bases = self._in_highs().prepared(model)
        session, sign = WarmSession(program), end.known.sign
        basis = bases.greatest if sign == 1 else bases.least
        extreme = _warm_extreme(program, session, basis, sign)
        if extreme.status not in (LimitStatus.OPTIMAL, LimitStatus.UNSTABLE):
            return end, None
        found = _known(sign, extreme)
        bound = _bound_of(self.program, added, found, sign, WARM)
        return LocalEnd(found, session.basis() or basis), bound

    def _bounds(self, model: RigidBlockModel, added: Added) -> "tuple[Bound, ...] | None":
        """Find the end that is weaker in the wall; of the other, whether it is no weaker (LLC).

        A fall alone says enough.  None where an end is not found, or there is none.
        """
        near, found = Near(self.program, added), dict[int, Bound]()
        for one, other in sorted(self._ends, key=lambda ends: abs(ends[0].known.alpha)):
            end, opposite = one.known, other.known
            weaker = found.get(-end.sign)
            bound = None if weaker is None else self._carries(-weaker.alpha, end, opposite, near)
            bound = bound or self._found_near(near, end, opposite)[1]
            bound = bound or self._solved(model, added, one)[1]
            if bound is None or bound.falls:
                return None if bound is None else (bound,)
            found[end.sign] = bound
        return found[1], found[-1]

    def _carries(
        self, alpha: float, end: PrimalDual, opposite: PrimalDual, near: Near
    ) -> "Bound | None":
        """Prove that the wall with a stone carries an alpha, and maybe more towards one end."""
        forces, added = forces_at(near, end, opposite, alpha), near.added
        if forces is None:
            return None
        rest = np.zeros(3 * (len(self.program.weights) + len(added.weights)))
        found = figures(self.program.cones, self.program.weights, added, alpha, forces, rest)
        proof = Certificate(found.residual, found.violation, lower=alpha)
        return Bound(alpha, proof, LOCAL) if proof.balances else None


def _known(sign: int, extreme: Extreme) -> PrimalDual:
    """Return what HiGHS has found of an end; a fall has no alpha."""
    solution = extreme.solution
    if extreme.status is LimitStatus.OPTIMAL:
        columns, duals = solution.optimum
        return PrimalDual(sign, extreme.alpha, columns[1:], -duals)
    assert solution.duals is not None  # noqa: S101 - it is certified
    return PrimalDual(sign, np.nan, np.empty(0), -solution.duals)


class WarmBases(NamedTuple):
    """Where the two ends of the range of alpha are looked for from."""

    least: WarmBasis = WarmBasis()
    greatest: WarmBasis = WarmBasis()

    def appended(self, program: EquilibriumProgram) -> "WarmBases":
        """Return bases of a program with more columns and rows."""
        size = program.column_count, len(program.rhs)
        return WarmBases(self.least.appended(*size), self.greatest.appended(*size))

    def without(self, closed: NDArray[np.integer]) -> "WarmBases":
        """Return bases of a program without some edges of friction cones, by their numbers."""
        return WarmBases(*(basis.without(closed) for basis in self))


@dataclass(frozen=True, eq=False)
class HighsAnalysis(IncrementalAnalysis):
    """Any model: the primal simplex method of HiGHS from the bases of the wall.

    A solver is used for one model only, so that answers do not depend on what was asked before.
    """

    units: Units
    bases: WarmBases  # optimal ones; where there is none, the last ones
    extremes: tuple[Extreme, Extreme] | None = None
    """The least and the greatest alpha; None without free blocks."""

    @classmethod
    def of(cls, model: RigidBlockModel, units: Units) -> "HighsAnalysis":
        """Begin with a wall, which may be empty."""
        program = assemble(model, units=units)
        starts = WarmBases().appended(program)
        if len(program.block_ids) >= MANY_BLOCKS_AT_ONCE:
            # Bases near the optimum, by crossover: hundreds of times quicker.
            session = HighsSession(program, "ipm")
            certified_extreme(program, session, 1.0)
            greatest = session.basis()
            certified_extreme(program, session, -1.0)
            starts = WarmBases(session.basis() or starts.least, greatest or starts.greatest)
        return cls._of(model, units, program, starts)

    @classmethod
    def _of(
        cls, model: RigidBlockModel, units: Units, program: EquilibriumProgram, starts: WarmBases
    ) -> "HighsAnalysis":
        """Solve both ends from their bases."""
        model = model.forgetting()  # or every model would keep all those before it
        if not program.block_ids:
            return cls(model, IncrementalResult(lateral_resistance(model)), units, starts)
        session = WarmSession(program)
        least = greatest = _warm_extreme(program, session, starts.greatest, 1)
        lower = upper = session.basis()
        if greatest.status is not LimitStatus.UNSTABLE:  # or no alpha holds the blocks up
            least = _warm_extreme(program, session, starts.least, -1)
            lower = session.basis()
        result = IncrementalResult(resistance_between(program, least, greatest, model.mu))
        if result.resistance.failed:
            result = IncrementalResult(lateral_resistance(model), solved_cold=True)
        bases = WarmBases(lower or starts.least, upper or starts.greatest)
        return cls(model, result, units, bases, (least, greatest))

    def _result_with(self, model: RigidBlockModel) -> IncrementalResult:
        return self._extended_to(model).result

    def _extended_to(self, model: RigidBlockModel) -> "HighsAnalysis":
        return self._of(model, self.units, *self.prepared(model))

    def prepared(self, model: RigidBlockModel) -> tuple[EquilibriumProgram, WarmBases]:
        """Return the program of another model, and bases to start from, if it grew from this."""
        program = assemble(model, units=self.units)
        added = model.added
        if added is None or added.base is not self.model:
            return program, WarmBases().appended(program)
        gone = np.isin(np.repeat(self.model.contact_interfaces, 2), added.closed)
        return program, self.bases.without(np.flatnonzero(gone)).appended(program)


def _warm_extreme(
    program: EquilibriumProgram, session: WarmSession, start: WarmBasis, sign: int
) -> Extreme:
    """Solve from a basis; once more from the last one if there is no certificate.

    Thousands of blocks can cost the factors of the basis their last digits; then they are made
    anew.
    """
    session.start_from(start)
    extreme = certified_extreme(program, session, float(sign))
    optimal = extreme.solution.status is LimitStatus.OPTIMAL
    if not (extreme.status is LimitStatus.FAILED and optimal):
        return extreme
    last = session.basis()
    if last is None:
        return extreme
    session.start_from(last)
    return certified_extreme(program, session, float(sign))


class Bound(NamedTuple):
    """One end of the range of alpha, certified."""

    alpha: float  # load multiplier; NaN when there is none at all
    certificate: Certificate  # that it is the end, or that the blocks fall by themselves
    solver: str

    @property
    def falls(self) -> bool:
        """Whether it proves that the blocks do not stand."""
        return self.certificate.fall_work is not None


def _bound_of(
    program: ConeProgram, added: Added, answer: Answer | PrimalDual, sign: int, solver: str
) -> Bound | None:
    """Certify forces and mechanism of a wall with a stone."""
    found = figures(
        program.cones, program.weights, added, answer.alpha, answer.forces, answer.velocity
    )
    return certified_bound(found, answer.alpha, sign, solver)


def certified_bound(found: Figures, alpha: float, sign: int, solver: str) -> Bound | None:
    """Return the greatest (sign 1) or least (-1) alpha if the figures prove it.

    Beyond 0 they have to prove that the blocks fall by themselves: no forces do.  With an alpha
    that is NaN they have to prove that no alpha holds them up.
    """
    certificate = optimum_of(found, alpha, sign)
    if isnan(alpha) or sign * alpha < -TOLERANCE:
        certificate = certified_fall(found, found.live if isnan(alpha) else 0.0)
    return Bound(alpha, certificate, solver) if certificate.holds else None


def _result_between(model: RigidBlockModel, bounds: Iterable[Bound | None]) -> IncrementalResult:
    """Return the resistance of a wall from the greatest alpha and the least.

    The second is not looked at when the first says enough.  Without a certificate for one of them
    the wall is solved from the start.
    """
    found = []
    status = LimitStatus.OPTIMAL
    for bound in bounds:
        if bound is None:
            return IncrementalResult(lateral_resistance(model), solved_cold=True)
        if bound.falls:
            status, found = LimitStatus.UNSTABLE, [bound, bound]
            break
        found.append(bound)

    def result(direction: Direction, bound: Bound, alpha: float) -> LimitResult:
        one_sided = not bound.falls and bound.certificate.upper is None
        return LimitResult(
            status,
            direction,
            max(0.0, alpha) if status is LimitStatus.OPTIMAL else None,
            certificate=bound.certificate,
            message=NO_WEAKER if one_sided else MESSAGES[status],
            solver=bound.solver,
        )

    greatest, least = found
    left, right = result("left", least, -least.alpha), result("right", greatest, greatest.alpha)
    return IncrementalResult(LateralResistance(left, right, model.mu))
