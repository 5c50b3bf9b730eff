"""Load multipliers for Coulomb friction without dilatancy (non-associative flow).

The blocks fail at a load multiplier alpha when there are forces in equilibrium, within friction,
and a motion with live . v = 1 that obeys the flow rule of :mod:`drystone.statics.flow.flow_search`.
That is a mixed complementarity problem, and it has several solutions; the forces of each are
admissible in the associative problem, so none lies above that one's alpha.

**Rounds.**  With the change of variable of De Saxcé the problem is a fixed point (Acary, Cadoux,
Lemaréchal, Malick: A formulation of the linear discrete Coulomb friction problem via convex
optimization, ZAMM 91 (2011) 155-175).  For given slip rates s_i >= 0 solve

    maximise  alpha - sum_i mu_i s_i n_i   subject to equilibrium and the cones of friction;

its dual is a motion with live . v = 1 and u_n,i + mu s_i >= mu |u_t,i|.  Where s_i = |u_t,i| all
conditions hold.  Only costs change from round to round, so the program stays feasible, and
s = 0 is the associative problem.  The slip rates move towards those of the last motion, or a
little beyond: each round by another part of the way, and by a leap now and then.  What lies beyond
may be below 0.  That led to lower answers on planned walls; where the program has no limit then,
the start ends without an answer.

**Closing.**  The rounds converge slowly or run away.  But the forces of a round settle early, and
the motions that go with given forces are the solutions of a linear program, so each round asks it
for one: mostly within ten rounds there is one, and the answer is exact.

**Descent.**  From a solution, forces and motion are improved in turn: the least alpha whose
forces go with the motion, then, of the motions that go with these forces, the one that gets least
into the way of the forces which would lower alpha further (their reduced costs weigh them).

**Central paths.**  Of hundreds of blocks a round takes half a second, and few starts end within a
hundred.  There :mod:`drystone.statics.flow.central_path` comes near an answer first, in seconds;
one round from its slip rates closes nearly always.  It is also asked where no start has an answer.

**Against the load.**  Where a load presses blocks together or lifts them off, they may move against
it: a search that ends below 0 has an answer of the other side.  The blocks fall by themselves only
where a motion goes with forces at alpha = 0.

What is heuristic: nothing says that rounds find a solution (they run away towards motions in which
the live load does no work), or that descent ends at the least one.  So there are several starts,
the least of all solutions found is told, and every answer is checked from the blocks themselves.
Starts with fast slip ask for small normal forces, everywhere or in the head joints, and lead to
the lower solutions.  What an answer means: docs/analysis.md.
"""

from collections.abc import Callable
from dataclasses import astuple, dataclass, replace

import numpy as np

from drystone.statics.failing.mechanism import kinematics
from drystone.statics.flow.flow_search import FlowState, NonassociativeSettings, Search
from drystone.statics.flow.release import fall_of, with_inertia
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads, tilting_table
from drystone.statics.lp.program import EquilibriumProgram, Floats, assemble, units_of
from drystone.statics.model import FREEDOMS, Direction, RigidBlockModel
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus, Mechanism

HOLDS = 1e-7
"""Largest error of a check that holds."""


@dataclass(frozen=True)
class FlowCheck:
    """How far an answer is from all conditions of the non-associative problem."""

    equilibrium: float
    """Largest force or moment on a block that is not balanced, over the mean weight of a block (and
    the root of the mean area)."""
    friction: float  # largest tension, or tangential force above mu n, over the mean weight
    closing: float  # largest rate at which a contact closes, over the largest velocity
    held: float  # largest velocity of what is fixed or held, over the largest velocity
    dilatancy: float
    """Power of the normal forces, the sum of |n u_n|, over that of the live or the dead load, the
    greater: contacts open that carry a force, or dilate as they slide."""
    dissipation: float
    """Sum of |t u_t + mu n |u_t||, over the same: contacts that slide without all their friction,
    or along with it."""

    @property
    def holds(self) -> bool:
        """True when every error is at most `HOLDS`; never for what is no number.

        The last two are errors of alpha.
        """
        return all(error <= HOLDS for error in astuple(self))


