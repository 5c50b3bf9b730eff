"""Search for forces and motions of blocks with Coulomb friction and no dilatancy.

At a contact point with normal force n, tangential force t and relative velocity (u_n, u_t) of the
block that the normal points into, the flow rule says

    u_n >= 0,  n >= 0,  n u_n = 0;      |t| <= mu n,  t u_t = -mu n |u_t|:

a contact that opens carries nothing, a closed one sticks, or slides along itself against
friction of mu n.  For given forces these are linear conditions on the motion, and the other way
round, so each half is a linear program.  `n = a + b` and `t = mu (a - b)` are written with the
forces a, b along the two edges of the cone of friction, and slip as the rate r = mu u_t.

The method stands in :mod:`drystone.statics.flow.nonassociative`.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import highspy
import numpy as np
from scipy.sparse import csc_array, csr_array, vstack

from drystone.statics.flow.central_path import CentralPath
from drystone.statics.lp.highs import INFINITY, HighsSession, loaded, solved
from drystone.statics.lp.program import EquilibriumProgram, Floats, Solution
from drystone.statics.result import LimitStatus

Pattern = Literal["even", "head joints", "bed joints", "mechanism", "rest", "random"]

NOTHING = 1e-9
"""Forces and velocities below this share of the largest one are taken as none."""

RUNAWAY = 1e8
"""Slip rates above this, when the live load does work at a rate of 1, have left for infinity."""

SHORTEST, GOLDEN = 0.3, (5.0**0.5 - 1.0) / 2.0
"""A round goes 0.3 to 1.3 of the way to the slip rates of the last motion, spread evenly by the
golden ratio: rounds of equal steps may go round in a circle for ever."""

LEAP, BETWEEN = 30.0, 20
"""So far goes a round after so many others: some slip rates grow by a few per cent in each."""

MANY_POINTS = 700
"""Models of more contact points, some 150 blocks, are answered along central paths first."""

EFFORT = 1.1e8
"""So many rounds are left to them then, times the square of contact points: so rounds grow."""

CLOSING_ROUNDS = 3
"""From the end of a path; the first one nearly always closes."""


@dataclass(frozen=True)
class Start:
    """Slip rates with which rounds begin."""

    name: str
    pattern: Pattern
    """"even": the same rate at every contact point; "head joints" and "bed joints": by how level or
    upright the normal is; "mechanism": those of the associative mechanism; "rest": where that one
    does not slide; "random": powers of random numbers, few of them large."""
    factor: float  # largest rate over the largest one of the associative mechanism


STARTS = (
    Start("even slip", "even", 10.0),
    Start("slip in head joints", "head joints", 10.0),
    Start("slip in bed joints", "bed joints", 10.0),
    Start("slip of resting contacts", "rest", 10.0),
    Start("fast associative slip", "mechanism", 50.0),
    Start("no slip", "mechanism", 0.0),
)


@dataclass(frozen=True)
class NonassociativeSettings:
    """How much is tried."""

    rounds: int = 100  # most rounds from each start
    patience: int = 5  # steps of descent in a row without a lower load, after which it ends
    starts: tuple[Start, ...] = STARTS  # all are tried, in this order
    random_starts: int = 6  # so many more, from random slip rates
    seed: int = 0  # of the random slip rates
    paths: tuple[float, ...] = (0.0, 1.0)
    """How far contacts may close at first along each central path.  Those are taken of many contact
    points, and where no start has led to an answer."""
    let_go: bool = True  # it is looked first whether the blocks can fall when they are let go


@dataclass(frozen=True, eq=False)
class FlowState:
    """Forces and a motion, in the units of the program."""

    alpha: float  # load multiplier along the direction of the search
    edges: Floats  # (m, 2): forces along the two edges of every cone of friction
    velocity: Floats
    """(rows,): one entry a row of the program; the live load does work at a rate of 1."""


@dataclass(frozen=True, eq=False)
class ContactRates:
    """Relative velocities at the contact points as linear functions of the velocities of blocks."""

    normal: csc_array  # (rows, m)
    slip: csc_array  # (rows, m)

    @classmethod
    def of(cls, program: EquilibriumProgram) -> "ContactRates":
        """Take them from the columns of a program."""
        first, second = program.matrix[:, 1::2], program.matrix[:, 2::2]
        return cls(csc_array(first + second) / 2.0, csc_array(first - second) / 2.0)

    @cached_property
    def _transposed(self) -> tuple[csr_array, csr_array]:
        return self.normal.T, self.slip.T

    def opening(self, velocity: Floats) -> Floats:
        """Return u_n (m,) of a motion."""
        return np.asarray(self._transposed[0] @ velocity)

    def sliding(self, velocity: Floats) -> Floats:
        """Return r = mu u_t (m,) of a motion."""
        return np.asarray(self._transposed[1] @ velocity)


class MotionsOfForces:
    """A motion that goes with given forces, along the live load (sign 1) or against it."""

    def __init__(self, program: EquilibriumProgram, rates: ContactRates, sign: float) -> None:
        self._rates = rates
        live = sign * program.matrix[:, [0]]
        matrix = csc_array(vstack((rates.normal.T, rates.slip.T, live.T)))
        self._rows, self._columns = matrix.shape
        self._points = (self._rows - 1) // 2
        options = {"solver": "simplex", "presolve": "off"}
        lower = np.full(self._columns, -INFINITY)
        self._highs = loaded(options, matrix, self._open_bounds(), lower)

    def _open_bounds(self) -> tuple[Floats, Floats]:
        """No contact closes, the live load does work at a rate of 1."""
        least = np.zeros(self._rows)
        greatest = np.full(self._rows, INFINITY)
        least[self._points : -1] = -INFINITY
        least[-1] = greatest[-1] = 1.0
        return least, greatest

    @property
    def exist(self) -> bool:
        """False when no motion at all lets the load do work: that is proved."""
        self._minimise(np.zeros(self._columns), *self._open_bounds())
        return bool(self._highs.getModelStatus() != highspy.HighsModelStatus.kInfeasible)

    def find(
        self, edges: Floats, wanted: Floats | None = None, last: Floats | None = None
    ) -> Floats | None:
        """Return a velocity for each row of the program, or None.

        With `wanted` edges and the `last` motion that went with these forces, the motion in
        which those edges are least in the way: an edge can carry force where its contact is
        closed and does not slide away from it.
        """
        points = self._points
        least, greatest = self._open_bounds()
        bears = edges > NOTHING * max(1.0, float(edges.max(initial=0.0)))
        greatest[:points][bears.any(axis=1)] = 0.0
        greatest[points:-1][bears[:, 0]] = 0.0
        least[points:-1][bears[:, 1]] = 0.0
        costs = np.zeros(self._columns)
        if wanted is not None and last is not None:
            opens = self._rates.opening(last) > NOTHING * float(np.abs(last).max())
            way = np.where(opens, 0.0, np.sign(self._rates.sliding(last)))
            share = wanted.sum(axis=1)
            least[points:-1][(share > 0) & (way > 0)] = 0.0
            greatest[points:-1][(share > 0) & (way < 0)] = 0.0
            costs = self._rates.normal @ (share * opens) + self._rates.slip @ (share * way)
        return self._minimise(costs, least, greatest)

    def _minimise(self, costs: Floats, least: Floats, greatest: Floats) -> Floats | None:
        columns, rows = (np.arange(n, dtype=np.int32) for n in (self._columns, self._rows))
        self._highs.changeColsCost(len(columns), columns, costs)
        self._highs.changeRowsBounds(len(rows), rows, least, greatest)  # type: ignore[attr-defined]
        return solved(self._highs)


def _state(found: Solution, sign: float, velocity: Floats | None = None) -> FlowState | None:
    """Return the forces of a solution with a motion, its duals unless given."""
    if found.status is not LimitStatus.OPTIMAL or found.columns is None or found.duals is None:
        return None
    edges = np.maximum(found.columns[1:], 0.0).reshape(-1, 2)
    motion = -found.duals if velocity is None else velocity
    return FlowState(sign * float(found.columns[0]), edges, motion)


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
        look: Callable[[], None],
    ) -> None:
        self._program, self._sign, self._upright = program, sign, upright
        self._settings = settings
        self._look = look
        self._rates = ContactRates.of(program)
        self._forces = HighsSession(program)
        self.motions = MotionsOfForces(program, self._rates, sign)

    def attempts(self) -> Iterator[tuple[str, int, FlowState | None]]:
        """Yield the name of each start, how many rounds it took, and to which state, if any."""
        first = self._round(HighsSession(self._program), np.zeros(len(self._upright)))
        # Without an associative mechanism, where no load is too great for one, all slip alike.
        mechanism = np.ones(len(self._upright))
        if first is not None:
            mechanism = np.abs(self._rates.sliding(first.velocity))
        settings, points = self._settings, len(mechanism)
        rng = np.random.default_rng(settings.seed)
        more = (Start(f"random {i + 1}", "random", 30.0) for i in range(settings.random_starts))
        starts = [*settings.starts, *more]
        left, found = settings.rounds * len(starts), False
        many = bool(settings.paths) and points > MANY_POINTS
        if many:
            yield from self._along_paths()
            starts.sort(key=lambda start: start.factor)  # the slower, the sooner it ends
            left = int(EFFORT / points**2)
        for start in starts:
            if not left:
                break
            rates = self._slip_rates(start, mechanism, rng)
            rounds, state = self._rounds(rates, min(settings.rounds, left))
            left, found = left - rounds, found or state is not None
            yield start.name, rounds, state and self._descended(state)
        if not (many or found):
            yield from self._along_paths()

    def _along_paths(self) -> Iterator[tuple[str, int, FlowState | None]]:
        path = CentralPath(self._program, self._rates.normal, self._rates.slip, self._sign)
        for closing in self._settings.paths:
            motion = path.motion(closing, self._look)
            if motion is not None:
                slip = np.abs(self._rates.sliding(motion))
                rounds, state = self._rounds(slip, CLOSING_ROUNDS)
                yield f"central path, closing {closing:g}", rounds, state and self._descended(state)

    def _slip_rates(self, start: Start, mechanism: Floats, rng: np.random.Generator) -> Floats:
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

    def _rounds(self, rates: Floats, most: int) -> tuple[int, FlowState | None]:
        """Go on until a motion goes with the forces of a round, at most for so many."""
        session = HighsSession(self._program)
        for number in range(1, most + 1):
            state = self._round(session, rates)
            if state is None:
                return number, None
            velocity = self.motions.find(state.edges)
            if velocity is not None:
                return number, FlowState(state.alpha, state.edges, velocity)
            way = np.abs(self._rates.sliding(state.velocity)) - rates
            if number % BETWEEN:
                rates = rates + (SHORTEST + number * GOLDEN % 1.0) * way
            else:
                rates = np.maximum(rates + LEAP * way, 0.0)
            if rates.max() > RUNAWAY:
                return number, None
        return most, None

    def _round(self, session: HighsSession, rates: Floats) -> FlowState | None:
        """Maximise alpha - sum r n; None when the solver gives up."""
        self._look()
        costs = np.concatenate(([-self._sign], np.repeat(rates, 2)))
        return _state(session.minimise(costs), self._sign)

    def _least_forces(self, velocity: Floats, way: float) -> tuple[FlowState, Floats] | None:
        """Return the state of least alpha (way 1; -1: greatest) that goes with a motion, or None.

        Opening contacts are left without force, sliding ones with the edge that resists.  With it
        comes how much alpha would gain by a unit of force on each edge (m, 2) ruled out so.
        """
        fastest = float(np.abs(velocity).max())
        opens = self._rates.opening(velocity) > NOTHING * fastest
        slip = self._rates.sliding(velocity)
        barred = np.column_stack(
            (opens | (slip > NOTHING * fastest), opens | (slip < -NOTHING * fastest))
        ).ravel()
        columns = np.arange(1, 1 + len(barred), dtype=np.int32)
        upper = np.where(barred, 0.0, INFINITY)
        self._forces.highs.changeColsBounds(len(columns), columns, np.zeros(len(columns)), upper)
        costs = np.zeros(1 + len(barred))
        costs[0] = way * self._sign
        found = self._forces.minimise(costs)
        state = _state(found, self._sign, velocity)
        if state is None:
            return None
        gain = (found.duals @ self._program.matrix)[1:]
        return state, np.where(barred & (gain > NOTHING), gain, 0.0).reshape(-1, 2)

    def _descended(self, state: FlowState) -> FlowState:
        """Improve forces and motion in turn until alpha comes no nearer to 0 for some steps."""
        stalled, way = 0, -1.0 if state.alpha < 0.0 else 1.0
        while stalled < self._settings.patience:
            self._look()
            found = self._least_forces(state.velocity, way)
            if found is None or way * (found[0].alpha - state.alpha) > NOTHING:
                return state
            better, wanted = found
            if way * better.alpha < 0.0:  # what lies between goes with this motion too
                share = state.alpha / (state.alpha - better.alpha)
                edges = state.edges + share * (better.edges - state.edges)
                return FlowState(0.0, edges, state.velocity)
            stalled = stalled + 1 if way * (better.alpha - state.alpha) > -NOTHING else 0
            state = better
            if not wanted.any():
                return state
            velocity = self.motions.find(state.edges, wanted, state.velocity)
            if velocity is None:
                return state
            state = FlowState(state.alpha, state.edges, velocity)
        return state
