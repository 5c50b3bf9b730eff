"""What a plan says of itself: its settings, its site, and its lengths in px."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from drystone.errors import PlanError, UsageError
from drystone.kernels.polygons import on_grid
from drystone.model.plan import Plan, Point
from drystone.model.site import MAX_SITE_PX, Site
from drystone.planner.settings import PlannerSettings
from drystone.verify.report import Problem

MAX_WALL_PX = MAX_SITE_PX
"""Larger walls are neither planned nor rebuilt."""


def plan_settings(plan: Plan) -> tuple[PlannerSettings, list[Problem]]:
    """Return the settings of a plan; the package's own, and E217, when they are not usable.

    The geometry is the one that the plan claims, in any case.
    """
    try:
        return PlannerSettings().updated(plan.settings), []
    except UsageError as error:
        problem = Problem("E217", None, f"the settings cannot be used: {error}")
    exact = plan.settings.get("geometry") == "exact"
    return replace(PlannerSettings(), geometry="exact" if exact else "raster"), [problem]


def plan_site(plan: Plan) -> Site:
    """Return the site of a plan; raise PlanError (E215) when it is no possible image."""
    source_px = plan.px_per_m or 1.0
    # Metres times px per metre leave rounding errors, which must not decide over a half px.
    width, height = round(plan.width * source_px, 6), round(plan.height * source_px, 6)
    area = width * height * plan.working_scale**2
    if not 0.25 <= area <= MAX_WALL_PX or plan.working_scale * min(width, height) < 0.5:
        raise PlanError(
            "E215",
            f"a wall of {width:g} x {height:g} px at a working scale of {plan.working_scale:g} "
            "cannot be made an image.",
            where="wall",
            cure=f"Its image must have 1 to {MAX_WALL_PX} px.",
        )
    return Site.from_source(width, height, plan.working_scale, plan.px_per_m)


def source_points(points: Sequence[Point], site: Site) -> NDArray[np.float64]:
    """Turn points in plan's units into source px, on the grid of settled stones."""
    return on_grid(np.array(points, float) * (site.px_per_m or 1.0))


def working_points(points: Sequence[Point], site: Site) -> NDArray[np.float64]:
    """Turn points in plan's units into working px."""
    return np.asarray(np.array(points, float) * (site.px_per_m or 1.0) * site.scale)
