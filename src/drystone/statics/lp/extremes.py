"""The two ends of the range of alpha: solvers are asked in turn until an answer is certified."""

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, Protocol

import numpy as np

from drystone.model.settings import of_type
from drystone.statics.lp.certificate import certify
from drystone.statics.lp.highs import HighsSession, WarmSession
from drystone.statics.lp.program import EquilibriumProgram, Floats, Solution
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import Certificate, LimitStatus

Solver = Literal["auto", "highs", "highs-ipm", "clarabel"]

MANY_BLOCKS = 50
"""From here on "auto" asks the interior point method first, unless a mechanism is wanted."""

MANY_BLOCKS_FOR_A_VERTEX = 300
"""From here on it does so for a mechanism too, which may then blend several."""

LIGHT = 1e-3
"""A block below this share of the mean weight has units of its own; others are as they were."""

WEIGHTLESS = 1e-8
"""A block below this share is meant to weigh nothing, and so has none."""


class Session(Protocol):
    """One program in a solver."""

    def minimise(self, costs: Floats) -> Solution:
        """Minimise costs . x."""
        ...


@dataclass(frozen=True, eq=False)
class Extreme:
    """One end of the range of alpha: a solution and its certificate."""

    solution: Solution
    certificate: Certificate | None

    @cached_property
    def status(self) -> LimitStatus:
        """FAILED unless the certificate holds."""
        if self.certificate is None or not self.certificate.holds:
            return LimitStatus.FAILED
        return self.solution.status

    @property
    def alpha(self) -> float:
        """Load multiplier of an optimal solution."""
        return float(self.solution.optimum[0][0])


def extremes(
    model: RigidBlockModel, program: EquilibriumProgram, solver: Solver, *, mechanism: bool
) -> tuple[Extreme, Extreme]:
    """Find the least and the greatest alpha.

    Solvers and certificates allow errors of 1e-9 to 1e-8 of the mean weight.  The moment that
    brings down a stone of a millionth of it is no larger, so the equations of light blocks are
    divided by their own weight and size.  Velocities come in the units of the program, certificates
    in those of each block.
    """
    units = units_of_light_blocks(model, program)
    if units is not None:
        value = program.value / units[program.index]
        scaled = replace(program, value=value, rhs=program.rhs / units)
        least, greatest = _extremes(scaled, solver, mechanism=mechanism)
        if LimitStatus.FAILED not in (least.status, greatest.status):
            return _unscaled(least, units), _unscaled(greatest, units)
        # Slivers under heavy blocks are badly scaled so; an answer needs its certificate anyway.
    return _extremes(program, solver, mechanism=mechanism)


def units_of_light_blocks(model: RigidBlockModel, program: EquilibriumProgram) -> Floats | None:
    """Return the unit of every row, in those of the program; None where all of them are 1."""
    free = [block for block in model.blocks if not block.fixed]
    weights = np.array([block.weight for block in free]) / program.weight
    light = (weights >= WEIGHTLESS) & (weights < LIGHT)
    if not light.any():
        return None
    sizes = np.sqrt([block.area for block in free]) / program.length
    own = np.column_stack((weights, weights, weights * sizes))
    own[~light] = 1.0
    return np.asarray(own[program.rows >= 0])


def _unscaled(extreme: Extreme, units: Floats) -> Extreme:
    """Return the same with duals, the velocities, that belong to the rows as they were."""
    duals = extreme.solution.duals
    if duals is None:
        return extreme
    return Extreme(replace(extreme.solution, duals=duals / units), extreme.certificate)


def _extremes(
    program: EquilibriumProgram, solver: Solver, *, mechanism: bool
) -> tuple[Extreme, Extreme]:
    """Find the greatest alpha, then the least from its basis."""
    sessions = _sessions(program, solver, mechanism=mechanism)
    greatest, session = _certified(program, (make() for make in sessions), 1.0)
    if greatest.status is LimitStatus.UNSTABLE:
        return greatest, greatest
    again = itertools.chain([session], (make() for make in sessions))
    least, _ = _certified(program, again, -1.0)
    return least, greatest


def _certified(
    program: EquilibriumProgram, sessions: Iterable[Session], sign: float
) -> tuple[Extreme, Session]:
    """Return the first answer whose certificate holds, or the last one, and its session."""
    for session in sessions:
        extreme = certified_extreme(program, session, sign)
        if extreme.status is not LimitStatus.FAILED:
            break
    return extreme, session


def _sessions(
    program: EquilibriumProgram, solver: Solver, *, mechanism: bool
) -> list[Callable[[], Session]]:
    """Return what makes the sessions to ask, in this order."""

    def clarabel() -> Session:
        # Walls of a few stones never need it.
        from drystone.statics.lp.clarabel import ClarabelSession  # noqa: PLC0415

        return ClarabelSession(program)

    kinds: dict[str, Callable[[], Session]] = {
        "highs": lambda: HighsSession(program),
        "highs-ipm": lambda: HighsSession(program, "ipm"),
        "clarabel": clarabel,
        # Large friction and heavy stones cost the others the last digits of their forces.
        "refined": lambda: WarmSession(program),
    }
    if solver != "auto":
        return [kinds[of_type(solver, Solver, "solver")]]
    many = MANY_BLOCKS_FOR_A_VERTEX if mechanism else MANY_BLOCKS
    if len(program.block_ids) < many:
        return list(kinds.values())
    return [kinds[name] for name in ("clarabel", "highs-ipm", "highs", "refined")]


def certified_extreme(program: EquilibriumProgram, session: Session, sign: float) -> Extreme:
    """Find the greatest (sign 1) or least (-1) alpha and certify the answer."""
    costs = np.zeros(program.column_count)
    costs[0] = -sign
    solution = session.minimise(costs)
    if solution.status is not LimitStatus.UNBOUNDED:
        return Extreme(solution, certify(program, solution, sign))
    # Any live load is carried, if the dead load is carried at all.  A growing state of self-stress
    # tells nothing of that: of a wall that falls by itself an interior point method may find one.
    held = session.minimise(np.zeros(program.column_count))
    proof = certify(program, held, sign)
    if held.status is LimitStatus.UNSTABLE:
        return Extreme(held, proof)
    if held.status is not LimitStatus.OPTIMAL or proof is None or not proof.balances:
        return Extreme(solution, None)
    return Extreme(solution, certify(program, solution, sign))
