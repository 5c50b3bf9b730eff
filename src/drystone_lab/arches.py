"""Semicircular arches of voussoirs: how thin they may be under their own weight.

Mean radius 1, n equal voussoirs with radial joints, the springings radial too.  The classical
answer for many voussoirs without sliding is t/R = .1075; the values by n and those with friction
were computed independently of this project.
"""

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from drystone.contacts.given import model_from_json
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel

NO_SLIDING = 50.0
"""A coefficient of friction at which nothing slides in an arch."""

THINNEST, THICKEST = 0.01, 0.4
"""Range of t/R in which the least thickness is sought."""


@dataclass(frozen=True)
class ArchCase:
    """An arch and the least thickness it must have.

    Parameters
    ----------
    count : int
        Voussoirs.
    mu : float
        Coefficient of friction.
    least : float or None
        Least t/R, to five digits; None when no thickness up to `THICKEST` stands.
    """

    count: int
    mu: float
    least: float | None


WITHOUT_SLIDING = (
    ArchCase(9, NO_SLIDING, 0.10213),
    ArchCase(11, NO_SLIDING, 0.10491),
    ArchCase(16, NO_SLIDING, 0.10724),
    ArchCase(20, NO_SLIDING, 0.10746),
    ArchCase(27, NO_SLIDING, 0.10678),
    ArchCase(40, NO_SLIDING, 0.10746),
    ArchCase(100, NO_SLIDING, 0.10746),
)

WITH_FRICTION = (
    ArchCase(40, 0.5, 0.10746),
    ArchCase(40, 0.4, 0.10746),
    ArchCase(40, 0.35, 0.15182),
    ArchCase(40, 0.32, 0.18544),
    ArchCase(40, 0.3, None),
)


def arch(count: int, thickness: float, mu: float) -> RigidBlockModel:
    """Make an arch with the joints of its corners, and area and centroid of annular sectors.

    Examples
    --------
    >>> model = arch(9, 0.2, mu=0.6)
    >>> len(model.blocks), len(model.interfaces)
    (9, 10)
    """
    inner, outer = 1.0 - thickness / 2.0, 1.0 + thickness / 2.0
    angles = np.linspace(0.0, math.pi, count + 1)
    blocks = []
    for number, (first, last) in enumerate(pairwise(angles.tolist()), start=1):
        polar = ((inner, first), (outer, first), (outer, last), (inner, last))
        corners = [[r * math.cos(t), max(0.0, r * math.sin(t))] for r, t in polar]
        blocks.append({"id": number, "polygon": corners})
    model = model_from_json({"blocks": blocks, "mu": mu})
    half = math.pi / count / 2.0
    area = half * (outer**2 - inner**2)
    radius = 2.0 / 3.0 * math.sin(half) / half * (outer**3 - inner**3) / (outer**2 - inner**2)
    sectors = tuple(
        replace(
            block,
            area=area,
            centroid=(radius * math.cos(middle), radius * math.sin(middle)),
        )
        for block, middle in zip(model.blocks, (angles[:-1] + half).tolist(), strict=True)
    )
    return RigidBlockModel(sectors, model.interfaces, mu)


def stands(count: int, thickness: float, mu: float) -> bool:
    """Tell whether an arch stands under its own weight."""
    return lateral_resistance(arch(count, thickness, mu)).stable


def least_thickness(count: int, mu: float, tolerance: float) -> float | None:
    """Find the thickness over the mean radius at which an arch first stands, by bisection.

    Parameters
    ----------
    count : int
        Voussoirs.
    mu : float
        Coefficient of friction.
    tolerance : float
        The arch stands at what is returned, and falls at this much less.

    Returns
    -------
    float or None
        None when it does not stand at `THICKEST` either.
    """
    falls, carries = THINNEST, THICKEST
    if not stands(count, carries, mu):
        return None
    while carries - falls > tolerance:
        middle = (falls + carries) / 2.0
        if stands(count, middle, mu):
            carries = middle
        else:
            falls = middle
    return carries
