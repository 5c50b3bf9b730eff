"""Least thickness of the semicircular arch under its own weight.

Mean radius 1, n equal voussoirs with radial joints, the springings radial too.  The classical
answer for many voussoirs without sliding is t/R = .1075; the values by n and those with friction
were computed independently of this project.  The thickness is given to five digits: one unit less
must fall, one more stand.
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from drystone.statics.given import model_from_json
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel


def arch(count, thickness, mu):
    """Voussoirs as annular sectors: joints from the corners, area and centroid of the sector."""
    inner, outer = 1 - thickness / 2, 1 + thickness / 2
    angles = np.linspace(0, math.pi, count + 1)
    blocks = []
    for number, (first, last) in enumerate(pairwise(angles.tolist()), start=1):
        polar = ((inner, first), (outer, first), (outer, last), (inner, last))
        corners = [[r * math.cos(t), max(0.0, r * math.sin(t))] for r, t in polar]
        blocks.append({"id": number, "polygon": corners})
    model = model_from_json({"blocks": blocks, "mu": mu})
    half = math.pi / count / 2
    area = half * (outer**2 - inner**2)
    radius = 2 / 3 * math.sin(half) / half * (outer**3 - inner**3) / (outer**2 - inner**2)
    sectors = tuple(
        replace(
            block,
            area=area,
            centroid=(radius * math.cos(middle), radius * math.sin(middle)),
        )
        for block, middle in zip(model.blocks, angles[:-1] + half, strict=True)
    )
    return RigidBlockModel(sectors, model.interfaces, mu)


def stands(count, thickness, mu):
    return lateral_resistance(arch(count, thickness, mu)).stable


@pytest.mark.parametrize(
    ("count", "least"),
    [(9, 0.10213), (11, 0.10491), (16, 0.10724), (20, 0.10746), (27, 0.10678), (40, 0.10746)],
)
def test_without_sliding(count, least):
    assert not stands(count, least - 1e-5, mu=50.0)
    assert stands(count, least + 1e-5, mu=50.0)


@pytest.mark.parametrize(
    ("mu", "least"), [(0.5, 0.10746), (0.4, 0.10746), (0.35, 0.15182), (0.32, 0.18544)]
)
def test_with_friction(mu, least):
    assert not stands(40, least - 1e-5, mu)
    assert stands(40, least + 1e-5, mu)


def test_too_little_friction_for_any_thickness():
    assert not stands(40, 0.4, mu=0.3)
