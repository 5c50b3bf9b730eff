"""Coulomb friction without dilatancy: which motions go with which forces, and a check of both.

At a contact point with normal force n, tangential force t and relative velocity (u_n, u_t) of the
block that the normal points into, the flow rule says

    u_n >= 0,  n >= 0,  n u_n = 0;      |t| <= mu n,  t u_t = -mu n |u_t|:

a contact that opens carries nothing, a closed one sticks, or slides along itself against
friction of mu n.  For given forces these are linear conditions on the motion, and the other way
round, so each half is a linear program.  `n = a + b` and `t = mu (a - b)` are written with the
forces a, b along the two edges of the cone of friction, and slip as the rate r = mu u_t.
"""

from dataclasses import dataclass

import highspy
import numpy as np
from scipy.sparse import csc_array, vstack

from drystone.statics.lp.highs import TOLERANCE, HighsSession, silent_highs
from drystone.statics.lp.program import EquilibriumProgram, Floats
from drystone.statics.result import LimitStatus

NOTHING = 1e-9
"""Forces and velocities below this share of the largest one are taken as none."""


@dataclass(frozen=True, eq=False)
class State:
    """Forces and a motion, in the units of the program."""

    alpha: float  # load multiplier along the direction of the search
    edges: Floats  # (m, 2): forces along the two edges of every cone of friction
    velocity: Floats
    """(rows,): one entry a row of the program; the live load does work at a rate of 1."""


@dataclass(frozen=True, eq=False)
class ContactRates:
    """Relative velocities at the contact points as linear functions of the velocities of blocks."""

    normal: csc_array  # (rows, m): its transpose times a velocity is the rate of opening u_n
    slip: csc_array  # (rows, m): its transpose times a velocity is r = mu u_t

    @classmethod
    def of(cls, program: EquilibriumProgram) -> "ContactRates":
        """Take them from the columns of a program."""
        first, second = program.matrix[:, 1::2], program.matrix[:, 2::2]
        return cls(csc_array(first + second) / 2.0, csc_array(first - second) / 2.0)


@dataclass(frozen=True, eq=False)
class LeastForces:
    """Forces that go with a motion at the least load multiplier."""

    alpha: float
    edges: Floats
    wanted: Floats
    """(m, 2): how much alpha would fall for a unit of force on an edge that the motion rules out.
    """


class ForcesOfMotion:
    """The least load multiplier, along the sign, with forces that go with a given motion."""

    def __init__(self, program: EquilibriumProgram, sign: float) -> None:
        self._program, self._sign = program, sign
        self._rates = ContactRates.of(program)
        self._session = HighsSession(program)
        self._costs = np.zeros(program.column_count)
        self._costs[0] = sign

    def find(self, velocity: Floats) -> LeastForces | None:
        """Return the least load multiplier, or None when no forces go with the motion.

        Opening contacts are left without force, sliding ones with the edge that resists.
        """
        fastest = float(np.abs(velocity).max())
        opens = self._rates.normal.T @ velocity > NOTHING * fastest
        slip = self._rates.slip.T @ velocity
        barred = np.column_stack(
            (opens | (slip > NOTHING * fastest), opens | (slip < -NOTHING * fastest))
        ).ravel()
        columns = np.arange(1, 1 + len(barred), dtype=np.int32)
        upper = np.where(barred, 0.0, highspy.kHighsInf)
        self._session.highs.changeColsBounds(len(columns), columns, np.zeros(len(columns)), upper)
        found = self._session.minimise(self._costs)
        if found.columns is None or found.duals is None or found.status is not LimitStatus.OPTIMAL:
            return None
        edges = np.maximum(found.columns[1:], 0.0).reshape(-1, 2)
        gain = found.duals @ self._program.matrix[:, 1:]
        wanted = np.where(barred & (gain > NOTHING), gain, 0.0).reshape(-1, 2)
        return LeastForces(self._sign * float(found.columns[0]), edges, wanted)


class MotionsOfForces:
    """A motion that goes with given forces, along the live load (sign 1) or against it."""

    def __init__(self, program: EquilibriumProgram, sign: float) -> None:
        self._rates = ContactRates.of(program)
        live = sign * program.matrix[:, [0]]
        matrix = csc_array(vstack((self._rates.normal.T, self._rates.slip.T, live.T)))
        self._rows, columns = matrix.shape
        self._points = (self._rows - 1) // 2
        free = np.full(columns, highspy.kHighsInf)
        least, greatest = self._open_bounds()
        by_column, minimise, offset = 1, 1, 0.0
        self._highs = silent_highs(
            {
                "threads": 1,
                "solver": "simplex",
                "presolve": "off",
                "primal_feasibility_tolerance": TOLERANCE,
                "dual_feasibility_tolerance": TOLERANCE,
            }
        )
        self._highs.passModel(
            columns, self._rows, matrix.nnz, by_column, minimise, offset, np.zeros(columns), -free,
            free, least, greatest, matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32),
            matrix.data, np.zeros(columns, np.int32),
        )  # fmt: skip

    def _open_bounds(self) -> tuple[Floats, Floats]:
        """No contact closes, the live load does work at a rate of 1."""
        least = np.zeros(self._rows)
        greatest = np.full(self._rows, highspy.kHighsInf)
        least[self._points : -1] = -highspy.kHighsInf
        least[-1] = greatest[-1] = 1.0
        return least, greatest

    @property
    def exist(self) -> bool:
        """False when no motion at all lets the load do work: that is proved."""
        self._minimise(np.zeros(self._rates.normal.shape[0]), *self._open_bounds())
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
        costs = np.zeros(self._rates.normal.shape[0])
        if wanted is not None and last is not None:
            opens = self._rates.normal.T @ last > NOTHING * float(np.abs(last).max())
            way = np.where(opens, 0.0, np.sign(self._rates.slip.T @ last))
            share = wanted.sum(axis=1)
            least[points:-1][(share > 0) & (way > 0)] = 0.0
            greatest[points:-1][(share > 0) & (way < 0)] = 0.0
            costs = self._rates.normal @ (share * opens) + self._rates.slip @ (share * way)
        return self._minimise(costs, least, greatest)

    def _minimise(self, costs: Floats, least: Floats, greatest: Floats) -> Floats | None:
        highs = self._highs
        highs.changeColsCost(len(costs), np.arange(len(costs), dtype=np.int32), costs)
        rows = np.arange(self._rows, dtype=np.int32)
        highs.changeRowsBounds(self._rows, rows, least, greatest)  # type: ignore[attr-defined]
        highs.run()
        if highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
            return None
        return np.array(highs.getSolution().col_value)
