"""Search for forces and motions of blocks with Coulomb friction and no dilatancy.

The method is told in :mod:`drystone.statics.flow.nonassociative`.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from drystone.statics.flow.flow_rule import (
    NOTHING,
    ContactRates,
    ForcesOfMotion,
    MotionsOfForces,
    State,
)
from drystone.statics.lp.highs import HighsSession
from drystone.statics.lp.program import EquilibriumProgram, Floats
from drystone.statics.result import LimitStatus

Pattern = Literal["even", "head joints", "bed joints", "mechanism", "rest", "random"]

RUNAWAY = 1e8
"""Slip rates above this, when the live load does work at a rate of 1, have left for infinity."""


@dataclass(frozen=True)
class Start:
    """Slip rates with which rounds begin, and how far each round goes."""

    name: str
    pattern: Pattern
    """"even": the same rate at every contact point; "head joints" and "bed joints": by how level or
    upright the normal is; "mechanism": those of the associative mechanism; "rest": where that one
    does not slide; "random": powers of random numbers, few of them large."""
    factor: float  # largest rate over the largest one of the associative mechanism
    step: float
    """Part of the way to the slip rates of the last motion that a round goes, above 0 to 1."""


STARTS = (
    Start("even slip", "even", 10.0, 0.5),
    Start("slip in head joints", "head joints", 10.0, 0.5),
    Start("slip in bed joints", "bed joints", 10.0, 0.5),
    Start("slip of resting contacts", "rest", 10.0, 0.5),
    Start("fast associative slip", "mechanism", 50.0, 0.7),
    Start("no slip", "mechanism", 0.0, 0.3),
)


@dataclass(frozen=True)
class NonassociativeSettings:
    """How much is tried.

    Parameters
    ----------
    rounds : int
        Most rounds from each start.
    patience : int
        Steps of descent in a row without a lower load, after which it ends.
    starts : tuple of Start
        All are tried, in this order.
    random_starts : int
        So many more, from random slip rates.
    seed : int
        Of the random slip rates.
    let_go : bool
        It is looked first whether the blocks can fall when they are let go.
    """

    rounds: int = 60
    patience: int = 5
    starts: tuple[Start, ...] = STARTS
    random_starts: int = 6
    seed: int = 0
    let_go: bool = True

    @property
    def all_starts(self) -> tuple[Start, ...]:
        """The fixed and the random ones."""
        more = (Start(f"random {i + 1}", "random", 30.0, 0.5) for i in range(self.random_starts))
        return (*self.starts, *more)


@dataclass(frozen=True, eq=False)
class Found:
    """What the rounds from one start came to."""

    method: str
    rounds: int
    state: State | None  # forces and a motion that go together, if any


class Search:
    """All attempts at one direction of one program, whose blocks stand under their dead load.

    The sign is 1 along the live load, -1 against it.  `upright` (m,) is the vertical part of the
    unit normal at every contact point, 0 to 1: 1 in a bed joint.  `look` is called before every
    round and every step of descent; what it raises ends the search.
    """

    def __init__(
        self,
        program: EquilibriumProgram,
        sign: float,
        upright: Floats,
        settings: NonassociativeSettings,
        look: Callable[[], None] = lambda: None,
    ) -> None:
        self._program, self._sign, self._upright = program, sign, upright
        self._settings = settings
        self._look = look
        self._slip = ContactRates.of(program).slip
        self._forces = ForcesOfMotion(program, sign)
        self._motions = MotionsOfForces(program, sign)

    @property
    def moves(self) -> bool:
        """False when no motion that closes no contact goes along with the load."""
        return self._motions.exist

    def attempts(self) -> Iterator[Found]:
        """Yield what each start leads to."""
        first = self._round(HighsSession(self._program), np.zeros(len(self._upright)))
        # Without an associative mechanism, where no load is too great for one, all slip alike.
        mechanism = np.ones(len(self._upright))
        if first is not None:
            mechanism = np.abs(self._slip.T @ first.velocity)
        rng = np.random.default_rng(self._settings.seed)
        for start in self._settings.all_starts:
            rounds, state = self._rounds(self._rates(start, mechanism, rng), start.step)
            yield Found(start.name, rounds, state and self._descended(state))

    def _rates(self, start: Start, mechanism: Floats, rng: np.random.Generator) -> Floats:
        largest = float(mechanism.max(initial=0.0)) or 1.0
        shares = {
            "even": np.ones_like(mechanism),
            "head joints": 1.0 - self._upright,
            "bed joints": self._upright,
            "mechanism": mechanism / largest,
            "rest": 1.0 - mechanism / largest,
            "random": rng.random(len(mechanism)) ** 4,
        }
        return start.factor * largest * shares[start.pattern]

    def _rounds(self, rates: Floats, step: float) -> tuple[int, State | None]:
        """Go on until a motion goes with the forces of a round."""
        session = HighsSession(self._program)
        for number in range(1, self._settings.rounds + 1):
            state = self._round(session, rates)
            if state is None:
                return number, None
            velocity = self._motions.find(state.edges)
            if velocity is not None:
                return number, State(state.alpha, state.edges, velocity)
            rates = rates + step * (np.abs(self._slip.T @ state.velocity) - rates)
            if rates.max() > RUNAWAY:
                return number, None
        return self._settings.rounds, None

    def _round(self, session: HighsSession, rates: Floats) -> State | None:
        """Maximise alpha - sum r n; None when the solver gives up."""
        self._look()
        costs = np.concatenate(([-self._sign], np.repeat(rates, 2)))
        found = session.minimise(costs)
        if found.status is not LimitStatus.OPTIMAL or found.columns is None or found.duals is None:
            return None
        edges = np.maximum(found.columns[1:], 0.0).reshape(-1, 2)
        return State(self._sign * float(found.columns[0]), edges, -found.duals)

    def _descended(self, state: State) -> State:
        """Improve forces and motion in turn until alpha has not fallen for some steps."""
        stalled = 0
        while stalled < self._settings.patience:
            self._look()
            better = self._forces.find(state.velocity)
            if better is None or better.alpha > state.alpha + NOTHING:
                return state
            stalled = stalled + 1 if better.alpha > state.alpha - NOTHING else 0
            state = State(better.alpha, better.edges, state.velocity)
            if not better.wanted.any():
                return state
            velocity = self._motions.find(state.edges, better.wanted, state.velocity)
            if velocity is None:
                return state
            state = State(state.alpha, state.edges, velocity)
        return state
