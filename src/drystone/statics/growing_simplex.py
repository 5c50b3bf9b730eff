"""Growing walls of loose stones by the simplex kernel: what the inner loop of a planner asks.

What the kernel is not made for is left to :mod:`drystone.statics.growing_highs`, fixed and guided
blocks and models that do not grow, and to :mod:`drystone.statics.growing_large`, walls of many
stones.
"""

from dataclasses import dataclass, replace

import numpy as np

from drystone.kernels.certificate import figures
from drystone.kernels.simplex import (
    FAILED,
    OPTIMAL,
    Added,
    Answer,
    Tilt,
    empty_tilt,
    grown_tilt,
    solve_added,
)
from drystone.statics import growing_highs, growing_large
from drystone.statics.appending import Units
from drystone.statics.cone_program import ConeProgram
from drystone.statics.ends import End, no_alpha, optimum, told
from drystone.statics.grown import GrowingAnalysis, Grown
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, RigidBlockModel

NAME = "simplex"

MANY_BLOCKS = 120
"""Walls of more blocks are left to others.

At 120 the inverses of both tilts take 4 MB, and all states that a plan may go back to, which it
keeps, 170 MB; at 200 it would be 800 MB.  In time the break-even is about 400.
"""


@dataclass(frozen=True, eq=False)
class SimplexGrowth:
    """A :class:`GrowingAnalysis` by the simplex kernel.

    Parameters
    ----------
    model : RigidBlockModel
        The wall: loose blocks.
    grown : Grown
        Its resistance.
    program : ConeProgram
        Its equations.
    greatest, least : Tilt
        Its two tilts, solved.
    most : int
        Walls of more blocks are left to others.
    """

    model: RigidBlockModel
    grown: Grown
    program: ConeProgram
    greatest: Tilt
    least: Tilt
    most: int = MANY_BLOCKS

    @classmethod
    def empty(cls, mu: float, units: Units, most: int = MANY_BLOCKS) -> "SimplexGrowth":
        """Return the analysis before the first stone."""
        model = RigidBlockModel((), (), mu)
        grown = Grown(lateral_resistance(model))
        return cls(model, grown, ConeProgram.empty(units), empty_tilt(1), empty_tilt(-1), most)

    def resistance_with(self, model: RigidBlockModel) -> Grown:
        """See :meth:`GrowingAnalysis.resistance_with`."""
        if model is self.model:
            return self.grown
        added = self._added(model)
        if added is None:
            return self._otherwise().resistance_with(model)
        tilts = (self.greatest, self.least)
        return told(model, (_solved(self.program, tilt, added)[1] for tilt in tilts))

    def extended(self, model: RigidBlockModel) -> GrowingAnalysis:
        """See :meth:`GrowingAnalysis.extended`."""
        if model is self.model:
            return self
        added = self._added(model)
        if added is None:
            return self._otherwise().extended(model)
        assert model.added is not None  # noqa: S101 - or nothing would be added
        greatest, upper = _solved(self.program, self.greatest, added)
        least, lower = _solved(self.program, self.least, added)
        grown = told(model, (upper, lower))
        program = self.program.appended(model.added, added)
        model = model.forgetting()  # or every model would keep all those before it
        certified = upper is not None and lower is not None
        optimal = greatest.status == OPTIMAL and least.status == OPTIMAL
        if not (certified and optimal) or len(program.weights) > self.most:
            return replace(growing_large.begun(model, program.units), grown=grown)
        return SimplexGrowth(
            model,
            grown,
            program,
            grown_tilt(self.greatest, added, greatest),
            grown_tilt(self.least, added, least),
            self.most,
        )

    def _added(self, model: RigidBlockModel) -> Added | None:
        """Return what is new; None when it is not for the kernel."""
        addition = model.added
        if addition is None or addition.base is not self.model:
            return None
        added = self.program.columns_of(addition, model.mu)
        if added is None or not len(self.program.weights) + len(added.weights):
            return None
        return added

    def _otherwise(self) -> growing_highs.WarmGrowth:
        nothing = RigidBlockModel((), (), self.model.mu)
        return growing_highs.begun(nothing, self.program.units)


def begun(model: RigidBlockModel, units: Units, most: int = MANY_BLOCKS) -> GrowingAnalysis:
    """Begin with a wall, which may be empty; see :func:`drystone.statics.growing.growing`.

    It is built block by block in the order of the model; if it cannot be built in this order, it
    is for HiGHS.
    """
    if len(model.blocks) > most:
        return growing_large.begun(model, units)
    analysis = SimplexGrowth.empty(model.mu, units, most)
    place = {GROUND: -1, **{block.id: i for i, block in enumerate(model.blocks)}}
    last = np.array([max(place[i.block], place[i.other]) for i in model.interfaces], np.int32)
    for i, block in enumerate(model.blocks):
        new = tuple(model.interfaces[k] for k in np.flatnonzero(last == i))
        grown = analysis.extended(analysis.model.with_added((block,), new))
        if not isinstance(grown, SimplexGrowth):
            return growing_highs.begun(model, units)
        analysis = grown
    order = np.argsort(last, kind="stable").astype(np.int32)
    program = replace(analysis.program, interfaces=order[analysis.program.interfaces])
    return replace(analysis, model=model.forgetting(), program=program)


def _solved(program: ConeProgram, tilt: Tilt, added: Added) -> tuple[Answer, End | None]:
    """Solve one tilt; no end without a certificate that holds."""
    answer = solve_added(tilt, added)
    if answer.status == FAILED:
        return answer, None
    found = figures(
        program.cones, program.weights, added, answer.alpha, answer.forces, answer.velocity
    )
    if answer.status == OPTIMAL:
        return answer, optimum(found, answer.alpha, tilt.sign, NAME)
    return answer, no_alpha(found, NAME)
