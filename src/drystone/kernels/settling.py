"""Settling a polygon on polygons: down to the least energy, by small linear programs (DESIGN 4.9).

A stone is let go at a pose where it touches nothing.  Step by step it makes the move (shift and
turn) that goes down most while no gap to what is around it, linearised, falls below a clearance;
then the true gaps are looked at.  Since turns are not straight, a move may come too near to
something: it is brought apart again at the least cost, or halved where that gains nothing.
Gravity may lean towards the side from which the wall is built, which closes the joints beside the
stone.  At the end a friction test says whether the stone rests, and how far gravity may lean
until it moves.

No step passes through anything.  A step moves no corner by more than (1 + sqrt 2) radii, and all
gaps within 2.5 radii keep their corners on the right side of a face, or of a line through a
corner, that parts the convex pieces there; what turns and notches add to that shows afterwards as
a depth, or as edges that cross, since a whole stone is larger than a step.
"""

import numpy as np

from drystone.kernels.backend import compiled
from drystone.kernels.firmness import Friction, rest_margin_python
from drystone.kernels.polygons import Points, Polygons, polygon_edges
from drystone.kernels.settling_python import settle_python
from drystone.kernels.settling_types import Rules, Settling, Status

__all__ = ["Rules", "Settling", "Status", "rest_margin", "settle"]

_fast = compiled("settling")
_firm = compiled("firmness")


def settle(
    outline: Points,
    edges: Points,
    pose: tuple[float, float, float],
    around: Polygons,
    width: float,
    rules: Rules,
) -> Settling:
    """Settle one stone.

    Parameters
    ----------
    outline : (n, 2) float array
        Corners relative to the centroid, counter-clockwise.
    edges : (n, 3) float array
        Of the outline (:func:`drystone.kernels.polygons.polygon_edges`).
    pose : (float, float, float)
        Where it is let go: x, y of the centroid, and the turn in radians.
    around : Polygons
        What is there already.
    width : float
        Of the wall; its ends at x = 0 and `width` stop the stone, but carry nothing.
    rules : Rules
        How.

    Raises
    ------
    ValueError
        When mu is not positive.
    """
    _require_friction(rules.mu)
    if _fast is None:
        return settle_python(outline, edges, pose, around, width, rules)
    numbers = np.array(rules[:14], np.float64)
    found = _fast.settle(
        outline, edges, *pose, around.corners, around.first, around.boxes, around.edges, width,
        numbers, rules.sticks, rules.turns, rules.steps,
    )  # fmt: skip
    return Settling(Status(found[0]), *found[1:])


def rest_margin(  # noqa: PLR0913, PLR0917 - as many facts as it takes
    corners: Points,
    centroid: tuple[float, float],
    around: Polygons,
    width: float,
    mu: float,
    tolerance: float,
    corner: float = 0.3,
    steep: float = -1.0,
) -> float:
    """Return how far gravity may lean, over mu, until a placed polygon moves.

    Parameters
    ----------
    corners : (n, 2) float array
        Where it is.
    centroid : (float, float)
        Its centre of mass.
    around : Polygons
        Rigid neighbours.
    width : float
        Of the wall; its ends carry nothing.
    mu : float
        Coefficient of friction, positive: margins are shares of it.
    tolerance : float
        Gaps up to this one touch.
    corner, steep : float
        See :class:`Rules`.

    Returns
    -------
    margin : float
        -1 when it does not rest; 10 or more counts as 10.

    Raises
    ------
    ValueError
        When mu is not positive.
    """
    _require_friction(mu)
    edges = polygon_edges(corners)
    if _firm is None:
        friction = Friction(mu, tolerance, corner, steep)
        return rest_margin_python(corners, edges, centroid, around, width, friction)
    return float(
        _firm.rest_margin(
            corners, edges, *centroid, around.corners, around.first, around.boxes, around.edges,
            width, mu, tolerance, corner, steep,
        )
    )  # fmt: skip


def _require_friction(mu: float) -> None:
    if not mu > 0.0:
        raise ValueError(f"mu must be positive, not {mu}")
