"""What planning gave, and whether the wall counts as complete."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from importlib import import_module
from importlib.metadata import version
from typing import Any

import numpy as np

from drystone.errors import Notice
from drystone.metrics.level import top_profile
from drystone.model.plan import Plan, PlanMetrics
from drystone.model.wall import Wall
from drystone.planner.assemble import Frame, assemble_plan, plan_metrics
from drystone.planner.build import Build
from drystone.planner.events import Stopped
from drystone.planner.planner import Planner
from drystone.planner.profile import Profile
from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.search.goal import usable_area_px
from drystone.search.notices import missing_stones
from drystone.statics.contacts.settled import model_of_outlines
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance

FILLED = 0.99
"""Filling from which a plan is complete whatever its top (DESIGN 2)."""

FILLED_TOP = 0.9
"""A plan is incomplete when its mean top stays below this share of the wall's height."""


@dataclass(frozen=True, eq=False)
class PlanResult:
    """What planning gave.

    Parameters
    ----------
    success : bool
        True unless the wall is incomplete or planning was interrupted.
    status : {"complete", "incomplete", "interrupted"}
        Incomplete: filling below .99 and a mean top below .9 of the height, or without a stone
        that is pinned.
    message : str
        Why construction ended.
    shortfall : str
        What an incomplete wall falls short of; else empty.
    plan : Plan
        The plan.
    metrics : PlanMetrics
        The plan's figures of merit.
    wall : Wall
        The wall at the working resolution.
    model : RigidBlockModel
        Its blocks and contacts, in working px; in source px when the geometry is exact.
    resistance : LateralResistance
        With both mechanisms.
    clusters : dict of int to int
        Cluster of each stone.
    seconds : float
        From the stones to the last step.
    F_SF_bound : float
        What F_SF can be at most: the area of the stones that may be used over that of the wall,
        or 1.
    notices : tuple of Notice
        W120 when pinned stones are missing, W121 when stones of the wall that was begun with were
        taken out, W122 when a process died, W125 when the search or what follows it was
        interrupted, W126 when a wall that was built already does not stand; W303 when the solver
        gave up on some candidates, which were then passed over.
    profile : Profile
        Where the time went.
    solves : Solves
        What trouble the solver had on the way.
    choice : tuple of PlanResult
        When they were asked for: walls of the search that none beats in every figure of merit,
        that of most merit first.
    """

    success: bool
    status: str
    message: str
    shortfall: str
    plan: Plan
    metrics: PlanMetrics
    wall: Wall
    model: RigidBlockModel
    resistance: LateralResistance
    clusters: dict[int, int]
    seconds: float
    F_SF_bound: float
    notices: tuple[Notice, ...] = ()
    profile: Profile = field(default_factory=Profile)
    solves: Solves = field(default_factory=Solves)
    choice: "tuple[PlanResult, ...]" = ()

    def __repr__(self) -> str:
        placed, stones = len(self.plan.stone_steps), self.plan.source.get("stones", "?")
        return f"<PlanResult {self.status}: {placed} of {stones} stones, {self.metrics}>"

    def _repr_html_(self) -> str:
        # By name, as the package itself loads its rooms: the report lies above the search.
        return str(import_module("drystone.report.notebook").frame_of_result(self))


def finish(
    planner: Planner,
    frame: Frame,
    stopped: Stopped,
    provenance: Mapping[str, Any],
    seconds: float,
) -> PlanResult:
    """Judge what a planner has built and write the plan."""
    build = planner.build
    resistance = lateral_resistance(build.model, mechanism=True)
    metrics = plan_metrics(
        build, frame, resistance, resistance_by_tolerance(build, planner.settings)
    )
    plan = assemble_plan(planner.workshop, frame, build, stopped, metrics, provenance)
    interrupted = stopped.reason == "interrupted"
    shortfall = "" if interrupted else _shortfall(planner, metrics)
    status = "interrupted" if interrupted else "incomplete" if shortfall else "complete"
    return PlanResult(
        success=status == "complete",
        status=status,
        message=stopped.text,
        shortfall=shortfall,
        plan=plan,
        metrics=metrics,
        wall=build.wall,
        model=build.model,
        resistance=resistance,
        clusters=planner.workshop.clusters,
        seconds=seconds,
        F_SF_bound=min(1.0, usable_area_px(planner.workshop) / (frame.width * frame.height)),
        profile=planner.profile,
    )


def result_of(planner: Planner) -> PlanResult:
    """Return what a planner has built so far, as a result whose plan can be written.

    Parameters
    ----------
    planner : Planner
        After its :meth:`~drystone.Planner.steps`, or in the midst of them: the result is then
        "interrupted".

    Examples
    --------
    >>> import drystone as ds
    >>> bricks = ds.generate.BrickSettings(count=3, height_px=10, aspect=2)
    >>> stones = ds.generate.brick_stones(bricks, np.random.default_rng(1))
    >>> planner = ds.Planner(stones, ds.Site(60, 10))
    >>> steps = planner.steps()
    >>> _ = next(steps), next(steps)
    >>> result = result_of(planner)
    >>> result.status, len(result.plan.steps)
    ('interrupted', 2)
    """
    settings = planner.settings
    one_pass = replace(settings, search=replace(settings.search, budget=1))
    provenance = {
        "version": version("drystone"),
        "method": "custom",
        "seed": planner.seed,
        "settings": one_pass.as_dict(),
    }
    site = planner.build.wall.site
    stopped = planner.stopped or Stopped("interrupted", "interrupted")
    result = finish(planner, Frame(*site.extent_px, site), stopped, provenance, 0.0)
    return replace(result, solves=Solves(planner.failed_solves, planner.cold_solves))


def _shortfall(planner: Planner, metrics: PlanMetrics) -> str:
    if missing_stones(planner):
        return "stones that are pinned are missing"
    top = mean_top(planner.build.wall)
    if metrics.F_SF < FILLED and top < FILLED_TOP:
        return f"the top is at {top:.3f} of the wall's height on average, less than {FILLED_TOP:g}"
    return ""


def resistance_by_tolerance(
    build: Build, settings: PlannerSettings
) -> tuple[float | None, float | None]:
    """Return F_LR at half and at twice the contact tolerance; None for a wall of pixels."""
    outlines = build.wall.outlines
    if outlines is None:
        return None, None
    models = [
        model_of_outlines(outlines, settings.mu, share * settings.settle.contact_px)
        for share in (0.5, 2.0)
    ]
    half, double = (lateral_resistance(model).value for model in models)
    return half, double


def mean_top(wall: Wall) -> float:
    """Return the mean height of the wall's top over its columns, as a share of its height."""
    return float(np.mean(top_profile(wall.labels))) / wall.site.height_px
