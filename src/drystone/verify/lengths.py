"""What a plan says of itself: its settings, its site, and its lengths in px."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import PlanError, UsageError
from drystone.kernels.polygons import on_grid
from drystone.model.plan import Plan, Point
from drystone.model.settings import flat, nested
from drystone.model.site import MAX_SITE_PX, Site
from drystone.model.steps import Problem
from drystone.planner.settings import METHODS, PlannerSettings

_Path = tuple[str, ...]
"""Names that lead to a setting, the outer first."""


def plan_settings(plan: Plan) -> tuple[PlannerSettings, list[Problem]]:
    """Return the settings of a plan, and E217 when not all of them are usable.

    A setting that is not has the value of the plan's method, or the package's own default when
    the plan names none that is known here.
    """
    base, settle = PlannerSettings(), plan.settings.get("settle")
    if isinstance(settle, Mapping) and "setback" not in settle:  # made when there was none yet
        base = base.updated({"settle": {"setback": 0.0}})
    try:
        return base.updated(plan.settings), []
    except UsageError as error:
        refusal = error
    settings, refused = _usable(base, plan.settings)
    instead = METHODS.get(plan.method, PlannerSettings()).as_dict()
    for path in refused:
        value = _value(instead, path)
        if value is not ...:
            settings, _ = _usable(settings, nested([(path, value)]))
    whose = f"of the method {plan.method!r}" if plan.method in METHODS else "the package's own"
    message = f"the settings cannot be used: {refusal} {_instead(settings, refused, whose)}"
    return settings, [Problem("E217", None, message)]


def _usable(
    settings: PlannerSettings, asked: Mapping[str, Any]
) -> tuple[PlannerSettings, list[_Path]]:
    """Take over each setting that can be; return the names of the others too."""
    left, before = list(flat(asked)), -1
    # Some are only allowed beside others (a policy beside a budget of 1), in whatever order.
    while left and len(left) != before:
        before, refused = len(left), []
        for path, value in left:
            try:
                settings = settings.updated(nested([(path, value)]))
            except UsageError:
                refused.append((path, value))
        left = refused
    return settings, [path for path, _ in left]


def _value(settings: Any, path: _Path) -> Any:
    """Return a setting by the names that lead to it; ... where there is none."""
    for name in path:
        settings = settings.get(name, ...) if isinstance(settings, Mapping) else ...
    return settings


def _instead(settings: PlannerSettings, refused: Sequence[_Path], whose: str) -> str:
    """Say with what a plan is checked whose settings are not all usable."""
    used, unknown = [], []
    for path in refused:
        value = _value(settings.as_dict(), path)
        if value is ...:
            unknown.append(".".join(path))
        else:
            used.append(".".join(path) + ("" if isinstance(value, Mapping) else f" = {value!r}"))
    said = [f"Used instead, {whose}: {', '.join(used)}."] if used else []
    said += [f"Left out: {', '.join(unknown)}."] if unknown else []
    return " ".join([*said, "The others are those of the plan."])


def plan_site(plan: Plan) -> Site:
    """Return the site of a plan; raise PlanError (E215) when it is no possible image."""
    source_px = plan.px_per_m or 1.0
    # Metres times px per metre leave rounding errors, which must not decide over a half px.
    width, height = round(plan.width * source_px, 6), round(plan.height * source_px, 6)
    area = width * height * plan.working_scale**2
    if not 0.25 <= area <= MAX_SITE_PX or plan.working_scale * min(width, height) < 0.5:
        raise PlanError(
            "E215",
            f"a wall of {width:g} x {height:g} px at a working scale of {plan.working_scale:g} "
            "cannot be made an image.",
            where="wall",
            cure=f"Its image must have 1 to {MAX_SITE_PX} px.",
        )
    return Site.from_source(width, height, plan.working_scale, plan.px_per_m)


def source_points(points: Sequence[Point], site: Site) -> NDArray[np.float64]:
    """Turn points in plan's units into source px, on the grid of settled stones."""
    return on_grid(np.array(points, float) * (site.px_per_m or 1.0))


def working_points(points: Sequence[Point], site: Site) -> NDArray[np.float64]:
    """Turn points in plan's units into working px."""
    return np.asarray(np.array(points, float) * (site.px_per_m or 1.0) * site.scale)
