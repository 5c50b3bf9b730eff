"""Limit analysis of a wall that grows stone by stone, without starting anew (§4.1).

A step of the planner asks for the resistance of the wall with each of many stones on top, and
then places one of them.  A stone adds three equations and a few unknowns to the program of the
wall, and the mechanism of the wall is close to that of the wall with the stone: each tilt is
solved from where the same tilt of the wall ended.  Walls of loose stones, up to some hundred,
are for a simplex method of our own (:mod:`drystone.statics.growing_simplex`); above that the
neighbourhood of a stone is looked at first (:mod:`drystone.statics.growing_large`); fixed and
guided blocks, and walls that fell, are for HiGHS (:mod:`drystone.statics.growing_highs`).

Like all answers these count only with a certificate that holds; otherwise the wall with the
stone is solved from the start by :func:`drystone.statics.limit.lateral_resistance`.
"""

from drystone.statics.appending import Units
from drystone.statics.growing_simplex import begun
from drystone.statics.grown import GrowingAnalysis, Grown
from drystone.statics.model import RigidBlockModel

__all__ = ["GrowingAnalysis", "Grown", "growing"]


def growing(model: RigidBlockModel, units: Units) -> GrowingAnalysis:
    """Begin with a wall, which may be empty.

    Parameters
    ----------
    model : RigidBlockModel
        What is built.
    units : Units
        Of the equations, for as long as the wall grows: those of a typical stone.  Certificates
        are relative to their weight; alpha does not depend on them.

    Examples
    --------
    A stone on a stone, half as wide as high; the pile is as stable as a block of twice its height.

    >>> from drystone.statics.appending import units_of
    >>> from drystone.statics.contacts.given import model_from_json
    >>> pile = model_from_json({"blocks_xywh": [[0, 0, 1, 2], [0, 2, 1, 2]], "mu": 0.58})
    >>> first = RigidBlockModel(pile.blocks[:1], pile.interfaces[:1], pile.mu)
    >>> wall = growing(first, units_of(first))
    >>> round(wall.grown.resistance.right.alpha, 6)
    0.5
    >>> taller = wall.model.with_added(pile.blocks[1:], pile.interfaces[1:])
    >>> round(wall.resistance_with(taller).resistance.right.alpha, 6)
    0.25
    """
    return begun(model, units)