def check_flow(
    model: RigidBlockModel,
    loads: Loads | None,
    direction: Direction,
    alpha: float,
    mechanism: Mechanism,
    forces: Floats,
) -> FlowCheck:
    """Check forces and a mechanism at alpha in a direction; at least one block is free.

    The load multiplier is alpha for "right" and -alpha for "left".  `forces` is (m, 2): normal and
    tangential force at every contact point on the block that the normal points into; the tangent of
    a normal (x, y) is (y, -x).
    """
    loads = tilting_table(model) if loads is None else loads
    own, sign = units_of(model), -1.0 if direction == "left" else 1.0
    units = np.array([1.0, 1.0, own.length])
    free = [not block.fixed for block in model.blocks]
    moves = [[not b.fixed and freedom not in b.held for freedom in FREEDOMS] for b in model.blocks]
    kin, (n, t) = kinematics(model, mechanism), forces.T
    # The last row is that of the ground.
    balance = np.vstack((loads.dead + sign * alpha * loads.live, np.zeros(3)))
    tangent = np.column_stack((kin.normal[:, 1], -kin.normal[:, 0]))
    force = n[:, None] * kin.normal + t[:, None] * tangent
    force, arm = np.stack((force, -force), axis=1), kin.point[:, None] - kin.centroid[kin.blocks]
    turning = arm[..., 0] * force[..., 1] - arm[..., 1] * force[..., 0]
    np.add.at(balance, kin.blocks, np.dstack((force, turning)))
    opening, slip = kin.relative.T
    leaving = np.maximum(-n, np.abs(t) - kin.friction * n)
    velocity = np.abs(kin.velocity[:-1] * units)
    fastest = float(velocity.max())
    way = kin.velocity[:-1][free]
    power = max(abs(float((load[free] * way).sum())) for load in (loads.live, loads.dead))
    lost = sum(np.abs(t * slip + kin.friction * n * np.abs(slip)).tolist())
    return FlowCheck(
        equilibrium=float(np.abs(balance[:-1] / units)[moves].max(initial=0.0)) / own.weight,
        friction=float(leaving.max(initial=0.0)) / own.weight,
        closing=float(abs(opening.min(initial=0.0))) / fastest,
        held=float(velocity[np.invert(moves)].max(initial=0.0)) / fastest,
        dilatancy=float(sum(np.abs(n * opening).tolist()) / power) if power > 0 else np.inf,
        dissipation=float(lost / power) if power > 0 else np.inf,
    )


STANDING = 1e-9
"""A load multiplier down to minus this is one of 0."""

IMMOVABLE = "No motion goes along with a load in this direction."


@dataclass(frozen=True, eq=False)
class NonassociativeResult(LimitResult):
    """Outcome of one non-associative limit analysis; "optimal" only with a check that holds."""

    rounds: int = 0  # linear programs of the rounds, all starts together
    method: str = ""  # the start that found the answer
    check: FlowCheck | None = None
    answers: tuple[float, ...] = ()
    """Load multipliers of all verified answers, the least first: which of them a wall fails at
    depends on the forces that are locked in it."""


@dataclass(frozen=True, eq=False)
class NonassociativeResistance(LateralResistance):
    """Both directions; `value` is None unless both are optimal, and without friction."""

    left: NonassociativeResult
    right: NonassociativeResult

    @property
    def carried(self) -> float | None:
        """The value, and 0 where it was verified that the blocks can fall by themselves."""
        falls = LimitStatus.UNSTABLE in (self.left.status, self.right.status)
        return 0.0 if falls else self.value


def nonassociative_resistance(
    model: RigidBlockModel,
    *,
    loads: Loads | None = None,
    settings: NonassociativeSettings | None = None,
    look: Callable[[], None] = lambda: None,
) -> NonassociativeResistance:
    """Find the least loads at which the blocks can move by Coulomb's law without dilatancy.

    A direction is "optimal" when forces and motion were found whose check holds: the least alpha of
    those found, in bounded effort, an upper estimate of the least there is.  "unstable" when the
    blocks do not stand under their dead load, or only without certainty: there are forces with
    which they start to fall, or can move, under it alone.  "unbounded" when no motion goes along
    with the load.  "failed" when nothing was found.

    Parameters
    ----------
    model : RigidBlockModel
        Blocks and interfaces.
    loads : Loads, optional
        Dead and live loads; the tilting table unless given.
    settings : NonassociativeSettings, optional
        How much is tried.
    look : callable
        Called before every round; what it raises ends the search.

    Returns
    -------
    NonassociativeResistance
        Its `value` is to F_LR what the flow rule without dilatancy makes of it.
    """
    both = lateral_resistance(model, loads)
    ends = both.left, both.right
    if not both.stable or all(block.fixed for block in model.blocks):
        left, right = (NonassociativeResult(e.status, e.direction, message=e.message) for e in ends)
        return NonassociativeResistance(left, right, both.mu)
    settings = settings or NonassociativeSettings()
    loads = loads or tilting_table(model)
    program = assemble(model, loads)
    falls = _released(model, loads, program, settings.rounds, look) if settings.let_go else None
    if falls is not None:
        left, right = (replace(falls, direction=end.direction) for end in ends)
    else:
        searched = [_searched(model, loads, program, end, settings, look) for end in ends]
        # A load below 0 is one of the other side, where blocks move against the live load.
        answers = [answer for _, found in searched for answer in found]
        left, right = (
            _least_verified(end, nothing, [a for a in answers if a.direction == end.direction])
            for end, (nothing, _) in zip(ends, searched, strict=True)
        )
    return NonassociativeResistance(left, right, both.mu)


