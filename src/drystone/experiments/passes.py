"""Suite "passes": single passes on outlines, and what becomes of plans on finer outlines."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import hypot
from statistics import median

from drystone.contacts.settled import PlacedPolygons, model_of_outlines
from drystone.experiments.exact_walls import BuiltWall, Target, one_pass, targets
from drystone.experiments.planned_walls import missing_data
from drystone.experiments.table import BenchSettings, Cell, Table
from drystone.kernels.polygons import Points, no_polygons
from drystone.model.stone import StoneSet
from drystone.planner.settings import PlannerSettings
from drystone.search.plan_wall import plan_wall
from drystone.settle.rest import Repose, Scene, Turned, lay
from drystone.statics.limit import lateral_resistance

COLUMNS = (
    "passes", "all placed", "placed", "F_SF", "F_AV", "F_AH", "F_LR .05 px", ".1 px", ".25 px",
    "wedges", "s", "relaid at .1 px: lost", "F_LR",
)  # fmt: skip

PASSES = 20
FINER_PX = 0.1
"""Tolerance of the outlines on which plans are laid again."""

NEARBY = 0.1
"""A stone that comes to rest further away, over its size, is lost."""


@dataclass(frozen=True)
class Way:
    """A way to make passes.

    Parameters
    ----------
    name : str
        For people.
    change : callable
        Makes its settings from those of one pass.
    """

    name: str
    change: Callable[[PlannerSettings], PlannerSettings]


def _blind(settings: PlannerSettings) -> PlannerSettings:
    return replace(settings, score=replace(settings.score, analysed=1, llc=0.0))


def _pivot(settings: PlannerSettings) -> PlannerSettings:
    return replace(settings, settle=replace(settings.settle, method="pivot"))


WAYS = (
    Way("best", lambda settings: settings),
    Way("without look-ahead", _blind),
    Way("--settle pivot", _pivot),
)


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Make passes on the published sets."""
    chosen = targets(settings, 4)
    rows = [row for target in chosen for row in _rows(target, settings)]
    return (
        Table(
            "Single passes on outlines, medians",
            COLUMNS,
            tuple(rows),
            (
                "F_LR counts as 0 where a wall does not stand with contacts up to so many source "
                "px. Without look-ahead: the cheapest action that stands is taken, whatever it "
                "carries. Relaid: the stones of the plan, laid one after the other where the "
                f"plan has them, on outlines within {FINER_PX} px; lost are those that do not "
                "rest there any more.",
                *missing_data(settings),
            ),
        ),
    )


def _rows(target: Target, settings: BenchSettings) -> list[tuple[Cell, ...]]:
    stones = target.stones(settings)
    if stones is None:
        return []
    seeds = range(settings.seed, settings.seed + (2 if settings.quick else PASSES))
    return [_row(way, [_pass(target, stones, way, seed) for seed in seeds]) for way in WAYS]


def _pass(target: Target, stones: StoneSet, way: Way, seed: int) -> BuiltWall:
    result = plan_wall(
        stones,
        *target.size(stones),
        seed=seed,
        settings=way.change(one_pass("exact")),
        scale=target.scale,
    )
    return BuiltWall(target, "exact", seed, stones, result)


def _row(way: Way, walls: Sequence[BuiltWall]) -> tuple[Cell, ...]:
    placed = [len(wall.result.plan.stone_steps) for wall in walls]
    metrics = [wall.result.metrics for wall in walls]
    relaid = [relay(wall) for wall in walls]
    return (
        f"{walls[0].target.name}, {way.name}",
        f"{sum(n == len(walls[0].stones) for n in placed)} of {len(walls)}",
        median(placed),
        median(m.F_SF for m in metrics),
        median(m.F_AV or 0.0 for m in metrics),
        median(m.F_AH or 0.0 for m in metrics),
        *(median(_resistance(wall, px) for wall in walls) for px in (0.05, 0.1, 0.25)),
        median(len(wall.result.plan.wedge_steps) for wall in walls),
        median(wall.result.seconds for wall in walls),
        sum(lost for lost, _ in relaid),
        median(resistance for _, resistance in relaid),
    )


def _resistance(wall: BuiltWall, tolerance_px: float) -> float:
    outlines = wall.result.wall.outlines
    assert outlines is not None  # noqa: S101 - passes are made on outlines
    mu = float(wall.result.plan.settings["mu"])
    return lateral_resistance(model_of_outlines(outlines, mu, tolerance_px)).value or 0.0


def relay(wall: BuiltWall) -> tuple[int, float]:
    """Lay the stones of a plan again on finer outlines.

    Returns
    -------
    lost : int
        Stones that do not rest near their planned places.
    resistance : float
        F_LR of the wall of the others, 0 when it does not stand.
    """
    plan = wall.result.plan
    settings, mu = one_pass("exact").settle, float(plan.settings["mu"])
    width = wall.target.size(wall.stones)[0]
    laid: list[tuple[int, Points]] = []
    polygons, lost = no_polygons(), 0
    for group in wall.result.wall.groups:
        placement = group.placement
        assert placement.settled is not None  # noqa: S101 - passes are made on outlines
        wedges = [(wedge.id, wedge.corners) for wedge in group.wedges if wedge.corners is not None]
        below = polygons.added(corners for _, corners in wedges)
        outline = placement.posed.stone.outline_within(FINER_PX)
        size = placement.posed.stone.area_px**0.5
        turned = Turned.of(outline, placement.posed.angle_deg, "left", size)
        start = (placement.settled.x_px, placement.settled.y_px)
        found = lay(turned, Scene.of(below, width, "left", mu), start, settings)
        if found is None or _moved(found, start) > NEARBY * size:
            lost += 1
            continue
        polygons = below.added([found.settled.corners])
        laid += [*wedges, (placement.stone_id, found.settled.corners)]
    model = model_of_outlines(PlacedPolygons.of(laid), mu, settings.contact_px)
    return lost, lateral_resistance(model).value or 0.0


def _moved(repose: Repose, start: tuple[float, float]) -> float:
    """Return how far from its planned place a stone rests."""
    return hypot(repose.settled.x_px - start[0], repose.settled.y_px - start[1])
