"""Growing walls of many loose stones: what a stone changes near it first, then the whole wall.

See :mod:`drystone.statics.neighbourhood` for the small programs.  An answer of theirs counts only
with a certificate of the whole wall; without one HiGHS solves the whole program from the basis of
the wall (:mod:`drystone.statics.growing_highs`).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from drystone.kernels.certificate import figures
from drystone.kernels.simplex import Added
from drystone.statics import growing_highs
from drystone.statics.appending import Units
from drystone.statics.asking import Answer
from drystone.statics.cone_program import ConeProgram
from drystone.statics.ends import End, no_alpha, optimum, told
from drystone.statics.growing_highs import WarmGrowth
from drystone.statics.grown import GrowingAnalysis, Grown
from drystone.statics.model import Addition, RigidBlockModel
from drystone.statics.neighbourhood import Extreme, guessed
from drystone.statics.result import LimitStatus

NAME = "HiGHS simplex below the stone"


@dataclass(frozen=True, eq=False)
class LargeGrowth:
    """A :class:`GrowingAnalysis` that looks below a stone first.

    Parameters
    ----------
    grown : Grown
        Resistance of the wall.
    warm : WarmGrowth
        The wall in HiGHS.
    program : ConeProgram
        Its equations, the columns in the same order.
    greatest, least : Extreme
        Its two tilts, solved.
    """

    grown: Grown
    warm: WarmGrowth
    program: ConeProgram
    greatest: Extreme
    least: Extreme

    @property
    def model(self) -> RigidBlockModel:
        """The wall."""
        return self.warm.model

    def resistance_with(self, model: RigidBlockModel) -> Grown:
        """See :meth:`GrowingAnalysis.resistance_with`."""
        if model is self.model:
            return self.grown
        added = self._added(model)
        if added is None:
            return self.warm.resistance_with(model)
        return told(model, self._ends(model, added))

    def extended(self, model: RigidBlockModel) -> GrowingAnalysis:
        """See :meth:`GrowingAnalysis.extended`."""
        if model is self.model:
            return self
        added = self._added(model)
        if added is None:
            return self.warm.extended(model)
        assert model.added is not None  # noqa: S101 - or nothing would be added
        grown = told(model, self._ends(model, added))
        program = self.program.appended(model.added, added)
        return _large(self.warm.extended(model), grown, program)

    def _added(self, model: RigidBlockModel) -> Added | None:
        addition = model.added
        if addition is None or addition.base is not self.model:
            return None
        return self.program.columns_of(addition, model.mu)

    def _ends(self, model: RigidBlockModel, added: Added) -> Iterator[End | None]:
        """Find the greatest alpha, then the least."""
        whole = None
        for tilt, other in ((self.greatest, self.least), (self.least, self.greatest)):
            end = self._near(tilt, other, added)
            if end is None:
                whole = whole or self.warm.prepared(model)
                end = growing_highs.end(*whole, tilt.sign)
            yield end

    def _near(self, tilt: Extreme, other: Extreme, added: Added) -> End | None:
        guess = guessed(self.program, tilt, other, added)
        if guess is None:
            return None
        found = figures(
            self.program.cones, self.program.weights, added,
            guess.alpha, guess.forces, guess.velocity,
        )  # fmt: skip
        if np.isnan(guess.alpha):
            return no_alpha(found, NAME)
        return optimum(found, guess.alpha, tilt.sign, NAME)


def begun(model: RigidBlockModel, units: Units) -> WarmGrowth | LargeGrowth:
    """Begin with a wall of many stones; see :func:`drystone.statics.growing.growing`."""
    warm = growing_highs.begun(model, units)
    addition = Addition(RigidBlockModel((), (), model.mu), model.blocks, model.interfaces)
    program = ConeProgram.empty(units)
    added = program.columns_of(addition, model.mu)
    if added is None:
        return warm
    return _large(warm, warm.grown, program.appended(addition, added))


def _large(warm: WarmGrowth, grown: Grown, program: ConeProgram) -> WarmGrowth | LargeGrowth:
    """Look near stones from now on, if both tilts of the wall are known."""
    if warm.answers is None:
        return warm
    greatest = _extreme(warm.answers.greatest, 1)
    least = _extreme(warm.answers.least, -1)
    if greatest is None or least is None:
        return replace(warm, grown=grown)
    return LargeGrowth(grown, warm, program, greatest, least)


def _extreme(answer: Answer, sign: int) -> Extreme | None:
    if answer.status is not LimitStatus.OPTIMAL:
        return None
    solution = answer.solution
    assert solution.columns is not None  # noqa: S101 - an optimal solution has both
    assert solution.duals is not None  # noqa: S101
    return Extreme(sign, answer.alpha, solution.columns[1:], -solution.duals)