def _released(
    model: RigidBlockModel,
    loads: Loads,
    program: EquilibriumProgram,
    rounds: int,
    look: Callable[[], None],
) -> NonassociativeResult | None:
    """Tell how blocks start to fall that stand with associated flow; None when none was found."""
    fall = fall_of(model, program, rounds, look)
    if fall is None:
        return None
    state = FlowState(0.0, fall.edges, fall.acceleration)
    falling = with_inertia(model, program, loads, fall)
    answer = _answer(model, falling, "right", program, state, "let go")
    if not (answer.check and answer.check.holds):
        return None
    return replace(
        answer,
        status=LimitStatus.UNSTABLE,
        alpha=None,
        message="There are forces with which the blocks, let go, start to fall under their dead"
        " load alone; others, squeezed in before, would hold them.",
    )


def _searched(
    model: RigidBlockModel,
    loads: Loads,
    program: EquilibriumProgram,
    associative: LimitResult,
    settings: NonassociativeSettings,
    look: Callable[[], None],
) -> tuple[NonassociativeResult, list[NonassociativeResult]]:
    """Return what to say where nothing is found, and the verified answers of both sides."""
    direction, most = associative.direction, associative.alpha
    rounds, answers = 0, list[NonassociativeResult]()
    sign = -1.0 if direction == "left" else 1.0
    upright = np.array([abs(interface.normal[1]) for interface in model.interfaces], float)
    # A share of the dead load in the live one only renames alpha, and then motions are found, too,
    # on which the live load does no work.
    shares = [0.0] if most is None else [0.0, 1.0 / (1.0 + 2.0 * most)]
    for share in shares:
        live = loads.live + sign * share * loads.dead
        program = assemble(model, replace(loads, live=live)) if share else program
        search = Search(program, sign, upright[model.contact_interfaces], settings, look)
        if most is None and not search.motions.exist:
            return NonassociativeResult(LimitStatus.UNBOUNDED, direction, message=IMMOVABLE), []
        for method, needed, found in search.attempts():
            rounds += needed
            scale = 0.0 if found is None else 1.0 + share * found.alpha
            if found is None or scale <= 0.0:
                continue
            alpha = found.alpha / scale
            alpha = 0.0 if -STANDING <= alpha <= 0.0 else alpha
            # The forces are admissible with associated flow too: what is above is rounding.
            alpha = alpha if most is None else min(alpha, most)
            state = FlowState(alpha, found.edges / scale, found.velocity)
            answer = _answer(model, loads, direction, program, state, method)
            if answer.check and answer.check.holds:
                answers.append(answer)
        if any(answer.direction == direction for answer in answers):
            break
    message = f"The search did not converge in {rounds} rounds; " + (
        "with associated flow no load is too great."
        if most is None
        else f"the load multiplier lies at or below the associative one, {most:.5g}."
    )
    failed = NonassociativeResult(LimitStatus.FAILED, direction, rounds=rounds, message=message)
    return failed, answers


def _answer(
    model: RigidBlockModel,
    loads: Loads,
    direction: Direction,
    program: EquilibriumProgram,
    state: FlowState,
    method: str,
) -> NonassociativeResult:
    """Check a state, in the units of the model and the direction of its load."""
    mechanism, forces = program.mechanism(state.velocity), program.forces(state.edges)
    alpha = abs(state.alpha)
    if state.alpha < 0.0:
        direction = "right" if direction == "left" else "left"
    return NonassociativeResult(
        LimitStatus.OPTIMAL,
        direction,
        alpha,
        mechanism,
        forces,
        method=method,
        check=check_flow(model, loads, direction, alpha, mechanism, forces),
    )


def _least_verified(
    associative: LimitResult, nothing: NonassociativeResult, verified: list[NonassociativeResult]
) -> NonassociativeResult:
    """Choose the least of the verified answers, of equal ones the first; else say `nothing`."""
    if not verified:
        return nothing
    best = min(verified, key=lambda answer: round(answer.alpha or 0.0, 9))
    alphas = tuple(sorted(answer.alpha or 0.0 for answer in verified))
    least, most = alphas[0], alphas[-1]
    found = replace(best, rounds=nothing.rounds, answers=alphas)
    count = f"{len(verified)} solutions"
    if least > STANDING or (associative.alpha is not None and associative.alpha <= STANDING):
        upto = f"; range {least:.4f} to {most:.4f}" if most - least > 5e-5 else ""
        return replace(found, message=f"Lowest of {count}{upto}.")
    message = (
        "Without dilatancy the blocks can move this way under their dead load alone. Other forces"
        f" would hold them: {count} reach up to {most:.4f}."
    )
    return replace(found, status=LimitStatus.UNSTABLE, alpha=None, message=message)
