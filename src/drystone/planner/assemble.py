"""Turn what was built into a plan: steps, metrics, units (DESIGN 2)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from drystone.kernels.outline import pixel_polygon
from drystone.metrics.measure import measure_labels
from drystone.model.placement import Wedge
from drystone.model.plan import Plan, PlanMetrics, StoneStep, WedgeStep
from drystone.model.site import Site
from drystone.planner.build import Build, Candidate
from drystone.planner.events import Stopped
from drystone.planner.workshop import Workshop
from drystone.statics.result import LateralResistance


@dataclass(frozen=True)
class Frame:
    """Lengths of the plan: the wall in source px, and how working px become plan units.

    Parameters
    ----------
    width, height : float
        Of the wall, source px.
    site : Site
        The same at the working resolution.
    """

    width: float
    height: float
    site: Site

    def point(self, x: float, y: float) -> tuple[float, float]:
        """Turn a point of the wall frame in working px into plan units."""
        unit = self.site.units_per_px
        return x * unit, y * unit


def plan_steps(
    build: Build, frame: Frame, clusters: Mapping[int, int]
) -> tuple[StoneStep | WedgeStep, ...]:
    """Return the steps of a plan: each stone, right after it its wedges."""
    steps: list[StoneStep | WedgeStep] = []
    for action in build.actions:
        wedges = action.stabilised.wedges
        alphas = (action.resistance.left.alpha, action.resistance.right.alpha)
        # The alphas of a group stand at its last step.
        none = (None, None)
        steps.append(
            _stone_step(len(steps) + 1, action, frame, clusters, none if wedges else alphas)
        )
        for index, wedge in enumerate(wedges, 1):
            own = alphas if index == len(wedges) else none
            steps.append(_wedge_step(len(steps) + 1, wedge, frame, own))
    return tuple(steps)


def plan_metrics(build: Build, frame: Frame, resistance: LateralResistance) -> PlanMetrics:
    """Return the figures of merit of what is built (DESIGN 5)."""
    scale = frame.site.scale
    wall = build.wall
    if not wall.groups:
        return PlanMetrics(0.0, None, None, None, 0.0, 0.0, None, None, 0.0)
    measured = measure_labels(
        wall.labels,
        wall_px=(frame.width * scale, frame.height * scale),
        wedge_ids=frozenset(wedge.id for wedge in wall.wedges),
        stone_area_px=sum(p.posed.stone.area_px for p in wall.placements) * scale**2,
        lateral_resistance=resistance.value,
    )
    wedge_px = sum(wedge.area_px for wedge in wall.wedges)
    return PlanMetrics(
        F_SF=measured.F_SF,
        F_AV=measured.F_AV,
        F_AH=measured.F_AH,
        F_LR=measured.F_LR,
        T_LEVEL=measured.T_LEVEL,
        E_FLUSH=measured.E_FLUSH,
        alpha_left=resistance.left.alpha,
        alpha_right=resistance.right.alpha,
        wedge_area=wedge_px * frame.site.units_per_px**2,
    )


def assemble_plan(
    workshop: Workshop,
    frame: Frame,
    build: Build,
    stopped: Stopped,
    metrics: PlanMetrics,
    provenance: Mapping[str, Any],
) -> Plan:
    """Return the plan of what is built.

    Parameters
    ----------
    workshop : Workshop
        The stones and their clusters.
    frame : Frame
        Lengths.
    build : Build
        What is built.
    stopped : Stopped
        Why construction ended.
    metrics : PlanMetrics
        Of the wall.
    provenance : mapping
        version, method, seed and settings.
    """
    stones, source = workshop.stones, workshop.stones.source
    described: dict[str, Any] = {
        "path": source.path,
        "sha256": source.sha256,
        "stones": len(stones),
        "width_px": source.width_px,
        "height_px": source.height_px,
    }
    if source.files:
        described["files"] = list(source.files)
    if source.reading:
        described["reading"] = dict(source.reading)
    placed = {action.stone_id for action in build.actions}
    return Plan(
        version=provenance["version"],
        method=provenance["method"],
        seed=provenance["seed"],
        settings=provenance["settings"],
        length_unit="m" if frame.site.px_per_m else "px",
        px_per_m=frame.site.px_per_m,
        working_scale=frame.site.scale,
        source=described,
        width=frame.width / (frame.site.px_per_m or 1.0),
        height=frame.height / (frame.site.px_per_m or 1.0),
        steps=plan_steps(build, frame, workshop.clusters),
        unused=tuple(stone.id for stone in stones if stone.id not in placed),
        stopped=stopped.text,
        metrics=metrics,
    )


def _stone_step(
    number: int,
    action: Candidate,
    frame: Frame,
    clusters: Mapping[int, int],
    alphas: tuple[float | None, float | None],
) -> StoneStep:
    placement = action.stabilised.placement
    height = action.course_height_px
    return StoneStep(
        step=number,
        stone=action.stone_id,
        angle_deg=placement.posed.angle_deg,
        source_centroid=placement.posed.stone.centroid,
        centroid=frame.point(*placement.centroid(frame.site.height_px)),
        side=action.side,
        cluster=clusters[action.stone_id],
        rotation_moves=placement.rotation_moves,
        indices=action.indices.as_dict(),
        course_height=None if height is None else height * frame.site.units_per_px,
        alpha_left=alphas[0],
        alpha_right=alphas[1],
    )


def _wedge_step(
    number: int, wedge: Wedge, frame: Frame, alphas: tuple[float | None, float | None]
) -> WedgeStep:
    bottom = frame.site.height_px - wedge.row - wedge.mask.shape[0]
    corners = pixel_polygon(wedge.mask) + np.array([wedge.col, bottom])
    return WedgeStep(
        step=number,
        id=wedge.id,
        under=wedge.under,
        polygon=tuple(frame.point(float(x), float(y)) for x, y in corners),
        alpha_left=alphas[0],
        alpha_right=alphas[1],
    )
