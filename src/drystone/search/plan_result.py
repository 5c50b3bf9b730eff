"""What planning gave, and whether the wall counts as complete."""

import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from importlib.metadata import version
from typing import Any

from drystone.contacts.settled import model_of_outlines
from drystone.errors import Notice
from drystone.model.plan import Plan, PlanMetrics
from drystone.model.wall import Wall
from drystone.planner.assemble import assemble_plan, plan_metrics
from drystone.planner.build import Build, Solves
from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from drystone.planner.events import INTERRUPTED, Stopped
from drystone.planner.planner import Planner
from drystone.planner.profile import Profile
from drystone.planner.settings import PlannerSettings
from drystone.search.goal import FILLED, FILLED_TOP, mean_top, usable_area_px
from drystone.shown import html_of
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance

MOST_WITHOUT_DILATANCY = 150
"""Twelve starts take some ten seconds for so many blocks, and the time grows with their square."""


@dataclass(frozen=True, eq=False)
class PlanResult:
    """What planning gave.

    Parameters
    ----------
    success : bool
        True unless the wall is incomplete or planning was interrupted.
    status : {"complete", "incomplete", "interrupted"}
        Incomplete: filling below 0.99 and a mean top below 0.9 of the height, without a stone that
        is pinned, or as it was measured it does not stand.
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
        taken out, W122 when a process died, W125 when what follows a search was cut short, W126
        when a wall that was built already does not stand, W128 when the time limit cut the first
        wall short; W303 when the solver gave up on some candidates, which were then passed over.
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

    def _repr_html_(self) -> str | None:
        return html_of("plan", self)


def provenance_of(settings: PlannerSettings, method: str, seed: int, budget: int) -> dict[str, Any]:
    """Say how a plan was made; `budget` is that which repeats it."""
    return {
        "version": version("drystone"),
        "method": method,
        "seed": seed,
        "settings": settings.updated({"search": {"budget": budget}}).as_dict(),
    }


def finish(
    planner: Planner,
    stopped: Stopped,
    provenance: Mapping[str, Any],
    seconds: float,
    until: Deadline = NEVER,
) -> PlanResult:
    """Judge what a planner has built and write the plan."""
    build = planner.build
    width, height = build.wall.site.extent_px
    resistance = lateral_resistance(build.model, mechanism=True)
    others = other_resistances(build, resistance, planner.settings, until)
    metrics = plan_metrics(build, resistance, others)
    plan = assemble_plan(planner.workshop, build, stopped, metrics, provenance)
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
        F_SF_bound=min(1.0, usable_area_px(planner.workshop) / (width * height)),
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
    >>> import drystone as ds, numpy as np
    >>> bricks = ds.generate.BrickSettings(count=3, height_px=10, aspect=2)
    >>> stones = ds.generate.brick_stones(bricks, np.random.default_rng(1))
    >>> planner = ds.Planner(stones, ds.Site(60, 10))
    >>> steps = planner.steps()
    >>> _ = next(steps), next(steps)
    >>> result = result_of(planner)
    >>> result.status, len(result.plan.steps)
    ('interrupted', 2)
    """
    provenance = provenance_of(planner.settings, "custom", planner.seed, 1)
    stopped = planner.stopped or INTERRUPTED
    result = finish(planner, stopped, provenance, 0.0)
    return replace(result, solves=planner.solves)


def missing_stones(planner: Planner) -> tuple[int, ...]:
    """Return the ids of pinned stones that are not in the wall of a planner."""
    placed = {action.stone_id for action in planner.build.actions}
    return tuple(sorted(set(planner.settings.pin) - placed))


def _shortfall(planner: Planner, metrics: PlanMetrics) -> str:
    if missing_stones(planner):
        return "stones that are pinned are missing"
    if not all(action.stands for action in planner.build.actions):
        return "as it was built, it does not stand"
    top = mean_top(planner.build.wall)
    if metrics.F_SF < FILLED and top < FILLED_TOP:
        below = math.floor(1e3 * top) / 1e3  # 0.8999 must not read 0.900
        return (
            f"the top is at {below:.3f} of the wall's height on average, less than {FILLED_TOP:g}"
        )
    return ""


def other_resistances(
    build: Build, resistance: LateralResistance, settings: PlannerSettings, until: Deadline = NEVER
) -> dict[str, float | None]:
    """Return F_LR by other rules, and load multipliers, by the names of a plan's metrics.

    Without dilatancy it is looked for in walls of up to :data:`MOST_WITHOUT_DILATANCY` blocks,
    where the wall stands, and where there is time.
    """
    found: dict[str, float | None] = {}
    if resistance.stable and 0 < len(build.model.blocks) <= MOST_WITHOUT_DILATANCY:
        with suppress(TimeIsUp):
            # What is found goes by the order of blocks; `check` puts the wall together otherwise.
            without = nonassociative_resistance(build.model.in_order(), look=until.look)
            found["F_LR_coulomb"] = without.carried
            found["alpha_left_coulomb"] = without.left.alpha
            found["alpha_right_coulomb"] = without.right.alpha
    outlines, settle = build.wall.outlines, settings.settle
    if outlines is not None:
        for name, share, setback in (
            ("F_LR_half", 0.5, settle.setback),
            ("F_LR_double", 2.0, settle.setback),
            ("F_LR_no_setback", 1.0, 0.0),
        ):
            tolerance = share * settle.contact_px
            model = model_of_outlines(outlines.blocks, settings.mu, tolerance, setback)
            found[name] = lateral_resistance(model).value
    return found
