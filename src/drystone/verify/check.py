"""Check a plan: build its wall again and verify every claim (DESIGN 2, 4.9)."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np
import shapely

from drystone.kernels.polygons import turn
from drystone.model.overlap import deepest_overlap, shape_of
from drystone.model.placement import Placement, Wedge
from drystone.model.plan import Plan, PlanMetrics, WedgeStep
from drystone.model.steps import Problem
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels
from drystone.planner.workshop import wedge_limits
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.verify import claims, pieces
from drystone.verify.blocks import check_blocks
from drystone.verify.claims import Reference
from drystone.verify.lengths import source_points
from drystone.verify.replay import Replay, replay_plan


@dataclass(frozen=True)
class PrefixAlpha:
    """What the wall carries after a stone and its wedges."""

    step: int  # last step of the stone and its wedges
    alpha_left: float | None
    alpha_right: float | None  # load multipliers found; None where the wall does not stand


@dataclass(frozen=True)
class CheckReport:
    """Outcome of :func:`check_plan`."""

    problems: tuple[Problem, ...]
    """Every claim that does not hold; empty when the plan is what it says."""
    overlap_depth: float
    """How deep real outlines of two stones (on exact geometry also of wedges) lie in each other at
    most, source px; see :func:`drystone.model.overlap.overlap_depth`."""
    overlap_depth_at: tuple[int, int] | None  # ids of the two; None when no two outlines overlap
    buried: tuple[int, ...]  # ids of stones that cannot be lowered in from above; no failure
    area_error: float
    """Largest deviation of a stone's pixels in the wall from its own area, as a share of it."""
    area_error_at: int | None  # id of that stone; None for an empty plan
    prefixes: tuple[PrefixAlpha, ...]
    """Load multipliers after every stone, as far as the wall could be built."""
    metrics: PlanMetrics | None  # recomputed; None when the wall could not be built to its end
    notes: tuple[str, ...]
    geometry: Literal["raster", "exact"] = "raster"
    """What the plan was verified on: the pixels or the outlines of its stones."""

    @property
    def ok(self) -> bool:
        """True when nothing was found that does not hold."""
        return not self.problems

    def as_dict(self) -> dict[str, Any]:
        """Return what ``drystone check --json`` prints."""
        return {"ok": self.ok, **asdict(self)}


def check_plan(
    plan: Plan, stones: StoneSet, *, wall_labels: Labels | None = None, blocks: Any = None
) -> CheckReport:
    """Build the wall of a plan again from the input stones and verify everything it claims.

    Verified are: the source; that each stone is used once and the others are listed; that stones
    and wedges are inside the site and overlap by no pixel at the working resolution; the source
    centroids, clusters and turns of stones; the rules of wedging; that the wall stands after every
    stone with its wedges, with the load multipliers claimed; all indices; the metrics; that no
    stone is banned or out of a given order; the images and the block model beside the plan.
    `wall_labels` are those of wall.png, `blocks` the contents of blocks.json.

    On exact geometry outlines are what is judged: that they are those of the pixels, how deep they
    lie in each other and beyond the edges of the wall, and the limit analysis on their contacts,
    with the tolerance of the plan.  Stones that cannot be lowered in from above, the deviation of
    pixel areas from the stones' own and, on the raster, overlap of the real outlines are reported
    and are not a failure.

    A wall that is too large or too small to be an image is a PlanError (E215).
    """
    replay = replay_plan(plan, stones)
    reference = Reference.of(stones, replay.settings, plan.working_scale)
    problems = [*claims.check_source(plan, stones), *replay.problems]
    problems += claims.check_choice(plan, replay.settings)
    problems += _check_pieces(replay, reference)
    models, prefixes, faults = _check_stages(replay, reference)
    problems += faults
    if wall_labels is not None:
        problems += _check_image(replay, wall_labels)
    metrics: PlanMetrics | None = None
    whole = replay.broken_at is None and None not in models
    model = models[-1] if whole and models else None
    if blocks is not None and replay.exact:
        problems += check_blocks(blocks, plan, replay, model)
    if whole:
        metrics = claims.recompute_metrics(plan, replay, model)
        problems += claims.check_metrics(plan.metrics, metrics)
    depth, depth_at = deepest_overlap(_outlines(replay))
    area_error, area_error_at = _worst_area(replay)
    return CheckReport(
        problems=tuple(sorted(problems, key=lambda p: (p.step is not None, p.step or 0, p.code))),
        overlap_depth=depth,
        overlap_depth_at=depth_at,
        buried=tuple(stage.stone.stone for stage in replay.stages if pieces.is_buried(stage)),
        area_error=area_error,
        area_error_at=area_error_at,
        prefixes=tuple(prefixes),
        metrics=metrics,
        notes=tuple(_notes(plan, stones, replay, wall_labels, blocks)),
        geometry=replay.settings.geometry,
    )


def _check_pieces(replay: Replay, reference: Reference) -> Iterator[Problem]:
    """Verify what each step says by itself."""
    for piece in replay.pieces:
        if piece.step.kind == "stone":
            yield from claims.check_stone_claims(piece.step, reference)
            if piece.corners is not None:
                stone = reference.stones.by_id(piece.step.stone)
                centroid_px = source_points([piece.step.centroid], replay.site)[0]
                within_px = replay.settings.settle.outline_px
                yield from pieces.check_outline(
                    piece.step, stone, centroid_px, piece.corners, within_px
                )
        elif isinstance(piece.item, Wedge) and not replay.exact:
            yield from pieces.check_polygon(piece.step, piece.item, replay.site)


