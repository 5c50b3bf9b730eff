"""The plan of a small wall made by hand, and a mechanism of it, for pictures and reports."""

from dataclasses import replace

import numpy as np

from drystone.model.plan import PlanMetrics
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus, Mechanism
from tests.verify.examples import L_STONE, SLAB, WEDGE, example

CLUSTERS = {3: 1, 5: 2, SLAB: 1, L_STONE: 3, 300: 2}
UNUSED = 9


def wall(px_per_m=None):
    """A slab on two pillars, with a wedge on the lower one, an L, and a slim stone at the end."""
    return example(1.0, px_per_m).wall


def mechanism():
    """The L slides to the left, the slab turns counter-clockwise."""
    velocity = np.zeros((6, 3))
    velocity[3] = (-1.0, 0.0, 0.0)
    velocity[2] = (-0.3, 0.4, 0.05)
    return Mechanism((3, 5, SLAB, L_STONE, 300, WEDGE), velocity)


def resistance():
    left = LimitResult(LimitStatus.OPTIMAL, "left", 0.41, mechanism())
    right = LimitResult(LimitStatus.FAILED, "right", message="gave up")
    return LateralResistance(left, right, 0.58)


def plan(px_per_m=None, metrics=None):
    """Return the plan of the wall with results and words that tests look for."""
    made = example(1.0, px_per_m).plan
    usual = PlanMetrics(0.4773, None, 4.25, 0.6724, 0.31, 0.12, 0.41, 0.39, 32.0)
    placement = {"rule": "eq12", "note": "<script>alert(1)</script>"}
    return replace(
        made,
        source={**made.source, "path": "<b>PR.png", "sha256": "0" * 64},
        settings={**made.settings, "placement": placement},
        stopped="no acceptable place was found five times in a row",
        metrics=metrics or usual,
    )
