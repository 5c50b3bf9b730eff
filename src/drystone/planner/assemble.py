"""Turn what was built into a plan: steps, metrics, units (DESIGN 2)."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from drystone.kernels.outline import pixel_polygon
from drystone.kernels.polygons import area_and_centroid
from drystone.metrics.measure import measure_labels
from drystone.model.placement import Placement, Wedge
from drystone.model.plan import FIGURES, Plan, PlanMetrics, StoneStep, WedgeStep
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.planner.build import Build
from drystone.planner.events import Stopped
from drystone.planner.workshop import Workshop
from drystone.statics.result import LateralResistance


@dataclass(frozen=True)
class Frame:
    """Lengths of the plan: the wall in source px, and how working px become plan units."""

    # of the wall, source px
    width: float
    height: float
    site: Site  # the same at the working resolution

    def point(self, x: float, y: float) -> tuple[float, float]:
        """Turn a point of the wall frame in working px into plan units."""
        unit = self.site.units_per_px
        return x * unit, y * unit

    def source_point(self, x_px: float, y_px: float) -> tuple[float, float]:
        """Turn a point of the wall frame in source px into plan units."""
        px_per_m = self.site.px_per_m or 1.0
        return x_px / px_per_m, y_px / px_per_m

    def centroid(self, placement: Placement) -> tuple[float, float]:
        """Return where the centroid of a stone is, in plan units."""
        if placement.settled is not None:
            return self.source_point(placement.settled.x_px, placement.settled.y_px)
        return self.point(*placement.centroid(self.site.height_px))

    def polygon(self, wedge: Wedge) -> tuple[tuple[float, float], ...]:
        """Return the corners of a wedge, in plan units."""
        if wedge.corners is not None:
            return tuple(self.source_point(x, y) for x, y in wedge.corners.tolist())
        bottom = self.site.height_px - wedge.row - wedge.mask.shape[0]
        corners = pixel_polygon(wedge.mask) + np.array([wedge.col, bottom])
        return tuple(self.point(float(x), float(y)) for x, y in corners)


def plan_steps(
    build: Build, frame: Frame, clusters: Mapping[int, int]
) -> tuple[StoneStep | WedgeStep, ...]:
    """Return the steps of a plan: each stone, right after it its wedges."""
    steps: list[StoneStep | WedgeStep] = []
    for action in build.actions:
        placement, wedges = action.stabilised.placement, action.stabilised.wedges
        height = action.course_height_px
        alphas = (action.resistance.left.alpha, action.resistance.right.alpha)
        # The alphas of a group stand at its last step.
        left, right = (None, None) if wedges else alphas
        stone = StoneStep(
            step=len(steps) + 1,
            stone=action.stone_id,
            angle_deg=placement.posed.angle_deg,
            source_centroid=placement.posed.stone.centroid,
            centroid=frame.centroid(placement),
            side=action.side,
            cluster=clusters[action.stone_id],
            rotation_moves=placement.rotation_moves,
            indices=action.indices.as_dict(),
            course_height=None if height is None else height * frame.site.units_per_px,
            alpha_left=left,
            alpha_right=right,
        )
        steps.append(stone)
        for index, wedge in enumerate(wedges, 1):
            left, right = alphas if index == len(wedges) else (None, None)
            number, polygon = len(steps) + 1, frame.polygon(wedge)
            steps.append(WedgeStep(number, wedge.id, wedge.under, polygon, left, right))
    return tuple(steps)


def plan_metrics(
    build: Build,
    frame: Frame,
    resistance: LateralResistance,
    others: Mapping[str, float | None] = MappingProxyType({}),
) -> PlanMetrics:
    """Return the figures of merit of what is built (DESIGN 5).

    `others` are F_LR by other rules, by the names of :class:`drystone.model.plan.PlanMetrics`.
    """
    scale = frame.site.scale
    wall = build.wall
    if not wall.groups:
        return PlanMetrics(0.0, None, None, None, 0.0, 0.0, None, None, 0.0)
    measured = measure_labels(
        wall.labels,
        # Metres times px per metre leave rounding errors, which must not decide over a half px.
        wall_px=(round(frame.width * scale, 9), round(frame.height * scale, 9)),
        wedge_ids=frozenset(wedge.id for wedge in wall.wedges),
        stone_area_px=sum(p.posed.stone.area_px for p in wall.placements) * scale**2,
        lateral_resistance=resistance.value,
    )
    figures: dict[str, Any] = {name: getattr(measured, name) for name in FIGURES}
    return PlanMetrics(
        alpha_left=resistance.left.alpha,
        alpha_right=resistance.right.alpha,
        wedge_area=wedge_area(wall) / (frame.site.px_per_m or 1.0) ** 2,
        **(figures | dict(others)),
    )


def wedge_area(wall: Wall) -> float:
    """Return the area of all wedges in source px."""
    if wall.outlines is None:
        return sum(wedge.area_px for wedge in wall.wedges) / wall.site.scale**2
    corners = (wedge.corners for wedge in wall.wedges if wedge.corners is not None)
    return math.fsum(area_and_centroid(polygon)[0] for polygon in corners)


def assemble_plan(
    workshop: Workshop,
    frame: Frame,
    build: Build,
    stopped: Stopped,
    metrics: PlanMetrics,
    provenance: Mapping[str, Any],
) -> Plan:
    """Return the plan of what is built; `provenance`: version, method, seed and settings."""
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
    if source.photograph:
        described["photograph"] = dict(source.photograph)
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
