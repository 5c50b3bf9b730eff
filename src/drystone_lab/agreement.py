"""`drystone bench walls`: planned walls, every step by every solver, with its certificates."""

import numpy as np

from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.extremes import Solver
from drystone.statics.result import LateralResistance
from drystone_lab.planned_walls import PlannedWall, missing_data, planned_walls
from drystone_lab.table import BENCH, BenchSettings, Cell, Table, worded

SOLVERS: tuple[Solver, ...] = ("highs", "highs-ipm", "clarabel")

AGREED = 1e-8
"""Largest difference of load multipliers that counts as the same."""


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Return how far solvers are apart, and how well answers are certified."""
    rows = (_row(wall) for wall in planned_walls(settings))
    return (worded(BENCH["walls"]["agreement"], rows, more=missing_data(settings)),)


def _row(wall: PlannedWall) -> tuple[Cell, ...]:
    answers = same = certified = 0
    differences, gaps, residuals = [0.0], [0.0], [0.0]
    for model in wall.models:
        found = [lateral_resistance(model, solver=solver) for solver in SOLVERS]
        for ends in ([both.left for both in found], [both.right for both in found]):
            answers += 1
            same += len({end.status for end in ends}) == 1
            certificates = [end.certificate for end in ends]
            certified += all(c is not None and c.holds for c in certificates)
            alphas = [end.alpha for end in ends if end.alpha is not None]
            differences.append(float(np.ptp(alphas)) if alphas else 0.0)
            gaps += [c.gap for c in certificates if c is not None and c.gap is not None]
            residuals += [c.residual for c in certificates if c is not None]
    holds = answers == same == certified and max(differences) <= AGREED
    return (
        wall.name, len(wall.models), answers, same, max(differences), certified, max(gaps),
        max(residuals), *_factors(wall, found[0]), "pass" if holds else "miss",
    )  # fmt: skip


def _factors(wall: PlannedWall, last: LateralResistance) -> tuple[float | None, str]:
    value = None if last.value is None else last.value * last.mu
    without = nonassociative_resistance(wall.models[-1])
    if without.left.alpha is None or without.right.alpha is None:
        return value, " / ".join(str(end.status) for end in (without.left, without.right))
    return value, f"{min(without.left.alpha, without.right.alpha):.4f}"
