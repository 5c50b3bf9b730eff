"""The way to an answer without dilatancy through the inside of all conditions.

With r = mu u_t split into p - q, slip with and against the tangent, and the forces a, b along the
edges of the cone of friction, the conditions of :mod:`drystone.statics.flow.flow_search` are

    (a + b) u_n = 0,  a p = 0,  b q = 0;  a, b, u_n, p, q >= 0,

beside equilibrium and live . v = 1, which are linear.  Each product is made t instead: there are
solutions with everything above 0, and for t -> 0 they become an answer.  They form a curve.  The
problem is not monotone, so t does not fall all along it: where Newton's method for one t after the
other stops, the curve turns back for a while.  So it is followed as a curve, with t one of its
unknowns (pseudo-arclength continuation): a step along the tangent, then one of Newton's method
across it.  Both come from one sparse factorisation of the size of the blocks' freedoms: what
belongs to one contact point is eliminated by hand.

Where many forces go with one motion the curve ends in the middle of them.  So contacts may close at
first, by t^(3/4) times a factor: that drives out normal forces, and leads to other, often lower
answers.
"""

from collections.abc import Callable

import numpy as np
from scipy.sparse import block_array, csc_array, diags_array
from scipy.sparse.linalg import splu

from drystone.statics.lp.program import EquilibriumProgram, Floats

END, FAR = 1e-9, 1e4
"""At this t the curve has arrived, or left for infinity; in mean weights times velocity."""

POWER = 0.75
"""Of t in how far contacts may close; with 1 it would only weigh the forces."""

REACH, NEAR = 0.9, 0.7
"""Most that anything changes along the tangent and across it, in shares of itself."""

SHORTEST = 1e-5
"""The curve is lost where even a step of this reach is too long."""

CENTRING, STEPS = 30, 300
"""Factorisations to reach the curve, and along it."""


class CentralPath:
    """The curve of one program, along the live load (sign 1) or against it.

    `normal` and `slip` are :class:`drystone.statics.flow.flow_search.ContactRates`.  Points of the
    curve are vectors: a, b, u_n, p, q of all contact points, v, alpha.
    """

    def __init__(
        self, program: EquilibriumProgram, normal: csc_array, slip: csc_array, sign: float
    ) -> None:
        self._normal, self._slip = normal, slip
        self._opens, self._slides = csc_array(normal.T), csc_array(slip.T)
        self._live = sign * program.matrix[:, [0]].toarray().ravel()
        self._rhs, self._inside = program.rhs, 5 * normal.shape[1]  # how many stay above 0

    def motion(self, closing: float, look: Callable[[], None]) -> Floats | None:
        """Return the velocity where the curve ends or is lost; None where it has no start.

        `look` is called before every factorisation; what it raises ends the search.
        """
        inside, live = self._inside, self._live
        point, t = np.concatenate((np.ones(inside), live / (live @ live), [0.0])), 1.0
        most, tangent = np.inf, None
        for _ in range(CENTRING):
            if most < NEAR:
                break
            look()
            found = self._directions(point, t, closing)
            if found is None:
                return None
            newton, tangent = found
            most = float(np.abs(newton[:inside] / point[:inside]).max())
            point = point + REACH / max(most, REACH) * newton
        if tangent is None or not np.isfinite(point).all():
            return None
        shares, sense, reach = tangent[:inside] / point[:inside], -1.0, REACH
        for _ in range(STEPS):
            if (t < END and sense < 0.0) or t > FAR or reach < SHORTEST:
                break
            look()
            step = sense * reach / max(float(np.abs(shares).max()), 0.5)
            ahead, there = point + step * tangent, t * float(np.exp(step))
            found = self._directions(ahead, there, closing)
            if found is None:
                reach /= 2.0
                continue
            newton, turned = (one[:inside] / ahead[:inside] for one in found)
            bend = float(turned @ shares) + inside
            along = -float(newton @ shares) / bend
            across = float(np.abs(newton + along * turned).max())
            if not (across < NEAR and abs(along) < 3.0):
                reach /= 2.0
                continue
            point, t = ahead + found[0] + along * found[1], there * float(np.exp(along))
            tangent, shares, sense = found[1], turned, sense * float(np.sign(bend))
            if across < NEAR / 2.0:
                reach = min(1.5 * reach, REACH)
        return point[inside:-1]

    def _directions(self, point: Floats, t: float, closing: float) -> tuple[Floats, Floats] | None:
        """Return the step of Newton's method to the curve at t, and d(point) / d(log t).

        None where the equations are singular.
        """
        a, b, u, p, q = point[: self._inside].reshape(5, -1)
        velocity, alpha, live = point[self._inside : -1], point[-1], self._live[:, None]
        first, second, normal = a / p, b / q, (a + b) / u
        stiffness = 2.0 * first * second / (first + second)
        uneven = (first - second) / (first + second)
        pressed = self._normal @ diags_array(normal) + self._slip @ diags_array(uneven * normal)
        moving = pressed @ self._opens + self._slip @ diags_array(stiffness) @ self._slides
        try:
            solve = splu(csc_array(block_array([[moving, -live], [live.T, None]]))).solve
        except RuntimeError:
            return None

        def step(
            force: Floats, work: float, opening: Floats, slip: Floats, products: list[Floats]
        ) -> Floats:
            """Undo what is missing in all equations; of products over u_n, p and q."""
            push, more, less = products
            both = more + less - push
            drag = more - less - uneven * (both + normal * opening) - stiffness * slip
            loads = force + self._normal @ (push - normal * opening) + self._slip @ drag
            moves = solve(np.append(loads, -work))
            opening, slip = self._opens @ moves[:-1] + opening, self._slides @ moves[:-1] + slip
            p_step = (both + second * slip + normal * opening) / (first + second)
            q_step = p_step - slip
            edges = more - first * p_step, less - second * q_step
            return np.concatenate((*edges, opening, p_step, q_step, moves))

        gap, none = np.full_like(a, closing * t**POWER), np.zeros_like(a)
        force = self._live * alpha + self._normal @ (a + b) + self._slip @ (a - b) - self._rhs
        opening, slip = self._opens @ velocity + gap - u, self._slides @ velocity - p + q
        wanted = [t / u, t / p, t / q]
        products = [w - there for w, there in zip(wanted, (a + b, a, b), strict=True)]
        newton = step(force, float(self._live @ velocity) - 1.0, opening, slip, products)
        return newton, step(0.0 * force, 0.0, POWER * gap, none, wanted)
