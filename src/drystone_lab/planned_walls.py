"""Walls planned from published stone sets: every step by every solver, and in a rigid-body engine.

Suite "walls" compares solvers; suite "engine" builds walls up in the engine, and "tilt" tilts them.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from statistics import median
from typing import NamedTuple

import numpy as np
from scipy.stats import spearmanr

from drystone.contacts.outlines import model_of_traced, outlines_of_labels
from drystone.model.plan import Plan
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall
from drystone.physics.building import BuildUp, build_up, tilt_of
from drystone.physics.scatter import compare_with_tilt, usual_variations
from drystone.physics.scene import EngineScene
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.extremes import Solver
from drystone.statics.model import RigidBlockModel
from drystone.verify.claims import wall_model
from drystone.verify.lengths import plan_settings
from drystone.verify.outlines import plan_polygons
from drystone.verify.replay import replay_plan
from drystone_lab.runs.outcome import execute
from drystone_lab.table import BENCH, BenchSettings, Cell, Rows, Table, worded
from drystone_lab.walls import BRICKS, IR, JUDGED, PR, R, Target

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


class EngineWall(NamedTuple):
    """A wall in the engine; ends are to the left and to the right."""

    name: str
    stones: int  # in it
    built: BuildUp
    alphas: tuple[float | None, float | None]  # load multipliers of the plan
    # tangents at which it comes down; None when it fell before, or never
    tilts: tuple[float | None, float | None]


def run_engine(settings: BenchSettings) -> tuple[Table, ...]:
    """Build every wall in the engine, then tilt it."""
    judged = [
        _judged(target, stones, seed)
        for target in ((BRICKS,) if settings.quick else JUDGED)
        if (stones := target.stones(settings.data)) is not None
        for seed in range(settings.seed, settings.seed + (1 if settings.quick else 5))
    ]
    return (
        worded(BENCH["engine"]["walls"], map(_engine_row, judged), more=missing_data(settings)),
        _summary(judged),
    )


def _judged(target: Target, stones: StoneSet, seed: int) -> EngineWall:
    outcome = execute(target.run(seed, ("search.budget", 1), method="best"), None, stones)
    plan, figures = outcome.as_plan, outcome.figures
    built = build_up(plan_polygons(plan, stones), float(plan.settings["mu"]))
    found = tilt_of(built)
    tilts = (None, None) if found is None else (found[0].alpha, found[1].alpha)
    alphas = figures["alpha_left"], figures["alpha_right"]
    return EngineWall(f"{target.name}, seed {seed}", len(plan.stone_steps), built, alphas, tilts)


def _engine_row(judged: EngineWall) -> tuple[Cell, ...]:
    moves = judged.built.moves
    return (
        judged.name, judged.stones, ", ".join(map(str, judged.built.fallen)) or "none",
        max(move.move_px for move in moves), max(move.share for move in moves),
        max(move.turn_deg for move in moves), max(move.overlap_px for move in moves),
        judged.alphas[0], judged.tilts[0], judged.alphas[1], judged.tilts[1],
    )  # fmt: skip


def _summary(judged: Sequence[EngineWall]) -> Table:
    standing = sum(one.built.stands for one in judged)
    pairs = [
        (alpha, tilt)
        for one in judged
        for alpha, tilt in zip(one.alphas, one.tilts, strict=True)
        if alpha is not None and tilt is not None
    ]
    weaker = [
        (min(a for a in one.alphas if a is not None), min(t for t in one.tilts if t is not None))
        for one in judged
        if None not in one.alphas and None not in one.tilts
    ]
    ratios = [tilt / alpha for alpha, tilt in pairs if alpha > 0]
    row = (
        len(judged), f"{standing} of {len(judged)}", len(pairs),
        *(float(spearmanr(of).statistic) if len(of) > 2 else None for of in (pairs, weaker)),
        median(ratios) if ratios else None,
    )  # fmt: skip
    return worded(BENCH["engine"]["summary"], [row])


BOTH_FALL = "both fall"
"""The outlines do not stand, by the analysis and in the engine."""


def run_tilted(settings: BenchSettings) -> tuple[Table, ...]:
    """Return simulated and predicted load multipliers of the same outlines, a row a direction."""
    walls = planned_walls(settings, methods=("paper",), seeds=3)
    rows = [row for wall in walls for row in _tilted_rows(wall, settings)]
    agreeing = sum(row[5] in ("yes", BOTH_FALL) for row in rows)
    counted = f"{agreeing} of {len(rows)} directions: " if rows else ""
    words, more = BENCH["tilt"]["directions"], missing_data(settings)
    return (worded(words, rows, more=more, counted=counted),)


def _tilted_rows(wall: PlannedWall, settings: BenchSettings) -> Rows:
    outlines = outlines_of_labels(wall.after[-1].labels)
    variations = usual_variations()
    for one in compare_with_tilt(
        EngineScene(outlines, wall.mu),
        model_of_traced(outlines, wall.mu),
        np.random.default_rng(settings.seed),
        variations=variations[:1] if settings.quick else variations,
    ):
        simulated, predicted = one.simulated, one.nonassociative
        motion, fall = simulated.interval("first motion"), simulated.interval("fall")
        inside = predicted is not None and motion and motion[0] <= predicted <= motion[1]
        # Trials that fall at rest would make the scatter as wide as one likes.
        inside = inside and not simulated.fell_at_rest
        both_fall = one.associative is None and simulated.fell_at_rest
        why = "falls" if one.associative is None else "not certain to stand"
        yield (
            wall.name, simulated.direction, one.associative,
            why if one.associative is None or predicted is None else predicted,
            "falls at rest" if simulated.fell_at_rest else _interval(motion),
            BOTH_FALL if both_fall else "yes" if inside else "no",
            _interval(fall), simulated.settled_shift,
        )  # fmt: skip


def _interval(found: tuple[float, float] | None) -> str:
    return "never" if found is None else f"{found[0]:.3f} to {found[1]:.3f}"
