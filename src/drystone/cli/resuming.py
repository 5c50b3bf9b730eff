"""What an earlier run has left in the output folder, and going on with it (`--resume`)."""

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from drystone.cli.output import print_json
from drystone.cli.request import PlanOutput, PlanRequest
from drystone.drawing.words.planned import summary_of_plan
from drystone.errors import Notice, PlanError, UsageError
from drystone.io.checkpoint import CHECKPOINT, read_checkpoint
from drystone.io.plan_json import read_plan
from drystone.model.plan import Plan
from drystone.planner.events import UNFINISHED, Stopped
from drystone.planner.planner import Planner
from drystone.search.plan_result import result_of
from drystone.search.standing import Standing
from drystone.verify.replay import rebuild_wall


@dataclass(frozen=True, eq=False)
class Earlier:
    """What an earlier run of the same command has left.

    Parameters
    ----------
    plan : Plan or None
        Partial, to be gone on with; or finished.
    standing : Standing or None
        Where its search stands, which goes on whatever the plan is.
    begun : bool
        Whether there is anything of it.
    """

    plan: Plan | None = None
    standing: Standing | None = None
    begun: bool = False

    @property
    def finished(self) -> bool:
        """Whether there is nothing to go on with."""
        return self.plan is not None and self.plan.stopped not in UNFINISHED

    def tell(self) -> None:
        """Say what is gone on with."""
        if self.standing is not None:
            print(f"drystone: going on after {self.standing.walls} walls", file=sys.stderr)
        elif self.plan is not None:
            print(f"drystone: going on after {len(self.plan.stone_steps)} stones", file=sys.stderr)
        elif self.begun:
            print("drystone: nothing to go on with yet, planning begins anew", file=sys.stderr)


def made_of(request: PlanRequest) -> dict[str, Any]:
    """Return all that shapes the plan of a command, by what the user gives, as JSON has it."""
    source = request.stones.source
    shaped: dict[str, Any] = json.loads(
        json.dumps(
            {
                "stones": source.sha256,
                "reading": dict(source.reading),
                "--wall": request.wall,
                "--px-per-m": request.px_per_m,
                "--scale": request.scale,
                "--seed": request.seed,
                "--method": request.method,
                "settings": _without_budget(request.settings.as_dict()),
            }
        )
    )
    return shaped


def earlier_run(request: PlanRequest, folder: Path) -> Earlier:
    """Return what to go on from, if that is asked for; refuse what is of something else (E136)."""
    if not request.resume:
        return Earlier()
    asked, path = made_of(request), folder / "plan.json"
    plan = read_plan(path) if path.exists() else None
    different = [] if plan is None else _differences(plan, asked, request.asked_method)
    try:
        kept = read_checkpoint(
            folder, [stone.id for stone in request.stones], request.settings.search
        )
    except PlanError as error:
        cure = "The partial plan is gone on from." if plan is not None else "Planning begins anew."
        notice = Notice("W129", f"{error.where}: {error.what}", cure)
        print(f"drystone: {notice}", file=sys.stderr)
        kept = None
    if kept is None:
        if plan is not None:
            _refuse(different, path)
        return Earlier(plan, begun=(folder / CHECKPOINT).exists() or plan is not None)
    _refuse([n for n in asked if kept.made_of.get(n) != asked[n]], folder / CHECKPOINT)
    if kept.standing is not None:
        return Earlier(standing=kept.standing, begun=True)
    # Beside a checkpoint a finished plan is an earlier one, or was not written to the end.
    partial = plan is not None and not different and plan.stopped in UNFINISHED
    return Earlier(plan if partial else None, begun=True)


def _differences(plan: Plan, asked: Mapping[str, Any], asked_method: str) -> list[str]:
    """Name what a plan was made of that is not what is asked for."""
    px_per_m = asked["--px-per-m"] or 1.0
    size = plan.width * px_per_m, plan.height * px_per_m
    equal = {
        "stones": plan.source["sha256"] == asked["stones"],
        "reading": plan.source.get("reading", {}) == asked["reading"],
        "--wall": np.allclose(size, asked["--wall"], rtol=0, atol=1e-6),
        "--px-per-m": plan.px_per_m == asked["--px-per-m"],
        "--scale": plan.working_scale == asked["--scale"],
        "--seed": plan.seed == asked["--seed"],
        "--method": plan.method in (asked["--method"], asked_method),
        "settings": _without_budget(plan.settings) == asked["settings"],
    }
    return [name for name, same in equal.items() if not same]


def _refuse(different: list[str], path: Path) -> None:
    if different:
        raise UsageError(
            "E136",
            f"the partial plan was made with other {', '.join(different)}.",
            where=str(path),
            cure="Give the same command again with --resume added, or plan into another folder.",
        )


def tell_finished(plan: Plan, request: PlanRequest, output: PlanOutput) -> str:
    """Say that there is nothing to go on with; return the status that the wall ended with."""
    print(
        "drystone: this plan is finished, there is nothing to go on with;"
        " --from begins a search with it",
        file=sys.stderr,
    )
    wall = rebuild_wall(plan, request.stones)
    planner = Planner(request.stones, wall.site, seed=plan.seed, settings=request.settings)
    planner.restore(wall, plan.course_heights_px)
    # A plan keeps why it ended in words only, and the words are all that is asked for.
    planner.stopped = Stopped("search", plan.stopped)
    result = result_of(planner)
    if result.shortfall:
        print(f"drystone: {result.status}: {result.shortfall}", file=sys.stderr)
    if output.json:
        told = summary_of_plan(plan, output.folder)
        print_json(told | {"status": "finished"})
    return result.status


def _without_budget(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Leave out how many walls a search builds: an interrupted plan says how many it had built."""
    search = dict(settings.get("search", {}))
    search.pop("budget", None)
    return {**settings, "search": search}
