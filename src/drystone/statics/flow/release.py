"""How blocks that are let go start to fall, by Coulomb friction without dilatancy.

Equilibrium says that forces exist which would hold the blocks, not that they arise
(docs/analysis.md).  So it is asked whether Newton's law has another answer than rest.  At the
moment when the blocks are let go, forces and an acceleration a obey

    M a = dead + contact forces;  a_n >= 0, n >= 0, n a_n = 0;  |t| <= mu n, t a_t = -mu n |a_t|:

the flow rule of :mod:`drystone.statics.flow.flow_search`, with the rates at which contacts begin to
open and slide.  With a = 0 that is equilibrium, and with a != 0 the blocks fall: their weight does
more work than friction takes.

**Rounds**, as in :mod:`drystone.statics.flow.nonassociative`: for given slip rates s_i the problem

    minimise  a . M a / 2 - dead . a   subject to  a_n,i + mu s_i >= mu |a_t,i|

is convex (Gauss's principle), its multipliers are the contact forces, and where s_i = |a_t,i| all
conditions hold.  The first slip rates are those without any friction: nothing is pressed but by
weight.  From there walls that hold themselves come to rest in some rounds.

**Closing.**  Which contacts open, stick or slide, and which way, shows early.  With that given the
conditions are linear in a and the forces, and a linear program answers exactly.

What is heuristic: a fall that was found is one, checked from the blocks themselves; that none was
found proves nothing.  The model knows no moments of inertia, so each block has that of a square
of its area, which decides how fast it turns, and not which forces it can be held by.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import block_array, csc_array, diags_array

from drystone.statics.flow import flow_search
from drystone.statics.flow.flow_search import ContactRates
from drystone.statics.joints import slippery
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads
from drystone.statics.lp.clarabel import least_constraint
from drystone.statics.lp.extremes import Solver
from drystone.statics.lp.highs import INFINITY, loaded, solved
from drystone.statics.lp.program import EquilibriumProgram, Floats, assemble
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitStatus

AT_REST = 1e-6
"""Blocks whose weight does no more work than this on their acceleration rest; in mean weights
times that of free fall."""

UNBALANCED = 1e-5
"""Least force that nothing balances in a fall, in mean weights: far above errors of checks."""

CLEAR = 1e-4
"""Forces and slip rates below this share of the largest one are taken as none."""


@dataclass(frozen=True, eq=False)
class Fall:
    """How blocks start to fall, in the units of the program; free fall has acceleration 1."""

    acceleration: Floats  # (rows,): one entry a row of the program
    edges: Floats  # (m, 2): forces along the two edges of every cone of friction
    inertia: Floats  # (rows,): mass times acceleration: what the forces on the blocks sum up to


def fall_of(
    model: RigidBlockModel,
    program: EquilibriumProgram,
    rounds: int,
    look: Callable[[], None] = lambda: None,
) -> Fall | None:
    """Let blocks go, and find how they start to fall; None when they come to rest.

    At least one block is free.  `look` is called before each of so many rounds; what it raises
    ends the search.
    """
    rows = masses(model, program)
    if not len(rows) or program.column_count == 1:
        return None
    rates = ContactRates.of(program)
    dead, edges = -program.rhs, csc_array(program.matrix[:, 1:])
    states = _States(program, rates, rows)
    found = least_constraint(rows, dead, rates.normal, np.zeros(rates.normal.shape[1]))
    for _ in range(rounds):
        look()
        if found is None or dead @ found[0] < AT_REST:
            return None
        slip = np.abs(rates.sliding(found[0]))
        found = least_constraint(rows, dead, edges, -np.repeat(slip, 2))
        fall = None if found is None else states.exact(*found)
        if fall is not None and np.abs(fall.inertia).max() > UNBALANCED:
            return fall
    return None


def with_inertia(
    model: RigidBlockModel, program: EquilibriumProgram, loads: Loads, fall: Fall
) -> Loads:
    """Return loads that the forces of a fall balance (d'Alembert): its dead ones less inertia.

    Live is the dead load, whose work is that of the fall.
    """
    forces = np.zeros((len(program.rows), 3))
    forces[program.rows >= 0] = program.weight * fall.inertia
    forces[:, 2] *= program.length
    dead = loads.dead.copy()
    dead[[not block.fixed for block in model.blocks]] -= forces
    return Loads(dead, loads.dead, f"{loads.name}, let go")


def masses(model: RigidBlockModel, program: EquilibriumProgram) -> Floats:
    """Return mass or moment of inertia of every row; a unit of weight has a mass of 1."""
    free = [block for block in model.blocks if not block.fixed]
    mass = np.array([block.weight for block in free]) / program.weight
    square = np.array([block.area for block in free]) / 6.0 / program.length**2
    return np.asarray(np.column_stack((mass, mass, mass * square))[program.rows >= 0])


class _States:
    """Newton's law with what each contact does given: a linear program in a and the forces."""

    def __init__(self, program: EquilibriumProgram, rates: ContactRates, masses: Floats) -> None:
        self._rates, self._masses = rates, masses
        rows, points = rates.normal.shape
        newton = [diags_array(masses), -program.matrix[:, 1:]]
        matrix = csc_array(block_array([newton, [rates.normal.T, None], [rates.slip.T, None]]))
        count, columns = matrix.shape
        self._columns = np.arange(rows, columns, dtype=np.int32)
        self._contacts = np.arange(rows, count, dtype=np.int32)
        fixed = np.concatenate((-program.rhs, np.zeros(2 * points)))
        lower = np.full(columns, -INFINITY)
        # Of many points a simplex method may take minutes, most for what has no answer.
        many = {"solver": "ipm", "run_crossover": "off"}
        options = {"solver": "simplex"} if points <= flow_search.MANY_POINTS else many
        self._highs = loaded(options, matrix, (fixed, fixed), lower)

    def exact(self, acceleration: Floats, multipliers: Floats) -> Fall | None:
        """Return the answer in which contacts do what they do in an inexact one, if any.

        A contact that presses stays closed, others carry nothing; one that slips resists by the
        edge against its slip, one that does not slip sticks.
        """
        rows = len(self._masses)
        forces = multipliers.reshape(-1, 2).sum(axis=1)
        presses = forces > CLEAR * max(1.0, float(forces.max()))
        slip = self._rates.sliding(acceleration)
        clear = CLEAR * float(np.abs(acceleration).max())
        forth, back = slip > clear, slip < -clear
        none = np.column_stack((~presses | forth, ~presses | back)).ravel()
        upper = np.where(none, 0.0, INFINITY)
        least = np.concatenate((np.zeros(len(slip)), np.where(presses & ~back, 0.0, -INFINITY)))
        greatest = np.concatenate(
            (np.where(presses, 0.0, INFINITY), np.where(presses & ~forth, 0.0, INFINITY))
        )
        highs = self._highs
        highs.changeColsBounds(len(upper), self._columns, np.zeros(len(upper)), upper)
        highs.changeRowsBounds(len(least), self._contacts, least, greatest)  # type: ignore[attr-defined]
        answer = solved(highs)
        if answer is None:
            return None
        moves, edges = answer[:rows], np.maximum(answer[rows:], 0.0).reshape(-1, 2)
        return Fall(moves, edges, self._masses * moves)


def held_by_upright_faces(
    model: RigidBlockModel, loads: Loads | None = None, *, solver: Solver = "auto"
) -> tuple[int, ...] | None:
    """Name the blocks that fall when upright faces have no friction (DESIGN 4.8), in their order.

    Equilibrium asks only whether forces exist, not what would press such faces together
    (docs/analysis.md).  Mechanisms of such a wall are many, but by Gauss's principle it starts to
    fall, by associated flow, in one way only.  Returned are the blocks that move then: with these
    held fast the rest stands.  None when a solver gave up.
    """
    tilt_deg = 0.0 if loads is None else loads.tilt_deg
    faces = slippery(model.interfaces, model.mu, tilt_deg=tilt_deg)
    smooth = replace(model, interfaces=faces)
    status = lateral_resistance(smooth, loads, solver=solver).left.status
    if status is not LimitStatus.UNSTABLE:
        return None if status is LimitStatus.FAILED else ()
    program = assemble(smooth, loads)
    edges = csc_array(program.matrix[:, 1:])
    fall = least_constraint(masses(smooth, program), -program.rhs, edges, np.zeros(edges.shape[1]))
    if fall is None:
        return None
    moves = np.abs(np.append(fall[0], 0.0)[program.rows]).max(axis=1)
    return tuple(np.array(program.block_ids)[moves > CLEAR * moves.max()].tolist())
