"""Walls planned from the published stone sets; suite "walls": every step by every solver."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from drystone.model.plan import Plan
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.extremes import Solver
from drystone.statics.model import RigidBlockModel
from drystone.verify.claims import wall_model
from drystone.verify.lengths import plan_settings
from drystone.verify.replay import replay_plan
from drystone_lab.runs.outcome import execute
from drystone_lab.table import BENCH, BenchSettings, Cell, Table, worded
from drystone_lab.walls import IR, PR, R

SETS = (PR, R, IR)


@dataclass(frozen=True, eq=False)
class PlannedWall:
    """A plan, and the wall after every step."""

    name: str  # Set, method and seed
    plan: Plan  # The plan
    stones: StoneSet

    @cached_property
    def after(self) -> tuple[Wall, ...]:
        """The wall after each stone and its wedges."""
        return tuple(stage.after for stage in replay_plan(self.plan, self.stones).stages)

    @cached_property
    def models(self) -> tuple[RigidBlockModel, ...]:
        """Models of these walls on the geometry of the plan: of its pixels or its outlines."""
        settings, _ = plan_settings(self.plan)
        found = (wall_model(wall, settings) for wall in self.after)
        return tuple(model for model in found if model is not None)

    @property
    def mu(self) -> float:
        """Coefficient of friction of the plan."""
        return float(self.plan.settings["mu"])


def planned_walls(
    settings: BenchSettings, methods: tuple[str, ...] = ("paper", "best"), seeds: int = 1
) -> Iterator[PlannedWall]:
    """Plan walls from the published sets, one after another."""
    if missing_data(settings):
        return
    for target in SETS[:1] if settings.quick else SETS:
        stones = target.source.stones(settings.data)
        for method in methods[:1] if settings.quick else methods:
            for seed in range(settings.seed, settings.seed + (1 if settings.quick else seeds)):
                plan = execute(target.run(seed, method=method), settings.data, stones).as_plan
                yield PlannedWall(f"{target.name}, {method}, seed {seed}", plan, stones)


def missing_data(settings: BenchSettings) -> tuple[str, ...]:
    """Say in a note that rows are missing for want of data."""
    if settings.data is not None and (settings.data / "almeida").is_dir():
        return ()
    return ("Rows need the published stone sets: name their folder with --data.",)


SOLVERS: tuple[Solver, ...] = ("highs", "highs-ipm", "clarabel")


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
    holds = answers == same == certified and max(differences) <= 1e-8
    last, without = found[0], nonassociative_resistance(wall.models[-1])
    if without.left.alpha is None or without.right.alpha is None:
        least = " / ".join(str(end.status) for end in (without.left, without.right))
    else:
        least = f"{min(without.left.alpha, without.right.alpha):.4f}"
    return (
        wall.name, len(wall.models), answers, same, max(differences), certified, max(gaps),
        max(residuals), None if last.value is None else last.value * last.mu, least,
        "pass" if holds else "miss",
    )  # fmt: skip
