"""The plan that a search begins with (`--from`)."""

import numpy as np

from drystone.cli.request import PlanRequest
from drystone.errors import UsageError
from drystone.io.plan_json import read_plan
from drystone.model.plan import Plan


def plan_to_begin_with(request: PlanRequest) -> Plan | None:
    """Return the plan of `--from`; None when there is none.

    Raises
    ------
    UsageError
        E144: it is of other stones, for another wall, made at another resolution or geometry, or
        in poses or from a side that the settings do not allow.
    """
    if request.begin is None:
        return None
    plan = read_plan(request.begin)
    stones, wall, settings = request.stones, request.wall, request.settings
    size = np.array([plan.width, plan.height]) * (plan.px_per_m or 1.0)
    geometry = str(plan.settings.get("geometry", "raster"))
    found = [
        _other("other stones", same=plan.source["sha256"] == stones.source.sha256),
        _other(
            "stones that were read otherwise",
            same=plan.source.get("reading", {}) == dict(stones.source.reading),
        ),
        _other(
            f"another wall ({size[0]:g}x{size[1]:g} px, not {wall[0]:g}x{wall[1]:g})",
            same=bool(np.allclose(size, wall, rtol=0, atol=1e-6)),
        ),
        _other(
            "another resolution",
            f"--scale {plan.working_scale:g}",
            same=plan.working_scale == request.scale,
        ),
        _other("another geometry", f"--geometry {geometry}", same=geometry == settings.geometry),
        _other(
            "other orientations",
            f"--orientations {plan.settings.get('orientations', settings.orientations)}",
            same=plan.settings.get("orientations", settings.orientations) == settings.orientations,
        ),
        _other(
            "both sides",
            "--two-sided",
            same=settings.two_sided or not plan.settings.get("two_sided", False),
        ),
    ]
    different = [one for one in found if one is not None]
    if different:
        options = " ".join(option for _, option in different if option)
        raise UsageError(
            "E144",
            f"the plan is of {', '.join(name for name, _ in different)}.",
            where=str(request.begin),
            cure=f"Add {options}." if all(option for _, option in different) else
            "Give the stones and the wall that the plan was made for, or leave --from out.",
        )  # fmt: skip
    return plan


def _other(name: str, option: str = "", *, same: bool) -> tuple[str, str] | None:
    return None if same else (name, option)
