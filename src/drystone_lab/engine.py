"""Suite "engine": walls planned on outlines, built up and tilted in a rigid-body engine."""

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from scipy.stats import spearmanr

from drystone.model.stone import StoneSet
from drystone.physics.building import BuildUp, build_up, tilt_of
from drystone.search.plan_result import PlanResult
from drystone.search.plan_wall import plan_wall
from drystone.verify.outlines import plan_polygons
from drystone_lab.planned_walls import missing_data
from drystone_lab.search_ways import tries
from drystone_lab.table import BenchSettings, Cell, Table
from drystone_lab.walls import BRICKS, JUDGED, Target

SEEDS = 5
"""Walls of each set."""

COLUMNS = (
    "wall", "stones", "fallen", "moved most px", "share", "turn deg", "overlap px",
    "alpha left", "tilt left", "alpha right", "tilt right",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Judged:
    """A wall in the engine."""

    name: str
    result: PlanResult
    built: BuildUp
    # Tangent of the tilt at which it comes down, to the left and to the right; None when it fell
    # before, or never
    tilts: tuple[float | None, float | None]

    @property
    def alphas(self) -> tuple[float | None, float | None]:
        """Load multipliers of the plan, to the left and to the right."""
        metrics = self.result.metrics
        return metrics.alpha_left, metrics.alpha_right


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Build every wall in the engine, then tilt it."""
    judged = [
        _judged(target, stones, seed)
        for target in ((BRICKS,) if settings.quick else JUDGED)
        if (stones := target.stones(settings.data)) is not None
        for seed in range(settings.seed, settings.seed + (1 if settings.quick else SEEDS))
    ]
    rows = tuple(_row(one) for one in judged)
    return (
        Table(
            "Walls of one pass on outlines in the engine",
            COLUMNS,
            rows,
            missing_data(settings),
        ),
        _summary(judged),
    )


def _judged(target: Target, stones: StoneSet, seed: int) -> Judged:
    size = target.size(stones)
    result = plan_wall(stones, *size, seed=seed, settings=tries(1), scale=target.scale)
    built = build_up(plan_polygons(result.plan, stones), float(result.plan.settings["mu"]))
    tilts = tilt_of(built)
    alphas = (None, None) if tilts is None else (tilts[0].alpha, tilts[1].alpha)
    return Judged(f"{target.name}, seed {seed}", result, built, alphas)


def _row(judged: Judged) -> tuple[Cell, ...]:
    moves = judged.built.moves
    alphas, tilts = judged.alphas, judged.tilts
    return (
        judged.name,
        len(judged.result.plan.stone_steps),
        ", ".join(map(str, judged.built.fallen)) or "none",
        max(move.move_px for move in moves),
        max(move.share for move in moves),
        max(move.turn_deg for move in moves),
        max(move.overlap_px for move in moves),
        alphas[0],
        tilts[0],
        alphas[1],
        tilts[1],
    )


def _summary(judged: Sequence[Judged]) -> Table:
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
    return Table(
        "Load multipliers beside tilts",
        ("walls", "nothing falls", "both sides", "rank correlation", "weaker side", "tilt / alpha"),
        (
            (
                len(judged),
                f"{standing} of {len(judged)}",
                len(pairs),
                _rank_correlation(pairs),
                _rank_correlation(weaker),
                _median_ratio(pairs),
            ),
        ),
        (
            "Rank correlation (Spearman) of alpha and the tangent of the tilt at failure, over "
            "both sides of all walls, and over the weaker sides; then the median ratio.",
        ),
    )


def _rank_correlation(pairs: Sequence[tuple[float, float]]) -> float | None:
    if len(pairs) < 3:
        return None
    found = spearmanr([first for first, _ in pairs], [second for _, second in pairs])
    return float(found.statistic)


def _median_ratio(pairs: Sequence[tuple[float, float]]) -> float | None:
    ratios = [tilt / alpha for alpha, tilt in pairs if alpha > 0]
    return median(ratios) if ratios else None
