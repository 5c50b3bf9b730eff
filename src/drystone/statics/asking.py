"""Asking solvers for the ends of the range of alpha until an answer is certified."""

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, Protocol

import numpy as np

from drystone.statics.certificate import certify, in_equilibrium
from drystone.statics.program import EquilibriumProgram, Floats
from drystone.statics.result import Certificate, LimitStatus
from drystone.statics.solvers.highs import HighsSession
from drystone.statics.solvers.refined import RefinedSession
from drystone.statics.solvers.solution import Solution

Solver = Literal["auto", "highs", "highs-ipm", "clarabel"]

MANY_BLOCKS = 50
"""From here on "auto" asks the interior point method first, unless a mechanism is wanted."""

MANY_BLOCKS_FOR_A_VERTEX = 300
"""From here on it does so for a mechanism too, which may then blend several."""


class Session(Protocol):
    """One program in a solver."""

    def minimise(self, costs: Floats) -> Solution:
        """Minimise costs . x."""
        ...


@dataclass(frozen=True, eq=False)
class Answer:
    """A solution and its certificate."""

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
        assert self.solution.columns is not None  # noqa: S101 - asked for only when optimal
        return float(self.solution.columns[0])


def extremes(
    program: EquilibriumProgram, solver: Solver, *, mechanism: bool
) -> tuple[Answer, Answer]:
    """Find the least and the greatest alpha, the second from the basis of the first."""
    chain = _chain(program, solver, mechanism=mechanism)
    greatest, session = _certified(program, _made(chain), 1.0)
    if greatest.status is LimitStatus.UNSTABLE:
        return greatest, greatest
    least, _ = _certified(program, itertools.chain([session], _made(chain)), -1.0)
    return least, greatest


def _made(chain: Sequence[Callable[[], Session]]) -> Iterator[Session]:
    return (make() for make in chain)


def _certified(
    program: EquilibriumProgram, sessions: Iterable[Session], sign: float
) -> tuple[Answer, Session]:
    """Return the first answer whose certificate holds, or the last one, and its session."""
    for session in sessions:
        answer = answered(program, session, sign)
        if answer.status is not LimitStatus.FAILED:
            break
    return answer, session


def _chain(
    program: EquilibriumProgram, solver: Solver, *, mechanism: bool
) -> list[Callable[[], Session]]:
    """Return the sessions to ask, in this order."""

    def clarabel() -> Session:
        # Walls of a few stones never need it.
        from drystone.statics.solvers.clarabel import ClarabelSession  # noqa: PLC0415

        return ClarabelSession(program)

    kinds: dict[str, Callable[[], Session]] = {
        "highs": lambda: HighsSession(program),
        "highs-ipm": lambda: HighsSession(program, "ipm"),
        "clarabel": clarabel,
        # Large friction and heavy stones cost the others the last digits of their forces.
        "refined": lambda: RefinedSession(program),
    }
    if solver != "auto":
        return [kinds[solver]]
    many = MANY_BLOCKS_FOR_A_VERTEX if mechanism else MANY_BLOCKS
    if len(program.block_ids) < many:
        return list(kinds.values())
    return [kinds[name] for name in ("clarabel", "highs", "highs-ipm", "refined")]


def answered(program: EquilibriumProgram, session: Session, sign: float) -> Answer:
    """Find the greatest (sign 1) or least (-1) alpha and certify the answer."""
    costs = np.zeros(program.column_count)
    costs[0] = -sign
    solution = session.minimise(costs)
    if solution.status is LimitStatus.UNBOUNDED:
        return _unlimited(program, session, solution, sign)
    return Answer(solution, certify(program, solution, sign))


def _unlimited(
    program: EquilibriumProgram, session: Session, growing: Solution, sign: float
) -> Answer:
    """Return the answer that any live load is carried, if the dead load is carried at all.

    A growing state of self-stress tells nothing of the dead load: of a wall that falls by itself
    an interior point method may find that one as well as the fall.
    """
    held = session.minimise(np.zeros(program.column_count))
    if held.status is LimitStatus.UNSTABLE:
        return Answer(held, certify(program, held, sign))
    proven = held.status is LimitStatus.OPTIMAL and in_equilibrium(program, held)
    return Answer(growing, certify(program, growing, sign) if proven else None)
