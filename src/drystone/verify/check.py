"""Check a plan: build its wall again and verify every claim (DESIGN 2, 4.9)."""

from collections.abc import Sequence

import numpy as np

from drystone.errors import UsageError
from drystone.model.landscape import Landscape
from drystone.model.placement import Placement, Wedge
from drystone.model.plan import Plan, PlanMetrics, WedgeStep
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels
from drystone.placement.feasible import can_be_lowered
from drystone.planner.settings import PlannerSettings
from drystone.verify.claims import (
    Reference,
    check_indices,
    check_metrics,
    check_source,
    check_stone_claims,
    check_unused,
    recompute_metrics,
)
from drystone.verify.overlap import deepest_overlap
from drystone.verify.replay import Replay, Stage, replay_plan
from drystone.verify.report import CheckReport, Problem
from drystone.verify.stability import Standing, check_stability, prefix_alphas
from drystone.verify.wedges import check_polygon, check_wedge


def check_plan(plan: Plan, stones: StoneSet, *, wall_labels: Labels | None = None) -> CheckReport:
    """Build the wall of a plan again from the input stones and verify everything it claims.

    Parameters
    ----------
    plan : Plan
        To be checked.
    stones : StoneSet
        The stones that it was made from, read again.
    wall_labels : (h, w) integer array, optional
        Contents of wall.png; every stone's pixels must be those of its pose, which a mirrored
        stone's are not.

    Returns
    -------
    CheckReport
        `ok` when nothing was found that does not hold.

    Raises
    ------
    PlanError
        E215 when the wall is too large or too small to be an image.

    Notes
    -----
    Verified are: the source; that each stone is used once and the others are listed; that stones
    and wedges are inside the site and overlap by no pixel at the working resolution; the source
    centroids, clusters and turns of stones; the rules of wedging; that the wall stands after
    every stone with its wedges, with the load multipliers claimed; all indices; the metrics.
    Overlap of the real outlines, stones that cannot be lowered in from above, and the deviation
    of pixel areas from the stones' own are reported and are no failure on the raster.
    """
    settings, problems = _settings(plan)
    problems += check_source(plan, stones) + check_unused(plan, stones)
    replay = replay_plan(plan, stones)
    problems += replay.problems
    reference = Reference.of(stones, settings, plan.working_scale)
    for piece in replay.pieces:
        if piece.step.kind == "stone":
            problems += check_stone_claims(piece.step, reference)
        elif isinstance(piece.item, Wedge):
            problems += check_polygon(piece.step, piece.item, replay.site)
    standing = check_stability(replay.stages, settings.mu)
    problems += standing.problems + tuple(_check_stages(replay, standing, reference))
    if wall_labels is not None:
        problems += _check_image(replay, wall_labels)
    metrics: PlanMetrics | None = None
    if replay.broken_at is None and None not in standing.resistances:
        metrics = recompute_metrics(plan, replay, standing.model)
        problems += check_metrics(plan.metrics, metrics)
    placements = [p.item for p in replay.pieces if isinstance(p.item, Placement)]
    depth, depth_at = deepest_overlap(placements, replay.site.height_px)
    area_error, area_error_at = _worst_area(placements)
    return CheckReport(
        problems=tuple(sorted(problems, key=lambda p: (p.step is not None, p.step or 0, p.code))),
        overlap_depth=depth,
        overlap_depth_at=depth_at,
        buried=tuple(stage.stone.stone for stage in replay.stages if is_buried(stage)),
        area_error=area_error,
        area_error_at=area_error_at,
        prefixes=prefix_alphas(replay.stages, standing.resistances),
        metrics=metrics,
        notes=tuple(_notes(plan, stones, replay, wall_labels)),
    )


def is_buried(stage: Stage) -> bool:
    """Say whether a stone cannot be lowered to its place from straight above."""
    placement = stage.group.placement
    before = Landscape.of(stage.before)
    return not can_be_lowered(before, placement.posed, placement.row, placement.col)


def _settings(plan: Plan) -> tuple[PlannerSettings, list[Problem]]:
    """Return the plan's settings; the package's own, and E217, when they are not usable."""
    try:
        return PlannerSettings().updated(plan.settings), []
    except UsageError as error:
        return PlannerSettings(), [Problem("E217", None, f"the settings cannot be used: {error}")]


def _check_stages(replay: Replay, standing: Standing, reference: Reference) -> list[Problem]:
    """Verify indices and wedges of every stage."""
    problems = []
    unit = replay.site.units_per_px
    wedge_steps = {p.id: p.step for p in replay.pieces if isinstance(p.step, WedgeStep)}
    for stage, resistance in zip(replay.stages, standing.resistances, strict=True):
        if resistance is not None:
            problems += check_indices(stage, resistance, reference, unit)
        for wedge in stage.group.wedges:
            problems += check_wedge(
                wedge_steps[wedge.id],
                wedge,
                stage.after.labels,
                reference.settings.stabilise,
                reference.stock.mean_height_px,
            )
    return problems


def _check_image(replay: Replay, wall_labels: Labels) -> list[Problem]:
    """Compare wall.png with the rebuilt wall, stone by stone (E236)."""
    if wall_labels.shape != replay.labels.shape:
        height, width = wall_labels.shape
        size = f"{replay.site.width_px} x {replay.site.height_px}"
        return [Problem("E236", None, f"wall.png is {width} x {height} px, not {size}.")]
    different = wall_labels != replay.labels
    seen, counts = np.unique(
        np.concatenate([wall_labels[different], replay.labels[different]]), return_counts=True
    )
    steps = {piece.id: piece.step for piece in replay.pieces}
    problems = []
    for label, count in zip(seen.tolist(), counts.tolist(), strict=True):
        if label in steps:
            step = steps[label]
            message = f"{count} px of {step.kind} {label} in wall.png are not those of its pose."
            problems.append(Problem("E236", step.step, message))
        elif label:
            message = f"wall.png has {count} px of {label}, which the plan does not place."
            problems.append(Problem("E236", None, message))
    return problems


def _worst_area(placements: Sequence[Placement]) -> tuple[float, int | None]:
    """Return the largest share by which a mask's area is not the stone's own, and its id."""
    worst, at = 0.0, None
    for placement in placements:
        posed = placement.posed
        own = posed.stone.area_px * posed.scale**2
        error = abs(posed.area_px - own) / own
        if at is None or error > worst:
            worst, at = error, posed.stone.id
    return worst, at


def _notes(plan: Plan, stones: StoneSet, replay: Replay, wall_labels: Labels | None) -> list[str]:
    notes = []
    if not (plan.source["sha256"] and stones.source.sha256):
        notes.append("The bytes of the source were not compared: one of the digests is missing.")
    if wall_labels is None:
        notes.append("wall.png was not compared.")
    if replay.broken_at is not None:
        notes.append(
            f"From step {replay.broken_at} on the wall cannot be built: stability, indices and "
            "wedges from there, and the metrics, were not checked."
        )
    return notes
