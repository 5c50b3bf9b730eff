"""Turn what was built into a plan: steps, metrics, units (DESIGN 2)."""

import math
from collections.abc import Mapping
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


def _source_point(site: Site, x_px: float, y_px: float) -> tuple[float, float]:
    """Turn a point of the wall frame in source px into plan units."""
    px_per_m = site.px_per_m or 1.0
    return x_px / px_per_m, y_px / px_per_m


def _centroid(placement: Placement, site: Site) -> tuple[float, float]:
    """Return where the centroid of a stone is, in plan units."""
    if placement.settled is not None:
        return _source_point(site, placement.settled.x_px, placement.settled.y_px)
    x, y = placement.centroid(site.height_px)
    return x * site.units_per_px, y * site.units_per_px


def _polygon(wedge: Wedge, site: Site) -> tuple[tuple[float, float], ...]:
    """Return the corners of a wedge, in plan units."""
    if wedge.corners is not None:
        return tuple(_source_point(site, x, y) for x, y in wedge.corners.tolist())
    bottom, unit = site.height_px - wedge.row - wedge.mask.shape[0], site.units_per_px
    corners = pixel_polygon(wedge.mask) + np.array([wedge.col, bottom])
    return tuple((float(x) * unit, float(y) * unit) for x, y in corners)


def plan_steps(build: Build, clusters: Mapping[int, int]) -> tuple[StoneStep | WedgeStep, ...]:
    """Return the steps of a plan: each stone, right after it its wedges."""
    steps: list[StoneStep | WedgeStep] = []
    site = build.wall.site
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
            centroid=_centroid(placement, site),
            side=action.side,
            cluster=clusters[action.stone_id],
            rotation_moves=placement.rotation_moves,
            indices=action.indices.as_dict(),
            course_height=None if height is None else height * site.units_per_px,
            alpha_left=left,
            alpha_right=right,
        )
        steps.append(stone)
        for index, wedge in enumerate(wedges, 1):
            left, right = alphas if index == len(wedges) else (None, None)
            number, polygon = len(steps) + 1, _polygon(wedge, site)
            steps.append(WedgeStep(number, wedge.id, wedge.under, polygon, left, right))
    return tuple(steps)


def plan_metrics(
    build: Build,
    resistance: LateralResistance,
    others: Mapping[str, float | None] = MappingProxyType({}),
) -> PlanMetrics:
    """Return the figures of merit of what is built (DESIGN 5).

    `others` are F_LR by other rules, by the names of :class:`drystone.model.plan.PlanMetrics`.
    """
    wall, site = build.wall, build.wall.site
    if not wall.groups:
        return PlanMetrics(0.0, None, None, None, None, None, None, None, 0.0)
    width, height = site.extent_px
    measured = measure_labels(
        wall.labels,
        # Metres times px per metre leave rounding errors, which must not decide over a half px.
        wall_px=(round(width * site.scale, 9), round(height * site.scale, 9)),
        wedge_ids=frozenset(wedge.id for wedge in wall.wedges),
        stone_area_px=sum(p.posed.stone.area_px for p in wall.placements) * site.scale**2,
        lateral_resistance=resistance.value,
    )
    figures: dict[str, Any] = {name: getattr(measured, name) for name in FIGURES}
    return PlanMetrics(
        alpha_left=resistance.left.alpha,
        alpha_right=resistance.right.alpha,
        wedge_area=wedge_area(wall) / (site.px_per_m or 1.0) ** 2,
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
    told = (("files", list), ("reading", dict), ("photograph", dict))
    described |= {name: kind(said) for name, kind in told if (said := getattr(source, name))}
    placed = {action.stone_id for action in build.actions}
    site = build.wall.site
    width, height = _source_point(site, *site.extent_px)
    return Plan(
        **provenance,
        length_unit="m" if site.px_per_m else "px",
        px_per_m=site.px_per_m,
        working_scale=site.scale,
        source=described,
        width=width,
        height=height,
        steps=plan_steps(build, workshop.clusters),
        unused=tuple(stone.id for stone in stones if stone.id not in placed),
        stopped=stopped.text,
        metrics=metrics,
    )