def _check_stages(
    replay: Replay, reference: Reference
) -> tuple[list[RigidBlockModel | None], list[PrefixAlpha], list[Problem]]:
    """Verify each wall on the way, its indices and wedges; its model and what it carries."""
    models: list[RigidBlockModel | None] = []
    prefixes, problems = [], list[Problem]()
    unit, wall = replay.site.units_per_px, replay.wall
    settings, stock = reference.settings, reference.stock
    limits = wedge_limits(settings, stock, wall.site)
    steps = {p.id: p.step for p in replay.pieces if isinstance(p.step, WedgeStep)}
    for stage in replay.stages:
        model = claims.wall_model(stage.after, settings)
        resistance = None if model is None else lateral_resistance(model)
        problems += claims.check_stands(stage, resistance) or claims.check_sturdy(stage, settings)
        models.append(model)
        alphas: tuple[float | None, float | None] = (None, None)
        if resistance is not None:
            problems += claims.check_indices(stage, resistance, reference, unit)
            alphas = (resistance.left.alpha, resistance.right.alpha)
        prefixes.append(PrefixAlpha(stage.last.step, *alphas))
        for wedge in stage.group.wedges:
            step, settled = steps[wedge.id], stage.group.placement.settled
            if wedge.corners is None or settled is None or wall.outlines is None:
                problems += pieces.check_wedge(
                    step, wedge, stage.after.labels, settings.stabilise, stock.mean_height_px
                )
                continue
            bare, every = model or RigidBlockModel((), (), settings.mu), wall.outlines.polygons
            problems += pieces.check_settled_wedge(
                step, wedge.corners, bare, settled.corners, every, wall.site.extent_px[0], limits
            )
    return models, prefixes, problems


def _check_image(replay: Replay, wall_labels: Labels) -> Iterator[Problem]:
    """Compare wall.png with the rebuilt wall, stone by stone (E236)."""
    if wall_labels.shape != replay.labels.shape:
        height, width = wall_labels.shape
        size = f"{replay.site.width_px} x {replay.site.height_px}"
        yield Problem("E236", None, f"wall.png is {width} x {height} px, not {size}.")
        return
    different = wall_labels != replay.labels
    seen, counts = np.unique(
        np.concatenate([wall_labels[different], replay.labels[different]]), return_counts=True
    )
    steps = {piece.id: piece.step for piece in replay.pieces}
    for label, count in zip(seen.tolist(), counts.tolist(), strict=True):
        if label in steps:
            step = steps[label]
            message = f"{count} px of {step.kind} {label} in wall.png are not those of its pose."
            yield Problem("E236", step.step, message)
        elif label:
            message = f"wall.png has {count} px of {label}, which the plan does not place."
            yield Problem("E236", None, message)


def _outlines(replay: Replay) -> list[tuple[int, shapely.Geometry]]:
    """Return what the outlines of a plan are; wedges of pixels are left out, they fit their gap."""
    height = replay.site.height_px
    found = []
    for piece in replay.pieces:
        if piece.corners is not None:
            found.append((piece.id, shape_of(piece.corners)))
        elif isinstance(piece.item, Placement):
            posed, centroid = piece.item.posed, np.array(piece.item.centroid(height))
            corners = turn(posed.stone.outline, posed.angle_deg) + centroid / posed.scale
            found.append((piece.id, shape_of(corners)))
    return found


def _worst_area(replay: Replay) -> tuple[float, int | None]:
    """Return the largest share by which a stone's pixels miss its own area, and its id."""
    ids, counts = np.unique(replay.labels, return_counts=True)
    seen = dict(zip(ids.tolist(), counts.tolist(), strict=True))
    errors = list[tuple[float, int]]()
    for piece in replay.pieces:
        if not isinstance(piece.item, Placement):
            continue
        posed = piece.item.posed
        # Of a hole that is kept an outline shows nothing.
        whole = int(posed.stone.solid.sum()) if replay.exact else posed.stone.area_px
        own = whole * posed.scale**2
        # Pixels that two outlines share go to the one that covers more.
        area = seen.get(piece.id, 0) if replay.exact else posed.area_px
        errors.append((abs(area - own) / own, piece.id))
    return max(errors, key=lambda one: one[0], default=(0.0, None))


def _notes(
    plan: Plan, stones: StoneSet, replay: Replay, wall_labels: Labels | None, blocks: Any
) -> Iterator[str]:
    if not plan.source["path"]:
        yield "The stones were given by a program: there is no file to compare bytes with."
    elif not (plan.source["sha256"] and stones.source.sha256):
        yield "The bytes of the source were not compared: one of the digests is missing."
    if wall_labels is None:
        yield "wall.png was not compared."
    if blocks is None and replay.exact and plan.steps:
        yield "There is no blocks.json to compare; `analyse` and exports need it."
    if replay.broken_at is not None:
        yield (
            f"From step {replay.broken_at} on the wall cannot be built: stability, indices and "
            "wedges from there, and the metrics, were not checked."
        )
