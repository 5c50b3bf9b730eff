"""The plan that is in the output folder already, and going on with it (`--resume`)."""

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from drystone.cli.output import print_json
from drystone.cli.plan_summary import summary_of_plan
from drystone.cli.settings import recorded_method
from drystone.errors import UsageError
from drystone.io.plan_json import read_plan
from drystone.model.plan import Plan
from drystone.model.stone import StoneSet
from drystone.planner.events import Stopped
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.search.plan_result import result_of
from drystone.search.plan_wall import working_scale
from drystone.verify.replay import rebuild_wall


def partial_plan(
    folder: Path,
    stones: StoneSet,
    wall: tuple[float, float],
    arguments: argparse.Namespace,
    settings: PlannerSettings,
) -> Plan | None:
    """Return the plan to go on from; refuse one that was made of or for something else (E136)."""
    path = folder / "plan.json"
    if not getattr(arguments, "resume", False) or not path.exists():
        return None
    plan = read_plan(path)
    px_per_m = arguments.px_per_m or 1.0
    scale = arguments.scale or working_scale(stones)
    size = plan.width * px_per_m, plan.height * px_per_m
    equal = {
        "stones": plan.source["sha256"] == stones.source.sha256,
        "reading": plan.source.get("reading", {}) == dict(stones.source.reading),
        "--wall": np.allclose(size, wall, rtol=0, atol=1e-6),
        "--px-per-m": plan.px_per_m == arguments.px_per_m,
        "--scale": plan.working_scale == scale,
        "--seed": plan.seed == arguments.seed,
        "--method": plan.method in (recorded_method(arguments), arguments.method),
        "settings": _without_budget(plan.settings) == _without_budget(settings.as_dict()),
    }
    different = [name for name, same in equal.items() if not same]
    if different:
        raise UsageError(
            "E136",
            f"the partial plan was made with other {', '.join(different)}.",
            where=str(path),
            cure="Give the same command again with --resume added, or plan into another folder.",
        )
    return plan


def tell_finished(
    plan: Plan, stones: StoneSet, settings: PlannerSettings, arguments: argparse.Namespace
) -> str:
    """Say that there is nothing to go on with; return the status that the wall ended with."""
    print(
        "drystone: this plan is finished, there is nothing to go on with;"
        " --from begins a search with it",
        file=sys.stderr,
    )
    wall = rebuild_wall(plan, stones)
    planner = Planner(stones, wall.site, seed=plan.seed, settings=settings)
    planner.restore(wall, course_heights(plan))
    # A plan keeps why it ended in words only, and the words are all that is asked for.
    planner.stopped = Stopped("search", plan.stopped)
    result = result_of(planner)
    if result.shortfall:
        print(f"drystone: {result.status}: {result.shortfall}", file=sys.stderr)
    if arguments.json:
        told = summary_of_plan(plan, Path(arguments.output))
        print_json(told | {"status": "finished"})
    return result.status


def _without_budget(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Leave out how many walls a search builds: an interrupted plan says how many it had built."""
    search = {name: value for name, value in settings["search"].items() if name != "budget"}
    return {**settings, "search": search}


def course_heights(plan: Plan | None) -> dict[int, float]:
    """Return the heights that the courses of a plan were begun with, by their first stone; px."""
    if plan is None:
        return {}
    to_px = plan.working_scale * (plan.px_per_m or 1.0)
    return {
        step.stone: step.course_height * to_px
        for step in plan.stone_steps
        if step.course_height is not None
    }
