"""Suite "engine": walls planned on outlines, built up and tilted in a rigid-body engine."""

from collections.abc import Sequence
from statistics import median
from typing import NamedTuple

from scipy.stats import spearmanr

from drystone.model.stone import StoneSet
from drystone.physics.building import BuildUp, build_up, tilt_of
from drystone.verify.outlines import plan_polygons
from drystone_lab.planned_walls import missing_data
from drystone_lab.runs.outcome import execute
from drystone_lab.table import BENCH, BenchSettings, Cell, Table, worded
from drystone_lab.walls import BRICKS, JUDGED, Target

BothSides = tuple[float | None, float | None]


class EngineWall(NamedTuple):
    """A wall in the engine; ends are to the left and to the right."""

    name: str
    stones: int  # in it
    built: BuildUp
    alphas: BothSides  # load multipliers of the plan
    tilts: BothSides  # tangents at which it comes down; None when it fell before, or never


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Build every wall in the engine, then tilt it."""
    judged = [
        _judged(target, stones, seed)
        for target in ((BRICKS,) if settings.quick else JUDGED)
        if (stones := target.stones(settings.data)) is not None
        for seed in range(settings.seed, settings.seed + (1 if settings.quick else 5))
    ]
    return (
        worded(BENCH["engine"]["walls"], map(_row, judged), more=missing_data(settings)),
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


def _row(judged: EngineWall) -> tuple[Cell, ...]:
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
